#include "bench/benchmark/pair_name.h"

#include <utility>

namespace cscd::bench {

using Kind = FeaturePair::Kind;

PairName PairName::vertex_face(std::int32_t vertex, std::int32_t triangle) {
  return {Kind::vertex_face, {vertex, triangle, -1, -1}};
}

PairName PairName::edge_edge(std::int32_t a0, std::int32_t a1, std::int32_t b0, std::int32_t b1) {
  std::pair<std::int32_t, std::int32_t> a = std::minmax(a0, a1), b = std::minmax(b0, b1);
  if (b < a) std::swap(a, b);
  return {Kind::edge_edge, {a.first, a.second, b.first, b.second}};
}

PairName PairName::of(const TriangleMesh& mesh, const FeaturePair& pair) {
  if (pair.kind == Kind::vertex_face) return vertex_face(pair.a, pair.b);
  const Edge &a = mesh.ends(EdgeId{pair.a}), &b = mesh.ends(EdgeId{pair.b});
  const auto number = [](VertexId vertex) { return static_cast<std::int32_t>(vertex); };
  return edge_edge(number(a[0]), number(a[1]), number(b[0]), number(b[1]));
}

const char* key_of(const PairName& pair) {
  return pair.kind == Kind::vertex_face ? "vf" : "ee";
}

nlohmann::ordered_json numbers_json(const PairName& pair) {
  const auto& i = pair.index;
  return pair.kind == Kind::vertex_face ? nlohmann::ordered_json{i[0], i[1]}
                                        : nlohmann::ordered_json{i[0], i[1], i[2], i[3]};
}

std::string text(const PairName& pair) {
  const auto number = [&](std::size_t i) { return std::to_string(pair.index[i]); };
  if (pair.kind == Kind::vertex_face) return "vertex " + number(0) + ", triangle " + number(1);
  return "edges " + number(0) + "-" + number(1) + " and " + number(2) + "-" + number(3);
}

}  // namespace cscd::bench
