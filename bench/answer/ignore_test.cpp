#include "bench/inputs/ignore.h"

#include <gtest/gtest.h>
#include <random>
#include <set>

#include "bench/answer/answer.h"
#include "bench/answer/test_figure.h"
#include "bench/inputs/surface_names.h"
#include "bench/inputs/test_inputs.h"
#include "bench/strategies/catalogue.h"
#include "core/base/test_refusal.h"
#include "core/detect/start/crossings.h"
#include "core/detect/start/embedding.h"
#include "core/detect/start/rest_crossings.h"

// Answers that ignore something, held against all contacts of the reference without what is ignored.
namespace cscd::bench {
namespace {

constexpr std::size_t kAllCrossings = 1'000'000;

const ElementaryTest& filtered() {
  return elementary_test_named("filtered_exact");
}

IgnoreRequest named(std::vector<std::string> pairs) {
  return {std::move(pairs), std::nullopt};
}

std::string refusal(Input& input, const IgnoreRequest& request) {
  return test::refusal([&] { ignore(input, request); });
}

// Which pairs of triangles are ignored, found out triangle by triangle from names and parents.
class Oracle {
 public:
  Oracle(const Input& input, const IgnoreRequest& request)
      : input_(input), names_(input), request_(request), parent_(input.clip->header().bone_parent) {}

  bool ignores(const CrossingPair& pair) const {
    if (request_.neighbours) {
      const std::int32_t a = names_.bone_of(pair.first), b = names_.bone_of(pair.second);
      if (a >= 0 && b >= 0 && joints_between(a, b) <= *request_.neighbours) return true;
    }
    for (const std::string& text : request_.pairs)
      for (const bool turned : {false, true}) {
        const std::size_t colon = text.find(':');
        const std::string one = text.substr(0, colon), other = text.substr(colon + 1);
        if (is(turned ? pair.second : pair.first, one) && is(turned ? pair.first : pair.second, other))
          return true;
      }
    return false;
  }
  bool ignores(const FeaturePair& pair) const {
    return std::ranges::all_of(carriers(input_.mesh, pair),
                               [&](const CrossingPair& carrier) { return ignores(carrier); });
  }

 private:
  bool is(TriangleId triangle, const std::string& name) const {
    return name == "*" || names_.place_of(triangle) == name || names_.part_of(triangle) == name;
  }
  // Up from both bones to the lowest one that is above both.
  int joints_between(std::int32_t a, std::int32_t b) const {
    std::vector<std::int32_t> above;
    for (std::int32_t bone = a; bone >= 0; bone = up(bone)) above.push_back(bone);
    int steps = 0;
    for (std::int32_t bone = b; bone >= 0; bone = up(bone), ++steps)
      if (const auto met = std::ranges::find(above, bone); met != above.end())
        return steps + static_cast<int>(met - above.begin());
    return 1000;  // in different trees
  }
  std::int32_t up(std::int32_t bone) const {
    return static_cast<std::int32_t>(parent_[static_cast<std::size_t>(bone)]);
  }

