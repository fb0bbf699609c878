#include "bench/benchmark/benchmark.h"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <unistd.h>

#include "bench/benchmark/entry.h"
#include "bench/benchmark/judge.h"
#include "bench/output/schema.h"
#include "bench/strategies/catalogue.h"
#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/exact/static_contact.h"
#include "scenes/hard/disturbance.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
namespace hard = scenes::hard;
using nlohmann::ordered_json;

// The folder of a small benchmark without scenes, made once for all tests of this program.
class PublicBenchmark : public testing::Test {
 protected:
  static inline fs::path folder = fs::temp_directory_path() / ("cscd-benchmark-" + std::to_string(getpid()));
  fs::path copy = folder / "copy";

  static void make(const fs::path& where) {
    BenchmarkPlan plan;
    plan.folder = where;
    plan.small = 40;
    make_benchmark(plan, [](std::size_t, std::size_t) {});
  }
  static void SetUpTestSuite() {
    fs::remove_all(folder);
    make(folder / "made");
  }
  static void TearDownTestSuite() { fs::remove_all(folder); }
  void SetUp() override { fs::copy(folder / "made", copy); }
  void TearDown() override { fs::remove_all(copy); }

  static void expect_refused(const std::function<void()>& act, const std::string& reason) {
    EXPECT_NE(test::refusal(act).find(reason), std::string::npos);
  }

  // What a program that knows the truth would answer.
  static Answers perfect(const Benchmark& benchmark) {
    Answers answers;
    answers.program = "the truth";
    for (const IntervalTruth& truth : read_truth(benchmark)) {
      IntervalAnswers& one = answers.intervals.emplace_back();
      one.id = truth.id;
      one.contacts.emplace();
      for (const TrueContact& contact : truth.contacts)
        one.contacts->push_back({contact.pair, contact.time.hi});
      one.collides = truth.collides();
      one.starts_embedded = truth.starts_embedded();
      one.start_pairs = truth.start_pairs;
    }
    return answers;
  }
};

// The truth by another way: the oracle is asked about every feature pair, without culling and without a
// filter, and every two triangles are tested at the start.
IntervalTruth by_oracle(const TriangleMesh& mesh, const scenes::PosedMesh& posed) {
  const auto& [start, end] = posed.intervals.at(0);
  const Motion motion(start.positions, end.positions);
  IntervalTruth out;
  const auto add = [&](const FeaturePair& pair, const std::optional<exact::TimeEnclosure>& time) {
    if (time) out.contacts.push_back({PairName::of(mesh, pair), *time});
  };
  const auto vertices = static_cast<std::int32_t>(mesh.vertex_count()),
             triangles = static_cast<std::int32_t>(mesh.triangle_count()),
             edges = static_cast<std::int32_t>(mesh.edge_count());
  for (std::int32_t v = 0; v < vertices; ++v)
    for (std::int32_t t = 0; t < triangles; ++t) {
      const Triangle& corners = mesh.corners(TriangleId{t});
      if (std::ranges::find(corners, VertexId{v}) != corners.end()) continue;
      add(FeaturePair::of(VertexId{v}, TriangleId{t}),
          exact::first_contact(vertex_face(mesh, motion, VertexId{v}, TriangleId{t})));
    }
  for (std::int32_t a = 0; a < edges; ++a)
    for (std::int32_t b = a + 1; b < edges; ++b) {
      const Edge &p = mesh.ends(EdgeId{a}), &q = mesh.ends(EdgeId{b});
      if (p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1]) continue;
      add(FeaturePair::of(EdgeId{a}, EdgeId{b}),
          exact::first_contact(edge_edge(mesh, motion, EdgeId{a}, EdgeId{b})));
    }
  for (std::int32_t a = 0; a < triangles; ++a)
    for (std::int32_t b = a + 1; b < triangles; ++b)
      if (triangles_meet(mesh, start.positions, TriangleId{a}, TriangleId{b}))
        out.start_pairs.push_back({TriangleId{a}, TriangleId{b}});
  return out;
}

