#include "scenes/effects/sequence.h"

#include <gtest/gtest.h>

#include "core/base/test_refusal.h"
#include "scenes/shape/tube.h"

namespace cscd::scenes {
namespace {

// One call of an instrumented effect below.
struct Call {
  std::string effect;
  double time, step;
  bool operator==(const Call&) const = default;
};
std::vector<std::string> made;
std::vector<Call> stepped;

class Instrumented final : public Effect {
 public:
  explicit Instrumented(std::string name) : name_(std::move(name)) { made.push_back(name_); }
  void step(SceneState& state) override { stepped.push_back({name_, state.time, state.step}); }

 private:
  std::string name_;
};

template <char Name>
std::unique_ptr<Effect> make_instrumented(const Parameters&, const Shape&) {
  return std::make_unique<Instrumented>(std::string(1, Name));
}

const ParameterRow kSpeed[] = {number_row("speed", "length / frame", "speed", {0, 1})};
const EffectRow kRows[] = {
    {"a", "", Pace::substep, {}, make_instrumented<'a'>},
    {"b", "", Pace::substep, kSpeed, make_instrumented<'b'>},
    {"c", "", Pace::frame, {}, make_instrumented<'c'>},
    {"d", "", Pace::frame, {}, make_instrumented<'d'>},
};

class Sequence : public testing::Test {
 protected:
  Sequence() {
    made.clear();
    stepped.clear();
    TubeParameters p;
    p.rings = 10;
    p.sides = 4;
    p.bones = 3;
    p.length = 10;
    shape = tube(p);
  }
  static EffectCall call(const std::string& name,
                         std::map<std::string, Parameters::Value, std::less<>> values = {}) {
    return {name, Parameters("scene s, effect " + name, std::move(values))};
  }
  std::string refusal(const std::vector<EffectCall>& calls) {
    return test::refusal([&] { EffectSequence(calls, shape, 1, kRows); });
  }
  Shape shape;
};

TEST_F(Sequence, NeverTouchesAnEffectThatTheSceneDoesNotName) {
  const EffectCall calls[] = {call("d"), call("a")};
  EffectSequence sequence(calls, shape, 2, kRows);
  SceneState state(shape);
  for (int frame = 1; frame < 4; ++frame) sequence.advance(state, frame);
  EXPECT_EQ(made, (std::vector<std::string>{"d", "a"}));
  for (const Call& step : stepped) EXPECT_TRUE(step.effect == "d" || step.effect == "a") << step.effect;
  ASSERT_EQ(sequence.size(), 2u);
  EXPECT_EQ(sequence.name(0), "d");
  EXPECT_EQ(sequence.evaluations(0), 3u);
  EXPECT_EQ(sequence.evaluations(1), 6u);
}

TEST_F(Sequence, RunsInTheScenesOrderAndNeighboursInSubstepsByTurns) {
  const EffectCall calls[] = {call("a"), call("b", {{"speed", 0.5}}), call("c"), call("a")};
  EffectSequence sequence(calls, shape, 2, kRows);
  SceneState state(shape);
  std::vector<std::size_t> watched;
  sequence.advance(state, 7, [&](std::size_t effect) { watched.push_back(effect); });
  const std::vector<Call> expected = {{"a", 6.5, 0.5}, {"b", 6.5, 0.5}, {"a", 7, 0.5}, {"b", 7, 0.5},
                                      {"c", 7, 1},     {"a", 6.5, 0.5}, {"a", 7, 0.5}};
  EXPECT_EQ(stepped, expected);
  EXPECT_EQ(watched, (std::vector<std::size_t>{0, 1, 0, 1, 2, 3, 3, 4}));
}

TEST_F(Sequence, NamesSceneEffectAndParameterInItsRefusals) {
  EXPECT_EQ(refusal({call("z")}), "scene s, effect z: unknown effect; known are: a, b, c, d");
  EXPECT_EQ(refusal({call("a", {{"speed", 1.0}})}),
            "scene s, effect a: parameter speed is unknown; known are: none");
  EXPECT_EQ(refusal({call("b")}),
            "scene s, effect b: parameter speed is missing (speed); add it to the scene file");
  EXPECT_EQ(refusal({call("b", {{"speed", 1.0}})}), "");
}

TEST(Effects, HaveRowsOfDifferentNamesThatDescribeThemselves) {
  for (const EffectRow& row : effects()) {
    EXPECT_FALSE(row.description.empty());
    for (const EffectRow& other : effects())
      EXPECT_TRUE(&row == &other || row.name != other.name) << row.name;
    for (const ParameterRow& parameter : row.parameters) EXPECT_FALSE(parameter.meaning.empty()) << row.name;
  }
}

}  // namespace
}  // namespace cscd::scenes
