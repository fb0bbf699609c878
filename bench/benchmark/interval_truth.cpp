#include "bench/benchmark/interval_truth.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "bench/measure/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/exact/exact.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostForAllPairs = 600;  // triangles

exact::TimeEnclosure enclosure(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair) {
  const auto time =
      pair.kind == FeaturePair::Kind::vertex_face
          ? exact::first_contact(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}))
          : exact::first_contact(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}));
  if (!time) throw std::logic_error("the referee takes back a contact");
  return *time;
}

std::int32_t number(TriangleId triangle) {
  return static_cast<std::int32_t>(triangle);
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

}  // namespace cscd::bench
