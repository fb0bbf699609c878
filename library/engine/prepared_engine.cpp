#include "library/engine/prepared_engine.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/base/number_text.h"
#include "core/base/rounding.h"
#include "core/detect/contact_geometry.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/geometry/feature_motion.h"
#include "core/mesh/mean_edge.h"
#include "core/session/vertex_bounds.h"
#include "library/engine/paths.h"

namespace cscd {

using PreparedEngine = SelfCollision::Engine::Prepared;

namespace {

using Positions = SelfCollision::Positions;
using Faces = SelfCollision::Faces;

constexpr int kMostThreads = 1024;  // each has memory of its own
constexpr std::size_t kMostLabels = 1000;
constexpr int kFilteredSteps = 16;  // after a step in which something excluded touched
// The first reach of a search for bounds of vertices, in mean edges, and by how much each further one is
// wider.
constexpr double kFirstReach = 0.5, kWider = 4;
// The pairs of vertices that are far from all others are looked for one by one where these are fewer than
// this part of all. Each takes some ten passes over the mesh.
constexpr std::size_t kFew = 64;

// A vertex's coordinates stand side by side in both, so the caller's rows are read where they are.
static_assert(sizeof(Vec3) == 3 * sizeof(double));
std::span<const Vec3> rows_of(const Positions& positions, std::string_view name) {
  positions.require_rows_of_three(name, "vertex");
  return {reinterpret_cast<const Vec3*>(positions.data()), positions.rows()};
}

std::span<const Vec3> rows_of(const Positions& positions, std::size_t count, std::string_view name) {
  const std::span<const Vec3> rows = rows_of(positions, name);
  if (rows.size() != count)
    throw InputError(std::string(name) + ": " + std::to_string(rows.size()) + " rows for " +
                     std::to_string(count) + " vertices; give one row a vertex");
  return rows;
}

std::vector<Triangle> triangles_of(const Faces& faces) {
  faces.require_rows_of_three("faces", "triangle");
  std::vector<Triangle> triangles;
  triangles.reserve(faces.rows());
  for (const int* c = faces.data(); triangles.size() < faces.rows(); c += 3)
    triangles.push_back({VertexId{c[0]}, VertexId{c[1]}, VertexId{c[2]}});
  return triangles;
}

std::vector<Vec3> copy_of(std::span<const Vec3> positions) {
  return {positions.begin(), positions.end()};
}

const ElementaryTest& elementary() {
  return *find_elementary_test("filtered_exact");
}

std::array<int, 4> indices_of(const TriangleMesh& mesh, const FeaturePair& pair) {
  const auto [a, b, c, d] = vertices_of(mesh, pair);
  return {static_cast<int>(a), static_cast<int>(b), static_cast<int>(c), static_cast<int>(d)};
}

}  // namespace

PreparedEngine::Prepared(const Faces& faces, const Positions& reference, Options options)
    : options_(std::move(options)),
      reference_(copy_of(rows_of(reference, "reference positions"))),
      mesh_(triangles_of(faces), reference_.size(), "faces"),
      beside_(obstacle_mesh_of(options_.obstacles)) {
  require_finite(reference_, "reference positions");
  // Positions that were never filled in. Every pair of triangles would cross.
  if (mesh_.triangle_count() > 1 &&
      std::ranges::all_of(reference_, [&](const Vec3& p) { return p == reference_[0]; }))
    throw InputError("reference positions: all vertices are in one place; give the pose at rest");
  if (options_.threads < 1 || options_.threads > kMostThreads)
    throw InputError("options: threads is " + std::to_string(options_.threads) + "; give 1 to " +
                     std::to_string(kMostThreads));
  if (options_.exclude.ongoing && !options_.check_start)
    throw InputError("exclude, ongoing: needs to know what crosses at the start; set check_start");
  check_labels();
  thickness_ = checked_thickness();
  options_.obstacles.clear();
  if (beside_)
    obstacles_.emplace(mesh_, reference_, beside_->mesh, beside_->positions, beside_->first_vertex,
                       elementary());
  std::vector<Vec3> all = reference_;
  if (beside_) all.insert(all.end(), beside_->positions.begin(), beside_->positions.end());
  exclusions_ = exclusions_of(obstacles_ ? obstacles_->together() : mesh_, all, options_.exclude);
  if (obstacles_ && !exclusions_.empty()) obstacles_->leave_out(exclusions_);
  if (obstacles_) obstacles_->thicken(thickness_);
  near_.emplace(mesh_, reference_, thickness_);
  // Preparing here, and not in the first step, finds what is wrong with the input where it is given.
  plain(first_);
}

Motion PreparedEngine::motion(const Positions& start, const Positions& end) const {
  return {rows_of(start, mesh_.vertex_count(), "start positions"),
          rows_of(end, mesh_.vertex_count(), "end positions")};
}

std::span<const Vec3> PreparedEngine::pose(const Positions& positions) const {
  const std::span<const Vec3> rows = rows_of(positions, mesh_.vertex_count(), "positions");
  check_finite(rows, "positions");
  return rows;
}

void PreparedEngine::check_finite(std::span<const Vec3> positions, const std::string& which) const {
  if (options_.check_positions) require_finite(positions, which);
}

void PreparedEngine::move(std::size_t obstacle, const Positions& start, const Positions& end) {
  // A caller's -1 is the largest number by the time it is here.
  const std::string name = "obstacle " + std::to_string(static_cast<std::ptrdiff_t>(obstacle));
  const std::size_t count = beside_ ? beside_->first_vertex.size() : 0;
  if (obstacle >= count)
    throw InputError(name + ": there are " + std::to_string(count) + "; obstacles are counted from 0");
  const std::string start_name = name + ", start positions", end_name = name + ", end positions";
  const std::span<const Vec3> from = rows_of(start, obstacles_->vertex_count(obstacle), start_name);
  const std::span<const Vec3> to = rows_of(end, obstacles_->vertex_count(obstacle), end_name);
  check_finite(from, start_name);
  check_finite(to, end_name);
  obstacles_->move(obstacle, from, to);
}

void PreparedEngine::step(const Motion& motion, bool first, Session::Sought sought) {
  step_itself(first ? first_ : all_, motion, options_.exclude.ongoing ? Session::Sought::contacts : sought);
  if (options_.exclude.ongoing && answer_.start.total > 0) leave_out_ongoing(motion, first);
  const std::vector<cscd::Contact>& own = answer_.found.contacts;
  const auto touched = std::ranges::find(own, Verdict::contact, &cscd::Contact::verdict);
  if (touched != own.end()) touched_first_ = touched->pair;
  if (!obstacles_) return;
  obstacles_->step(motion, first, sought == Session::Sought::time, options_.check_start, touched_, crossed_);
  const std::optional<double> earliest = time();
  if (first && earliest)
    for (std::vector<cscd::Contact>* contacts : {&answer_.found.contacts, &touched_.contacts})
      std::erase_if(*contacts, [&](const cscd::Contact& contact) { return contact.time > *earliest; });
}

std::optional<double> PreparedEngine::time() const {
  const std::optional<double> own = answer_.time();
  if (touched_.contacts.empty()) return own;
  return std::min(own.value_or(1), touched_.contacts.front().time);
}

void PreparedEngine::contacts(const Motion& motion, bool first, Answer& out) {
  step(motion, first, Session::Sought::contacts);
  out.start_crossings.clear();
  for (const cscd::Crossings* crossings : {&answer_.start, &crossed_})
    for (const auto& [a, b] : crossings->pairs)
      out.start_crossings.push_back({static_cast<int>(a), static_cast<int>(b)});
  if (!crossed_.pairs.empty()) std::sort(out.start_crossings.begin(), out.start_crossings.end());
  out.contacts.clear();
  const std::size_t count = answer_.found.contacts.size();
  if (count > out.contacts.capacity())
    require_memory(count, 3 * sizeof(Contact) * count);  // the list doubles
  for (const cscd::Contact& contact : answer_.found.contacts)
    out.contacts.push_back(written(mesh_, contact, motion));
  const auto own = static_cast<std::ptrdiff_t>(out.contacts.size());
  for (const cscd::Contact& contact : touched_.contacts)
    out.contacts.push_back(written(obstacles_->together(), contact, obstacles_->motion()));
  if (!touched_.contacts.empty())
    std::inplace_merge(out.contacts.begin(), out.contacts.begin() + own, out.contacts.end(),
                       [](const Contact& a, const Contact& b) { return a.time < b.time; });
}

// A solver that looks for a free step asks about one start many times, and about small steps one after
// another. From a start that crosses itself none is free, which is known after the first. What touched first
// in one step often touches in the next, and is close for many steps where there is a thickness: one pair
// that touches says that a step is not free, and one that does so at the start says when the step ends.
std::optional<double> PreparedEngine::free_until(const Motion& motion, Session::Sought sought) {
  if (same_bits(motion.start(), crossing_start_)) {
    check_finite(motion.end(), "end positions");
    return 0;
  }
  const std::optional<double> again = touches_again(motion);
  if (again && (sought == Session::Sought::any_contact || *again <= 0)) {
    check_finite(motion.start(), "start positions");
    check_finite(motion.end(), "end positions");
    return again;
  }
  step(motion, true, sought);
  if (answer_.start.total > 0) crossing_start_ = copy_of(motion.start());
  return answer_.start.total + crossed_.total > 0 ? 0 : time();
}

std::optional<double> PreparedEngine::touches_again(const Motion& motion) const {
  // With `ongoing`, the start of each step decides what is left out of that step.
  if (!touched_first_ || options_.exclude.ongoing) return std::nullopt;
  const FeaturePair& pair = *touched_first_;
  for (const VertexId v : vertices_of(mesh_, pair))
    if (!motion.start()[+v].allFinite() || !motion.end()[+v].allFinite()) return std::nullopt;
  const auto ask = [&](const auto& query) {
    return is_thick() ? elementary().answer_close(query, thickness_.of(mesh_, pair))
                      : elementary().answer(query);
  };
  const cscd::Answer answer = pair.kind == FeaturePair::Kind::vertex_face
                                  ? ask(vertex_face(mesh_, motion, VertexId{pair.a}, TriangleId{pair.b}))
                                  : ask(edge_edge(mesh_, motion, EdgeId{pair.a}, EdgeId{pair.b}));
  return answer.verdict == Verdict::contact ? std::optional(answer.time) : std::nullopt;
}

double PreparedEngine::largest_step(const Positions& start, const Positions& end, double safety) {
  if (!(safety > 0 && safety <= 1))
    throw InputError("largest_step: safety " + exact_text(safety) + "; give a number in (0, 1]");
  // The time of a contact is off by at most 2^-50, and the product with a share rounds by less than that.
  constexpr double kSlack = 0x1p-49;
  const std::optional<double> touched = free_until(motion(start, end), Session::Sought::time);
  return touched ? safety * std::max(0.0, *touched - kSlack) : 1.0;
}

SelfCollision::Candidates PreparedEngine::candidates(const Positions& start, const Positions& end,
                                                     double radius) {
  const Motion step = motion(start, end);
  check_finite(step.start(), "start positions");
  check_finite(step.end(), "end positions");
  if (!(radius >= 0) || !std::isfinite(radius))
    throw InputError("candidates: radius " + exact_text(radius) + "; give a finite length of at least 0");
  Candidates out;
  search().find(step, Thickness(radius), found_);
  append(mesh_, out);
  if (!obstacles_) return out;
  obstacles_->find_candidates(step, Thickness(radius), found_);
  append(obstacles_->together(), out);
  return out;
}

SelfCollision::PathsAnswer PreparedEngine::true_motion(const Paths& paths, double from, double to,
                                                       double resolution) {
  if (beside_ || is_thick())
    throw InputError("true_motion: knows no obstacles and no thickness; leave them out");
  return answer_paths(paths, from, to, resolution,
                      setup(false, exclusions_.empty() ? nullptr : &exclusions_));
}

// The near is found first: it says of most vertices that they get less than the cap, so that farther pairs
// are looked for, and kept, only where they matter. A wide cap then takes no more memory than a narrow one.
// Where few vertices are far from everything, their pairs are looked for one by one.
std::vector<double> PreparedEngine::vertex_bounds(const Positions& positions, double cap) {
  const std::span<const Vec3> pose = this->pose(positions);
  if (!(cap >= 0) || !std::isfinite(thickness_.largest() + 4 * cap))
    throw InputError("vertex_bounds: cap " + exact_text(cap) +
                     "; give a length of at least 0 of which twice, with the thickness, is finite");
  const double edge = mean_edge(mesh_, reference_);  // 0 where squares underflow
  double reach = edge > 0 ? std::min(cap, kFirstReach * edge) : cap;
  std::vector<double> caps(mesh_.vertex_count(), reach), most(mesh_.vertex_count(), cap);
  for (;;) {
    const VertexBounds bounds = bounds_within(pose, caps, {});
    if (reach >= cap) return bounds.find();
    const std::vector<double> known = bounds.find_most(cap);
    std::vector<VertexId> far;
    for (std::size_t v = 0; v < most.size(); ++v) {
      most[v] = std::min(most[v], known[v]);
      if (most[v] > reach) far.push_back(VertexId{static_cast<std::int32_t>(v)});
    }
    if (far.empty()) return bounds.find();
    if (far.size() <= most.size() / kFew) return bounds_within(pose, most, far).find();
    reach = std::min(cap, kWider * reach);
    for (std::size_t v = 0; v < most.size(); ++v) caps[v] = std::min(most[v], reach);
  }
}

VertexBounds PreparedEngine::bounds_within(std::span<const Vec3> pose, const std::vector<double>& caps,
                                           std::span<const VertexId> far) {
  // Pairs farther apart than this stay apart while no vertex moves farther than its cap. The slack exceeds
  // the roundings of the sums.
  const auto reach_of = [&](std::vector<double>& moved) {
    moved.resize(mesh_.vertex_count() + (beside_ ? beside_->positions.size() : 0), 0);
    const double widest = *std::ranges::max_element(moved);
    const double slack = 32 * kUnitRoundoff * (thickness_.largest() + 2 * widest);
    const bool same = std::ranges::all_of(std::span(moved).first(mesh_.vertex_count()),
                                          [&](double own) { return own == widest; });
    return same ? Thickness(thickness_.largest() + 2 * widest + slack)
                : Thickness(thickness_.largest() + slack, moved);
  };
  const Motion rest(pose, pose);
  VertexBounds bounds(caps);
  std::vector<double> moved = caps, near = caps;
  for (const VertexId v : far) near[+v] = 0;
  search().find(rest, reach_of(near), found_);
  const Thickness reach = reach_of(moved);
  if (!far.empty()) search().find_more(rest, reach, far, found_);
  bounds.add(mesh_, rest, found_, thickness_);
  if (obstacles_) {
    obstacles_->find_candidates(rest, reach, found_);
    if (!found_.empty()) bounds.add(obstacles_->together(), obstacles_->motion(), found_, thickness_);
  }
  return bounds;
}

void PreparedEngine::check_labels() const {
  const std::vector<int>& labels = options_.labels;
  if (labels.empty()) return;
  if (labels.size() != mesh_.vertex_count())
    throw InputError("labels: " + std::to_string(labels.size()) + " for " +
                     std::to_string(mesh_.vertex_count()) + " vertices; give one label a vertex");
  const std::size_t different = std::set<int>(labels.begin(), labels.end()).size();
  if (different > kMostLabels)
    throw InputError("labels: " + std::to_string(different) + " different ones; give at most " +
                     std::to_string(kMostLabels) + ", such as one for each bone");
}

Thickness PreparedEngine::checked_thickness() const {
  const auto require_length = [](double length, const std::string& name) {
    if (!(length >= 0) || !std::isfinite(length))
      throw InputError("options: " + name + " is " + exact_text(length) +
                       "; give a finite length of at least 0");
  };
  require_length(options_.thickness, "thickness");
  const std::vector<double>& by_vertex = options_.vertex_thickness;
  if (by_vertex.empty()) return Thickness(options_.thickness);
  const std::size_t vertices = mesh_.vertex_count() + (beside_ ? beside_->positions.size() : 0);
  if (by_vertex.size() != vertices)
    throw InputError("options: vertex_thickness has " + std::to_string(by_vertex.size()) + " entries for " +
                     std::to_string(vertices) + " vertices of the mesh and of obstacles; give one a vertex");
  for (std::size_t v = 0; v < by_vertex.size(); ++v)
    require_length(by_vertex[v], "vertex_thickness of vertex " + std::to_string(v));
  require_length(Thickness(options_.thickness, by_vertex).largest(), "thickness of a pair of vertices");
  return Thickness(options_.thickness, by_vertex);
}

StrategyInput PreparedEngine::setup(bool first, const cscd::Exclusions* exclusions) const {
  return {.mesh = mesh_,
          .reference = reference_,
          .rig = nullptr,
          .elementary = elementary(),
          .threads = options_.threads,
          .first_only = first,
          .exclusions = exclusions,
          .preparation = options_.preparation,
          .labels = options_.labels};
}

Session& PreparedEngine::made(std::optional<Session>& wanted, bool first, const Strategy& strategy,
                              const cscd::Exclusions* exclusions) {
  if (wanted) return *wanted;
  const SessionOptions options{.first = first,
                               .keep_rest_crossings = true,
                               .ignore_starts = !options_.check_start,
                               .check_finite = options_.check_positions,
                               .near = near_ ? &*near_ : nullptr,
                               .thickness = thickness_};
  return wanted.emplace("reference positions", setup(first, exclusions), strategy, kDrvbcFastComplete,
                        reference_, options);
}

// The session of a complete strategy finds out how a step starts, and tells the strategy where nothing
// crosses, which makes that step quick. With check_start off, a session finds out and tells nothing. Then
// the strategy that promises the first contact is right, because it takes every start for free of crossings
// as the caller does. With exclusions, though, a caller may let excluded pairs cross, and with a thickness
// pairs may be close at the start.
//
// With a thickness, pairs are excluded that are close in every step, such as neighbours, and the one
// session knows of them.
Session& PreparedEngine::plain(Question& question) {
  const bool for_granted =
      !options_.check_start && mesh_.closed_and_oriented() && exclusions_.empty() && !is_thick();
  return made(question.plain, question.first, question.first && for_granted ? kDrvbcFast : kDrvbcFastComplete,
              is_thick() && !exclusions_.empty() ? &exclusions_ : nullptr);
}

CrossingSearch& PreparedEngine::crossing_search() {
  if (!crossing_search_) crossing_search_.emplace(mesh_, reference_);
  return *crossing_search_;
}

CandidateSearch& PreparedEngine::search() {
  if (!search_) search_.emplace(setup(false, exclusions_.empty() ? nullptr : &exclusions_));
  return *search_;
}

void PreparedEngine::step_itself(Question& question, const Motion& motion, Session::Sought sought) {
  if (question.filtered_steps == 0) {
    plain(question).step(motion, nullptr, answer_, exclusions_.empty() ? sought : Session::Sought::contacts);
    if (exclusions_.empty() || is_thick()) return;
    const std::size_t left_out = leave_out();
    if (left_out > 0) question.filtered_steps = kFilteredSteps;
    if (left_out == 0 || !question.first || !answer_.found.contacts.empty()) return;
  }
  made(question.filtered, question.first, kDrvbcFastComplete, &exclusions_).step(motion, nullptr, answer_);
  --question.filtered_steps;
}

// Drops what is excluded from the answer, and returns the number of contacts dropped.
std::size_t PreparedEngine::leave_out() {
  answer_.start.total -= std::erase_if(answer_.start.pairs, [&](const CrossingPair& pair) {
    return exclusions_.excludes(mesh_, TrianglePair{pair.first, pair.second});
  });
  return std::erase_if(answer_.found.contacts, [&](const cscd::Contact& contact) {
    return exclusions_.excludes(mesh_, contact.pair);
  });
}

// Drops from the answer what lies within overlaps of the start. Where that leaves nothing of the first
// contact, finds the first of the others among all contacts.
void PreparedEngine::leave_out_ongoing(const Motion& motion, bool first) {
  const OverlapPieces pieces = crossing_search().find_pieces(motion.start(), exclusions_);
  const auto leave_out = [&] {
    answer_.start.total -= std::erase_if(answer_.start.pairs, [&](const CrossingPair& pair) {
      return pieces.find(pair.first, pair.second) != OverlapPieces::kNone;
    });
    return std::erase_if(answer_.found.contacts, [&](const cscd::Contact& contact) {
      return pieces.find(mesh_, contact.pair) != OverlapPieces::kNone;
    });
  };
  if (leave_out() == 0 || !first || !answer_.found.contacts.empty()) return;
  step_itself(all_, motion, Session::Sought::contacts);
  leave_out();
  keep_first(answer_.found);
}

void PreparedEngine::append(const TriangleMesh& mesh, Candidates& out) const {
  require_memory(found_.size(), 3 * sizeof(out.edge_edge[0]) * found_.size());
  for (const FeaturePair& pair : found_)
    if (pair.kind == FeaturePair::Kind::vertex_face)
      out.vertex_face.push_back({pair.a, pair.b});
    else
      out.edge_edge.push_back(indices_of(mesh, pair));
}

SelfCollision::Contact PreparedEngine::written(const TriangleMesh& mesh, const cscd::Contact& contact,
                                               const Motion& motion) const {
  const ContactGeometry geometry =
      contact_geometry(mesh, motion, contact.pair, contact.time, thickness_.of(mesh, contact.pair) > 0);
  const bool edges = contact.pair.kind == FeaturePair::Kind::edge_edge;
  return {edges,
          indices_of(mesh, contact.pair),
          edges ? -1 : contact.pair.b,
          contact.time,
          geometry.point,
          geometry.normal.value_or(Vec3::Zero()),
          Eigen::Vector3d(geometry.weights[0], geometry.weights[1], geometry.weights[2]),
          geometry.relative_speed.value_or(0)};
}

template <>
std::unique_ptr<SelfCollision::Engine> make_engine<kCompiledFor>(const Faces& faces,
                                                                 const Positions& reference,
                                                                 SelfCollision::Options options) {
  return std::make_unique<PreparedEngine>(faces, reference, std::move(options));
}

}  // namespace cscd
