#include "scenes/effects/sequence.h"

#include "core/base/error.h"

namespace cscd::scenes {

EffectSequence::EffectSequence(std::span<const EffectCall> calls, const Shape& shape, int substeps,
                               std::span<const EffectRow> rows)
    : substeps_(substeps) {
  for (const EffectCall& call : calls) {
    const EffectRow* found = nullptr;
    std::string known;
    for (const EffectRow& row : rows) {
      if (row.name == call.name) found = &row;
      known += (known.empty() ? "" : ", ") + std::string(row.name);
    }
    if (!found) throw InputError(call.parameters.where() + ": unknown effect; known are: " + known);
    predicts_ = predicts_ || found->predicts;
    entries_.push_back(
        {found->name, found->pace, found->make(checked(call.parameters, found->parameters), shape)});
  }
}

void EffectSequence::advance(SceneState& state, int frame, const Watch& watch) {
  for (std::size_t first = 0; first < entries_.size();) {
    std::size_t last = first + 1;
    int steps = 1;
    if (entries_[first].pace == Pace::substep) {
      steps = substeps_;
      while (last < entries_.size() && entries_[last].pace == Pace::substep) ++last;
    }
    for (int step = 1; step <= steps; ++step) {
      state.step = 1.0 / steps;
      state.time = step == steps ? frame : frame - 1 + step * state.step;
      for (std::size_t i = first; i < last; ++i) {
        if (watch) watch(i);
        entries_[i].effect->step(state);
        ++entries_[i].evaluations;
      }
    }
    first = last;
  }
  if (watch) watch(entries_.size());
}

}  // namespace cscd::scenes
