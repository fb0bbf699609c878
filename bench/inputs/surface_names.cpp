#include "bench/inputs/surface_names.h"

#include <algorithm>
#include <limits>

namespace cscd::bench {
namespace {

// Without weights, the bone that is nearest to each vertex in frame 0.
std::vector<std::int32_t> nearest_bones(const Rig& rig, std::span<const Vec3> positions) {
  std::vector<std::int32_t> nearest;
  nearest.reserve(positions.size());
  for (const Vec3& x : positions) {
    double least = std::numeric_limits<double>::infinity();
    std::int32_t found = 0;
    for (std::size_t b = 0; b < rig.reference.size(); ++b) {
      const Bone& bone = rig.reference[b];
      const Vec3 way = bone.tail - bone.head;
      const double length = way.squaredNorm();
      const double share = length > 0 ? std::clamp(way.dot(x - bone.head) / length, 0.0, 1.0) : 0.0;
      const double distance = (bone.head + share * way - x).squaredNorm();
      if (distance < least) {
        least = distance;
        found = static_cast<std::int32_t>(b);
      }
    }
    nearest.push_back(found);
  }
  return nearest;
}

// Returns the name of a part: that of its node, under which modelling programs show the object.
std::string name_of(const scenes::ImportReport::Part& part, std::size_t number) {
  if (!part.node.empty()) return part.node;
  return part.name.empty() ? "mesh " + std::to_string(number) : part.name;
}

std::vector<std::string> part_names(const scenes::ImportReport& report) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < report.parts.size(); ++p) names.push_back(name_of(report.parts[p], p));
  // Two objects of one name, or two materials of one object, are told apart by number.
  std::map<std::string, std::size_t> count;
  for (const std::string& name : names) ++count[name];
  for (std::size_t p = 0; p < names.size(); ++p)
    if (count[names[p]] > 1) names[p] += " (part " + std::to_string(p) + ")";
  return names;
}

}  // namespace

SurfaceNames::SurfaceNames(const Input& input) : input_(input) {
  const TriangleMesh& mesh = input.mesh;
  const std::vector<std::string> parts =
      input.import ? part_names(*input.import) : std::vector<std::string>();
  const auto part = [&](std::size_t t) { return input.sources ? input.sources->triangle[t].part : -1; };
  std::map<std::int32_t, std::int32_t> one_component;  // of each part, or -1 for several
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::int32_t component = mesh.component(TriangleId{static_cast<std::int32_t>(t)});
    const auto [known, added] = one_component.try_emplace(part(t), component);
    if (!added && known->second != component) known->second = -1;
  }
  const auto cloth_of = [&](std::int32_t component) -> const std::string* {
    const std::int32_t first = mesh.component_count() - static_cast<std::int32_t>(input.cloth_names.size());
    return component < first ? nullptr : &input.cloth_names[static_cast<std::size_t>(component - first)];
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> known;  // part, component or -1
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::int32_t p = part(t), component = mesh.component(TriangleId{static_cast<std::int32_t>(t)});
    const bool several = one_component[p] < 0;
    const auto [label, added] = known.try_emplace({p, several ? component : -1}, label_.size());
    if (added) {
      std::string name = p >= 0 ? parts[static_cast<std::size_t>(p)] : several ? "" : "the surface";
      if (several) name += (name.empty() ? "" : ", ") + std::string("component ") + std::to_string(component);
      if (const std::string* const cloth = cloth_of(component)) name = *cloth;
      label_.push_back(std::move(name));
    }
    label_of_triangle_.push_back(label->second);
  }
  if (input.sources && input.import && !input.import->bones.empty())
    bone_ = input.sources->bone;
  else if (input.rig)
    bone_ = nearest_bones(*input.rig, input.reference);
  if (input.cloth_names.empty() || bone_.empty()) return;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId triangle{static_cast<std::int32_t>(t)};
    if (cloth_of(mesh.component(triangle)) == nullptr) continue;
    for (const VertexId corner : mesh.corners(triangle)) bone_[+corner] = -1;
  }
}

std::string SurfaceNames::name_of_bone(std::int32_t bone) const {
  const auto i = static_cast<std::size_t>(bone);
  if (i < input_.bone_names.size() && !input_.bone_names[i].empty()) return input_.bone_names[i];
  return "bone " + std::to_string(bone);
}

std::string SurfaceNames::bone_of(VertexId vertex) const {
  if (bone_.empty() || bone_[+vertex] < 0) return {};
  return name_of_bone(bone_[+vertex]);
}

std::int32_t SurfaceNames::bone_of(TriangleId triangle) const {
  if (bone_.empty()) return -1;
  const Triangle& c = input_.mesh.corners(triangle);
  const bool last_two = bone_[+c[1]] == bone_[+c[2]];
  return bone_[+(last_two ? c[1] : c[0])];
}

std::string SurfaceNames::place_of(TriangleId triangle) const {
  const std::int32_t bone = bone_of(triangle);
  return bone < 0 ? part_of(triangle) : name_of_bone(bone);
}

std::int32_t SurfaceNames::place_number(TriangleId triangle) const {
  const std::int32_t bone = bone_of(triangle);
  return bone < 0 ? -1 - static_cast<std::int32_t>(label_of_triangle_[+triangle]) : bone;
}

TriangleId SurfaceNames::triangle_of(const FeaturePair& pair, bool second) const {
  const TriangleMesh& mesh = input_.mesh;
  const TriangleId face{pair.b};
  const bool is_face = pair.kind == FeaturePair::Kind::vertex_face;
  const std::span<const TriangleId> firsts =
      is_face ? mesh.triangles_at(VertexId{pair.a}) : mesh.triangles_at(EdgeId{pair.a});
  const std::span<const TriangleId> seconds =
      is_face ? std::span(&face, 1) : mesh.triangles_at(EdgeId{pair.b});
  if (input_.ignored)
    for (const TriangleId s : firsts)
      for (const TriangleId t : seconds)
        if (s != t && !input_.ignored->triangles.excludes(mesh, TrianglePair{s, t})) return second ? t : s;
  return second || firsts.empty() ? seconds.front() : firsts.front();
}

std::string SurfaceNames::place_of(const FeaturePair& pair, bool second) const {
  const bool is_vertex = pair.kind == FeaturePair::Kind::vertex_face && !second;
  if (is_vertex && input_.mesh.triangles_at(VertexId{pair.a}).empty()) return kPoint;
  return place_of(triangle_of(pair, second));
}

std::map<NamePair, std::size_t> pairs_by_part(const SurfaceNames& names, const TriangleMesh& mesh,
                                              const Crossings& crossings) {
  std::map<std::string, std::size_t> size;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    ++size[names.part_of(TriangleId{static_cast<std::int32_t>(t)})];
  std::map<NamePair, std::size_t> count;
  for (const CrossingPair& pair : crossings.pairs) {
    std::string a = names.part_of(pair.first), b = names.part_of(pair.second);
    if (size[a] > size[b] || (size[a] == size[b] && a > b)) std::swap(a, b);
    ++count[{std::move(a), std::move(b)}];
  }
  return count;
}

std::vector<std::pair<NamePair, std::size_t>> most_first(const std::map<NamePair, std::size_t>& counts) {
  std::vector<std::pair<NamePair, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

}  // namespace cscd::bench
