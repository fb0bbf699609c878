#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scenes/clip/clip.h"

namespace cscd::scenes {

// The names of the families of random intervals. Each family is a kind of small noisy closed mesh with
// bones in large motion. Verification runs on them, because they show cases that animations hardly contain.
std::span<const std::string_view> random_families();

struct RandomInterval {
  std::string_view family;
  Clip clip;  // two frames: the reference pose, where the interval starts, and the end
};

// Makes a random interval. The interval depends on the seed alone, and consecutive seeds take the families
// in turn.
RandomInterval make_random_interval(std::uint64_t seed);

// Makes the random interval of the seed backwards, on a torn surface: some triangles are missing, turned
// round, or there twice. Played backwards, most intervals start with surfaces that cross. Every fourth seed
// makes an open sheet instead, which is flat, waved or rolled at first, or, of half of them, at the end. Code
// that promises to take any input is tested on these intervals.
RandomInterval make_torn_interval(std::uint64_t seed);

}  // namespace cscd::scenes