  const Input& input_;
  SurfaceNames names_;
  IgnoreRequest request_;
  std::vector<BoneId> parent_;
};

struct Seen {
  std::size_t ignored = 0, kept = 0, crossing = 0, later = 0;
};

void expect_right(Input& input, const IgnoreRequest& request, const Strategy& strategy,
                  const AnswerOptions& options, Seen& seen) {
  input.ignored = nullptr;
  ignore(input, request);
  const Oracle oracle(input, request);
  const SurfaceNames names(input);
  Answerer answerer(input, strategy, filtered(), options);
  const std::unique_ptr<Detector> reference = complete_reference().make(input.setup(filtered())).detector;
  EmbeddingTest looked(input.mesh, input.reference);
  RestCrossings rest;
  if (!options.keep_rest_crossings)
    rest = {
        input.mesh,
        tell_meetings_apart(input.mesh, input.rest(), looked.find_all(input.rest(), kAllCrossings)).crossing};
  for (std::size_t i = 0; i < input.clip->interval_count(); ++i) {
    const IntervalAnswer answer = answerer.answer(i, input.clip->load(i));
    const scenes::ClipInterval interval = input.clip->load(i);
    Crossings start = looked.find_all(interval.motion.start(), kAllCrossings);
    EXPECT_EQ(answer.starts_embedded, start.total == 0) << i;
    rest.follow(start);
    const std::size_t ignored_pairs =
        std::erase_if(start.pairs, [&](const CrossingPair& pair) { return oracle.ignores(pair); });
    EXPECT_EQ(answer.ignored_pairs.size(), ignored_pairs) << i;
    std::erase_if(start.pairs, [&](const CrossingPair& pair) { return rest.explains(pair); });
    const Meetings met = tell_meetings_apart(input.mesh, interval.motion.start(), start);
    ASSERT_EQ(answer.start.pairs, met.crossing.pairs) << i;
    ASSERT_EQ(answer.start_touching.pairs, met.touching.pairs) << i;

    ContactSet all, ignored, kept;
    reference->detect({interval.motion, interval.bones ? &*interval.bones : nullptr}, all);
    for (const Contact& contact : all.contacts) {
      const bool out = oracle.ignores(contact.pair);
      if (out) ignored.contacts.push_back(contact);
      if (!out && !rest.explains(contact.pair)) kept.contacts.push_back(contact);
    }
    all.sort(), ignored.sort(), kept.sort();
    seen.later += !kept.contacts.empty() && kept.contacts.front().time > all.contacts.front().time;
    if (options.first) keep_first(kept);
    ASSERT_EQ(digest(answer.found), digest(kept)) << i;
    ASSERT_EQ(digest(answer.ignored), digest(ignored)) << i;
    EXPECT_TRUE(answer.proven) << i;
    // No pair of names that is ignored is told.
    for (const Contact& contact : answer.found.contacts)
      EXPECT_FALSE(oracle.ignores(
          std::minmax(names.triangle_of(contact.pair, false), names.triangle_of(contact.pair, true))))
          << i;
    seen.ignored += ignored.contacts.size();
    seen.kept += kept.contacts.size();
    seen.crossing += ignored_pairs;
  }
}

// Two names of places of the surface, or one and all.
std::string random_pair(const Input& input, std::mt19937_64& random) {
  const SurfaceNames names(input);
  const auto any = [&] {
    const TriangleId t{static_cast<std::int32_t>(random() % input.mesh.triangle_count())};
    return random() % 4 == 0 ? names.part_of(t) : names.place_of(t);
  };
  const std::string first = any();
  return first + ":" + (random() % 8 == 0 ? "*" : any());
}

class Ignoring : public testing::TestWithParam<const char*> {};

// Mutations: a row that promises the first contact is not asked again where that is an ignored one; a contact
// is ignored because one of the pairs of triangles that carry it is; only the first contacts are asked for.
TEST_P(Ignoring, LeavesAllOtherContactsOfRandomCharacters) {
  const std::string name = GetParam();
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    Input input = random_input(seed, seed % 3 == 0);
    const Strategy& strategy =
        allows(input, strategy_named(name)) ? strategy_named(name) : default_strategy(input, true);
    IgnoreRequest request;
    if (input.rig && seed % 2 == 0) request.neighbours = static_cast<int>(random() % 2);
    if (seed % 4 != 2 || !request.neighbours) request.pairs.push_back(random_pair(input, random));
    if (seed % 5 == 0) request.pairs.push_back(random_pair(input, random));
    const bool keep = seed % 3 != 0 || seed % 2 == 0;
    expect_right(input, request, strategy, {.first = seed % 7 < 3, .keep_rest_crossings = keep}, seen);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(seen.ignored, 500u);
  EXPECT_GT(seen.kept, 300u);
  EXPECT_GT(seen.crossing, 100u);
  EXPECT_GT(seen.later, 5u) << "the first contact is never an ignored one";
}

// A clip whose steps follow one another: what is ignored in one crosses in the next.
TEST_P(Ignoring, LeavesAllOtherContactsOfAClip) {
  const Scratch scratch;
  Seen seen;
  for (const char* clip : {"0", "1"})
    for (const int joints : {1, 4}) {
      Input input = figure_for(strategy_named(GetParam()), clip, scratch);
      const IgnoreRequest request{{}, joints};
      for (const bool first : {false, true})
        expect_right(input, request, strategy_named(GetParam()), {.first = first}, seen);
    }
  EXPECT_GT(seen.ignored, 0u);
  EXPECT_GT(seen.kept, 0u);
}

INSTANTIATE_TEST_SUITE_P(Strategies, Ignoring,
                         testing::Values("base", "drvbc", "drvbc_fast", "drvbc_fast_all",
                                         "drvbc_fast_complete"),
                         [](const auto& name) { return std::string(name.param); });

// The walking figure, whose names are those of the file.
class IgnoredNames : public testing::Test {
 protected:
  Scratch scratch;
  Input figure(const std::string& prefix) {
    scenes::Character made = scenes::walking_figure();
    for (scenes::Node& node : made.nodes) node.name = prefix + node.name;
    write(scratch.path / "named.glb", scenes::to_glb(made));
    return open_input(scratch / "named.glb");
  }
  static std::pair<std::string, std::string> two_bones(const Input& input) {
    const SurfaceNames names(input);
    std::set<std::string> bones;
    for (std::size_t t = 0; t < input.mesh.triangle_count(); ++t)
      bones.insert(names.place_of(TriangleId{static_cast<std::int32_t>(t)}));
    return {*bones.begin(), *bones.rbegin()};
  }
};

TEST_F(IgnoredNames, MayHoldColons) {
  for (const char* prefix : {"", "rig:", "a:b:"}) {
    Input input = figure(prefix);
    const auto [first, second] = two_bones(input);
    EXPECT_EQ(refusal(input, named({first + ":" + second, first + ":*", "*:" + second})), "");
    ASSERT_TRUE(input.ignored);
    EXPECT_EQ(input.ignored->names[0], std::pair(first, second));
    EXPECT_EQ(input.ignored->names[2], std::pair(std::string("*"), second));
  }
}

TEST_F(IgnoredNames, MayStandForSeveral) {
  Input input = figure("");
  const auto [first, second] = two_bones(input);
  ignore(input, named({first + ":" + second.substr(0, second.size() - 1) + "*"}));
  const SurfaceNames names(input);
  std::size_t both = 0;
  for (std::size_t s = 0; s < input.mesh.triangle_count(); ++s)
    for (std::size_t t = s + 1; t < input.mesh.triangle_count(); t += 7) {
      const TriangleId a{static_cast<std::int32_t>(s)}, b{static_cast<std::int32_t>(t)};
      if (!input.ignored->triangles.excludes(input.mesh, TrianglePair{a, b})) continue;
      EXPECT_TRUE(names.place_of(a) == first || names.place_of(b) == first);
      ++both;
    }
  EXPECT_GT(both, 0u);
}

TEST_F(IgnoredNames, AreRefusedWhereTheInputHasNoneOfThem) {
  Input input = figure("rig:");
  const auto [first, second] = two_bones(input);
  std::string wrong = second;
  std::swap(wrong[wrong.size() - 1], wrong[wrong.size() - 2]);
  for (const std::string& text : {first + ":" + wrong, wrong + ":" + first}) {
    const std::string said = refusal(input, named({text}));
    EXPECT_NE(said.find("no bone, part or mesh is called '" + wrong + "'; did you mean " + second + "?"),
              std::string::npos)
        << said;
  }
  EXPECT_NE(refusal(input, named({"xyz:*"})).find("'xyz'; there are "), std::string::npos);
  EXPECT_NE(refusal(input, named({"knee"})).find("has no colon; write A:B"), std::string::npos);
  EXPECT_FALSE(input.ignored);
}

TEST(IgnoredNeighbours, NeedBones) {
  const test::Shape shape = test::octahedron();
  Input input = input_of(shape, {shape.positions, shape.positions});
  EXPECT_NE(
      refusal(input, {.pairs = {}, .neighbours = 1}).find("has no bones; name its parts with --ignore A:B"),
      std::string::npos);
  EXPECT_EQ(refusal(input, named({"the surface:the surface"})), "");
}

}  // namespace
}  // namespace cscd::bench