// Mutations: contacts are decided by the paper's test; crossings are those of the end. (Rows that promise the
// first contact alone are no mutation: on meshes as small as these they find all.)
TEST(Truth, IsWhatTheOracleSaysOfEveryPair) {
  std::size_t contacts = 0, crossing = 0;
  const auto compare = [&](const Subject& subject) {
    SCOPED_TRACE(subject.name);
    const TriangleMesh mesh(subject.mesh.triangles, subject.mesh.reference.positions.size());
    const IntervalTruth truth = find_truth(mesh, subject.mesh, 0);
    IntervalTruth expected = by_oracle(mesh, subject.mesh);
    std::vector<TrueContact> found = truth.contacts;
    const auto by_pair = [](const TrueContact& a, const TrueContact& b) { return a.pair < b.pair; };
    std::ranges::sort(found, by_pair);
    std::ranges::sort(expected.contacts, by_pair);
    ASSERT_EQ(found.size(), expected.contacts.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].pair, expected.contacts[i].pair);
      EXPECT_EQ(found[i].time.lo, expected.contacts[i].time.lo);
      EXPECT_EQ(found[i].time.hi, expected.contacts[i].time.hi);
    }
    EXPECT_EQ(truth.start_pairs, expected.start_pairs);
    contacts += found.size();
    crossing += !truth.starts_embedded();
  };
  for (const hard::Family& family : hard::families())
    for (const hard::Kind kind : {hard::Kind::vertex_face, hard::Kind::edge_edge})
      for (std::size_t number = 0; number < 2; ++number) compare(hard_subject(family, kind, number, 1));
  for (const ShapeFamily& family : shape_families())
    if (family.name == "tunnelling" || family.name == "folded") compare(shape_subject(family, 1, 1));
  std::size_t random = 0;
  for (std::uint64_t seed = 1; seed <= 200 && random < 12; ++seed)
    for (const Subject& subject : {random_subject(seed), torn_subject(seed)})
      if (subject.mesh.triangles.size() <= 120) compare(subject), ++random;
  EXPECT_GE(random, 12u) << "small enough to ask about every pair";
  EXPECT_GT(contacts, 100u);
  EXPECT_GT(crossing, 0u);
}

TEST(Subjects, AreClosedWhereTheySaySoAndDependOnTheirNumberAlone) {
  const auto closed = [](const Subject& subject) {
    return TriangleMesh(subject.mesh.triangles, subject.mesh.reference.positions.size())
        .closed_and_oriented();
  };
  for (const hard::Family& family : hard::families()) {
    const Subject one = hard_subject(family, hard::Kind::edge_edge, 5, 1),
                  again = hard_subject(family, hard::Kind::edge_edge, 5, 1),
                  other = hard_subject(family, hard::Kind::edge_edge, 6, 1);
    EXPECT_TRUE(closed(one)) << one.name;
    for (const Vec3& p : one.mesh.intervals[0].end.positions) EXPECT_TRUE(p.allFinite()) << one.name;
    EXPECT_EQ(one.mesh.intervals[0].end.positions, again.mesh.intervals[0].end.positions);
    EXPECT_NE(one.mesh.intervals[0].end.positions, other.mesh.intervals[0].end.positions);
    // The features of the query itself are there.
    const Query query = hard::suite_query(family, hard::Kind::edge_edge, 5, 1);
    EXPECT_EQ(one.mesh.intervals[0].start.positions[1], query.points[1].start);
    EXPECT_EQ(one.mesh.intervals[0].end.positions[4], query.points[2].end);
  }
  for (const ShapeFamily& family : shape_families())
    for (std::size_t number = 0; number < 8; ++number)
      EXPECT_EQ(closed(shape_subject(family, number, 1)), family.name != "folded") << family.name;
  EXPECT_TRUE(closed(random_subject(3)));
  EXPECT_FALSE(closed(torn_subject(3)));
}

TEST_F(PublicBenchmark, KeepsToItsSchemas) {
  EXPECT_EQ(schema_violation(ordered_json::parse(test::read(copy / kManifestName)), "benchmark.schema.json"),
            "");
  std::ifstream lines(copy / kTruthName);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count)
    EXPECT_EQ(schema_violation(ordered_json::parse(line), "benchmark_truth.schema.json"), "");
  const Benchmark made = read_benchmark(copy);
  EXPECT_EQ(count, made.intervals.size());
  EXPECT_EQ(count, 40u);
  std::set<std::string> sets;
  for (const ListedInterval& interval : made.intervals) sets.insert(made.family(interval.family).set);
  EXPECT_EQ(sets, (std::set<std::string>{"hard", "random", "shapes", "torn"}));
  ordered_json score = to_json(judge(made, perfect(made), "a"));
  EXPECT_EQ(schema_violation(score, "score.schema.json"), "");
}

// Mutation: with the times of creation that HDF5 keeps by default, the mesh files differ after a
// second.
TEST_F(PublicBenchmark, IsTheSameToTheByteWhenMadeAgain) {
  sleep(1);
  make(folder / "again");
  std::size_t files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "made")) {
    EXPECT_EQ(test::read(entry.path()), test::read(folder / "again" / entry.path().filename()))
        << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 7u);
  expect_refused([&] { make(folder / "again"); }, "exists");
  fs::remove_all(folder / "again");
}

