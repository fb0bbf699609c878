#include "scenes/effects/contact_response.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/detect/start/embedding.h"
#include "core/drvbc/drvbc.h"
#include "core/elementary/catalogue.h"
#include "scenes/effects/effect.h"

namespace cscd::scenes {

namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();
constexpr int kSmoothingPasses = 3;
constexpr int kMostCuts = 20;

// The features of one contact at its time: two groups of vertices, the share by which each vertex carries
// the point of contact, and the direction across both features.
struct Touch {
  VertexId vertex[4];
  double share[4];        // sums to 1 in the first group, to -1 in the second
  std::size_t first = 0;  // number of vertices in the first group
  Vec3 normal;            // not a unit vector; zero if the features have no normal
};

// The touch of a contact. at(vertex) gives the position of a vertex at the contact's time.
Touch touch_of(const TriangleMesh& mesh, const Contact& contact, const auto& at) {
  Touch touch;
  if (contact.pair.kind == FeaturePair::Kind::vertex_face) {
    const Triangle& c = mesh.corners(TriangleId{contact.pair.b});
    touch = {{VertexId{contact.pair.a}, c[0], c[1], c[2]}, {1, -1 / 3., -1 / 3., -1 / 3.}, 1, Vec3::Zero()};
    const Vec3 p = at(touch.vertex[0]), a = at(c[0]), b = at(c[1]), d = at(c[2]);
    touch.normal = (b - a).cross(d - a);
    const double area = touch.normal.squaredNorm();
    if (area == 0) return touch;
    touch.share[2] = -(p - a).cross(d - a).dot(touch.normal) / area;
    touch.share[3] = -(b - a).cross(p - a).dot(touch.normal) / area;
    touch.share[1] = -1 - touch.share[2] - touch.share[3];
  } else {
    const Edge &e = mesh.ends(EdgeId{contact.pair.a}), &f = mesh.ends(EdgeId{contact.pair.b});
    touch = {{e[0], e[1], f[0], f[1]}, {0.5, 0.5, -0.5, -0.5}, 2, Vec3::Zero()};
    const Vec3 u = at(e[1]) - at(e[0]), v = at(f[1]) - at(f[0]), between = at(f[0]) - at(e[0]);
    touch.normal = u.cross(v);
    const double area = touch.normal.squaredNorm();
    if (area == 0) return touch;
    const double s = between.cross(v).dot(touch.normal) / area, t = between.cross(u).dot(touch.normal) / area;
    touch.share[0] = 1 - s, touch.share[1] = s;
    touch.share[2] = t - 1, touch.share[3] = -t;
  }
  return touch;
}

// Keeps the animated surface from running into itself. The previous effects of the scene make the target,
// to which the surface is drawn. The surface itself starts at the end of its last step. The predicted end
// of a step follows the motion of the target and goes a part of the way back to the target:
//   predicted = target at the end + (1 - pull) (surface - target) at the start.
// A detector is asked about the step to the prediction, so the contacts are real. The next frame is the
// corrected end.
class ContactResponse final : public Effect {
 public:
  ContactResponse(const Parameters& p, const Shape& shape, const MakeDetector& first)
      : where_(p.where()),
        pull_(p.number("pull")),
        mesh_(shape.triangles, shape.positions.size(), p.where()),
        setup_{mesh_, shape.positions, shape.rig.parent.empty() ? nullptr : &shape.rig,
               *find_elementary_test("filtered_exact")},
        embedding_(mesh_, shape.positions),
        step_(mesh_, shape.positions, first(setup_),
              compose(std::make_unique<PlainCuller<Kdop16>>(setup_), setup_, {.relative_boxes = true}),
              options(p)),
        surface_(shape.positions),
        target_(shape.positions),
        bones_(shape.rig.reference) {
    require_embedded("frame 0");
  }

  void step(SceneState& state) override {
    predicted_.resize(surface_.size());
    for (std::size_t v = 0; v < surface_.size(); ++v)
      predicted_[v] = state.positions[v] + (1 - pull_) * (surface_[v] - target_[v]);
    target_ = state.positions;
    end_ = predicted_;
    step_.resolve(surface_, end_, {bones_, state.bones});
    surface_ = end_;
    bones_ = state.bones;
    require_embedded("frame " + std::to_string(static_cast<int>(state.time)));
    state.positions = surface_;
    state.predicted = predicted_;
  }

