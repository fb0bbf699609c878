#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/rig.h"
#include "scenes/clip/clip.h"

// The parts that only the study of growing work needs: longer and shorter steps, chains with other numbers of
// bones, and exponents.
namespace cscd::bench {

// y = factor x^exponent.
struct PowerLaw {
  double exponent, factor;
  std::size_t points;  // that it was fitted to
};
// Least squares in logarithms, over the pairs of which both are positive. Nothing with fewer than three, or
// if all x are alike.
std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y);

// A surface and its bones at one moment.
struct Moment {
  std::vector<Vec3> positions;  // [vertices]
  std::vector<Bone> bones;      // [bones]
};
// On the straight lines from a to b.
Moment between(const Moment& a, const Moment& b, double share);

// The joints of a chain at so many equal shares of its bones: as many merged, or cut, as it takes. Bones
// follow each other head to tail.
std::vector<Bone> resampled_chain(std::span<const Bone> chain, std::size_t count);
// Whether every bone hangs on the one before it.
bool is_chain(const Rig& rig);

}  // namespace cscd::bench
