#include "scenes/character/report.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "scenes/character/options.h"

namespace cscd::scenes {
namespace {

ImportReport some_report() {
  ImportReport report;
  report.format = "FBX";
  report.up = "-z";
  report.centimetres_per_unit = 2.54;
  report.vertices = 12345678901;
  report.chosen_clip = 1;
  report.fps = 1.0 / 3;
  report.fps_from = "asked";
  report.weld_spread = 1e-17;
  report.clips = {{"walk", 0.5, 1.5, 24, 46, 3, 12}, {"", 0, 0, 0, 1, 0}};
  report.parts = {{"body", "Body node", 3, 1}, {"", "eye", -1, -1}};
  report.bones = {"hip", "\xe6\x89\x8b", "hip"};
  report.chosen_components = {0, 7};
  report.component_bones = {3, 0, 12};
  report.notes = {"2 things ignored"};
  return report;
}

TEST(ImportReport, SurvivesItsText) {
  EXPECT_EQ(parse_report(to_text(some_report())), some_report());
  EXPECT_EQ(parse_report(to_text(ImportReport{})), ImportReport{});
}

TEST(ImportReport, NamesFromFilesCannotForgeLinesOrTerminals) {
  ImportReport report;
  report.clips = {{"a\nnote\tforged\x1b[31m\xff\xfe", 0, 1, 1, 1, 1}};
  const ImportReport back = parse_report(to_text(report));
  EXPECT_TRUE(back.notes.empty());
  EXPECT_EQ(back.clips[0].name, "a?note?forged?[31m?");
}

TEST(ImportReport, NamesOfAnyLanguageStayAndAreCutBetweenCharacters) {
  const std::string hand = "\xe6\x89\x8b", knee = "K\xc3\xa9o", face = "\xf0\x9f\x99\x82";
  EXPECT_EQ(printable(hand + knee + face), hand + knee + face);
  EXPECT_EQ(printable(hand + hand, 5), hand);
  EXPECT_EQ(printable("a\xc3"), "a?") << "cut short";
  EXPECT_EQ(printable("a\xc0\xaf"
                      "b"),
            "a?b")
      << "not the shortest form";
  EXPECT_EQ(printable("a\xed\xa0\x80"
                      "b"),
            "a?b")
      << "half of a pair";
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b"),
            "a?b")
      << "turns the direction of writing";
  EXPECT_EQ(printable("a\xc2\x9b"
                      "b"),
            "a?b")
      << "controls terminals";
}

TEST(ImportReport, RefusesWhatIsNotWhole) {
  const std::string whole = to_text(some_report());
  EXPECT_THROW(parse_report(""), InputError);
  EXPECT_THROW(parse_report("other\n"), InputError);
  EXPECT_THROW(parse_report(whole.substr(0, whole.size() - 1)), InputError);
  EXPECT_THROW(parse_report(whole + "clip\tonly\n"), InputError);
  EXPECT_THROW(parse_report(whole + "fps\tfast\n"), InputError);
  EXPECT_THROW(parse_report(whole + "fps\tnan\n"), InputError);
  EXPECT_THROW(parse_report(whole + "nodes\t-1\n"), InputError);
  EXPECT_THROW(parse_report(whole + "unheard\t1\n"), InputError);
}

TEST(ImportOptions, SurviveTheCommandLine) {
  ImportOptions options;
  EXPECT_EQ(parse_arguments(to_arguments(options)), options);
  options = {"a clip", 7, 23.976, true, "largest", 12, true, 0.1 / 3e4, true, true, "motion"};
  EXPECT_EQ(parse_arguments(to_arguments(options)), options);
}

TEST(ImportOptions, AreChecked) {
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{{"--fps", "0"},
                                                                                     {"--fps", "nan"},
                                                                                     {"--fps", "x"},
                                                                                     {"--fps"},
                                                                                     {"--weld", "-1"},
                                                                                     {"--weld", "0.5"},
                                                                                     {"--fill-holes", "-3"},
                                                                                     {"--unheard"}})
    EXPECT_THROW(parse_arguments(wrong), InputError) << wrong.front();
}

}  // namespace
}  // namespace cscd::scenes
