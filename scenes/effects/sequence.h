#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenes/effects/effect.h"

namespace cscd::scenes {

// An effect that a scene calls for.
struct EffectCall {
  std::string name;
  Parameters parameters;
};

// The effects of one scene, in the scene's order. Only the effects that the scene names are constructed and
// evaluated.
class EffectSequence {
 public:
  // `substeps` is the number of substeps of a frame. Throws InputError for a name that is not among `rows`
  // and for unusable parameters. The shape must outlive the sequence.
  EffectSequence(std::span<const EffectCall> calls, const Shape& shape, int substeps,
                 std::span<const EffectRow> rows = effects());

  // A function that is called with the place of an effect in the sequence when that effect begins, and with
  // size() when the frame is done. A caller's clock uses it to charge time to effects.
  using Watch = std::function<void(std::size_t effect)>;

  // Advances the state from frame - 1 to frame.
  void advance(SceneState& state, int frame, const Watch& watch = {});

  // True if frames come with predictions, because one of the effects makes predictions.
  bool predicts() const { return predicts_; }

  std::size_t size() const { return entries_.size(); }
  std::string_view name(std::size_t effect) const { return entries_[effect].name; }
  std::uint64_t evaluations(std::size_t effect) const { return entries_[effect].evaluations; }

 private:
  struct Entry {
    std::string_view name;
    Pace pace;
    std::unique_ptr<Effect> effect;
    std::uint64_t evaluations = 0;
  };
  std::vector<Entry> entries_;
  int substeps_;
  bool predicts_ = false;
};

}  // namespace cscd::scenes
