#include "bench/benchmark/benchmark.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "bench/output/schema.h"
#include "bench/output/sha256.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/exact/exact.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kMostForAllPairs = 600;  // triangles

exact::TimeEnclosure enclosure(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair) {
  const auto time =
      pair.kind == FeaturePair::Kind::vertex_face
          ? exact::first_contact(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}))
          : exact::first_contact(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}));
  if (!time) throw std::logic_error("the oracle takes back a contact");
  return *time;
}

std::int32_t number(TriangleId triangle) {
  return static_cast<std::int32_t>(triangle);
}

std::string content_of(const fs::path& path, const std::string& how_to_mend) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (!file.good() && !file.eof())
    throw InputError(path.string() + ": cannot be read (" + std::strerror(errno) + "); " + how_to_mend);
  return content;
}

// The checksum of the manifest is in the list of checksums alone, whose first line it is.
void hold_manifest_to_its_sum(const fs::path& folder, const std::string& sums, const std::string& sum) {
  if (!sums.starts_with(sum + "  " + kManifestName + "\n"))
    throw InputError((folder / kManifestName).string() + ": is not the one that " + kSumsName +
                     " lists, so the benchmark is damaged; copy it again, or make it again");
}

void hold_to_sums(const Benchmark& benchmark) {
  for (const ListedFile& file : benchmark.files) {
    const fs::path path = benchmark.folder / file.name;
    std::error_code error;
    const std::uint64_t bytes = fs::file_size(path, error);
    if (error)
      throw InputError(path.string() + ": is missing from the benchmark (" + error.message() +
                       "); copy it again, or make it again");
    if (bytes != file.bytes || sha256_of_file(path) != file.sha256)
      throw InputError(path.string() + ": is not the file that the manifest lists (" +
                       (bytes == file.bytes
                            ? "another SHA-256 checksum"
                            : std::to_string(bytes) + " bytes instead of " + std::to_string(file.bytes)) +
                       "), so the benchmark is damaged; copy it again, or make it again");
  }
}

// A manifest that keeps to its schema can still contradict itself.
void hold_together(const Benchmark& benchmark) {
  const std::string where = (benchmark.folder / kManifestName).string();
  std::set<std::string> ids, families, files;
  for (const SubjectFamily& family : benchmark.families) families.insert(family.name);
  for (const ListedFile& file : benchmark.files) {
    // Names of files come from whoever made the benchmark: they stay within its folder.
    if (file.name.find('/') != std::string::npos || file.name.starts_with("."))
      throw InputError(where + ": lists the file " + file.name + ", which is no plain name; make it again");
    files.insert(file.name);
  }
  for (const ListedInterval& interval : benchmark.intervals) {
    const std::string whose = where + ", interval " + interval.id + ": ";
    if (!ids.insert(interval.id).second) throw InputError(whose + "is listed twice; make it again");
    if (!families.contains(interval.family))
      throw InputError(whose + "its family " + interval.family + " is not listed; make it again");
    if (!files.contains(interval.file))
      throw InputError(whose + "its file " + interval.file + " is not listed; make it again");
  }
}

}  // namespace

std::string_view IntervalTruth::verdict() const {
  if (!start_pairs.empty()) return "intersects_at_start";
  return contacts.empty() ? "clear" : "touches";
}

std::optional<exact::TimeEnclosure> IntervalTruth::first_time() const {
  if (contacts.empty()) return std::nullopt;
  exact::TimeEnclosure first = contacts.front().time;
  for (const TrueContact& contact : contacts)
    first = {std::min(first.lo, contact.time.lo), std::min(first.hi, contact.time.hi)};
  return first;
}

