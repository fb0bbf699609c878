#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/detect/start/embedding.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/clip/clip.h"
#include "scenes/random/random_interval.h"

namespace cscd::test {

// A random interval as a mesh with its positions at both ends.
struct RandomStep {
  scenes::RandomInterval random;
  TriangleMesh mesh;
  std::vector<Vec3> start, end;  // [vertices]

  explicit RandomStep(std::uint64_t seed)
      : random(scenes::make_random_interval(seed)),
        mesh(random.clip.header().triangles, random.clip.header().vertex_count) {
    const scenes::ClipInterval interval = random.clip.interval(0);
    start.assign(interval.motion.start().begin(), interval.motion.start().end());
    end.assign(interval.motion.end().begin(), interval.motion.end().end());
  }
  Motion motion() const { return Motion(start, end); }
  bool starts_embedded() const { return EmbeddingTest(mesh, start).embedded(start); }
};

// How many steps a test takes: `usual`, unless the environment names another number.
inline std::uint64_t steps_asked(const char* variable, std::uint64_t usual) {
  const char* const asked = std::getenv(variable);
  return asked != nullptr ? std::stoull(asked) : usual;
}

}  // namespace cscd::test
