#pragma once

#include <gtest/gtest.h>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/test_refusal.h"
#include "scenes/effects/sequence.h"

namespace cscd::scenes {

using Values = std::map<std::string, Parameters::Value, std::less<>>;
using Table = Parameters::Table;

inline EffectCall call(const std::string& name, Values values = {}) {
  return {name, Parameters("test, effect " + name, std::move(values))};
}

// The state after frames 1 to `frame`.
inline SceneState run(const Shape& shape, const std::vector<EffectCall>& calls, int frame, int substeps = 1) {
  EffectSequence sequence(calls, shape, substeps);
  SceneState state(shape);
  for (int i = 1; i <= frame; ++i) sequence.advance(state, i);
  return state;
}

// The text of the InputError with which the effect refuses its parameters or the shape, or an empty text.
inline std::string refusal(const Shape& shape, const EffectCall& effect) {
  return test::refusal([&] { EffectSequence({&effect, 1}, shape, 1); });
}

inline void expect_near(const Vec3& found, const Vec3& expected) {
  EXPECT_LT((found - expected).norm(), 1e-11) << found.transpose() << " for " << expected.transpose();
}

}  // namespace cscd::scenes
