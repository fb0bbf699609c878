#include <gtest/gtest.h>

#include "bench/testing/test_generated.h"
#include "bench/testing/test_shell.h"

// Whoever made a model file chose its strings: names of bones, parts, materials and clips, and the file's own
// name. They must not control the terminal of whoever reads them, forge lines, or decide where files go.
namespace cscd::bench {
namespace {

// Sets a terminal's title, clears its screen, goes back to the line's start, begins a line that looks like
// the program's, and turns the direction of writing.
constexpr char kControl[] = "\x1b]0;x\a\x1b[2J\rcscd: done\ncscd: \xe2\x80\xae\xc2\x9b";

// The first byte or character of a text that does more than show itself, or an empty text.
std::string first_that_controls(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f) return "byte " + std::to_string(byte);
  }
  for (const char* character : {"\xe2\x80\xae", "\xc2\x9b"})
    if (text.find(character) != std::string::npos) return character;
  return {};
}

class ForeignStrings : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    scenes::Character figure = scenes::walking_figure();
    for (scenes::Node& node : figure.nodes) node.name = "../../" + node.name + kControl;
    for (scenes::Part& part : figure.parts) part.name = "/" + part.name + kControl;
    for (scenes::Animation& clip : figure.animations) clip.name = "../" + clip.name + kControl;
    put("figure.glb", scenes::to_glb(figure));
  }
};

TEST_F(ForeignStrings, DoNotControlATerminal) {
  for (const std::string command :
       {"query figure.glb --clip 1", "query figure.glb --clip all", "query figure.glb --clip none",
        "query figure.glb --clip all --strategy drvbc --component largest", "inspect figure.glb",
        "clusters figure.glb --component largest --json clusters.json",
        "run --smoke --input figure.glb --strategy base,mcd --json run.json", "tables run.json"}) {
    const Ran ran = run("cscd " + command);
    EXPECT_EQ(ran.status, command.ends_with("none") ? 2 : 0) << command << ran.errors;
    for (const std::string& text : {ran.out, ran.errors}) {
      EXPECT_EQ(first_that_controls(text), "") << command << ": " << text;
      EXPECT_EQ(text.find("\ncscd: done"), std::string::npos) << command << ": " << text;
    }
  }
}

TEST_F(ForeignStrings, InJsonAreEscaped) {
  const Ran ran = run("cscd query figure.glb --json - | cat; exit ${PIPESTATUS[0]}");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(first_that_controls(ran.out), "");
}

TEST_F(ForeignStrings, OfFileNamesAreRefusedWhereTheyControlATerminal) {
  for (const std::string bytes : {"\\033]0;x\\a", "\\r\\n", "\\177", "\\302\\233", "\\342\\200\\256"})
    for (const std::string command : {"query", "inspect", "query small --json"}) {
      const Ran ran = run("name=$(printf 'a" + bytes + "b.glb'); cp figure.glb \"$name\"; cscd " + command +
                          " \"$name\"; s=$?; rm \"$name\"; exit $s");
      expect_refused(ran, "holds a character that controls a terminal or the direction of writing");
      EXPECT_EQ(first_that_controls(ran.out + ran.errors), "");
    }
  // Names of any language stay, such as a Persian one with a character of no width.
  EXPECT_EQ(run("cp figure.glb $'\\u0645\\u06cc\\u200c\\u062e.glb'; cscd inspect "
                "$'\\u0645\\u06cc\\u200c\\u062e.glb'")
                .status,
            0);
}

TEST_F(ForeignStrings, DecideNoFileName) {
  const Ran ran =
      run("mkdir out; cd out; for kind in h5 obj pvd usda; do cscd export ../figure.glb figure.$kind || "
          "exit; done\n"
          "cscd view ../figure.glb || exit; cscd run --smoke --input ../figure.glb --strategy base --json "
          "figure.json");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(files(), "figure.glb out");
  const std::string names = run("ls -RA out").out;
  EXPECT_EQ(first_that_controls(names), "") << names;
  EXPECT_EQ(run("ls -A out | grep -v ^figure").out, "");
}

}  // namespace
}  // namespace cscd::bench
