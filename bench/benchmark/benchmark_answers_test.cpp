#include "bench/benchmark/benchmark_answers.h"

#include <gtest/gtest.h>

#include "bench/output/schema.h"
#include "core/base/test_refusal.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

constexpr char kSchema[] = "answers.schema.json";

// A document of one answer; `answer` is its text.
std::string document(const std::string& answer, const std::string& guarantee = "complete") {
  return R"({"schema": "cscd.answers/1", "program": "p", "guarantee": ")" + guarantee + R"(", "answers": [)" +
         answer + "]}";
}

void expect_refused(const std::string& text, const std::string& reason) {
  const std::string line = test::refusal([&] { parse_answers(text, "answers a.json"); });
  EXPECT_NE(line.find(reason), std::string::npos) << text << ": " << line;
  EXPECT_EQ(line.find("answers a.json"), 0u) << line;
}

TEST(BenchmarkAnswers, KeepToTheirSchemaAndComeBack) {
  const std::string text = document(
      R"({"id": "a", "contacts": [{"vf": [1, 2], "time": 0.5}, {"ee": [9, 8, 2, 1], "undecided": true}],
          "starts_embedded": false, "start_pairs": [[4, 3]], "milliseconds": 1.5},
         {"id": "b", "guarantee": "first_contact", "first_time": null},
         {"id": "c", "guarantee": "collides", "collides": true},
         {"id": "d", "guarantee": "none", "contacts": []})");
  EXPECT_EQ(schema_violation(ordered_json::parse(text), kSchema), "");
  const Answers answers = parse_answers(text, "a");
  ASSERT_EQ(answers.intervals.size(), 4u);
  const IntervalAnswers& first = answers.intervals[0];
  EXPECT_EQ(first.claim, Claim::complete);
  EXPECT_EQ((*first.contacts)[1].pair, PairName::edge_edge(1, 2, 8, 9));
  EXPECT_FALSE((*first.contacts)[1].time);
  EXPECT_EQ(first.start_pairs->front(), CrossingPair(TriangleId{3}, TriangleId{4}));
  ASSERT_TRUE(answers.intervals[1].first_time);
  EXPECT_FALSE(*answers.intervals[1].first_time);
  const ordered_json written = to_json(answers);
  EXPECT_EQ(schema_violation(written, kSchema), "");
  EXPECT_EQ(to_json(parse_answers(written.dump(), "again")), written);
}

TEST(BenchmarkAnswers, MayBeLines) {
  const Answers answers = parse_answers(
      "{\"schema\": \"cscd.answers/1\", \"program\": \"p\", \"guarantee\": \"collides\"}\n\n"
      "{\"id\": \"a\", \"collides\": true}\n{\"id\": \"b\", \"collides\": false}\n",
      "a");
  ASSERT_EQ(answers.intervals.size(), 2u);
  EXPECT_EQ(answers.intervals[1].collides, std::optional(false));
}