// Mutation: without hold_to_sums() a mesh file with one other byte is judged by.
TEST_F(PublicBenchmark, IsRefusedWhereItIsDamaged) {
  const auto damage = [&](const char* name, const std::function<std::string(std::string)>& change,
                          const std::string& reason) {
    const std::string whole = test::read(copy / name);
    test::write(copy / name, change(whole));
    expect_refused([&] { read_benchmark(copy); }, reason);
    test::write(copy / name, whole);
    read_benchmark(copy);
  };
  const auto flipped = [](std::string bytes) {
    bytes[bytes.size() / 2] ^= 1;
    return bytes;
  };
  const auto shortened = [](const std::string& bytes) { return bytes.substr(0, bytes.size() / 2); };
  damage("random.h5", flipped,
         "random.h5: is not the file that the manifest lists (another SHA-256 checksum)");
  damage("random.h5", shortened, "random.h5: is not the file that the manifest lists");
  damage(kTruthName, flipped, "truth.jsonl: is not the file that the manifest lists");
  damage(kManifestName, flipped, "manifest.json: is not the one that SHA256SUMS lists");
  damage(kSumsName, shortened, "SHA256SUMS: lists other files than manifest.json");
  damage(
      kSumsName, [](const std::string&) { return ""; },
      "manifest.json: is not the one that SHA256SUMS lists");
  fs::remove(copy / "torn.h5");
  expect_refused([&] { read_benchmark(copy); }, "torn.h5: is missing from the benchmark");
  fs::remove(copy / kManifestName);
  expect_refused([&] { read_benchmark(copy); }, "has no manifest.json");
}

// Mutations: the answers lose a contact, invent one, and move a time; each is counted, and nothing
// else.
TEST_F(PublicBenchmark, JudgesWholeAnswers) {
  const Benchmark made = read_benchmark(copy);
  const Answers right = perfect(made);
  const Score clean = judge(made, right, "a").all();
  EXPECT_EQ(clean.intervals, 40u);
  EXPECT_EQ(clean.answered, 40u);
  EXPECT_GT(clean.expected, 100u);
  EXPECT_EQ(clean.timed, clean.expected);
  EXPECT_EQ(clean.starts_told, 40u);
  EXPECT_EQ(clean.collides_told, 40u);
  EXPECT_EQ(judge(made, right, "a").fault_count, 0u);

  const auto touching = std::ranges::find_if(
      right.intervals, [](const IntervalAnswers& one) { return one.contacts->size() > 3; });
  ASSERT_NE(touching, right.intervals.end());
  const auto at = static_cast<std::size_t>(touching - right.intervals.begin());
  const auto judged_with = [&](const std::function<void(IntervalAnswers&)>& change) {
    Answers changed = right;
    change(changed.intervals[at]);
    const Judgement judgement = judge(made, changed, "a");
    EXPECT_EQ(judgement.fault_count, 1u);
    EXPECT_EQ(judgement.faults.at(0).id, touching->id);
    return judgement.all();
  };
  const Score lost = judged_with([](IntervalAnswers& one) { one.contacts->pop_back(); });
  EXPECT_EQ(lost.misses, 1u);
  EXPECT_EQ(lost.broken, 1u);
  EXPECT_EQ(lost.kept + 1, lost.contacts);
  EXPECT_FALSE(is_short(clean.shortfall()));
  EXPECT_TRUE(is_short(lost.shortfall()));
  const Score late = judged_with([](IntervalAnswers& one) { one.contacts->front().time = 1; });
  EXPECT_EQ(late.late, 1u);
  const Score start = judged_with([](IntervalAnswers& one) { one.starts_embedded = !*one.starts_embedded; });
  EXPECT_EQ(start.starts_wrong, 1u);

  // An invented contact: the first pair of a vertex and a triangle that never touches.
  for_each_mesh(made, [&](const scenes::PosedMesh& mesh, std::span<const std::size_t> intervals) {
    if (made.intervals[intervals[0]].id != touching->id) return;
    const Triangle& corners = mesh.triangles[0];
    for (std::int32_t v = 0; v < 100; ++v) {
      const PairName pair = PairName::vertex_face(v, 0);
      if (std::ranges::find(corners, VertexId{v}) != corners.end() ||
          std::ranges::find(*touching->contacts, pair, &AnsweredContact::pair) != touching->contacts->end())
        continue;
      const Score invented = judged_with([&](IntervalAnswers& one) { one.contacts->push_back({pair, 0.5}); });
      EXPECT_EQ(invented.inventions, 1u);
      EXPECT_EQ(invented.broken, 0u);
      return;
    }
    FAIL() << "every vertex touches triangle 0";
  });

  Answers few = right;
  few.intervals.erase(few.intervals.begin());
  const Judgement partial = judge(made, few, "a");
  EXPECT_EQ(partial.unanswered, std::vector<std::string>{right.intervals[0].id});
  EXPECT_EQ(partial.all().intervals, 40u);
  EXPECT_EQ(partial.all().answered, 39u);
}