IntervalTruth find_truth(const TriangleMesh& mesh, const scenes::PosedMesh& posed, std::size_t interval) {
  const scenes::PosedMesh::Interval& own = posed.intervals.at(interval);
  const Motion motion(own.start.positions, own.end.positions);
  const Strategy& strategy = mesh.triangle_count() <= kMostForAllPairs ? all_pairs() : complete_reference();
  ContactSet found;
  strategy.make({mesh, posed.reference.positions, nullptr, elementary_test_named("exact")})
      .detector->detect({motion}, found);
  IntervalTruth truth;
  for (const Contact& contact : found.contacts)
    truth.contacts.push_back({PairName::of(mesh, contact.pair), enclosure(mesh, motion, contact.pair)});
  std::ranges::sort(truth.contacts, [](const TrueContact& a, const TrueContact& b) {
    return std::tie(a.time.lo, a.time.hi, a.pair) < std::tie(b.time.lo, b.time.hi, b.pair);
  });
  truth.start_pairs = EmbeddingTest(mesh, posed.reference.positions)
                          .find_all(own.start.positions, std::numeric_limits<std::size_t>::max())
                          .pairs;
  return truth;
}

ordered_json to_json(const IntervalTruth& truth) {
  ordered_json start_pairs = ordered_json::array(), contacts = ordered_json::array();
  for (const CrossingPair& pair : truth.start_pairs)
    start_pairs.push_back({number(pair.first), number(pair.second)});
  for (const TrueContact& contact : truth.contacts)
    contacts.push_back(
        {{key_of(contact.pair), numbers_json(contact.pair)}, {"time", {contact.time.lo, contact.time.hi}}});
  const auto first = truth.first_time();
  return {{"id", truth.id},
          {"verdict", truth.verdict()},
          {"starts_embedded", truth.starts_embedded()},
          {"first_time", first ? ordered_json{first->lo, first->hi} : ordered_json()},
          {"start_pairs", std::move(start_pairs)},
          {"contacts", std::move(contacts)}};
}

IntervalTruth truth_from_json(const ordered_json& line, const std::string& where) {
  try {
    IntervalTruth truth;
    truth.id = line.at("id");
    for (const ordered_json& pair : line.at("start_pairs"))
      truth.start_pairs.push_back(
          {TriangleId{pair.at(0).get<std::int32_t>()}, TriangleId{pair.at(1).get<std::int32_t>()}});
    for (const ordered_json& contact : line.at("contacts")) {
      const bool face = contact.contains("vf");
      const std::vector<std::int32_t> i = contact.at(face ? "vf" : "ee");
      truth.contacts.push_back({face ? PairName::vertex_face(i.at(0), i.at(1))
                                     : PairName::edge_edge(i.at(0), i.at(1), i.at(2), i.at(3)),
                                {contact.at("time").at(0), contact.at("time").at(1)}});
    }
    return truth;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(where + ": is no answer of a benchmark (" + error.what() +
                     "); make the benchmark again");
  } catch (const std::out_of_range&) {
    throw InputError(where + ": a contact has too few numbers; make the benchmark again");
  }
}

const SubjectFamily& Benchmark::family(const std::string& name) const {
  return *std::ranges::find(families, name, &SubjectFamily::name);
}

ordered_json to_json(const Benchmark& benchmark) {
  ordered_json families = ordered_json::array(), files = ordered_json::array(),
               intervals = ordered_json::array();
  for (const SubjectFamily& family : benchmark.families)
    families.push_back({{"name", family.name}, {"set", family.set}, {"story", family.story}});
  for (const ListedFile& file : benchmark.files)
    files.push_back({{"name", file.name}, {"bytes", file.bytes}, {"sha256", file.sha256}});
  for (const ListedInterval& i : benchmark.intervals)
    intervals.push_back({{"id", i.id},
                         {"family", i.family},
                         {"file", i.file},
                         {"mesh", i.mesh},
                         {"row", i.row},
                         {"vertices", i.vertices},
                         {"triangles", i.triangles},
                         {"bones", i.bones},
                         {"closed", i.closed}});
  return {{"schema", kBenchmarkSchema},
          {"made_by", benchmark.made_by},
          {"families", std::move(families)},
          {"files", std::move(files)},
          {"intervals", std::move(intervals)}};
}

std::string sums_text(const Benchmark& benchmark) {
  std::string text = benchmark.sha256 + "  " + kManifestName + "\n";
  for (const ListedFile& file : benchmark.files) text += file.sha256 + "  " + file.name + "\n";
  return text;
}

