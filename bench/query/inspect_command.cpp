#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/answer/answer_text.h"
#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/inputs/input.h"
#include "bench/inputs/input_options.h"
#include "bench/inputs/thickness.h"
#include "bench/output/output.h"
#include "bench/strategies/catalogue.h"
#include "bench/strategies/strategy_row.h"
#include "core/base/number_text.h"
#include "core/detect/start/embedding.h"
#include "scenes/base/joined.h"
#include "scenes/character/pieces.h"

// `cscd inspect` says what an input is made of and what each strategy can do with it, for every component and
// for all of them together.
namespace cscd::bench {
namespace {

using nlohmann::json;
using scenes::Piece;

struct InspectOptions {
  std::string input, output;
  bool force = false;
  ModelOptions model;
  ThicknessRequest thickness;
};

// A moment that is looked at: the rest, and where each clip starts.
struct Moment {
  std::string name;
  std::vector<Vec3> positions;
};

std::vector<Moment> moments_of(Input& input) {
  const auto frame = [&](std::size_t i) {
    const std::span<const Vec3> x = input.clip->load_frame(i).positions;
    return std::vector<Vec3>(x.begin(), x.end());
  };
  std::vector<Moment> moments{{input.import ? "bind pose" : "frame 0", frame(0)}};
  if (!input.import) return moments;
  for (std::size_t c = 0; c < input.import->clips.size() && c + 1 < input.clip->frame_count(); ++c)
    moments.push_back({"clip " + std::to_string(c) + " '" + input.import->clips[c].name + "'", frame(c + 1)});
  return moments;
}

const char* key_of(Defect kind) {
  switch (kind) {
    case Defect::duplicate_triangle:
      return "duplicate_triangles";
    case Defect::non_manifold_edge:
      return "non_manifold_edges";
    case Defect::boundary_edge:
      return "boundary_edges";
    case Defect::inconsistent_orientation:
      return "inconsistently_oriented_edges";
    case Defect::non_manifold_vertex:
      return "non_manifold_vertices";
  }
  return "defects";
}

std::size_t count(const TriangleMesh& mesh, Defect kind) {
  for (const TriangleMesh::DefectReport& defect : mesh.defects())
    if (defect.kind == kind) return defect.count;
  return 0;
}

// Triangles without an area at rest, as far as doubles can tell.
std::size_t flat_triangles(const TriangleMesh& mesh, std::span<const Vec3> x) {
  std::size_t flat = 0;
  for (const Triangle& c : mesh.triangles())
    flat += (x[+c[1]] - x[+c[0]]).cross(x[+c[2]] - x[+c[0]]).squaredNorm() == 0;
  return flat;
}

// Where a surface meets itself: for each moment null, or the first two triangles found.
json embedding_json(const TriangleMesh& mesh, std::span<const std::vector<Vec3>> positions,
                    std::span<const Moment> moments) {
  EmbeddingTest test(mesh, positions.front());
  json rows = json::array();
  for (std::size_t m = 0; m < moments.size(); ++m) {
    const auto met = test.find_intersection(positions[m]);
    json pair;
    if (met) pair = {static_cast<int>(met->first), static_cast<int>(met->second)};
    rows.push_back({{"moment", moments[m].name}, {"embedded", !met}, {"triangles", pair}});
  }
  return rows;
}

json strategies_json(const TriangleMesh& mesh, bool has_bones, const json& embedding) {
  std::size_t embedded = 0;
  for (const json& row : embedding) embedded += row["embedded"].get<bool>();
  const bool always = embedded == embedding.size();
  json rows = json::array();
  for (const Strategy& strategy : strategies()) {
    const std::optional<std::string> reason = why_not(strategy, mesh, has_bones);
    json why;
    if (reason) why = *reason;
    std::string promise = "finds every contact";
    if (strategy.guarantee == Guarantee::first_contact)
      promise = always ? "finds the first contact" : "finds the first contact where the start is embedded";
    if (strategy.guarantee == Guarantee::all_from_embedded && !always)
      promise = "finds every contact where the start is embedded";
    if (strategy.guarantee == Guarantee::heuristic) promise = "promises nothing";
    rows.push_back({{"name", strategy.name}, {"can", !reason}, {"why_not", why}});
    if (!reason) rows.back()["promise"] = promise;
  }
  return rows;
}

json piece_json(const Piece& piece, std::span<const Moment> moments, bool has_bones) {
  std::vector<std::vector<Vec3>> positions;
  for (const Moment& moment : moments) {
    std::vector<Vec3>& own = positions.emplace_back();
    for (const VertexId v : piece.vertices) own.push_back(moment.positions[+v]);
  }
  const TriangleMesh& mesh = piece.mesh;
  const bool closed = count(mesh, Defect::boundary_edge) == 0;
  const bool manifold =
      count(mesh, Defect::non_manifold_edge) + count(mesh, Defect::non_manifold_vertex) == 0;
  json defects = json::object(), volume, facing;
  for (const TriangleMesh::DefectReport& defect : mesh.defects())
    defects[key_of(defect.kind)] = {{"count", defect.count}, {"first", defect.first}};
  if (mesh.closed_and_oriented()) {
    volume = signed_volume(piece, moments.front().positions);
    facing = volume.get<double>() < 0 ? "inward" : "outward";
  }
  json embedding = embedding_json(mesh, positions, moments);
  json strategies = strategies_json(mesh, has_bones, embedding);
  return {{"triangles", mesh.triangle_count()},
          {"vertices", mesh.vertex_count()},
          {"closed", closed},
          {"manifold", manifold},
          {"consistently_oriented", count(mesh, Defect::inconsistent_orientation) == 0},
          {"facing", facing},
          {"volume", volume},
          {"triangles_without_area", flat_triangles(mesh, positions.front())},
          {"defects", std::move(defects)},
          {"embedding", std::move(embedding)},
          {"strategies", std::move(strategies)}};
}

std::string number(const json& value) {
  return rounded_text(value, 6);
}

std::string embedding_text(const json& embedding) {
  constexpr std::size_t kMostNamed = 6;
  std::vector<std::string> bad;
  for (const json& row : embedding)
    if (!row["embedded"].get<bool>()) bad.push_back(row["moment"]);
  return "embedded at " + std::to_string(embedding.size() - bad.size()) + " of " +
         std::to_string(embedding.size()) + " moments (rest and starts of clips)" +
         (bad.empty() ? "" : "; meets itself at " + first_of(bad, kMostNamed, ""));
}

std::string strategies_text(const json& strategies) {
  std::vector<std::pair<std::string, std::string>> said;  // what is promised or lacks, who
  for (const json& row : strategies) {
    const std::string what =
        row["can"].get<bool>() ? row["promise"].get<std::string>() : row["why_not"].get<std::string>();
    const auto same = std::find_if(said.begin(), said.end(), [&](const auto& s) { return s.first == what; });
    const std::string name = row["name"].get<std::string>();
    if (same == said.end())
      said.emplace_back(what, name);
    else
      same->second += ", " + name;
  }
  std::string out;
  for (const auto& [what, who] : said) out += "      " + who + ": " + what + "\n";
  return out;
}

// How many pairs of features are within the thickness at rest, and how many of them rings leave.
json close_json(const Input& input) {
  constexpr int kMostRings = 4;
  const ContactSet close = close_at_rest(input);
  json beyond = json::array();
  for (int rings = 1; rings <= kMostRings && !close.contacts.empty(); ++rings) {
    Exclusions near;
    near.exclude_rings(input.mesh, rings);
    beyond.push_back(std::ranges::count_if(
        close.contacts, [&](const Contact& contact) { return !near.excludes(input.mesh, contact.pair); }));
    if (beyond.back() == 0) break;
  }
  return {{"asked", input.thickness.asked.thickness.text},
          {"length", input.thickness.length},
          {"mean_edge", input.thickness.edge},
          {"pairs", close.contacts.size()},
          {"pairs_beyond_rings", std::move(beyond)}};
}

void print_close(const json& close) {
  std::printf("  within %s of each other at rest (%s; the mean edge is %s long): %zu pairs of features",
              close["asked"].get<std::string>().c_str(), number(close["length"]).c_str(),
              number(close["mean_edge"]).c_str(), close["pairs"].get<std::size_t>());
  const json& beyond = close["pairs_beyond_rings"];
  for (std::size_t i = 0; i < beyond.size(); ++i)
    std::printf("%s %zu with --exclude-rings %zu", i == 0 ? ";" : ",", beyond[i].get<std::size_t>(), i + 1);
  std::printf("\n");
}

// Whatever the file holds, this fits a screen: of many clips and components the first are named, and what
// strategies can do is said of the component that is used, or else of all together.
void print(const json& document) {
  constexpr std::size_t kMostClips = 8, kMostInFull = 2, kMostComponents = 8;
  const json &clips = document["clips"], &components = document["components"];
  for (std::size_t c = 0; c < std::min(kMostClips, clips.size()); ++c) {
    const json& clip = clips[c];
    std::printf("  clip '%s': %s s, %s frames from frame %s, %s bones driven\n",
                clip["name"].get<std::string>().c_str(), number(clip["seconds"]).c_str(),
                number(clip["frames"]).c_str(), number(clip["first_frame"]).c_str(),
                number(clip["bones_driven"]).c_str());
  }
  if (clips.size() > kMostClips)
    std::printf("  and %zu more clips; --json FILE lists all\n", clips.size() - kMostClips);
  const bool one_is_used =
      std::ranges::count_if(components, [](const json& c) { return c["chosen"].get<bool>(); }) == 1;
  std::size_t passed_over = 0;
  for (const json& c : components) {
    const bool is_used = one_is_used && c["chosen"].get<bool>();
    if (c["index"].get<std::size_t>() >= kMostComponents && !is_used) {
      ++passed_over;
      continue;
    }
    const bool in_full = components.size() <= kMostInFull || is_used;
    std::string shape = c["closed"].get<bool>() ? "closed" : "open";
    shape += c["manifold"].get<bool>() ? ", manifold" : ", not manifold";
    if (!c["consistently_oriented"].get<bool>()) shape += ", not consistently oriented";
    if (!c["facing"].is_null())
      shape += ", facing " + c["facing"].get<std::string>() + ", volume " + number(c["volume"]);
    if (c["triangles_without_area"] != 0)
      shape += ", " + number(c["triangles_without_area"]) + " triangles without area";
    std::printf("  component %zu%s: %zu triangles, %zu vertices", c["index"].get<std::size_t>(),
                c["chosen"].get<bool>() ? " (used unless another is named)" : "",
                c["triangles"].get<std::size_t>(), c["vertices"].get<std::size_t>());
    if (!c["bones"].is_null()) std::printf(", %s", many(c["bones"].get<std::size_t>(), "bone").c_str());
    std::printf("; %s\n      %s\n%s", shape.c_str(), embedding_text(c["embedding"]).c_str(),
                in_full ? strategies_text(c["strategies"]).c_str() : "");
  }
  if (passed_over > 0) std::printf("  and %zu more components; --json FILE lists all\n", passed_over);
  if (document["identical_triangles"] != 0)
    std::printf("  %s\n", identical_text(document["identical_triangles"].get<std::size_t>()).c_str());
  if (document.contains("thickness")) print_close(document["thickness"]);
  if (document["components"].size() < 2) return;
  const json& all = document["together"];
  std::printf("  all components together\n      %s\n%s", embedding_text(all["embedding"]).c_str(),
              strategies_text(all["strategies"]).c_str());
}

void inspect(InspectOptions options) {
  OutputFile output(options.output, options.force);
  if (is_model_file(options.input)) options.model.import.survey = options.model.import.one_pose = true;
  Input input = open_input(options.input, options.model);
  say_what_was_read(input, stdout);
  set_thickness(input, options.thickness);
  const std::vector<Moment> moments = moments_of(input);
  const std::vector<Piece> pieces = scenes::pieces_of(input.mesh);
  const bool has_bones = input.rig.has_value();
  const std::vector<std::size_t> chosen =
      scenes::choose_pieces(pieces, input.import ? options.model.import.component : "all");

  json document = {{"schema", "cscd.inspect/1"}, {"input", options.input}, {"clips", json::array()}};
  if (input.import) {
    document["import"] = import_json(*input.import);
    document["clips"] = document["import"]["clips"];
  } else {
    std::printf("%s: %s, %s\n", options.input.c_str(), many(input.clip->frame_count(), "frame").c_str(),
                many(input.clip->header().bone_parent.size(), "bone").c_str());
  }
  document["identical_triangles"] = identical_triangles(input.mesh);
  document["components"] = json::array();
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    json row = piece_json(pieces[p], moments, has_bones);
    row["index"] = p;
    row["chosen"] = std::find(chosen.begin(), chosen.end(), p) != chosen.end();
    row["bones"] = nullptr;
    if (input.import && p < input.import->component_bones.size())
      row["bones"] = input.import->component_bones[p];
    document["components"].push_back(std::move(row));
  }
  std::vector<std::vector<Vec3>> positions;
  for (const Moment& moment : moments) positions.push_back(moment.positions);
  json together = embedding_json(input.mesh, positions, moments);
  json strategies = strategies_json(input.mesh, has_bones, together);
  document["together"] = {{"embedding", std::move(together)}, {"strategies", std::move(strategies)}};
  if (input.thickness.length > 0) document["thickness"] = close_json(input);
  output.commit(document.dump(1) + "\n");
  print(document);
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command = app.add_subcommand(
      "inspect",
      "Say what an input is made of, component by component, and what each strategy can do with it.\n\n"
      "  cscd inspect character.glb\n"
      "  cscd inspect character.fbx --fill-holes 12 --json report.json\n"
      "  cscd inspect skirt --thickness 0.2e         and how many pairs of features are that close at rest");
  using I = InspectOptions;
  static const OptionRow<I> rows[] = {required<I>({"input", &I::input, kInputHelp})};
  add_options<I>(*command, rows, *options);
  add_output_options(*command, *options, "where the same goes for a machine to read");
  add_options(*command, thickness_options().first(1), options->thickness);
  add_model_options(*command, options->model);
  command->callback([options] { inspect(*options); });
}

}  // namespace cscd::bench
