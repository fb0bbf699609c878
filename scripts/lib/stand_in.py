"""A copy of the tree in which builds run through in seconds: each rule of the build runs, and nothing is compiled.

A stand-in takes the compiler's place. It makes the object that a rule promises, with nothing in it but an empty main(). So what a build
system gets wrong - a file without a rule, a rule that two targets run at once, a path that breaks at a blank - fails as it would for a
user, and what a compiler gets wrong does not.
"""
import os
import shutil
import subprocess

from script import ROOT, output_of
from tracked import tracked_files

COMPILER = r"""#!/bin/bash
# COMPILER ARGUMENT...
case $PWD in */CMakeFiles/CMake*) exec "$@" ;; esac  # CMake tries the compiler itself
out='' dependencies='' entry=''  # a name that rules look for in the object, another one in each
while [ $# -gt 0 ]; do
  case $1 in -o) out=$2 ;; -MF) dependencies=$2 ;; */prepared_engine.cpp) entry=_ZN4cscd11make_engineI$$ ;; esac
  shift
done
[ -z "$dependencies" ] || echo "${out// /\\ }:" >"$dependencies"
if [ -n "$entry" ]; then echo "int $entry = 1;" | cc -x c -c - -o "$out"; else cp "${0%/*}/empty.o" "$out"; fi
"""
# What else a build asks for: npm fetches nothing, node writes its last argument, root's files go to a folder, and pip is the system's.
OTHERS = {"npm": "exit 0", "node": ': >"${@: -1}"', "sudo": 'DESTDIR=${0%/*}/root exec "$@"', "pip": 'exec /usr/bin/python3 -m pip "$@"'}


def copy_tree(copy):
    """Copies the tree without its records into a folder, as a checkout of one commit."""
    for path in tracked_files():
        name = path.relative_to(ROOT)
        if name.parts[0] != "results":
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, copy / name)
    for words in (["init", "--quiet", "--initial-branch", "main"], ["add", "--all"],
                  ["-c", "user.name=cscd", "-c", "user.email=cscd@localhost", "commit", "--quiet", "--no-verify", "-m", "copy"]):
        output_of("git", "-C", copy, *words, env=without_git(os.environ))


def without_git(environment):
    """An environment without what a hook of git hands on."""
    return {name: value for name, value in environment.items() if not name.startswith("GIT_")}


def stand_ins(folder):
    """Writes the stand-ins into a folder, and returns the environment in which a build uses them."""
    folder.mkdir()
    for name, body in {"compile": COMPILER, **{name: f"#!/bin/bash\n{body}\n" for name, body in OTHERS.items()}}.items():
        (folder / name).write_text(body)
        (folder / name).chmod(0o755)
    subprocess.run(["cc", "-x", "c", "-c", "-", "-o", folder / "empty.o"], check=True, text=True,
                   input="__attribute__((weak)) int main(void) { return 0; }\n")
    environment = without_git(os.environ) | {"PATH": f"{folder}:{os.environ['PATH']}"}
    return environment | {f"CMAKE_{language}_COMPILER_LAUNCHER": str(folder / "compile") for language in ("C", "CXX")}
