#include "bench/answer/answer_json.h"

#include <algorithm>

#include "bench/answer/answer_text.h"
#include "bench/answer/event_text.h"
#include "bench/answer/verdicts.h"
#include "bench/inputs/thickness.h"
#include "bench/output/json_text.h"
#include "core/detect/contact_geometry.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

json vector_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

template <class Id>
int number(Id id) {
  return static_cast<int>(id);
}

std::vector<VertexId> side_vertices(const TriangleMesh& mesh, const FeaturePair& pair, bool second) {
  if (pair.kind == FeaturePair::Kind::edge_edge) {
    const Edge& ends = mesh.ends(EdgeId{second ? pair.b : pair.a});
    return {ends[0], ends[1]};
  }
  if (!second) return {VertexId{pair.a}};
  const Triangle& corners = mesh.corners(TriangleId{pair.b});
  return {corners[0], corners[1], corners[2]};
}

// A triangle with these vertices that the file holds: one that fills a hole has no numbers there.
TriangleId source_triangle(const Input& input, const FeaturePair& pair, bool second, TriangleId otherwise) {
  if (pair.kind == FeaturePair::Kind::vertex_face && second) return otherwise;
  const TriangleMesh& mesh = input.mesh;
  const std::span<const TriangleId> around = pair.kind == FeaturePair::Kind::vertex_face
                                                 ? mesh.triangles_at(VertexId{pair.a})
                                                 : mesh.triangles_at(EdgeId{second ? pair.b : pair.a});
  const auto known = std::find_if(around.begin(), around.end(),
                                  [&](TriangleId t) { return input.sources->triangle[+t].part >= 0; });
  return known == around.end() ? otherwise : *known;
}

json source_json(const Input& input, const FeaturePair& pair, bool second, TriangleId triangle) {
  if (!input.sources || !input.import) return nullptr;
  triangle = source_triangle(input, pair, second, triangle);
  const scenes::SourceMap::Corners& from = input.sources->triangle[+triangle];
  if (from.part < 0) return nullptr;
  const scenes::ImportReport::Part& part = input.import->parts[static_cast<std::size_t>(from.part)];
  json vertices = json::array();
  const Triangle& corners = input.mesh.corners(triangle);
  for (const VertexId vertex : side_vertices(input.mesh, pair, second)) {
    const auto corner = std::find(corners.begin(), corners.end(), vertex);
    // A vertex of no face is one of a sequence, whose vertices keep the numbers of the file.
    vertices.push_back(
        corner == corners.end() ? +vertex : from.vertex[static_cast<std::size_t>(corner - corners.begin())]);
  }
  json out = {{"part", from.part}, {"mesh", nullptr}, {"primitive", nullptr}, {"vertices", vertices}};
  if (part.mesh >= 0) out["mesh"] = part.mesh;
  if (part.primitive >= 0) out["primitive"] = part.primitive;
  return out;
}

json side_json(const Input& input, const SurfaceNames& names, const FeaturePair& pair, bool second) {
  const TriangleId triangle = names.triangle_of(pair, second);
  const std::vector<VertexId> vertices = side_vertices(input.mesh, pair, second);
  const bool is_point = input.mesh.triangles_at(vertices.front()).empty();
  json out = {{"part", is_point ? SurfaceNames::kPoint : names.part_of(triangle)}, {"bone", nullptr}};
  const std::string bone = names.bone_of(vertices.front());
  if (!bone.empty()) out["bone"] = bone;
  if (input.import) out["source"] = source_json(input, pair, second, triangle);
  return out;
}

// What was asked of distances.
json thickness_json(const ClipAnswer& answer) {
  const InputThickness& own = answer.input.thickness;
  const auto length = [&](const WrittenLength& written) {
    return json{{"asked", written.text}, {"length", written.length(length_scale(answer.input))}};
  };
  json out = length(own.asked.thickness), near;
  if (own.asked.near_rest.number > 0) near = length(own.asked.near_rest);
  out["mean_edge"] = own.edge;
  out["left_out"] = nullptr;
  if (own.left_out)
    out["left_out"] = {{"rings", own.asked.rings.value_or(0)},
                       {"near_rest", std::move(near)},
                       {"kept_at_rest", answer.kept_at_rest}};
  return out;
}

bool asks_distances(const Input& input) {
  return input.thickness.length > 0 || input.thickness.left_out != nullptr;
}

