#include "scenes/import/fbx/morphs.h"

#include "core/base/error.h"
#include "scenes/character/sample.h"
#include "scenes/import/fbx/mesh.h"

namespace cscd::scenes::fbx {
namespace {

constexpr double kFullPercent = 100;

double full_weight(const Object& channel, std::size_t most, const std::string& what) {
  const Element* element = channel.element->child("FullWeights");
  if (element == nullptr) return kFullPercent;
  const std::vector<double> weights = reals(*element, most, what);
  if (weights.size() == 1 && weights[0] > 0) return weights[0];
  // Blender writes a number for each vertex; a number other than 100 stands for a vertex group.
  for (const double weight : weights)
    if (weight != kFullPercent)
      throw InputError(what + ": its full weights are not 100; apply vertex groups before the export");
  return kFullPercent;
}

std::vector<Vec3> displacements_of(const Element& shape, std::size_t vertices, const std::string& what) {
  std::vector<Vec3> displacements(vertices, Vec3::Zero());
  const Element *indexes = shape.child("Indexes"), *points = shape.child("Vertices");
  if (indexes == nullptr || points == nullptr) return displacements;
  const std::vector<std::int64_t> index = integers(*indexes, vertices, what);
  const std::vector<Vec3> moved = read_points(*points, vertices, what);
  if (index.size() != moved.size())
    throw InputError(what + ": has " + std::to_string(index.size()) + " vertices and " +
                     std::to_string(moved.size()) + " displacements; repair it");
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0 || index[i] >= static_cast<std::int64_t>(vertices))
      throw InputError(what + ": moves vertex " + std::to_string(index[i]) + " of " +
                       std::to_string(vertices) + "; repair it");
    displacements[static_cast<std::size_t>(index[i])] += moved[i];
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
                       double percent, double full) {
    const std::string what = told("mesh", geometry) + ", blend shape '" + name + "'";
    if ((part.targets.size() + 1) * vertices > limits.displacements)
      throw InputError(what + ": is more than the " + std::to_string(limits.displacements) +
                       " displacements that are supported; simplify the model");
    MorphTarget target{name, displacements_of(shape, vertices, what), 0, {{0, 0}, {full, 1}}};
    target.weight = weight_of(target, percent);
    part.targets.push_back(std::move(target));
    channels.push_back(channel);
  };
  // FBX 2011 writes shapes into the mesh, weighted by a property with the shape's name.
  for (const Element& shape : geometry.element->children) {
    if (shape.name != "Shape") continue;
    const std::string name(shape.text(0));
    add({&geometry, name}, shape, name, number(geometry, name, 0), kFullPercent);
  }
  for (const Object* deformer : objects.sources(geometry, "Deformer")) {
    if (deformer->subtype != "BlendShape") continue;
    for (const Object* channel : objects.sources(*deformer, "Deformer")) {
      if (channel->subtype != "BlendShapeChannel") continue;
      const std::vector<const Object*> shapes = objects.sources(*channel, "Geometry");
      const std::string what = told("mesh", geometry) + ", " + told("blend shape", *channel);
      if (shapes.empty()) continue;
      if (shapes.size() > 1) throw InputError(what + ": has shapes in between; export one shape a channel");
      add({channel, "DeformPercent"}, *shapes[0]->element, channel->name, percent_of(*channel),
          full_weight(*channel, limits.vertices, what));
    }
  }
  return channels;
}

}  // namespace cscd::scenes::fbx
