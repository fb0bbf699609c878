#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scenes/clip/clip.h"

namespace cscd::scenes {

// A family of small noisy closed meshes with bones in large motion: what verification runs on, as it shows
// what animations spare us.
std::span<const std::string_view> random_families();

struct RandomInterval {
  std::string_view family;
  Clip clip;  // two frames: the reference pose, where the interval starts, and its end
};

// Depends on the seed alone; seeds take turns through the families.
RandomInterval make_random_interval(std::uint64_t seed);

// The same interval backwards, so that it mostly starts by meeting itself, on what is left of the surface:
// some of its triangles are missing, turned round or there twice. For what promises to take any input.
RandomInterval make_torn_interval(std::uint64_t seed);

}  // namespace cscd::scenes
