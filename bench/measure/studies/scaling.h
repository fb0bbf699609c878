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

// Intervals between any two moments.
class MomentSource final : public scenes::ClipSource {
 public:
  using Pair = std::pair<std::size_t, std::size_t>;  // indices of moments
  // Throws InputError for a moment whose sizes do not fit the header or that is not finite.
  MomentSource(scenes::ClipHeader header, std::vector<Moment> moments, std::vector<Pair> intervals);

  const scenes::ClipHeader& header() const override { return header_; }
  std::size_t frame_count() const override { return intervals_.size() + 1; }
  scenes::ClipInterval load(std::size_t interval) override;
  // Where an interval starts; after the last one, where that ends.
  scenes::FrameView load_frame(std::size_t frame) override;

 private:
  scenes::ClipHeader header_;
  std::vector<Moment> moments_;
  std::vector<Pair> intervals_;
};

}  // namespace cscd::bench