json contact_json(const Input& input, const SurfaceNames& names, const Contact& contact,
                  const Motion& motion) {
  json vertices = json::array();
  for (const VertexId vertex : vertices_of(input.mesh, contact.pair)) vertices.push_back(number(vertex));
  const bool face = contact.pair.kind == FeaturePair::Kind::vertex_face;
  json out = {{"kind", face ? "vf" : "ee"}, {"vertices", vertices}, {"time", contact.time}};
  if (face) {
    out["vertex"] = contact.pair.a;
    out["triangle"] = contact.pair.b;
  }
  if (contact.verdict != Verdict::contact) return out;
  const ContactGeometry geometry = contact_geometry(input.mesh, motion, contact.pair, contact.time);
  out["point"] = vector_json(geometry.point);
  out["normal"] = geometry.normal ? vector_json(*geometry.normal) : json();
  out["relative_speed"] = geometry.relative_speed ? json(*geometry.relative_speed) : json();
  json weights = json::array();
  for (int i = 0; i < geometry.weight_count; ++i)
    weights.push_back(geometry.weights[static_cast<std::size_t>(i)]);
  out[face ? "barycentric" : "edge_parameters"] = weights;
  out["first"] = side_json(input, names, contact.pair, false);
  out["second"] = side_json(input, names, contact.pair, true);
  return out;
}

// The last pose starts no interval: its moment is the end of the last one.
json moment_json(const Input& input, ClipMoment moment) {
  if (moment.interval == input.clip->interval_count()) moment = {moment.interval - 1, 1};
  const std::optional<double> seconds = second_of(input, moment);
  return {{"interval", moment.interval},
          {"time", moment.time},
          {"frame", frame_of(input, moment)},
          {"seconds", seconds ? json(*seconds) : json()}};
}

const char* side_name(CrossingRegion::Side side) {
  using Side = CrossingRegion::Side;
  return side == Side::behind ? "behind" : side == Side::before ? "before" : "smaller";
}

json event_json(const ClipAnswer& answer, const OverlapEvent& event) {
  const Input& input = answer.input;
  const auto moment = [&](std::size_t interval) { return moment_json(input, {interval, 0}); };
  return {{"first", event.names.first},
          {"second", event.names.second},
          {"begins", moment(event.first)},
          {"deepest", moment(event.deepest)},
          {"ends", moment(event.last)},
          {"depth", {{"at_least", event.depth.lower}, {"at_most", event.depth.upper}}},
          {"at_rest", event.at_rest ? json(*event.at_rest) : json()},
          {"point", vector_json(event.point)},
          {"out", event.depth.nearest == TriangleId{-1} ? json() : vector_json(event.depth.out)},
          {"vertices", event.vertices},
          {"area", event.area},
          {"side", event.vertices == 0 ? json() : json(side_name(event.side))},
          {"other_is_open", event.other_is_open},
          {"pairs", event.pairs},
          {"curves", event.curves},
          {"crosses", event.crosses},
          {"at_joint", answer.joints.fold(event)},
          {"contacts", event.contacts},
          {"depth_at", event.depth_at}};
}

json pairs_json(std::span<const CrossingPair> pairs, std::size_t most) {
  json out = json::array();
  for (std::size_t i = 0; i < std::min(most, pairs.size()); ++i)
    out.push_back({number(pairs[i].first), number(pairs[i].second)});
  return out;
}

// All of an interval but its contacts.
json interval_json(const Input& input, const IntervalAnswer& answer, std::size_t most_start_pairs) {
  json collides;
  if (answer.verdict != IntervalVerdict::undecided) collides = answer.verdict != IntervalVerdict::clear;
  const std::optional<double> time = answer.time();
  json out = {{"index", answer.index},
              {"verdict", to_string(answer.verdict)},
              {"collides", collides},
              {"time", time ? json(*time) : json()},
              {"starts_embedded", answer.starts_embedded},
              {"start_pairs", pairs_json(answer.start.pairs, most_start_pairs)},
              {"start_pairs_total", answer.start.total},
              {"start_touching", answer.start_touching.total},
              {"left_out", {{"start_pairs", answer.rest_pairs}, {"contacts", answer.rest_contacts}}},
              {"ignored",
               {{"start_pairs", answer.ignored_pairs.size()}, {"contacts", answer.ignored.contacts.size()}}},
              {"contacts", json()},
              {"undecided", json()},
              {"strategy", answer.strategy->name},
              {"proven", answer.proven},
              {"counts", counts_json(answer.report)},
              {"ms", milliseconds_json(answer.report.ms)}};
  out["ms"]["embedding"] = answer.embedding_ms;
  out["ms"]["load"] = answer.load_ms;
  out["ms"]["wall"] = answer.wall_ms;
  if (input.thickness.length > 0)
    out["touching"] = answer.touching.size(), out["close_at_start"] = answer.close_at_start;
  if (answer.motion) out["true_motion"] = true_motion_json(input, answer);
  const json start = moment_json(input, {answer.index, 0});
  out["frame"] = start["frame"];
  out["seconds"] = start["seconds"];
  return out;
}

