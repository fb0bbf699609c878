#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/base/error.h"
#include "core/detect/contact_geometry.h"
#include "core/detect/exclusions.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/session/candidates.h"
#include "core/session/session.h"

#include "cscd/cscd.h"

namespace cscd {
namespace {

using Positions = SelfCollision::Positions;
using Faces = SelfCollision::Faces;

Prepared make_first(const Setup& setup) {
  return make_drvbc_fast(setup);
}
Prepared make_complete(const Setup& setup) {
  return make_drvbc_fast(setup, {.name = "drvbc_fast_complete", .complete = true});
}
const Strategy kFirst{"drvbc_fast", "", Guarantee::first_contact, {.closed_mesh = true}, make_first};
const Strategy kComplete{.name = "drvbc_fast_complete",
                         .source = "",
                         .guarantee = Guarantee::complete,
                         .needs = {},
                         .make = make_complete,
                         .sees_start = true};

// A vertex's coordinates stand side by side in both, so the caller's rows are read where they are.
static_assert(sizeof(Vec3) == 3 * sizeof(double));
std::span<const Vec3> rows_of(const Positions& positions) {
  return {reinterpret_cast<const Vec3*>(positions.data()), static_cast<std::size_t>(positions.rows())};
}

std::vector<Triangle> triangles_of(const Faces& faces) {
  std::vector<Triangle> triangles;
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    triangles.push_back({VertexId{faces(f, 0)}, VertexId{faces(f, 1)}, VertexId{faces(f, 2)}});
  return triangles;
}

template <class Id>
std::vector<std::pair<Id, Id>> ids_of(const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::pair<Id, Id>> ids;
  for (const auto& [a, b] : pairs) ids.emplace_back(Id{a}, Id{b});
  return ids;
}

Exclusions exclusions_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         const SelfCollision::Exclusions& asked) {
  Exclusions out;
  if (!asked.obstacle.empty()) out.set_obstacles(mesh, asked.obstacle);
  if (!asked.group.empty())
    out.set_groups(mesh, asked.group, asked.groups_that_ignore_each_other);
  else if (!asked.groups_that_ignore_each_other.empty())
    throw InputError("exclude: pairs of groups without the group of each vertex; give `group` as well");
  out.exclude(mesh, ids_of<VertexId>(asked.vertex_pairs));
  out.exclude(mesh, ids_of<TriangleId>(asked.face_pairs));
  if (asked.rings < 0) throw InputError("exclude: rings is negative; give at least 0");
  out.exclude_rings(mesh, asked.rings);
  if (!(asked.rest_distance >= 0)) throw InputError("exclude: rest_distance is not a length of at least 0");
  out.exclude_near(reference, asked.rest_distance);
  return out;
}

// Runs the call, and turns errors of the input into the library's.
template <class Call>
auto checked(const Call& call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw std::invalid_argument(error.what());
  }
}

}  // namespace

class SelfCollision::Engine {
 public:
  Engine(const Faces& faces, const Positions& reference, Options options)
      : options_(std::move(options)),
        reference_(rows_of(reference).begin(), rows_of(reference).end()),
        mesh_(triangles_of(faces), reference_.size(), "faces"),
        exclusions_(exclusions_of(mesh_, reference_, options_.exclude)) {
    require_finite(reference_, "reference positions");
    if (options_.threads < 1) throw InputError("options: threads is less than 1; give at least 1");
    // Preparing here, and not in the first step, finds what is wrong with the input where it is given.
    session(true);
  }

  const TriangleMesh& mesh() const { return mesh_; }

  Motion motion(const Positions& start, const Positions& end) const {
    check(start, "start");
    check(end, "end");
    return {rows_of(start), rows_of(end)};
  }

  const StepAnswer& step(const Motion& motion, bool first) {
    session(first).step(motion, nullptr, answer_);
    return answer_;
  }

  void write(const StepAnswer& from, const Motion& motion, Answer& out) const {
    out.start_crossings.clear();
    for (const auto& [a, b] : from.start.pairs)
      out.start_crossings.push_back({static_cast<int>(a), static_cast<int>(b)});
    out.contacts.clear();
    for (const cscd::Contact& contact : from.found.contacts) out.contacts.push_back(written(contact, motion));
  }

  void candidates(const Motion& motion, double radius, Candidates& out) {
    if (!(radius >= 0) || !std::isfinite(radius))
      throw InputError("candidates: radius " + std::to_string(radius) + "; give a length of at least 0");
    if (!search_) search_.emplace(mesh_, reference_, exclusions());
    search_->find(motion, radius, found_);
    for (const FeaturePair& pair : found_)
      if (pair.kind == FeaturePair::Kind::vertex_face)
        out.vertex_face.push_back({pair.a, pair.b});
      else
        out.edge_edge.push_back(indices_of(pair));
  }

 private:
  const cscd::Exclusions* exclusions() const { return exclusions_.empty() ? nullptr : &exclusions_; }

