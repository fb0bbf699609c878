#include "scenes/import/fbx/morphs.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "scenes/character/sample.h"
#include "scenes/import/fbx/mesh.h"

namespace cscd::scenes::fbx {
namespace {

constexpr double kFullPercent = 100;

// The full weights of a channel's shapes, in their order.
struct FullWeights {
  std::vector<double> percents;  // [shapes]
  // Blender writes a number for each vertex of the channel's shape instead: the percentage of the shape's
  // displacement that the vertex group gives this vertex. Empty where the file was written otherwise.
  std::vector<double> vertex_percents;
};

FullWeights full_weights(const Object& channel, std::size_t shapes, bool by_blender, std::size_t most,
                         const std::string& what) {
  FullWeights full{std::vector<double>(shapes, kFullPercent), {}};
  const Element* element = channel.element->child("FullWeights");
  if (element == nullptr) return full;
  std::vector<double> written = reals(*element, most, what);
  for (const double weight : written)
    if (!std::isfinite(weight)) throw InputError(what + ": a full weight is not finite; repair it");
  if (by_blender)
    full.vertex_percents = std::move(written);
  else
    std::copy_n(written.begin(), std::min(written.size(), shapes), full.percents.begin());
  return full;
}

// Returns for each shape how its weight depends on the channel's percentage. The weight of a shape has a peak
// of 1 at its full weight and falls to 0 at the full weights beside it.
std::vector<std::vector<MorphTarget::Knot>> responses(const std::vector<double>& percents,
                                                      const std::string& what) {
  std::vector<double> knots = percents;
  knots.push_back(0);
  std::sort(knots.begin(), knots.end());
  if (const auto twin = std::adjacent_find(knots.begin(), knots.end()); twin != knots.end())
    throw InputError(what +
                     (*twin == 0 ? ": a shape has the full weight 0" : ": two shapes have one full weight") +
                     "; give each shape a full weight of its own");
  std::vector<std::vector<MorphTarget::Knot>> all;
  for (const double percent : percents) {
    const auto peak = std::lower_bound(knots.begin(), knots.end(), percent) - knots.begin();
    const auto size = static_cast<std::ptrdiff_t>(knots.size());
    std::vector<MorphTarget::Knot>& response = all.emplace_back();
    // Two knots on each side are enough: beyond the second one, the weight stays 0.
    for (auto k = std::max<std::ptrdiff_t>(0, peak - 2); k < std::min(size, peak + 3); ++k)
      response.push_back({knots[static_cast<std::size_t>(k)], k == peak ? 1.0 : 0.0});
  }
  return all;
}

// Returns the displacements that a shape adds. `percents`, where not empty, scales each of those that the
// shape lists.
std::vector<Vec3> displacements_of(const Element& shape, std::size_t vertices,
                                   const std::vector<double>& percents, const std::string& what) {
  std::vector<Vec3> displacements(vertices, Vec3::Zero());
  const Element *indexes = shape.child("Indexes"), *points = shape.child("Vertices");
  if (indexes == nullptr || points == nullptr) return displacements;
  const std::vector<std::int64_t> index = integers(*indexes, vertices, what);
  const std::vector<Vec3> moved = read_points(*points, vertices, what);
  if (index.size() != moved.size())
    throw InputError(what + ": has " + std::to_string(index.size()) + " vertices and " +
                     std::to_string(moved.size()) + " displacements; repair it");
  if (!percents.empty() && percents.size() != index.size())
    throw InputError(what + ": has " + std::to_string(index.size()) + " vertices and " +
                     std::to_string(percents.size()) + " weights of a vertex group; repair it");
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0 || index[i] >= static_cast<std::int64_t>(vertices))
      throw InputError(what + ": moves vertex " + std::to_string(index[i]) + " of " +
                       std::to_string(vertices) + "; repair it");
    const double share = percents.empty() ? 1 : percents[i] / kFullPercent;
    displacements[static_cast<std::size_t>(index[i])] += share * moved[i];
  }
  return displacements;
}

double percent_of(const Object& channel) {
  if (has_property(channel, "DeformPercent")) return number(channel, "DeformPercent", 0);
  const Element* element = channel.element->child("DeformPercent");
  return element == nullptr || element->values.empty() ? 0 : element->values[0].real;
}

}  // namespace

std::vector<ShapeChannel> read_shapes(const Objects& objects, const Object& geometry,
                                      const CharacterLimits& limits, Part& part) {
  std::vector<ShapeChannel> channels;
  const std::size_t vertices = part.positions.size();
  const auto add = [&](const ShapeChannel& channel, const Element& shape, const std::string& name,
                       double percent, std::vector<MorphTarget::Knot> response,
                       const std::vector<double>& vertex_percents) {
    const std::string what = told("mesh", geometry) + ", blend shape '" + name + "'";
    if ((part.targets.size() + 1) * vertices > limits.displacements)
      throw InputError(what + ": is more than the " + std::to_string(limits.displacements) +
                       " displacements that are supported; simplify the model");
    MorphTarget target{name, displacements_of(shape, vertices, vertex_percents, what), 0,
                       std::move(response)};
    target.weight = weight_of(target, percent);
    part.targets.push_back(std::move(target));
    channels.push_back(channel);
  };
  // FBX 2011 writes shapes into the mesh, weighted by a property with the shape's name.
  for (const Element& shape : geometry.element->children) {
    if (shape.name != "Shape") continue;
    const std::string name(shape.text(0));
    add({&geometry, name}, shape, name, number(geometry, name, 0), responses({kFullPercent}, "").front(), {});
  }
  for (const Object* deformer : objects.sources(geometry, "Deformer")) {
    if (deformer->subtype != "BlendShape") continue;
    for (const Object* channel : objects.sources(*deformer, "Deformer")) {
      if (channel->subtype != "BlendShapeChannel") continue;
      const std::vector<const Object*> shapes = objects.sources(*channel, "Geometry");
      const std::string what = told("mesh", geometry) + ", " + told("blend shape", *channel);
      if (shapes.empty()) continue;
      const FullWeights full =
          full_weights(*channel, shapes.size(), objects.made_by("Blender"), limits.vertices, what);
      const auto response = responses(full.percents, what);
      for (std::size_t s = 0; s < shapes.size(); ++s)
        add({channel, "DeformPercent"}, *shapes[s]->element,
            shapes.size() == 1 ? channel->name : channel->name + " (" + shapes[s]->name + ")",
            percent_of(*channel), response[s], full.vertex_percents);
    }
  }
  return channels;
}

}  // namespace cscd::scenes::fbx