// The contacts of an interval, or those of which it is not decided whether they are any.
void write_contacts(JsonStream& out, const ClipAnswer& clip, const IntervalAnswer& answer,
                    const Motion& motion, bool undecided) {
  const bool is_thick = clip.input.thickness.length > 0;
  out.begin_array();
  for (std::size_t i = 0; i < answer.found.contacts.size(); ++i) {
    const Contact& contact = answer.found.contacts[i];
    if ((contact.verdict == Verdict::contact) == undecided) continue;
    json one = contact_json(clip.input, clip.names, contact, motion);
    if (i < answer.event_of_contact.size() && answer.event_of_contact[i] != OverlapEvents::kNone)
      one["event"] = answer.event_of_contact[i];
    if (is_thick && !undecided) {
      const auto touch = answer.touching.find(contact.pair);
      one["touch_time"] = touch == answer.touching.end() ? json() : json(touch->second);
    }
    out.value(one);
  }
  out.end();
}

// What crosses in the clip's last pose, which starts no interval.
json last_pose_json(const ClipAnswer& answer, std::size_t most_start_pairs) {
  if (!answer.last_pose) return nullptr;
  const IntervalAnswer& pose = *answer.last_pose;
  const json moment = moment_json(answer.input, {pose.index, 0});
  return {{"frame", moment["frame"]},
          {"seconds", moment["seconds"]},
          {"pairs", pairs_json(pose.start.pairs, most_start_pairs)},
          {"pairs_total", pose.start.total},
          {"touching", pose.start_touching.total},
          {"left_out", pose.rest_pairs},
          {"ignored", pose.ignored_pairs.size()}};
}

// What was asked to be ignored; null for nothing.
json ignored_json(const Input& input) {
  if (!input.ignored) return nullptr;
  json pairs = json::array(), neighbours;
  for (const auto& [first, second] : input.ignored->names) pairs.push_back({first, second});
  if (input.ignored->asked.neighbours) neighbours = *input.ignored->asked.neighbours;
  return {{"pairs", std::move(pairs)}, {"neighbours", std::move(neighbours)}};
}

}  // namespace

void write_members(JsonStream& out, const json& members) {
  for (const auto& [key, value] : members.items()) {
    out.key(key);
    out.value(value);
  }
}

json rest_json(const ClipAnswer& answer) {
  json parts = json::array();
  for (const auto& [pair, count] : pairs_by_part(answer.names, answer.input.mesh, answer.rest))
    parts.push_back({{"first", pair.first}, {"second", pair.second}, {"pairs", count}});
  return {{"pairs", answer.rest.total},
          {"touching", answer.rest_touching.total},
          {"left_out", answer.rest_left_out},
          {"parts", std::move(parts)}};
}

json headline_json(const ClipAnswer& answer) {
  const std::optional<std::size_t> worst = worst_event(answer);
  if (!worst) return nullptr;
  const OverlapEvent& event = answer.events[*worst];
  json out = {{"event", *worst}, {"text", worst_text(answer.input, event)}};
  const json all = event_json(answer, event);
  for (const char* key : {"first", "second", "begins", "deepest", "ends", "depth", "at_rest"})
    out[key] = all[key];
  return out;
}

