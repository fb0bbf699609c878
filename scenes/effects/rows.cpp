#include "scenes/effects/effect.h"

namespace cscd::scenes {

// One per file of this folder.
EffectRow chain_contact_row();
EffectRow chain_dynamics_row();
EffectRow keyframes_row();
EffectRow skinning_linear_row();

std::span<const EffectRow> effects() {
  static const EffectRow rows[] = {keyframes_row(), chain_dynamics_row(), chain_contact_row(),
                                   skinning_linear_row()};
  return rows;
}

}  // namespace cscd::scenes
