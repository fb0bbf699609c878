#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/inputs/input.h"
#include "core/detect/start/crossings.h"

// What people call the places of a surface: names from the model file where there is one.
namespace cscd::bench {

using NamePair = std::pair<std::string, std::string>;

class SurfaceNames {
 public:
  // `input` must outlive it.
  explicit SurfaceNames(const Input& input);

  // The object that a triangle belongs to: the name of the node that shows it, with the number of the
  // component where the object consists of several (cscd inspect counts them).
  const std::string& part_of(TriangleId triangle) const { return label_[label_of_triangle_[+triangle]]; }
  // The bone that moves a vertex most; by number where bones have no names, empty without bones.
  std::string bone_of(VertexId vertex) const;
  // The number of the bone that moves most of a triangle's corners; negative for none.
  std::int32_t bone_of(TriangleId triangle) const;
  // The name of a bone, or its number where bones have no names.
  std::string name_of_bone(std::int32_t bone) const;
  // Where a triangle is for an animator: the bone that moves most of its corners, or else its part.
  std::string place_of(TriangleId triangle) const;
  // A number that two triangles share if and only if they are at one place.
  std::int32_t place_number(TriangleId triangle) const;
  // A triangle that has the first, or the second, feature of a pair. Both belong to one pair of triangles
  // that is not ignored, where there is one.
  TriangleId triangle_of(const FeaturePair& pair, bool second) const;
  // Where the first, or the second, feature of a pair is. A vertex of no face is at kPoint.
  static constexpr const char* kPoint = "a point";
  std::string place_of(const FeaturePair& pair, bool second) const;

 private:
  const Input& input_;
  std::vector<std::string> label_;
  std::vector<std::size_t> label_of_triangle_;
  std::vector<std::int32_t> bone_;  // of each vertex; empty without bones
};

// How many pairs of triangles join two parts: ("eye_l", "head") to 96. The part with fewer triangles comes
// first.
std::map<NamePair, std::size_t> pairs_by_part(const SurfaceNames& names, const TriangleMesh& mesh,
                                              const Crossings& crossings);
// Sorts by the counts, largest first; equal counts stay in the order of the names.
std::vector<std::pair<NamePair, std::size_t>> most_first(const std::map<NamePair, std::size_t>& counts);

}  // namespace cscd::bench
