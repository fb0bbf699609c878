#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A box with sharp edges and a grid on all faces, on a chain of bones along its z axis.
struct BoxParameters {
  std::array<int, 3> cells = {32, 32, 82};  // along x, y, z, at least 1 each
  Vec3 size = Vec3(4, 4, 10.25);            // the box stands on the xy-plane, centred about the z axis
  int bones = 20;                           // of equal lengths, from the bottom to the top
};

// Builds the box. For a x b x c cells it has 2 (ab + bc + ca) + 2 vertices and 4 (ab + bc + ca) triangles,
// and genus 0. A vertex follows at most three bones, by quadratic B-splines along the axis. Throws
// InputError for sizes without volume and for more than 2^27 vertices.
Shape box(const BoxParameters& parameters);

ShapeRow box_row();

}  // namespace cscd::scenes