json summary_json(const ClipAnswer& answer) {
  const AnswerSummary& s = answer.summary;
  json strategies = json::array(), met = json::array(), ignored = json::array(), events = json::array(),
       first, named, worst;
  for (const OverlapEvent& event : answer.events) events.push_back(event_json(answer, event));
  for (const auto& [name, count] : s.strategies) strategies.push_back({{"name", name}, {"intervals", count}});
  std::map<NamePair, std::size_t> intervals;
  for (const auto& [names, here] : s.met) intervals[names] = here.intervals;
  for (const auto& [names, count] : most_first(intervals))
    met.push_back({{"first", names.first},
                   {"second", names.second},
                   {"intervals", count},
                   {"contacts", s.met.at(names).contacts},
                   {"start_pairs", s.met.at(names).start_pairs},
                   {"at_joint", answer.only_folds(names)}});
  for (const auto& [names, here] : s.ignored)
    ignored.push_back({{"first", names.first},
                       {"second", names.second},
                       {"intervals", here.intervals},
                       {"start_pairs", here.start_pairs},
                       {"contacts", here.contacts}});
  if (s.first) first = moment_json(answer.input, s.first->moment);
  if (const AnswerSummary::Meeting* const meeting = answer.first_named()) {
    named = moment_json(answer.input, meeting->moment);
    named["first"] = meeting->names.first, named["second"] = meeting->names.second;
  }
  if (s.worst) {
    worst = moment_json(answer.input, s.worst->moment);
    worst["start_pairs"] = s.worst->start_pairs;
    worst["contacts"] = s.worst->contacts;
  }
  json out = {
      {"verdict", to_string(s.verdict())},
      {"sentence", verdict_text(answer)},
      {"headline", headline_json(answer)},
      {"intervals", s.intervals()},
      {"proven", s.proven},
      {"ms",
       {{"query", s.query_ms},
        {"embedding", s.embedding_ms},
        {"overlap", s.overlap_ms},
        {"wall", s.wall_ms},
        {"load", s.load_ms},
        {"preparation", answer.preparation_ms}}},
      {"with_left_out", s.with_left_out},
      {"left_out_contacts", s.left_out_contacts},
      {"strategies", std::move(strategies)},
      {"first", std::move(first)},
      {"first_named", std::move(named)},
      {"worst", std::move(worst)},
      {"met", std::move(met)},
      {"events", std::move(events)},
      {"not_measured", answer.not_measured},
      {"old", {{"intervals", s.with_old}, {"start_pairs", s.old_pairs}, {"contacts", s.old_contacts}}},
      {"with_ignored", s.with_ignored},
      {"ignored", std::move(ignored)}};
  const bool is_thick = answer.input.thickness.length > 0;
  out.update(verdict_counts_json(s.verdicts, is_thick));
  if (is_thick)
    out.update({{"close_at_start", s.close_at_start}, {"with_close_at_start", s.with_close_at_start}});
  if (answer.input.motion) out["true_motion"] = true_motion_json(answer.input, answer.true_motion);
  return out;
}

ClipJson::ClipJson(JsonStream& out, const ClipAnswer& answer, const std::string& input,
                   std::size_t most_start_pairs)
    : out_(out), most_start_pairs_(most_start_pairs) {
  json head = {{"elementary", answer.elementary.name},
               {"first_only", answer.first_only},
               {"guarantee", to_string(answer.strategy.guarantee)},
               {"identical_triangles", identical_triangles(answer.input.mesh)},
               {"ignore", ignored_json(answer.input)},
               {"input", input}};
  if (answer.input.import) head["import"] = import_json(*answer.input.import);
  out_.begin_object();
  write_members(out_, head);
  out_.key("intervals");
  out_.begin_array();
}

void ClipJson::add(const ClipAnswer& answer, const IntervalAnswer& interval, const Motion& motion) {
  const json members = interval_json(answer.input, interval, most_start_pairs_);
  out_.begin_object();
  for (const auto& [key, value] : members.items()) {
    out_.key(key);
    if (key == "contacts" || key == "undecided")
      write_contacts(out_, answer, interval, motion, key == "undecided");
    else
      out_.value(value);
  }
  out_.end();
}

void ClipJson::finish(const ClipAnswer& answer) {
  out_.end();
  json tail = {{"last_pose", last_pose_json(answer, most_start_pairs_)},
               {"one_pose", answer.input.is_one_pose},
               {"rest_crossings", rest_json(answer)},
               {"schema", kQuerySchema},
               {"strategy", answer.strategy.name},
               {"summary", summary_json(answer)},
               {"threads", answer.threads}};
  if (asks_distances(answer.input)) tail["thickness"] = thickness_json(answer);
  write_members(out_, tail);
  out_.end();
}

}  // namespace cscd::bench