 private:
  static ContactStepOptions options(const Parameters& p) {
    ContactStepOptions options;
    options.push = p.number("push");
    options.spread = p.number("spread");
    options.back_off = p.number("back_off");
    options.rounds = p.integer("rounds");
    return options;
  }
  void require_embedded(const std::string& frame) {
    if (const auto found = embedding_.find_intersection(surface_))
      throw InputError(
          where_ + ": " + frame + ": triangles " + std::to_string(+found->first) + " and " +
          std::to_string(+found->second) +
          " meet, so the next step has no embedded start; mend the shape at rest, or what detects "
          "contacts");
  }

  std::string where_;
  double pull_;
  TriangleMesh mesh_;
  StrategyInput setup_;
  EmbeddingTest embedding_;
  ContactStep step_;
  std::vector<Vec3> surface_, target_, predicted_, end_;
  std::vector<Bone> bones_;
};

const ParameterRow kRows[] = {
    number_row("pull", "", "share of the way back to the animation that a step tries to make up for", {0, 1})
        .or_else({0.3}),
    number_row("push", "mean edge", "gap that is left at a contact", {0, 1e3})
        .or_else({ContactStepOptions{}.push}),
    number_row("spread", "mean edge", "how far along the surface a contact is felt", {1e-3, 1e6})
        .or_else({ContactStepOptions{}.spread}),
    number_row("back_off", "", "share of the time before contact that a step keeps if it is cut as a whole",
               {0.01, 0.99})
        .or_else({ContactStepOptions{}.back_off}),
    integer_row("rounds", "", "corrections of a step before it is cut as a whole", {0, 100})
        .or_else({double(ContactStepOptions{}.rounds)}),
};

}  // namespace

ContactStep::ContactStep(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         std::unique_ptr<Detector> first, std::unique_ptr<Detector> all,
                         const ContactStepOptions& options)
    : mesh_(mesh),
      options_(options),
      first_(std::move(first)),
      all_(std::move(all)),
      first_neighbour_(mesh.vertex_count() + 1),
      neighbours_(2 * mesh.edge_count()),
      correction_(mesh.vertex_count(), Vec3::Zero()),
      contacts_at_(mesh.vertex_count()),
      path_(mesh.vertex_count(), kUnreached) {
  double mean_edge = 0;
  for (const Edge& edge : mesh.edges())
    for (const VertexId end : edge) ++first_neighbour_[+end];
  std::size_t sum = 0;
  for (std::size_t& offset : first_neighbour_) offset = (sum += offset);
  for (const Edge& edge : mesh.edges()) {
    const double length = (reference[+edge[0]] - reference[+edge[1]]).norm();
    neighbours_[--first_neighbour_[+edge[0]]] = {edge[1], length};
    neighbours_[--first_neighbour_[+edge[1]]] = {edge[0], length};
    mean_edge += length / static_cast<double>(mesh.edge_count());
  }
  options_.push *= mean_edge;
  options_.spread *= mean_edge;
}

bool ContactStep::is_free(std::span<const Vec3> start, const std::vector<Vec3>& end,
                          const Rig::Interval& bones) {
  first_->detect({Motion(start, end), &bones}, found_);
  return found_.contacts.empty();
}

void ContactStep::resolve(std::span<const Vec3> start, std::vector<Vec3>& end, const Rig::Interval& bones) {
  ++counts_.steps;
  if (is_free(start, end, bones)) return;
  ++counts_.colliding;
  for (int round = 0; round < options_.rounds; ++round) {
    ++counts_.rounds;
    all_->detect({Motion(start, end), &bones}, found_);
    correct(start, end);
    if (is_free(start, end, bones)) return;
  }
  ++counts_.cut;
  for (int cut = 0; cut < kMostCuts; ++cut) {
    double time = 1;
    for (const Contact& contact : found_.contacts) time = std::min(time, contact.time);
    // Round the time down to a grid: the times of pairs that touch at once may differ in the last bits.
    constexpr double grid = 1 << 24;
    const double kept = std::floor(options_.back_off * time * grid) / grid;
    for (std::size_t v = 0; v < end.size(); ++v) end[v] = start[v] + kept * (end[v] - start[v]);
    if (is_free(start, end, bones)) return;
  }
  end.assign(start.begin(), start.end());
}

