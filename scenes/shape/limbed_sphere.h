#pragma once

#include <string>
#include <vector>

#include "scenes/shape/body_form.h"
#include "scenes/shape/box_grid.h"
#include "scenes/shape/limb_form.h"
#include "scenes/shape/shape.h"

namespace cscd::scenes {

// One limb that grows out of a square patch of the body's grid.
struct Limb {
  std::string name;
  std::string parent;              // the bone of the body on which it hangs
  std::vector<std::string> bones;  // one from each joint to the next
  LimbForm::Spec form;             // u and v are set from the face
  BoxGrid::Face face{0, false};
  int cell_u = 0, cell_v = 0;  // the patch's lowest cell on the face
  int size = 1;                // the patch has size x size cells
  int rings = 2;               // of 4 size quads each, between the patch's outline and the cap at the end
  double flare = 1;            // how much wider than the limb its outline on the body is
  double collar = 0;           // over which length the outline turns into the limb's sections
  double root_blend = 1;       // over which length the weights of body and limb run into each other
  double blend = 0.5;          // the same at its joints, as a share of the shorter bone
};

struct LimbedSphereParameters {
  int cells = 14;  // the body is the surface of a cube of so many cells along each edge
  BodyForm::Spec body;
  std::vector<std::string> body_bones;  // the first is the root; each hangs on the one before it
  std::vector<Vec3> body_joints;        // one more than bones, in order along the body's axis
  double body_blend = 0;                // over which length their weights run into each other
  int relax = 100;  // sweeps that space the body's vertices evenly; limbs hold it in place
  int smooth = 0;   // sweeps that round the creases where limbs begin
  std::vector<Limb> limbs;
};

// A body with limbs, of a quad sphere: a cube's grid laid onto the body, some square patches of which are
// extruded, ring by ring, into limbs that end in the patch itself. 6 n^2 + 4 sum(size * rings) quads, each
// two triangles, and two vertices more than quads; genus 0. A vertex follows at most four bones. Throws
// InputError for patches that overlap or leave the grid, unknown or repeated bones, and forms that cannot be.
Shape limbed_sphere(const LimbedSphereParameters& parameters);

ShapeRow limbed_sphere_row();

}  // namespace cscd::scenes
