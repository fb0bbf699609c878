#include "bench/inputs/ignore.h"

#include <algorithm>
#include <fnmatch.h>
#include <map>

#include "bench/inputs/surface_names.h"
#include "core/base/error.h"
#include "core/hierarchy/loose_vertices.h"
#include "scenes/base/closest_name.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

using Names = std::pair<std::string, std::string>;
using GroupPair = std::pair<std::int32_t, std::int32_t>;

// Whether a name is what the user wrote, in which * stands for any letters.
bool is_called(const std::string& name, const std::string& pattern) {
  return name == pattern || fnmatch(pattern.c_str(), name.c_str(), FNM_NOESCAPE) == 0;
}

// What a user may call a triangle: its bone, its part with and without the number of the component, its mesh.
std::set<std::string> names_of(const Input& input, const SurfaceNames& names, TriangleId triangle) {
  std::set<std::string> out{names.part_of(triangle)};
  if (const std::int32_t bone = names.bone_of(triangle); bone >= 0) out.insert(names.name_of_bone(bone));
  const std::int32_t part = input.sources && input.import ? input.sources->triangle[+triangle].part : -1;
  if (part >= 0) {
    const scenes::ImportReport::Part& from = input.import->parts[static_cast<std::size_t>(part)];
    for (const std::string& name : {from.node, from.name})
      if (!name.empty()) out.insert(name);
  }
  return out;
}

[[noreturn]] void refuse(const std::string& text, const std::string& unknown,
                         const std::set<std::string>& known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  std::string hint = did_you_mean(unknown, views);
  if (hint.empty()) hint = "; there are " + first_of(views, 12);
  throw InputError("--ignore " + text + ": no bone, part or mesh is called '" + unknown + "'" + hint);
}

// Cuts "A:B" where both sides are names.
Names cut(const std::string& text, const std::set<std::string>& known) {
  const auto is_known = [&](const std::string& pattern) {
    return std::ranges::any_of(known, [&](const std::string& name) { return is_called(name, pattern); });
  };
  std::vector<Names> right;
  std::optional<std::string> unknown;  // the other side of a cut that gives one name
  for (std::size_t at = text.find(':'); at != std::string::npos; at = text.find(':', at + 1)) {
    const Names both{text.substr(0, at), text.substr(at + 1)};
    const bool first = is_known(both.first), second = is_known(both.second);
    if (first && second) right.push_back(both);
    if (first != second) unknown = first ? both.second : both.first;
  }
  if (right.size() == 1) return right.front();
  if (right.size() > 1)
    throw InputError("--ignore " + text + ": can be read as '" + right[0].first + "' and '" +
                     right[0].second + "', and as '" + right[1].first + "' and '" + right[1].second +
                     "'; rename one of them in the file");
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    throw InputError("--ignore " + text + ": has no colon; write A:B, or A:* for A and everything");
  refuse(text, unknown.value_or(text.substr(0, colon)), known);
}

// Triangles that every request treats alike are one group.
struct Group {
  std::set<std::string> called;  // what requests say that fits a name of theirs
  std::int32_t bone = -1;        // negative where bones do not matter
  auto operator<=>(const Group&) const = default;
};

bool meet(const Names& names, const Group& a, const Group& b) {
  const auto is = [](const Group& group, const std::string& pattern) {
    return group.called.contains(pattern);
  };
  return (is(a, names.first) && is(b, names.second)) || (is(a, names.second) && is(b, names.first));
}

}  // namespace

std::vector<std::set<std::int32_t>> bones_within(std::span<const BoneId> parent, int joints) {
  std::vector<std::set<std::int32_t>> next(parent.size()), near(parent.size());
  for (std::size_t b = 0; b < parent.size(); ++b) {
    near[b].insert(static_cast<std::int32_t>(b));
    if (parent[b] == BoneId{-1}) continue;
    next[b].insert(static_cast<std::int32_t>(parent[b]));
    next[+parent[b]].insert(static_cast<std::int32_t>(b));
  }
  for (std::size_t b = 0; b < parent.size(); ++b) {
    std::set<std::int32_t> edge = near[b];
    for (int step = 0; step < joints && !edge.empty(); ++step) {
      std::set<std::int32_t> reached;
      for (const std::int32_t from : edge)
        for (const std::int32_t to : next[static_cast<std::size_t>(from)])
          if (near[b].insert(to).second) reached.insert(to);
      edge = std::move(reached);
    }
  }
  return near;
}

void ignore(Input& input, const IgnoreRequest& request) {
  if (request.pairs.empty() && !request.neighbours) return;
  const SurfaceNames names(input);
  const std::vector<BoneId>& parent = input.clip->header().bone_parent;
  if (request.neighbours && parent.empty())
    throw InputError("--ignore-neighbours " + std::to_string(*request.neighbours) + ": " + input.name +
                     " has no bones; name its parts with --ignore A:B");

  std::set<std::string> known;
  for (std::size_t t = 0; t < input.mesh.triangle_count(); ++t)
    known.merge(names_of(input, names, TriangleId{static_cast<std::int32_t>(t)}));
  const bool has_points = count_loose_vertices(input.mesh).count > 0;
  if (has_points) known.insert(SurfaceNames::kPoint);
  auto ignored = std::make_shared<Ignored>();
  ignored->asked = request;
  std::set<std::string> mentioned;
  for (const std::string& text : request.pairs) {
    ignored->names.push_back(cut(text, known));
    mentioned.insert({ignored->names.back().first, ignored->names.back().second});
  }

  std::map<Group, std::int32_t> groups;
  const auto number_of = [&](Group group, const std::set<std::string>& own) {
    for (const std::string& pattern : mentioned)
      if (std::ranges::any_of(own, [&](const std::string& name) { return is_called(name, pattern); }))
        group.called.insert(pattern);
    const auto number = static_cast<std::int32_t>(groups.size());
    return groups.try_emplace(std::move(group), number).first->second;
  };
  std::vector<std::int32_t> group_of_triangle;
  for (std::size_t t = 0; t < input.mesh.triangle_count(); ++t) {
    const TriangleId triangle{static_cast<std::int32_t>(t)};
    Group group;
    if (request.neighbours) group.bone = names.bone_of(triangle);
    group_of_triangle.push_back(number_of(std::move(group), names_of(input, names, triangle)));
  }
  const std::int32_t points = has_points ? number_of({}, {SurfaceNames::kPoint}) : -1;
  const std::vector<std::set<std::int32_t>> near = bones_within(parent, request.neighbours.value_or(0));
  std::vector<GroupPair> pairs;
  for (const auto& first : groups)
    for (const auto& second : groups) {
      const Group &a = first.first, &b = second.first;
      const bool are_near = request.neighbours && a.bone >= 0 && b.bone >= 0 &&
                            near[static_cast<std::size_t>(a.bone)].contains(b.bone);
      if (are_near ||
          std::ranges::any_of(ignored->names, [&](const Names& both) { return meet(both, a, b); }))
        pairs.emplace_back(first.second, second.second);
    }
  ignored->triangles.set_triangle_groups(input.mesh, std::move(group_of_triangle), pairs, points);
  input.ignored = std::move(ignored);
}

}  // namespace cscd::bench