// Mutations: with the checks of times, of unknown keys, or of pairs that are there twice left out,
// the lines about them are taken.
TEST(BenchmarkAnswers, AreRefusedWithPlaceAndRemedy) {
  const struct {
    const char *answer, *reason;
  } kCases[] = {
      {R"({"id": "a", "contacts": [{"vf": [1, 2], "time": 1.5}]})",
       "answer 0 (a), contacts[0], time: is 1.5; give a time from 0 to 1"},
      {R"({"id": "a", "contacts": [{"vf": [1, 2], "time": -0.1}]})", "give a time from 0 to 1"},
      {R"({"id": "a", "contacts": [{"vf": [1, 2], "time": null}]})", "is null; give a time from 0 to 1"},
      {R"({"id": "a", "contacts": [{"vf": [1, 2], "time": "0.5"}]})", "is \"0.5\"; give a time"},
      {R"({"id": "a", "contacts": [{"vf": [1, 2]}]})", "has no 'time'"},
      {R"({"id": "a", "contacts": [{"vf": [1, 2], "time": 0.5, "undecided": true}]})",
       "leave out one of the two"},
      {R"({"id": "a", "contacts": [{"vf": [1, 2, 3], "time": 0.5}]})",
       "has 3 numbers; give a vertex and a triangle"},
      {R"({"id": "a", "contacts": [{"ee": [1, 2, 3], "time": 0.5}]})", "the two ends of one edge"},
      {R"({"id": "a", "contacts": [{"vf": [1.5, 2], "time": 0.5}]})",
       "vf[0]: is 1.5; give the number of a vertex"},
      {R"({"id": "a", "contacts": [{"vf": [-1, 2], "time": 0.5}]})", "is -1"},
      {R"({"id": "a", "contacts": [{"vf": [9999999999, 2], "time": 0.5}]})", "is 9999999999"},
      {R"({"id": "a", "contacts": [{"time": 0.5}]})", "names no pair"},
      {R"({"id": "a", "contacts": [{"ee": [1, 2, 3, 4], "time": 0.5}, {"ee": [4, 3, 2, 1], "time": 0.6}]})",
       "contacts[1]: names edges 1-2 and 3-4 for the second time"},
      {R"({"id": "a", "contact": []})", "unknown key 'contact'; did you mean contacts?"},
      {R"({"id": "a"})", "has no 'contacts'"},
      {R"({"id": "a", "guarantee": "first_contact"})", "neither 'contacts' nor 'first_time'"},
      {R"({"id": "a", "guarantee": "collides"})", "does not say whether"},
      {R"({"id": "a", "guarantee": "complet", "contacts": []})", "did you mean complete?"},
      {R"({"id": "a", "contacts": {}})", "is {}; give a list"},
      {R"({"id": "a", "contacts": [], "milliseconds": -1})", "milliseconds: is -1"},
      {R"({"id": "a", "contacts": [], "start_pairs": [[3, 3]]})", "names triangle 3 twice"},
      {R"({"id": "a", "contacts": [], "start_pairs": [[3, 4], [4, 3]]})", "start_pairs[1]: names these two"},
      {R"({"id": "a", "contacts": [], "starts_embedded": 1})", "starts_embedded: is 1; give true or false"},
      {R"({"id": "a", "contacts": []}, {"id": "a", "contacts": []})",
       "answer 1 (a): answers this interval for the second time"},
      {R"({"id": 7, "contacts": []})", "answer 0, id: is 7; give a text"},
      {R"({"contacts": []})", "answer 0: has no 'id'"},
      {"5", "answer 0: is 5; give an object"},
  };
  for (const auto& one : kCases) {
    SCOPED_TRACE(one.answer);
    expect_refused(document(one.answer), one.reason);
  }
}

TEST(BenchmarkAnswers, AreNoJsonWithNumbersThatJsonDoesNotHave) {
  expect_refused(document("\n{\"id\": \"a\", \"contacts\": [{\"vf\": [1, 2], \"time\": NaN}]}"),
                 "line 2: is no JSON, which has no NaN");
  expect_refused(document(R"({"id": "a", "contacts": [{"vf": [1, 2], "time": Infinity}]})"),
                 "has no Infinity");
  expect_refused(document(R"({"id": "a", "contacts": [{"vf": [1, 2], "time": 1e999}]})"), "neither a JSON");
  expect_refused("", "neither a JSON document nor JSON lines");
  expect_refused("{\"schema\": ", "neither a JSON document nor JSON lines");
}

TEST(BenchmarkAnswers, NeedTheirHead) {
  expect_refused("[]", "is []; give an object");
  expect_refused("{}", "has no 'schema'");
  expect_refused(R"({"schema": "cscd.answers/2"})", "schema: is 'cscd.answers/2'; give cscd.answers/1");
  expect_refused(R"({"schema": "cscd.answers/1"})", "has no 'program'");
  expect_refused(R"({"schema": "cscd.answers/1", "program": ""})", "program: is empty");
  expect_refused(R"({"schema": "cscd.answers/1", "program": "p"})", "has no 'answers'");
  expect_refused(R"({"schema": "cscd.answers/1", "program": "p", "answers": {}})",
                 "answers: is {}; give a list");
  expect_refused(R"({"schema": "cscd.answers/1", "program": "p", "answers": [{"id": "a"}]})",
                 "has no 'guarantee', and the head has none either");
}

}  // namespace
}  // namespace cscd::bench
