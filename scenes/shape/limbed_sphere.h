#pragma once

#include <string>
#include <vector>

#include "scenes/shape/box.h"
#include "scenes/shape/limb_form.h"
#include "scenes/shape/shape.h"
#include "scenes/shape/surface_details.h"

namespace cscd::scenes {

// One limb that grows out of a square patch of the body's grid.
struct Limb {
  std::string name;
  std::string parent;              // the bone of the body on which the limb hangs
  std::vector<std::string> bones;  // one bone from each joint to the next
  LimbForm::Spec form;             // u and v are set from the face
  BoxGrid::Face face{0, false};
  int cell_u = 0, cell_v = 0;  // the patch's lowest cell on the face
  int size = 1;                // the patch has size x size cells
  int rings = 2;               // rings of 4 * size quads, between the patch's outline and the cap at the end
  double flare = 1;            // factor by which the outline on the body is wider than the limb
  double collar = 0;           // the length over which the outline turns into the limb's sections
  double root_blend = 1;       // the length over which the weights of body and limb run into each other
  double blend = 0.5;          // the same at the limb's joints, as a share of the shorter bone
};

struct LimbedSphereParameters {
  int cells = 14;  // the body is the surface of a cube of so many cells along each edge
  BodyForm::Spec body;
  std::vector<std::string> body_bones;  // the first is the root; each other bone hangs on the previous bone
  std::vector<Vec3> body_joints;        // [body_bones + 1], in order along the body's axis
  double body_blend = 0;  // the length over which weights of the body's bones run into each other
  int relax = 100;        // sweeps that space the body's vertices evenly; the outlines of limbs stay in place
  int smooth = 0;         // sweeps that round the creases where limbs begin
  std::vector<Limb> limbs;
  std::vector<SurfaceDetail> details;  // raised and dented places of the finished surface
};

// Builds a body with limbs out of a quad sphere. The grid of a cube is laid onto the body. Some square
// patches of the grid are extruded, ring by ring, into limbs that end in the patch itself.
//
// With n = cells there are 6 n^2 + 4 sum(size * rings) quads, each of two triangles, and two vertices more
// than quads. The genus is 0. A vertex follows at most four bones. Throws InputError for patches that
// overlap or leave the grid, for unknown or repeated bones, and for impossible forms.
Shape limbed_sphere(const LimbedSphereParameters& parameters);

ShapeRow limbed_sphere_row();

}  // namespace cscd::scenes
