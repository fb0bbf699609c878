#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/inputs/input.h"
#include "scenes/clip/mesh_file.h"
#include "scenes/hard/family.h"

namespace cscd::bench {

// A kind of intervals. A *set* is a group of families: random, torn, hard, shapes, scenes.
struct SubjectFamily {
  std::string name, set, story;
};

// A mesh of the benchmark, with its intervals.
struct Subject {
  std::string name;
  std::string family;
  scenes::PosedMesh mesh;
  std::vector<std::string> ids;  // [intervals]
};

// Each of these depends on its arguments alone.
//
// A small noisy closed mesh with bones, and the same played backwards on a torn surface
// (scenes/random/random_interval.h).
Subject random_subject(std::uint64_t seed);
Subject torn_subject(std::uint64_t seed);
// Two tetrahedra that carry the features of a hard elementary query (scenes/hard). They are closed, and the
// rest of each extends away from the other one.
Subject hard_subject(const scenes::hard::Family& family, scenes::hard::Kind kind, std::size_t number,
                     std::uint64_t seed);

// Small surfaces in a motion that is hard as a whole.
struct ShapeFamily {
  std::string_view name, story;
  scenes::PosedMesh (*make)(std::uint64_t seed);  // one interval
};
std::span<const ShapeFamily> shape_families();
Subject shape_subject(const ShapeFamily& family, std::size_t number, std::uint64_t seed);

// `count` intervals of a scene, or all where it has fewer. Where some touch, one is taken from the middle of
// the clip and the others are spread over those that touch; elsewhere all are spread over the clip. `scene`
// becomes part of names.
Subject scene_subject(Input& input, const std::string& scene, std::size_t count);

}  // namespace cscd::bench
