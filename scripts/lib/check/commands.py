"""Types the commands of README.md, library/README.md and scripts/README.md as they stand there.

  scripts/check commands BUILD    BUILD is a folder in which cscd is built
  scripts/check commands --list   what is not typed, and why

Commands of cscd run in a folder that holds the files which the pages name. Commands that build and install run in a copy of the tree at
a path with a blank, with a stand-in for the compiler and for sudo (lib/stand_in.py). Of a command that is not typed, the script or
the command of cscd has to exist, and its help has to name each option. Exit status: 0 all work, 1 one does not.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile

from script import ROOT, parser_of, refuse
from stand_in import copy_tree, stand_ins, without_git

PAGES = ("README.md", "library/README.md", "scripts/README.md")
START = r"(?:[A-Z_]+=\S+ )*(?:sudo |\(cd )?(?:cscd |cmake |ninja |ctest |cpack|scripts/\w|pip |apt |doxygen |git |python3 )"
# What a command begins with, and why it is not typed.
NOT_TYPED = (
    ("scripts/pages", "writes pages anew; tests run scripts/pages --check"),
    ("scripts/", "takes minutes to hours, or installs packages; the test scripts_start starts each kind"),
    ("ninja -C build-test-gcc-release", "builds everything and runs this suite"),
    ("ctest -R python_module", "is a part of this suite"),
    ("doxygen ", "is the test api_pages"),
    ("cpack", "the name of a program, which the command of its section calls"),
    ("apt ", "changes the system; scripts/check deb installs this in a bare one"),
    ("sudo apt install", "changes the system; scripts/check deb does it in a bare one"),
    ("git add", "changes the repository"),
    ("cscd run", "measures for minutes; tests of bench/measure do it with --smoke"),
    ("cscd benchmark make", "takes minutes; tests of bench/benchmark make small ones"),
    ("cscd view octopus", "generates and searches a large scene, which takes minutes; the commands with smaller inputs are typed"),
    ("cscd view skirt_contact", "simulates cloth for minutes; the tests of scenes/cloth do"),
    ("cscd view fold_contact", "simulates cloth for minutes; the tests of scenes/cloth do"),
    ("cscd query fold_contact", "simulates cloth for minutes; the tests of scenes/cloth do"),
)
BUILDS = re.compile(r"(?:\w+=\S+ )*(?:sudo )?(?:cmake|pip) ")
# The files that pages name, made of a scene by `cscd export` or, where only other programs write the format, taken from a package.
INPUTS = {"character.glb": "urchin", "steps.h5": "urchin",
          "walk.fbx": pathlib.Path("/usr/share/assimp/models/FBX/animation_with_skeleton.fbx")}


def commands_of(text):
    """The commands of a page: lines that are indented, prompts in blocks, and what stands between backquotes; each once."""
    found, in_block = [], False
    for line in text.splitlines():
        if line.startswith("```"):
            in_block = not in_block
        elif in_block:
            found += [line[2:]] if line.startswith("$ ") else []
        elif line.startswith("    "):
            found.append(re.split(r" {2,}(?!&&)", line.strip())[0].split("  #")[0])
        else:
            found += re.findall(r"`([^`]+)`", line)
    return [command for command in dict.fromkeys(found) if re.match(START, command) and not (ROOT / command.split()[0]).is_dir()]


def why_not(command):
    """Why a command is not typed; None where it is."""
    if re.fullmatch(r"cscd \w+|cscd benchmark \w+", command):
        return "the name of a command"
    return next((reason for begin, reason in NOT_TYPED if command.startswith(begin)), None)


def fault_of_help(command, environment):
    """What the help of a command that is not typed lacks; nothing where it names every option."""
    words = shlex.split(command)
    if words[0] == "cscd":
        asked = ["cscd", "help", *[word for word in words[1:3] if re.fullmatch("[a-z]+", word)][:2 if words[1] == "benchmark" else 1]]
    elif words[0].startswith("scripts/"):
        kind = words[1:2] if (ROOT / "scripts/lib" / words[0].removeprefix("scripts/")).is_dir() and words[1:] else []
        asked = [str(ROOT / words[0]), *[word for word in kind if not word.startswith("-")], "--help"]
    else:
        return ""
    done = subprocess.run(asked, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        return f"{' '.join(asked)}: {done.stderr.strip()}"
    missing = [word for word in words if word.startswith("--") and word not in done.stdout]
    return f"{' '.join(asked)} does not name {' and '.join(missing)}" if missing else ""


def typed(command, folder, environment):
    """Types a command in a folder; returns what it says last where it fails."""
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return "" if done.returncode == 0 else "\n".join((done.stdout + done.stderr).splitlines()[-20:]) or f"exit status {done.returncode}"


def make_inputs(folder, environment):
    """Makes the files that commands read. Returns the names of those that cannot be made here."""
    for name, source in INPUTS.items():
        if isinstance(source, pathlib.Path):
            if source.exists():
                shutil.copy(source, folder / name)
        elif fault := typed(f"cscd export {source} {name}", folder, environment):
            refuse(f"{name}: {fault}")
    return [name for name in INPUTS if not (folder / name).exists()]


def main():
    parser = parser_of(__doc__)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--list", action="store_true", help="say what is not typed, and why")
    given = parser.parse_args()
    commands = {page: commands_of((ROOT / page).read_text()) for page in PAGES}
    if given.list:
        for page, on_page in commands.items():
            for command in on_page:
                if reason := why_not(command):
                    print(f"{page}: {command}: {reason}")
        return 0
    if given.build is None or not (given.build / "cscd").exists():
        refuse("give the folder in which cscd is built")
    failed, counts = 0, {"typed": 0, "not typed": 0}
    with tempfile.TemporaryDirectory(prefix="cscd ") as name:
        work = pathlib.Path(name)
        (work / "files").mkdir()
        program = without_git(os.environ) | {"PATH": f"{given.build.resolve()}:{os.environ['PATH']}", "CSCD_SCENES": str(ROOT / "scenes"),
                                             "CSCD_CACHE": str(ROOT / ".cache")}
        missing = make_inputs(work / "files", program)
        copy_tree(work / "tree")
        building = stand_ins(work / "stand-ins")
        for page, on_page in commands.items():
            for command in on_page:
                reason = why_not(command)
                if lacks := [name for name in missing if name in command]:
                    reason = f"{lacks[0]} is not there"
                if "cpack" in command and not shutil.which("dpkg-shlibdeps"):
                    reason = "dpkg-dev is not installed"
                if " pip " in command and subprocess.run(["/usr/bin/python3", "-c", "import pip, setuptools, wheel"],
                                                         capture_output=True).returncode:
                    reason = "pip, setuptools or wheel is not installed"
                counts["not typed" if reason else "typed"] += 1
                if reason:
                    fault = fault_of_help(command, program)
                elif BUILDS.match(command):
                    fault = typed(command, work / "tree", building)
                else:
                    fault = typed(command, work / "files", program)
                if fault:
                    failed = 1
                    print(f"{page}: {command}: {fault}")
    print(f"{counts['typed']} commands typed, {counts['not typed']} not (scripts/check commands --list)")
    return failed