void ContactStep::correct(std::span<const Vec3> start, std::vector<Vec3>& end) {
  found_.sort();
  reached_.clear();
  for (const Contact& contact : found_.contacts) add_correction(contact, start, end);
  for (const VertexId v : reached_) correction_[+v] /= static_cast<double>(contacts_at_[+v]);
  spread();
  for (const VertexId v : reached_) {
    end[+v] += correction_[+v];
    correction_[+v].setZero();
    contacts_at_[+v] = 0;
    path_[+v] = kUnreached;
  }
}

void ContactStep::add_correction(const Contact& contact, std::span<const Vec3> start,
                                 std::span<const Vec3> end) {
  const double t = contact.time;
  Touch touch =
      touch_of(mesh_, contact, [&](VertexId v) -> Vec3 { return start[+v] + t * (end[+v] - start[+v]); });
  Vec3 approach = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    approach += touch.share[k] * (end[+touch.vertex[k]] - start[+touch.vertex[k]]);
  const double length = touch.normal.norm();
  if (length == 0) return;
  touch.normal /= length;
  const double speed = approach.dot(touch.normal);
  if (speed > 0) touch.normal = -touch.normal;  // from the second group to the first
  const Vec3 apart = ((1 - t) * std::abs(speed) + options_.push) / 2 * touch.normal;
  for (std::size_t k = 0; k < 4; ++k) {
    const VertexId v = touch.vertex[k];
    if (contacts_at_[+v]++ == 0) reached_.push_back(v);
    correction_[+v] += k < touch.first ? apart : Vec3(-apart);
  }
}

// Spreads the corrections. Every vertex near a vertex in contact takes over the correction of that vertex,
// fading out with the way between them. Then corrections are smoothed, because such regions meet.
void ContactStep::spread() {
  using Entry = std::pair<double, VertexId>;
  const auto later = [](const Entry& x, const Entry& y) { return x > y; };
  std::vector<Entry> heap;
  std::sort(reached_.begin(), reached_.end());
  for (const VertexId v : reached_) {
    path_[+v] = 0;
    heap.push_back({0, v});
  }
  std::make_heap(heap.begin(), heap.end(), later);
  reached_.clear();
  const auto around = [&](VertexId v) {
    return std::span(neighbours_)
        .subspan(first_neighbour_[+v], first_neighbour_[+v + 1] - first_neighbour_[+v]);
  };
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), later);
    const auto [done, at] = heap.back();
    heap.pop_back();
    if (done > path_[+at]) continue;
    reached_.push_back(at);
    for (const Neighbour& next : around(at)) {
      const double path = done + next.length;
      if (path >= path_[+next.vertex] || path > options_.spread) continue;
      path_[+next.vertex] = path;
      correction_[+next.vertex] = correction_[+at];
      heap.push_back({path, next.vertex});
      std::push_heap(heap.begin(), heap.end(), later);
    }
  }
  for (const VertexId v : reached_) {
    const double far = path_[+v] / options_.spread, fade = 1 - far * far;
    correction_[+v] *= fade * fade;
  }
  smoothed_.resize(reached_.size());
  for (int pass = 0; pass < kSmoothingPasses; ++pass) {
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      const auto neighbours = around(reached_[i]);
      Vec3 sum = Vec3::Zero();
      for (const Neighbour& next : neighbours) sum += correction_[+next.vertex];
      smoothed_[i] = (correction_[+reached_[i]] + sum / static_cast<double>(neighbours.size())) / 2;
    }
    for (std::size_t i = 0; i < reached_.size(); ++i) correction_[+reached_[i]] = smoothed_[i];
  }
}

std::unique_ptr<Effect> make_contact_response(const Parameters& parameters, const Shape& shape,
                                              const MakeDetector& first) {
  return std::make_unique<ContactResponse>(parameters, shape, first);
}

EffectRow contact_response_row() {
  return {"contact_response",
          "keeps the surface off itself as a simulator does: detects contacts of the predicted step, cuts it "
          "short, pushes apart",
          Pace::frame,
          kRows,
          [](const Parameters& parameters, const Shape& shape) -> std::unique_ptr<Effect> {
            // A scene's frames must not change with the reading of the paper that the strategy `drvbc`
            // follows.
            return make_contact_response(
                parameters, shape, [](const StrategyInput& setup) -> std::unique_ptr<Detector> {
                  if (!setup.rig || !setup.mesh.closed_and_oriented())
                    return compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup,
                                   {.relative_boxes = true});
                  return make_drvbc(setup, {.division = radial::Division::none}).detector;
                });
          },
          true};
}

}  // namespace cscd::scenes
