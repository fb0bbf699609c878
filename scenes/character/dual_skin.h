#pragma once

#include <span>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/shape/dual_quaternion.h"

namespace cscd::scenes {

// Moves the vertices of one part in one pose by dual quaternions.
//
// The map from the part to the world by way of a joint has to be a scaling along the part's axes, followed by
// a rotation and a move. The scalings of a vertex's joints are averaged by its weights and applied first; the
// rigid motions are blended after that (dual_quaternion.h). This is what Maya shows and what ufbx computes.
// A map that is sheared, that has no inverse, or that mirrors while another joint of the vertex does not, has
// no place in this recipe.
class DualSkin {
 public:
  // `joints` [joints of the part] are the maps. The part and its character must outlive this object.
  DualSkin(const Character& character, const Part& part, std::span<const Transform> joints);

  // Returns where the joints take a point by the weights of a vertex that has influences. Throws InputError
  // where one of the joints' maps does not follow the recipe.
  Vec3 moved(std::size_t vertex, const Vec3& point) const;

 private:
  struct Motion {
    DualQuaternion rigid;
    Vec3 scale;
    const char* fault;  // what keeps the map from following the recipe, or null
  };
  [[noreturn]] void refuse(int joint, const char* fault) const;

  const Character& character_;
  const Part& part_;
  std::vector<Motion> motion_;  // [joints]
};

}  // namespace cscd::scenes