TEST_F(PublicBenchmark, RefusesAnswersAboutWhatItDoesNotHave) {
  const Benchmark made = read_benchmark(copy);
  const auto refused = [&](const std::function<void(Answers&)>& change, const std::string& reason) {
    Answers answers = perfect(made);
    change(answers);
    expect_refused([&] { judge(made, answers, "answers a.json"); }, reason);
  };
  const auto with_pair = [](const PairName& pair) {
    return [pair](Answers& answers) { answers.intervals[0].contacts = {{pair, 0.5}}; };
  };
  refused([](Answers& a) { a.intervals[0].id = "random-99999"; },
          "answers a.json: answers random-99999, which is no interval of this benchmark");
  refused([](Answers& a) { a.benchmark = std::string(64, '0'); }, "answer this one, or judge by that one");
  refused(with_pair(PairName::vertex_face(0, 1'000'000)),
          "answer to random-00001: vertex 0, triangle 1000000: the mesh has");
  refused(with_pair(PairName::edge_edge(0, 0, 1, 1)), "the mesh has no edge from 0 to 0");
  refused(
      [](Answers& a) {
        a.intervals[0].start_pairs = {{TriangleId{0}, TriangleId{1'000'000}}};
      },
      "no triangle 1000000");
  for_each_mesh(made, [&](const scenes::PosedMesh& mesh, std::span<const std::size_t> intervals) {
    if (intervals[0] != 0) return;
    const Triangle& t = mesh.triangles[0];
    const auto i = [&](std::size_t k) { return static_cast<std::int32_t>(t[k]); };
    refused(with_pair(PairName::vertex_face(i(0), 0)), "is a corner of the triangle");
    refused(with_pair(PairName::edge_edge(i(0), i(1), i(1), i(2))), "the edges share a vertex");
  });
}

// Rows of the project through the whole format: what is complete by an exact test has nothing to be blamed
// for, and what is not promised claims nothing.
TEST_F(PublicBenchmark, IsAnsweredByStrategies) {
  const Benchmark made = read_benchmark(copy);
  const auto scored = [&](const char* name, std::size_t answered) {
    const Entry entry = answer_benchmark(made, rows_called(std::vector<std::string>{name}).front(),
                                         elementary_test_named("filtered_exact"), 2, [](std::size_t) {});
    EXPECT_EQ(schema_violation(to_json(entry.answers), "answers.schema.json"), "") << name;
    std::size_t left_out = 0;
    for (const auto& [reason, count] : entry.left_out) left_out += count;
    EXPECT_EQ(entry.answers.intervals.size() + left_out, 40u) << name;
    EXPECT_EQ(entry.answers.intervals.size(), answered) << name;
    const Score score = judge(made, parse_answers(to_json(entry.answers).dump(), name), name).all();
    EXPECT_EQ(score.broken + score.inventions + score.late + score.early + score.starts_wrong, 0u) << name;
    EXPECT_EQ(score.start_pairs_missed + score.start_pairs_invented, 0u) << name;
    EXPECT_EQ(score.milliseconds.size(), answered) << name;
    return score;
  };
  std::size_t closed = 0, boned = 0;
  for (const ListedInterval& interval : made.intervals) {
    closed += interval.closed;
    boned += interval.closed && interval.bones > 0;
  }
  ASSERT_GT(boned, 10u);
  ASSERT_LT(closed, 40u);
  const Score base = scored("base", 40), complete = scored("drvbc_fast_complete", 40);
  EXPECT_EQ(base.misses + complete.misses, 0u);
  EXPECT_FALSE(is_short(base.shortfall()) || is_short(complete.shortfall()));
  EXPECT_EQ(base.expected, complete.expected);
  const Score first = scored("base --first", 40);
  EXPECT_EQ(first.misses, 0u);
  EXPECT_TRUE(is_short(first.shortfall())) << "whoever lists the earliest contacts alone has a mark";
  scored("drvbc_fast", closed);
  scored("drvbc", boned);
}

}  // namespace
}  // namespace cscd::bench
