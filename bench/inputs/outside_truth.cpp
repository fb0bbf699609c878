#include "bench/inputs/outside_truth.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include "bench/output/gzip.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // of a table, unpacked
constexpr std::string_view kHead = "kind,v0,v1,v2,v3,truth,shares_vertex";
constexpr char kMend[] = "; mend the table, or move it away to run without it";
constexpr std::size_t kNumbers = 6;  // of a line, behind the kind

struct TruthLine {
  VerticesOfPair pair;
  bool touches;
};

// Returns nothing for features that share a vertex. Throws InputError, which says what is wrong with the
// line.
std::optional<TruthLine> parse_line(std::string_view line, std::size_t vertex_count) {
  const bool is_vertex_face = line.starts_with("vf,");
  if (!is_vertex_face && !line.starts_with("ee,")) throw InputError("its kind is neither vf nor ee");
  std::array<std::int32_t, kNumbers> numbers = {};
  const char *at = line.data() + 2, *const end = line.data() + line.size();
  for (std::int32_t& number : numbers) {
    if (at == end || *at != ',') throw InputError("it does not have seven columns");
    const auto [next, error] = std::from_chars(at + 1, end, number);
    if (error != std::errc{}) throw InputError("a column behind the kind is no whole number");
    at = next;
  }
  if (at != end) throw InputError("something follows its seven columns");
  const std::array vertices = {numbers[0], numbers[1], numbers[2], numbers[3]};
  for (const std::int32_t vertex : vertices)
    if (vertex < 0 || std::cmp_greater_equal(vertex, vertex_count))
      throw InputError("it names vertex " + std::to_string(vertex) + ", and the cache has " +
                       std::to_string(vertex_count) + " vertices");
  for (const std::int32_t flag : {numbers[4], numbers[5]})
    if (flag != 0 && flag != 1) throw InputError("its truth and shares_vertex have to be 0 or 1");
  const std::span<const std::int32_t> first = std::span(vertices).first(is_vertex_face ? 1 : 2);
  const bool shares =
      std::ranges::find_first_of(first, std::span(vertices).subspan(first.size())) != first.end();
  if (shares != (numbers[5] == 1)) throw InputError("its shares_vertex is not what its vertices say");
  if (shares) return std::nullopt;
  const auto kind = is_vertex_face ? FeaturePair::Kind::vertex_face : FeaturePair::Kind::edge_edge;
  return TruthLine{VerticesOfPair::of(kind, vertices), numbers[4] == 1};
}

}  // namespace

VerticesOfPair VerticesOfPair::of(FeaturePair::Kind kind, std::array<std::int32_t, 4> vertices) {
  auto& [a, b, c, d] = vertices;
  if (kind == FeaturePair::Kind::vertex_face) {
    std::sort(vertices.begin() + 1, vertices.end());
  } else {
    if (a > b) std::swap(a, b);
    if (c > d) std::swap(c, d);
    if (std::pair(a, b) > std::pair(c, d)) vertices = {c, d, a, b};
  }
  return {kind, vertices};
}

VerticesOfPair VerticesOfPair::of(const TriangleMesh& mesh, const FeaturePair& pair) {
  const auto number = [](VertexId vertex) { return static_cast<std::int32_t>(vertex); };
  if (pair.kind == FeaturePair::Kind::vertex_face) {
    const Triangle& corners = mesh.corners(TriangleId{pair.b});
    return of(pair.kind, {pair.a, number(corners[0]), number(corners[1]), number(corners[2])});
  }
  const Edge &one = mesh.ends(EdgeId{pair.a}), &other = mesh.ends(EdgeId{pair.b});
  return of(pair.kind, {number(one[0]), number(one[1]), number(other[0]), number(other[1])});
}

std::string text(const VerticesOfPair& pair) {
  std::string out = pair.kind == FeaturePair::Kind::vertex_face ? "vf" : "ee";
  for (const std::int32_t vertex : pair.vertices) out += " " + std::to_string(vertex);
  return out;
}

std::shared_ptr<const OutsideTruth> outside_truth(const std::filesystem::path& cache,
                                                  const TriangleMesh& mesh) {
  std::filesystem::path path = cache;
  path.replace_extension(".truth.csv.gz");
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) return nullptr;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream packed;
  if (!file || !(packed << file.rdbuf()))
    throw InputError("truth " + path.string() + ": cannot be read; make it readable, or move it away");
  std::istringstream lines(without_gzip(packed.str(), "truth " + path.string(), kMostBytes));

  const auto out = std::make_shared<OutsideTruth>();
  out->file = path.filename();
  std::vector<VerticesOfPair> apart;
  std::size_t number = 1;
  std::string line;
  try {
    if (!std::getline(lines, line) || line != kHead)
      throw InputError("is not the head " + std::string(kHead));
    while (std::getline(lines, line)) {
      ++number;
      if (const auto judged = parse_line(line, mesh.vertex_count()))
        (judged->touches ? out->contacts : apart).push_back(judged->pair);
    }
  } catch (const InputError& error) {
    throw InputError("truth " + path.string() + ": line " + std::to_string(number) + ": " + error.what() +
                     kMend);
  }
  for (std::vector<VerticesOfPair>* list : {&out->contacts, &apart}) {
    std::ranges::sort(*list);
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  out->pairs = out->contacts.size() + apart.size();
  const auto both = std::ranges::find_if(
      apart, [&](const VerticesOfPair& pair) { return std::ranges::binary_search(out->contacts, pair); });
  if (both != apart.end())
    throw InputError("truth " + path.string() + ": says of " + text(*both) +
                     " that it touches and that it does not" + kMend);
  return out;
}

}  // namespace cscd::bench