Benchmark read_benchmark(const fs::path& folder) {
  const fs::path path = folder / kManifestName;
  std::error_code error;
  if (!fs::exists(path, error))
    throw InputError("benchmark " + folder.string() + ": has no " + kManifestName +
                     "; name a folder that `cscd benchmark make` wrote to its end");
  const std::string text = content_of(path, "check its permissions");
  Benchmark benchmark;
  benchmark.folder = folder;
  benchmark.sha256 = sha256(text);
  const std::string sums = content_of(folder / kSumsName, "copy the whole benchmark again, or make it again");
  hold_manifest_to_its_sum(folder, sums, benchmark.sha256);
  const ordered_json json = ordered_json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("schema", ordered_json()) != kBenchmarkSchema)
    throw InputError(path.string() + ": is no manifest of schema " + kBenchmarkSchema +
                     "; make the benchmark again");
  if (const std::string violation = schema_violation(json, "benchmark.schema.json"); !violation.empty())
    throw InputError(path.string() + ": does not follow its schema at " + violation +
                     "; make the benchmark again");
  benchmark.made_by = json.at("made_by");
  for (const ordered_json& family : json.at("families"))
    benchmark.families.push_back({family.at("name"), family.at("set"), family.at("story")});
  for (const ordered_json& file : json.at("files"))
    benchmark.files.push_back({file.at("name"), file.at("bytes"), file.at("sha256")});
  for (const ordered_json& i : json.at("intervals"))
    benchmark.intervals.push_back({i.at("id"), i.at("family"), i.at("file"), i.at("mesh"), i.at("row"),
                                   i.at("vertices"), i.at("triangles"), i.at("bones"), i.at("closed")});
  hold_together(benchmark);
  if (sums != sums_text(benchmark))
    throw InputError((folder / kSumsName).string() + ": lists other files than " + kManifestName +
                     ", so the benchmark is damaged; copy it again, or make it again");
  hold_to_sums(benchmark);
  return benchmark;
}

std::vector<IntervalTruth> read_truth(const Benchmark& benchmark) {
  const fs::path path = benchmark.folder / kTruthName;
  std::istringstream lines(content_of(path, "copy the benchmark again"));
  std::vector<IntervalTruth> all;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = path.string() + ", line " + std::to_string(all.size() + 1);
    const ordered_json json = ordered_json::parse(line, nullptr, false);
    if (json.is_discarded()) throw InputError(where + ": is no JSON; make the benchmark again");
    all.push_back(truth_from_json(json, where));
    if (all.size() > benchmark.intervals.size() || all.back().id != benchmark.intervals[all.size() - 1].id)
      throw InputError(where + ": answers " + all.back().id +
                       ", which is not the interval that the manifest lists there; make the benchmark again");
  }
  if (all.size() != benchmark.intervals.size())
    throw InputError(path.string() + ": has " + std::to_string(all.size()) + " answers for " +
                     std::to_string(benchmark.intervals.size()) + " intervals; make the benchmark again");
  return all;
}

void for_each_mesh(const Benchmark& benchmark,
                   const std::function<void(const scenes::PosedMesh&, std::span<const std::size_t>)>& visit) {
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> intervals_of;
  for (std::size_t i = 0; i < benchmark.intervals.size(); ++i)
    intervals_of[{benchmark.intervals[i].file, benchmark.intervals[i].mesh}].push_back(i);
  std::map<std::string, scenes::MeshFileReader> readers;
  for (std::size_t i = 0; i < benchmark.intervals.size(); ++i) {
    const ListedInterval& listed = benchmark.intervals[i];
    const std::vector<std::size_t>& intervals = intervals_of.at({listed.file, listed.mesh});
    if (intervals.front() != i) continue;
    const auto reader = readers.try_emplace(listed.file, benchmark.folder / listed.file).first;
    const scenes::PosedMesh mesh = reader->second.read(listed.mesh);
    for (const std::size_t one : intervals)
      if (benchmark.intervals[one].row >= mesh.intervals.size())
        throw InputError((benchmark.folder / kManifestName).string() + ", interval " +
                         benchmark.intervals[one].id + ": its mesh has no such row; make it again");
    visit(mesh, intervals);
  }
}

}  // namespace cscd::bench