  // The sessions are prepared when they are asked for first. With exclusions, contacts may leave the surface
  // crossing itself without a word, so only a complete strategy is right.
  Session& session(bool first) {
    std::optional<Session>& wanted = first ? first_ : all_;
    if (wanted) return *wanted;
    const Setup setup{mesh_, reference_,  nullptr, *find_elementary_test("filtered_exact"), options_.threads,
                      first, exclusions()};
    const bool by_signs = first && mesh_.closed_and_oriented() && exclusions_.empty();
    const SessionOptions options{
        .first = first, .keep_rest_crossings = true, .ignore_starts = !options_.check_start};
    return wanted.emplace("reference positions", setup, by_signs ? kFirst : kComplete, kComplete, reference_,
                          options);
  }

  void check(const Positions& positions, const std::string& which) const {
    if (static_cast<std::size_t>(positions.rows()) != mesh_.vertex_count())
      throw InputError(which + " positions: " + std::to_string(positions.rows()) + " rows for " +
                       std::to_string(mesh_.vertex_count()) + " vertices; give one row a vertex");
    if (options_.check_positions) require_finite(rows_of(positions), which + " positions");
  }

  std::array<int, 4> indices_of(const FeaturePair& pair) const {
    const auto [a, b, c, d] = vertices_of(mesh_, pair);
    return {static_cast<int>(a), static_cast<int>(b), static_cast<int>(c), static_cast<int>(d)};
  }

  Contact written(const cscd::Contact& contact, const Motion& motion) const {
    const ContactGeometry geometry = contact_geometry(mesh_, motion, contact.pair, contact.time);
    const bool edges = contact.pair.kind == FeaturePair::Kind::edge_edge;
    return {edges,
            indices_of(contact.pair),
            edges ? -1 : contact.pair.b,
            contact.time,
            geometry.point,
            geometry.normal.value_or(Vec3::Zero()),
            Eigen::Vector3d(geometry.weights[0], geometry.weights[1], geometry.weights[2]),
            geometry.relative_speed.value_or(0)};
  }

  Options options_;
  std::vector<Vec3> reference_;
  TriangleMesh mesh_;
  cscd::Exclusions exclusions_;
  std::optional<Session> first_, all_;
  std::optional<CandidateSearch> search_;
  StepAnswer answer_;
  std::vector<FeaturePair> found_;
};

SelfCollision::SelfCollision(const Faces& faces, const Positions& reference, Options options)
    : engine_(checked([&] {
        instruction_set();  // throws if it cannot be what the environment asks for
        return std::make_unique<Engine>(faces, reference, std::move(options));
      })) {}
SelfCollision::SelfCollision(const Faces& faces, const Positions& reference)
    : SelfCollision(faces, reference, Options()) {}
SelfCollision::~SelfCollision() = default;
SelfCollision::SelfCollision(SelfCollision&&) noexcept = default;
SelfCollision& SelfCollision::operator=(SelfCollision&&) noexcept = default;

bool SelfCollision::is_free(const Positions& start, const Positions& end) {
  return checked([&] {
    const StepAnswer& answer = engine_->step(engine_->motion(start, end), true);
    return answer.found.contacts.empty() && answer.start.total == 0;
  });
}

void SelfCollision::first_contact(const Positions& start, const Positions& end, Answer& out) {
  checked([&] {
    const Motion motion = engine_->motion(start, end);
    engine_->write(engine_->step(motion, true), motion, out);
  });
}

SelfCollision::Answer SelfCollision::first_contact(const Positions& start, const Positions& end) {
  Answer out;
  first_contact(start, end, out);
  return out;
}

void SelfCollision::all_contacts(const Positions& start, const Positions& end, Answer& out) {
  checked([&] {
    const Motion motion = engine_->motion(start, end);
    engine_->write(engine_->step(motion, false), motion, out);
  });
}

SelfCollision::Answer SelfCollision::all_contacts(const Positions& start, const Positions& end) {
  Answer out;
  all_contacts(start, end, out);
  return out;
}

double SelfCollision::largest_step(const Positions& start, const Positions& end, double safety) {
  return checked([&] {
    if (!(safety > 0 && safety <= 1))
      throw InputError("largest_step: safety " + std::to_string(safety) + "; give a number in (0, 1]");
    const StepAnswer& answer = engine_->step(engine_->motion(start, end), true);
    if (answer.start.total > 0) return 0.0;
    const std::optional<double> time = answer.time();
    if (!time) return 1.0;
    // The time of a contact is off by at most 2^-50, and the product rounds by less than that.
    constexpr double kSlack = 0x1p-49;
    return std::max(0.0, safety * (*time - kSlack));
  });
}

SelfCollision::Candidates SelfCollision::candidates(const Positions& start, const Positions& end,
                                                    double radius) {
  return checked([&] {
    Candidates out;
    engine_->candidates(engine_->motion(start, end), radius, out);
    return out;
  });
}

std::size_t SelfCollision::vertex_count() const {
  return engine_->mesh().vertex_count();
}
std::size_t SelfCollision::face_count() const {
  return engine_->mesh().triangle_count();
}
bool SelfCollision::closed() const {
  return engine_->mesh().closed_and_oriented();
}

}  // namespace cscd
