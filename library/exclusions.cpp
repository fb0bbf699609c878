#include "library/exclusions.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace cscd {
namespace {

template <class Id>
std::vector<std::pair<Id, Id>> ids_of(const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::pair<Id, Id>> ids;
  for (const auto& [a, b] : pairs) ids.emplace_back(Id{a}, Id{b});
  return ids;
}

}  // namespace

Exclusions exclusions_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         const SelfCollision::Exclusions& asked) {
  Exclusions out;
  if (!asked.rigid.empty()) out.set_rigid(mesh, asked.rigid);
  if (!asked.group.empty())
    out.set_groups(mesh, asked.group, asked.groups_that_ignore_each_other);
  else if (!asked.groups_that_ignore_each_other.empty())
    throw InputError("exclude: pairs of groups without the group of each vertex; give `group` as well");
  out.exclude(mesh, ids_of<VertexId>(asked.vertex_pairs));
  out.exclude(mesh, ids_of<TriangleId>(asked.face_pairs));
  if (asked.rings < 0) throw InputError("exclude: rings is negative; give at least 0");
  out.exclude_rings(mesh, asked.rings);
  if (!(asked.rest_distance >= 0) || !std::isfinite(asked.rest_distance))
    throw InputError("exclude: rest_distance is no finite length; give at least 0");
  out.exclude_near(reference, asked.rest_distance);
  return out;
}

}  // namespace cscd
