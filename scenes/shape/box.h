#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A box with sharp edges, gridded on all faces, with a chain of bones along its z axis.
struct BoxParameters {
  std::array<int, 3> cells = {32, 32, 82};  // along x, y, z, at least 1 each
  Vec3 size = Vec3(4, 4, 10.25);            // it stands on the xy-plane, centred about the z axis
  int bones = 20;                           // of equal lengths, from the bottom to the top
};

// 2 (ab + bc + ca) + 2 vertices and 4 (ab + bc + ca) triangles, genus 0. A vertex follows at most three
// bones, by quadratic B-splines along the axis.
Shape box(const BoxParameters& parameters);

ShapeRow box_row();

}  // namespace cscd::scenes
