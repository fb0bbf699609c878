#include "scenes/shape/limbed_sphere.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

#include "core/base/error.h"
#include "core/base/sort_unique.h"
#include "scenes/shape/limb_weights.h"

namespace cscd::scenes {
namespace {

std::string who(const Limb& limb) {
  return "limbed_sphere: limb " + limb.name;
}

void check(const LimbedSphereParameters& p) {
  if (p.cells < 1 || p.cells > 4000) throw InputError("limbed_sphere: cells must be from 1 to 4000");
  if (p.body_bones.empty() || p.body_joints.size() != p.body_bones.size() + 1)
    throw InputError(
        "limbed_sphere: the body needs at least one bone and one joint more than bones; it has " +
        std::to_string(p.body_bones.size()) + " and " + std::to_string(p.body_joints.size()));
  if (!(p.body_blend > 0)) throw InputError("limbed_sphere: body_blend must be positive");
  std::vector<std::string> names = p.body_bones;
  double rings = 0;
  for (const Limb& limb : p.limbs) {
    if (limb.size < 1 || limb.size > p.cells || limb.cell_u < 0 || limb.cell_v < 0 ||
        limb.cell_u + limb.size > p.cells || limb.cell_v + limb.size > p.cells)
      throw InputError(who(limb) + ": its patch of " + std::to_string(limb.size) + " x " +
                       std::to_string(limb.size) + " cells at " + std::to_string(limb.cell_u) + ", " +
                       std::to_string(limb.cell_v) + " leaves the face of " + std::to_string(p.cells) +
                       " x " + std::to_string(p.cells) + " cells; move or shrink it");
    if (limb.rings < 2) throw InputError(who(limb) + ": needs at least 2 rings");
    if (limb.bones.size() + 1 != limb.form.joints.size())
      throw InputError(who(limb) + ": needs one joint more than bones; it has " +
                       std::to_string(limb.form.joints.size()) + " joints and " +
                       std::to_string(limb.bones.size()) + " bones");
    if (!(limb.flare > 0 && limb.collar > 0 && limb.root_blend > 0 && limb.blend > 0 && limb.blend <= 1))
      throw InputError(who(limb) + ": flare, collar and root_blend must be positive, blend in (0, 1]");
    if (std::find(p.body_bones.begin(), p.body_bones.end(), limb.parent) == p.body_bones.end())
      throw InputError(who(limb) + ": its parent " + limb.parent + " is no bone of the body");
    names.insert(names.end(), limb.bones.begin(), limb.bones.end());
    rings += 4.0 * limb.size * limb.rings;
  }
  if (rings > 1 << 27) throw InputError("limbed_sphere: more than 2^27 vertices; lower the rings");
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end())
    throw InputError("limbed_sphere: two bones are called " + *twice + "; give each a name of its own");
}

// Maps a point of the square from -1 to 1 to the unit circle. Equal steps along the boundary of the square
// become equal angles.
CirclePoint on_circle(double u, double v) {
  if (std::abs(v) <= u) return circle_point(v / u / 8);
  if (std::abs(u) <= v) return circle_point(0.25 - u / v / 8);
  if (std::abs(v) <= -u) return circle_point(0.5 + v / u / 8);
  return circle_point(0.75 - u / v / 8);
}

// A node of a limb's patch, and its place when the patch is the square from -1 to 1.
struct PatchNode {
  VertexId vertex;
  double u, v;
  double level() const { return std::max(std::abs(u), std::abs(v)); }
  CirclePoint direction() const { return level() > 0 ? on_circle(u, v) : CirclePoint{0, 0}; }
};

PatchNode patch_node(const BoxGrid& grid, const Limb& limb, int i, int j) {
  return {grid.at(grid.node(limb.face, limb.cell_u + i, limb.cell_v + j)), 2.0 * i / limb.size - 1,
          2.0 * j / limb.size - 1};
}

// The outline of the limb's patch, counter-clockwise seen from outside.
std::vector<PatchNode> outline(const BoxGrid& grid, const Limb& limb) {
  std::vector<PatchNode> nodes;
  const int m = limb.size;
  for (int i = 0; i < m; ++i) nodes.push_back(patch_node(grid, limb, i, 0));
  for (int i = 0; i < m; ++i) nodes.push_back(patch_node(grid, limb, m, i));
  for (int i = m; i > 0; --i) nodes.push_back(patch_node(grid, limb, i, m));
  for (int i = m; i > 0; --i) nodes.push_back(patch_node(grid, limb, 0, i));
  if (limb.face.upper == (limb.face.axis == 1)) std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

using Quad = std::array<VertexId, 4>;

// The quads of the body that no limb covers. Throws InputError if two patches overlap.
std::vector<Quad> body_quads(const BoxGrid& grid, const LimbedSphereParameters& p) {
  std::vector<Quad> quads;
  for (const BoxGrid::Face& face : BoxGrid::faces()) {
    std::vector<const Limb*> owner(static_cast<std::size_t>(p.cells) * static_cast<std::size_t>(p.cells));
    const auto at = [&](int u, int v) -> const Limb*& {
      return owner[static_cast<std::size_t>(v) * static_cast<std::size_t>(p.cells) +
                   static_cast<std::size_t>(u)];
    };
    for (const Limb& limb : p.limbs) {
      if (limb.face.axis != face.axis || limb.face.upper != face.upper) continue;
      for (int v = limb.cell_v; v < limb.cell_v + limb.size; ++v)
        for (int u = limb.cell_u; u < limb.cell_u + limb.size; ++u) {
          if (at(u, v))
            throw InputError(who(limb) + ": its patch overlaps that of limb " + at(u, v)->name + " in cell " +
                             std::to_string(u) + ", " + std::to_string(v) + "; move one of them");
          at(u, v) = &limb;
        }
    }
    for (int v = 0; v < p.cells; ++v)
      for (int u = 0; u < p.cells; ++u)
        if (!at(u, v)) quads.push_back(grid.cell(face, u, v));
  }
  return quads;
}

// The neighbours of every vertex along the edges of quads, as compressed rows.
class QuadGraph {
 public:
  QuadGraph(std::span<const Quad> quads, std::size_t vertices) : offset_(vertices + 1, 0) {
    std::vector<std::pair<VertexId, VertexId>> pairs;
    for (const Quad& quad : quads)
      for (std::size_t k = 0; k < 4; ++k) {
        pairs.push_back({quad[k], quad[(k + 1) % 4]});
        pairs.push_back({quad[(k + 1) % 4], quad[k]});
      }
    sort_unique(pairs);
    for (const auto& [from, to] : pairs) {
      ++offset_[+from + 1];
      to_.push_back(to);
    }
    for (std::size_t i = 0; i < vertices; ++i) offset_[i + 1] += offset_[i];
  }
  std::span<const VertexId> at(std::size_t vertex) const {
    return std::span(to_).subspan(offset_[vertex], offset_[vertex + 1] - offset_[vertex]);
  }
  Vec3 mean(std::size_t vertex, std::span<const Vec3> positions) const {
    Vec3 sum = Vec3::Zero();
    for (const VertexId neighbour : at(vertex)) sum += positions[+neighbour];
    return sum / static_cast<double>(at(vertex).size());
  }

 private:
  std::vector<std::size_t> offset_;
  std::vector<VertexId> to_;
};

class Builder {
 public:
  explicit Builder(const LimbedSphereParameters& p)
      : p_(p),
        grid_({p.cells, p.cells, p.cells}),
        body_(p.body, "limbed_sphere"),
        quads_(body_quads(grid_, p)) {}

  Shape build() {
    for (const Limb& limb : p_.limbs) {
      LimbForm::Spec spec = limb.form;
      spec.u = Vec3::Unit(limb.face.u());
      spec.v = Vec3::Unit(limb.face.v());
      forms_.emplace_back(std::move(spec), who(limb));
    }
    place_body();
    for (std::size_t limb = 0; limb < p_.limbs.size(); ++limb) grow(limb);
    const QuadGraph graph(quads_, positions_.size());
    smooth(graph);

    Shape shape;
    for (const Quad& quad : quads_) append_quad(quad, shape.triangles);
    add_bones(shape);
    add_weights(graph, shape);
    shape.positions = std::move(positions_);
    add_details(p_.details, shape);
    return shape;
  }

 private:
  // The arc length at which a limb's centre line leaves the body.
  double exit(std::size_t limb) const {
    const LimbForm& form = forms_[limb];
    constexpr int steps = 512;
    if (!body_.inside(form.at(0).centre))
      throw InputError(who(p_.limbs[limb]) + ": its first joint lies outside the body; move it inside");
    for (int i = 1; i <= steps; ++i)
      if (!body_.inside(form.at(form.length() * i / steps).centre)) return form.length() * (i - 0.5) / steps;
    throw InputError(who(p_.limbs[limb]) + ": never leaves the body; lengthen it");
  }

  // Places the vertices of the body. The outlines of the limbs are placed first, each round its centre
  // line. All other vertices then settle between the outlines.
  void place_body() {
    positions_.resize(grid_.vertex_count());
    on_limb_.resize(grid_.vertex_count());
    grid_.for_each_node([&](const BoxGrid::Node& node, VertexId vertex) {
      Vec3 direction;
      for (int axis = 0; axis < 3; ++axis)
        direction[axis] = 2.0 * node[static_cast<std::size_t>(axis)] / p_.cells - 1;
      positions_[+vertex] = body_.projected(body_.towards(direction));
    });

    // The sum and the number of places of each outline vertex: a vertex of two outlines lies halfway between.
    std::map<VertexId, std::pair<Vec3, int>> held;
    std::vector<bool> settled(positions_.size(), false);
    for (std::size_t limb = 0; limb < p_.limbs.size(); ++limb) {
      exit_.push_back(exit(limb));
      for (const PatchNode& node : outline(grid_, p_.limbs[limb])) {
        auto& [sum, count] = held.try_emplace(node.vertex, Vec3::Zero(), 0).first->second;
        sum += body_.projected(forms_[limb].point({exit_.back(), p_.limbs[limb].flare}, node.direction()));
        ++count;
      }
      for (int i = 1; i < p_.limbs[limb].size; ++i)
        for (int j = 1; j < p_.limbs[limb].size; ++j)
          settled[+patch_node(grid_, p_.limbs[limb], i, j).vertex] = true;
    }
    for (const auto& [vertex, place] : held) {
      positions_[+vertex] = body_.projected(place.first / place.second);
      settled[+vertex] = true;
    }
    const QuadGraph graph(quads_, positions_.size());
    for (int sweep = 0; sweep < p_.relax; ++sweep)
      for (std::size_t vertex = 0; vertex < positions_.size(); ++vertex)
        if (!settled[vertex]) positions_[vertex] = body_.projected(graph.mean(vertex, positions_));
  }

  // Extrudes the patch of a limb.
  void grow(std::size_t index) {
    const Limb& limb = p_.limbs[index];
    const LimbForm& form = forms_[index];
    const std::vector<PatchNode> root = outline(grid_, limb);
    const auto sides = root.size();

    // A vertex of the outline in the limb's own terms: its arc length, and its distance from the limb's
    // section.
    struct Foot {
      double arc, off_u, off_v;
    };
    std::vector<Foot> feet;
    double first = 0;
    for (const PatchNode& node : root) {
      const Vec3& x = positions_[+node.vertex];
      Foot foot{exit_[index], 0, 0};
      for (int i = 0; i < 4; ++i) {
        const LimbForm::Frame frame = form.at(foot.arc);
        foot.arc += (x - frame.centre).dot(frame.along);
      }
      const LimbForm::Frame frame = form.at(foot.arc);
      const Vec3 off = x - form.point({foot.arc}, node.direction());
      foot.off_u = off.dot(frame.u);
      foot.off_v = off.dot(frame.v);
      first = std::max(first, foot.arc);
      feet.push_back(foot);
      feel(node.vertex, index, 0, foot.arc);
    }
    const double collar_end = first + limb.collar;
    if (!(collar_end < form.length() - limb.form.tip))
      throw InputError(who(limb) + ": no room between body, collar and tip; lengthen it");
    double travel = 0;
    for (const Foot& foot : feet) {
      const double on = collar_end - foot.arc;
      travel += std::sqrt(on * on + foot.off_u * foot.off_u + foot.off_v * foot.off_v);
    }
    travel /= static_cast<double>(sides);
    const double share = travel / (travel + form.silhouette(collar_end));
    const int collar_rings = std::clamp(static_cast<int>(std::lround(share * limb.rings)), 1, limb.rings - 1);

    std::vector<VertexId> ring, next(sides);
    for (const PatchNode& node : root) ring.push_back(node.vertex);
    const auto add_ring = [&](const auto& place) {
      for (std::size_t side = 0; side < sides; ++side) {
        const auto [position, arc] = place(side);
        next[side] = VertexId{static_cast<int>(positions_.size())};
        positions_.push_back(position);
        on_limb_.emplace_back();
        feel(next[side], index, arc - feet[side].arc, arc);
      }
      for (std::size_t side = 0; side < sides; ++side) {
        const std::size_t after = (side + 1) % sides;
        quads_.push_back({ring[side], ring[after], next[after], next[side]});
      }
      ring = next;
    };
    struct Placed {
      Vec3 position;
      double arc;
    };
    for (int i = 1; i <= collar_rings; ++i) {
      const double t = static_cast<double>(i) / collar_rings, left = (1 - t) * (1 - t);
      add_ring([&](std::size_t side) {
        const Foot& foot = feet[side];
        const double arc = foot.arc + t * (collar_end - foot.arc);
        const LimbForm::Frame frame = form.at(arc);
        return Placed{
            form.point({arc}, root[side].direction()) + left * (foot.off_u * frame.u + foot.off_v * frame.v),
            arc};
      });
    }
    for (const LimbForm::Place& place :
         form.spread(collar_end, static_cast<std::size_t>(limb.rings - collar_rings)))
      add_ring([&](std::size_t side) {
        return Placed{form.point(place, root[side].direction()), place.arc};
      });

    // Make the cap out of the patch itself. The last ring takes the place of the patch's outline.
    std::map<VertexId, VertexId> moved;
    for (std::size_t side = 0; side < sides; ++side) moved[root[side].vertex] = ring[side];
    for (int i = 1; i < limb.size; ++i)
      for (int j = 1; j < limb.size; ++j) {
        const PatchNode node = patch_node(grid_, limb, i, j);
        const LimbForm::Place place = form.on_tip(1 - node.level() / 2);
        positions_[+node.vertex] = form.point(place, node.direction());
        feel(node.vertex, index, place.arc - exit_[index], place.arc);
      }
    for (int i = 0; i < limb.size; ++i)
      for (int j = 0; j < limb.size; ++j) {
        Quad quad = grid_.cell(limb.face, limb.cell_u + i, limb.cell_v + j);
        for (VertexId& corner : quad)
          if (const auto found = moved.find(corner); found != moved.end()) corner = found->second;
        quads_.push_back(quad);
      }
  }

  // Records that the bones of a limb can move the vertex (WeightPlace::OnLimb).
  void feel(VertexId vertex, std::size_t limb, double beyond, double arc) {
    on_limb_[+vertex].push_back({limb, beyond, arc});
  }

  // Smooths the surface about the outlines by Laplacian sweeps that fade away over a few edges.
  void smooth(const QuadGraph& graph) {
    constexpr int reach = 5;
    std::vector<int> edges(positions_.size(), reach);
    std::vector<std::size_t> reached;
    for (const Limb& limb : p_.limbs)
      for (const PatchNode& node : outline(grid_, limb))
        if (edges[+node.vertex] != 0) edges[+node.vertex] = 0, reached.push_back(+node.vertex);
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const VertexId neighbour : graph.at(reached[i]))
        if (edges[+neighbour] > edges[reached[i]] + 1) {
          edges[+neighbour] = edges[reached[i]] + 1;
          reached.push_back(+neighbour);
        }
    std::vector<Vec3> before;
    for (int sweep = 0; sweep < p_.smooth; ++sweep) {
      before = positions_;
      for (const std::size_t vertex : reached) {
        const double share = 0.5 * (reach - edges[vertex]) / reach;
        positions_[vertex] += share * (graph.mean(vertex, before) - before[vertex]);
      }
    }
  }

  void add_bones(Shape& shape) {
    const auto add = [&](const std::string& name, int parent, const Vec3& head, const Vec3& tail) {
      shape.bone_names.push_back(name);
      shape.rig.parent.push_back(BoneId{parent});
      shape.rig.reference.push_back({head, tail});
      return BoneId{static_cast<int>(shape.bone_names.size()) - 1};
    };
    for (std::size_t i = 0; i < p_.body_bones.size(); ++i) {
      body_chain_.bones.push_back(
          add(p_.body_bones[i], static_cast<int>(i) - 1, p_.body_joints[i], p_.body_joints[i + 1]));
      if (i > 0) body_chain_.joints.push_back({p_.body_joints[i][p_.body.axis], p_.body_blend});
    }
    for (std::size_t index = 0; index < p_.limbs.size(); ++index) {
      const Limb& limb = p_.limbs[index];
      LimbChain chain;
      // The outline itself gets most of its weight from the limb.
      chain.root = {-limb.root_blend / 4, limb.root_blend};
      int parent = static_cast<int>(std::find(p_.body_bones.begin(), p_.body_bones.end(), limb.parent) -
                                    p_.body_bones.begin());
      for (std::size_t i = 0; i < limb.bones.size(); ++i) {
        chain.chain.bones.push_back(add(limb.bones[i], parent, limb.form.joints[i], limb.form.joints[i + 1]));
        parent = static_cast<int>(chain.chain.bones.back());
        if (i == 0) continue;
        const double joint = forms_[index].joint(i);
        const double shorter =
            std::min(joint - forms_[index].joint(i - 1), forms_[index].joint(i + 1) - joint);
        chain.chain.joints.push_back({joint, 2 * limb.blend * shorter});
      }
      limb_chains_.push_back(std::move(chain));
    }
  }

  // Makes the weights. The share of a limb in a vertex off the limb depends on the way along the surface
  // from the vertex to the limb's outline.
  void add_weights(const QuadGraph& graph, Shape& shape) {
    for (std::size_t limb = 0; limb < p_.limbs.size(); ++limb) {
      const double furthest = limb_chains_[limb].root.width;
      std::map<VertexId, double> way;
      std::priority_queue<std::pair<double, VertexId>> todo;  // nearest first, because ways count down from 0
      const auto reach = [&](VertexId vertex, double at) {
        const auto [place, added] = way.try_emplace(vertex, at);
        if (!added && place->second >= at) return;
        place->second = at;
        todo.push({at, vertex});
      };
      const auto own = [&](VertexId vertex) {
        return std::ranges::any_of(on_limb_[+vertex], [&](const auto& on) { return on.limb == limb; });
      };
      std::vector<std::pair<VertexId, double>> felt;
      for (const PatchNode& node : outline(grid_, p_.limbs[limb])) reach(node.vertex, 0);
      while (!todo.empty()) {
        const auto [at, vertex] = todo.top();
        todo.pop();
        if (way[vertex] > at) continue;
        if (!own(vertex)) felt.push_back({vertex, at});
        for (const VertexId neighbour : graph.at(+vertex)) {
          const double there = at - (positions_[+neighbour] - positions_[+vertex]).norm();
          if (there > -furthest && !own(neighbour)) reach(neighbour, there);
        }
      }
      for (const auto& [vertex, at] : felt) feel(vertex, limb, at, exit_[limb] + at);
    }
    for (std::size_t vertex = 0; vertex < positions_.size(); ++vertex)
      shape.weights.push_back(
          limb_weights({positions_[vertex][p_.body.axis], on_limb_[vertex]}, body_chain_, limb_chains_));
  }

  const LimbedSphereParameters& p_;
  BoxGrid grid_;
  BodyForm body_;
  std::vector<Quad> quads_;
  std::vector<LimbForm> forms_;         // [limbs]
  std::vector<double> exit_;            // [limbs]: the arc length at which the centre line leaves the body
  std::vector<LimbChain> limb_chains_;  // [limbs]
  WeightChain body_chain_;
  std::vector<Vec3> positions_;                            // [vertices]
  std::vector<std::vector<WeightPlace::OnLimb>> on_limb_;  // [vertices]
};

}  // namespace

Shape limbed_sphere(const LimbedSphereParameters& parameters) {
  check(parameters);
  return Builder(parameters).build();
}

}  // namespace cscd::scenes
