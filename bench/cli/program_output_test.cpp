#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "bench/testing/test_generated.h"
#include "bench/testing/test_shell.h"

// These tests follow the program's outputs to files, pipes and devices, through errors and signals.
namespace cscd::bench {

namespace {

using nlohmann::json;

class ProgramOutput : public Program {
 protected:
  // A scene that takes minutes to generate.
  void put_long_scene(const std::string& name) const {
    std::string text = scenes::kSmallScene;
    text.replace(text.find("\"frames\": 6"), 11, "\"frames\": 9000000");
    put("scenes/" + name + ".json", text);
  }
};

TEST_F(ProgramOutput, TakesStandardOutputForTheAnswerAlone) {
  for (const std::string name : {"-", "/dev/stdout"})
    for (const std::string command :
         {"query small", "inspect small", "clusters small", "run --smoke --strategy base --scene small"}) {
      const Ran ran = run("cscd " + command + " --json " + name + " | cat; exit ${PIPESTATUS[0]}");
      EXPECT_EQ(ran.status, 0) << ran.errors;
      EXPECT_TRUE(json::accept(ran.out)) << command << ": " << ran.out.substr(0, 200);
      EXPECT_EQ(ran.errors.empty(), command.find("clusters") != std::string::npos) << command;
    }
  EXPECT_EQ(files(), "");
}

TEST_F(ProgramOutput, EndsQuietlyWhereNobodyReads) {
  const Ran listed = run("cscd list | true; exit ${PIPESTATUS[0]}");
  EXPECT_EQ(listed.status, 141);
  EXPECT_EQ(listed.errors, "");
  const Ran answered =
      run("{ sleep 0.2; cscd query small --json - 2>/dev/null; echo $? >status; } | true; cat status");
  EXPECT_EQ(answered.out, "141\n");
  EXPECT_EQ(answered.errors, "");
}

TEST_F(ProgramOutput, IsNoSuccessWhereStandardOutputIsClosedOrFull) {
  expect_refused(run("cscd list >&-"), "standard output: cannot be written");
  expect_refused(run("cscd list >/dev/full"), "standard output: cannot be written");
  expect_refused(run("cscd --version >/dev/full"), "standard output: cannot be written");
  EXPECT_EQ(run("cscd query small --json - >/dev/full").status, 2);
  EXPECT_EQ(run("cscd query small --json - >&-").status, 2);
  // The descriptor that is free must not become the output's, or the output holds what is printed.
  EXPECT_EQ(run("cscd query small --json out.json >&-").status, 2);
  EXPECT_TRUE(json::accept(text("out.json"))) << text("out.json");
  EXPECT_EQ(run("cscd query small --json all.json <&- >&- 2>&-").status, 2);
  EXPECT_TRUE(json::accept(text("all.json"))) << text("all.json");
}

// What commands that read or write numbers as text say and write, without what a clock measured. Frames of
// the figure lie beside the folder out.
constexpr char kManyNumbers[] = R"sh(rm -rf out; mkdir -p out/hard; cd out
answer() { cscd query "$@" >text 2>&1; grep -v -e '  took ' -e ': [0-9]* of [0-9]*' text; rm text; }
answer small
answer ../figure.glb --clip walk --fps 12.5 --frames 0:3 --interval-seconds 99.5
cscd inspect ../figure.glb --json inspect.json
for kind in obj ply usda pvd; do cscd export ../figure.glb figure.$kind --fps 12.5 >/dev/null; done
answer figure.0000.obj --frames 0:1
cscd run --scene small --strategy base,drvbc --counts --json counts.json
cscd tables counts.json
cscd hardcases --out hard --queries 5
cscd elementary hard/needles-vf.csv --kind vf --elementary exact | sed 's/ *[0-9]*$//'
find . -type f | sort | while read -r name; do echo "== $name"; cat "$name"; done)sh";

TEST_F(ProgramOutput, IsTheSameWhereADecimalHasAComma) {
  // glibc leaks the folder of its locales, and LeakSanitizer would say so.
  const std::string comma = "export LOCPATH=$PWD/locales LC_ALL=de_DE.UTF-8 ASAN_OPTIONS=detect_leaks=0\n";
  if (run("mkdir locales && localedef -i de_DE -f UTF-8 locales/de_DE.UTF-8 || exit\n" + comma +
          "[ \"$(bash -c 'printf %.1f 1,5')\" = 1,5 ]")
          .status != 0)
    GTEST_SKIP() << "has no locale with a decimal comma";
  put("figure.glb", scenes::to_glb(scenes::walking_figure()));
  const Ran with_point = run(std::string("export LC_ALL=C\n") + kManyNumbers),
            with_comma = run(comma + kManyNumbers);
  EXPECT_EQ(with_point.errors, "");
  for (const char* name : {"== ./figure.0000.obj", "== ./figure.usda", "== ./figure.0000.vtp",
                           "== ./counts.json", "== ./inspect.json", "== ./hard/needles-vf.csv",
                           " 30 frames a second, because the file does not say"})
    EXPECT_NE(with_point.out.find(name), std::string::npos) << name;
  EXPECT_TRUE(with_point.out == with_comma.out) << "a decimal comma changes what is written";
}

TEST_F(ProgramOutput, NeedsNoTerminalAndNoEnvironment) {
  const std::string query = "cscd query small >here.txt 2>&1; grep -v '  took ' here.txt";
  const Ran
      usual = run(query),
      alone = run(
          "program=$(command -v cscd)\n"
          "env -i CSCD_SCENES=\"$CSCD_SCENES\" CSCD_CACHE=\"$CSCD_CACHE\" setsid -w \"$program\" query small "
          "<&- >there.txt 2>&1; grep -v '  took ' there.txt");
  EXPECT_NE(usual.out.find("does not touch itself"), std::string::npos) << usual.out;
  EXPECT_EQ(usual.out, alone.out);
}

TEST_F(ProgramOutput, WritesToDevicesAndPipesAndLeavesThem) {
  for (const std::string force : {"", " --force"}) {
    expect_refused(run("cscd query small --json /dev/full" + force), "No space left on device");
    EXPECT_EQ(run("cscd query small --json /dev/null" + force).status, 0);
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    const Ran piped = run("rm -f pipe; mkfifo pipe; cat pipe >got.json & cscd query small --json pipe" +
                          force + "; echo $?; wait");
    EXPECT_EQ(piped.out.substr(piped.out.size() - 2), "0\n");
    EXPECT_TRUE(json::accept(text("got.json")));
    EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  }
  const std::string device = folder / "device";
  if (mknod(device.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0) GTEST_SKIP() << "may not make a device";
  for (const std::string name : {"device", "link"})
    for (const std::string force : {"", " --force"}) {
      EXPECT_EQ(run("ln -sf device link; cscd query small --json " + name + force).status, 0);
      EXPECT_TRUE(fs::is_character_file(device) && fs::is_symlink(folder / "link"));
      expect_refused(run("cscd export small " + name + force), "has no extension");
      expect_refused(run("ln -sf device d.h5; cscd export small d.h5" + force), "is a device");
    }
}

TEST_F(ProgramOutput, FollowsLinks) {
  ASSERT_EQ(
      run("echo old >real.json; ln -s real.json link.json; ln -s new.json dangling.json; ln -s new.h5 d.h5")
          .status,
      0);
  expect_refused(run("cscd query small --json link.json"), "exists");
  EXPECT_EQ(text("real.json"), "old\n");
  EXPECT_EQ(run("cscd query small --json link.json --force && cscd query small --json dangling.json && "
                "cscd export small d.h5")
                .status,
            0);
  EXPECT_TRUE(json::accept(text("real.json")) && json::accept(text("new.json")));
  for (const char* name : {"link.json", "dangling.json", "d.h5"}) EXPECT_TRUE(fs::is_symlink(folder / name));
  EXPECT_TRUE(fs::is_regular_file(folder / "new.h5") && !fs::is_symlink(folder / "new.h5"));
}

TEST_F(ProgramOutput, HasTheFormatThatItsExtensionNames) {
  expect_refused(run("cscd export small small.stl"), ".stl is not written here; let its name end in .h5");
  expect_refused(run("cscd export small small"), "has no extension");
  expect_refused(run("cscd query small --json out.obj"),
                 ".obj is not written here; let its name end in .json");
  EXPECT_EQ(run("cscd export small A.H5 && cscd export small b.hdf5 && cscd query small --json plain && "
                "cscd query small --json c.JSON && rm A.H5 b.hdf5 plain c.JSON")
                .status,
            0);
  EXPECT_EQ(files(), "");
}

TEST_F(ProgramOutput, IsRefusedBeforeTheWorkAndLeavesNothing) {
  put_long_scene("long");
  for (const std::string command :
       {"query long --json ", "run --scene long --json ", "inspect long --json "}) {
    expect_refused(run("cscd " + command + "."), "is a folder");
    expect_refused(run("cscd " + command + "no/such.json"), "cannot be created");
    expect_refused(run("touch here.json; cscd " + command + "here.json"), "exists");
  }
  expect_refused(run("cscd export long no/such.h5"), "cannot be created");
  expect_refused(run("touch here.h5; cscd export long here.h5"), "exists");
  expect_refused(run("cscd run --scene all --json -"), "several records");
  expect_refused(run("cscd run --scene small --input few --json x.json"), "both small and few are given");
  EXPECT_EQ(files(), "here.h5 here.json");
}

TEST_F(ProgramOutput, SaysThatADiskIsFullAndLeavesNothingThere) {
  ASSERT_EQ(run("cscd list >/dev/null; cscd clusters small --json /dev/null; mkdir disk").status, 0);
  const std::string commands[] = {"clusters small --json ", "export small "};
  for (const std::string& command : commands) {
    const std::string name = command.starts_with("export") ? "disk/out.h5" : "disk/out.json";
    const Ran limited = run("ulimit -f 2; cscd " + command + name + "; status=$?; ls -A disk; exit $status");
    expect_refused(limited, name);
    EXPECT_EQ(limited.out, "");
    const Ran full =
        run("unshare -m bash -c 'mount -t tmpfs -o size=4k none disk || exit 77; cscd " + command + name +
            "; status=$?; ls -A disk; exit $status' 2>+full; status=$?; cat +full >&2; exit $status");
    if (full.status == 77 || full.errors.find("unshare") != std::string::npos) continue;  // may not mount
    expect_refused(full, name);
    EXPECT_EQ(full.out, "");
  }
}

TEST_F(ProgramOutput, VanishesWhereASignalEndsTheProgram) {
  put_long_scene("long");
  put_long_scene("longer");
  // The signal is sent as soon as all that is unfinished can be seen.
  const auto interrupt = [&](const std::string& command, const std::string& signal, int unfinished) {
    return run("ulimit -t 60; set -m; mkdir -p records; cscd " + command + " & for i in $(seq 600); do\n" +
               "  n=$(find . -name '.cscd-unfinished-*' | wc -l); [ $n -ge " + std::to_string(unfinished) +
               " ] && break; sleep 0.05; done; echo $n; kill -" + signal + " $!; wait $!; status=$?\n" +
               "find . -name '.cscd-*' >+left; rmdir records; exit $status");
  };
  const struct {
    const char *command, *signal;
    int unfinished, status;
  } kCases[] = {{"query long --json out.json", "INT", 2, 130},
                {"export long out.h5", "TERM", 1, 143},
                {"run --scene all --json records", "HUP", 4, 129},
                {"run --scene all --json records", "INT -- -$! ; true", 4, 130}};
  for (const auto& one : kCases) {
    const Ran ran = interrupt(one.command, one.signal, one.unfinished);
    EXPECT_EQ(ran.status, one.status) << one.command << ran.errors;
    EXPECT_EQ(ran.out, std::to_string(one.unfinished) + "\n") << one.command;
    EXPECT_EQ(text("+left"), "") << one.command;
    EXPECT_EQ(files(), "") << one.command;
  }
}

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

// Whoever made a model file chose its strings: names of bones, parts, materials and clips, and the file's own
// name. They must not control the terminal of whoever reads them, forge lines, or decide where files go.
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
