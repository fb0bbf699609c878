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

// The effects of one scene, in its order. Only the effects named are constructed and evaluated.
class EffectSequence {
 public:
  // Throws InputError for a name that is not among `rows` and for unusable parameters. The shape must outlive
  // the sequence.
  EffectSequence(std::span<const EffectCall> calls, const Shape& shape, int substeps,
                 std::span<const EffectRow> rows = effects());

  // Called with an effect's place in the sequence as it is entered, and with size() when the frame is done,
  // so that a caller's clock can tell whom the time belongs to.
  using Watch = std::function<void(std::size_t effect)>;

  // Advances the state from frame - 1 to frame.
  void advance(SceneState& state, int frame, const Watch& watch = {});

  // Whether frames come with predictions: one of the effects makes them.
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
