// A program that holds the rope's effects and no others. It defines the list of effects itself, so that the
// linker takes no other effect's code from the library. The rope's frames must not change.

#include <gtest/gtest.h>

#include "scenes/catalog/generate.h"
#include "scenes/effects/effect.h"

namespace cscd::scenes {

EffectRow chain_contact_row();
EffectRow chain_dynamics_row();
EffectRow skinning_linear_row();

// Each of these is null if the program holds no such function.
[[gnu::weak]] EffectRow cloth_dynamics_row();
[[gnu::weak]] EffectRow contact_response_row();
[[gnu::weak]] EffectRow keyframes_row();
[[gnu::weak]] EffectRow skinning_dual_quaternion_row();
[[gnu::weak]] EffectRow spring_follow_row();
[[gnu::weak]] EffectRow travelling_wave_row();
[[gnu::weak]] EffectRow twist_row();
[[gnu::weak]] EffectRow volume_bulge_row();

std::span<const EffectRow> effects() {
  static const EffectRow rows[] = {chain_dynamics_row(), chain_contact_row(), skinning_linear_row()};
  return rows;
}

namespace {

TEST(Alone, HasNoOtherEffectsCode) {
  using Row = EffectRow (*)();
  for (const Row row : {Row{cloth_dynamics_row}, Row{contact_response_row}, Row{keyframes_row},
                        Row{skinning_dual_quaternion_row}, Row{spring_follow_row}, Row{travelling_wave_row},
                        Row{twist_row}, Row{volume_bulge_row}})
    EXPECT_EQ(row, nullptr);
}

TEST(Alone, TheRopeHasItsDigest) {
  EXPECT_NO_THROW(generate(load_scene("rope")));
}

}  // namespace
}  // namespace cscd::scenes
