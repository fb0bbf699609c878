"""Checks that no check of this tree looks at files that git does not track.

  scripts/check untracked CHECK...   each CHECK is a command as one word, "scripts/pages --check", run in the root of a copy

Such files are a user's own records, scenes and sources. In a copy of this tree in which they lie, every check has to pass. Then git tracks those files, and the checks that MUST_NOTICE
names have to fail and say what it names, or the files were no trial. Exit status: 0 all is so, 1 it is not, 77 this tree is no checkout.
"""
import gzip
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import tempfile

from records import read_json
from script import ROOT, call, parser_of, refuse
from tracked import is_checkout, tracked_files

# A part of a check's command, and what the check has to say of the files once git tracks them.
MUST_NOTICE = {"pages": ("core/fast/README.md", "results/README.md", "results/trust/README.md"),
               "check includes": ("core/base/scratch.h", "core/attic/scratch.cpp"), "SceneFolder": ("mine",)}
FOLDER = "2099-01-01-some-machine-2core-0123456789"

# A hook of git hands on where its own repository is.
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")} | {"PYTHONDONTWRITEBYTECODE": "1"}


def copy_tree(copy):
    git(copy, "init", "--quiet")  # first, so that nothing that is copied names another repository
    for path in tracked_files():
        target = copy / path.relative_to(ROOT)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(path, target)
    git(copy, "add", "--all")


def git(copy, *words):
    call("git", "-C", copy, *words, env=ENVIRONMENT, stdout=subprocess.DEVNULL)


def leave_things_about(copy):
    """What scripts and people leave in a checkout: whole records, halves of them, and files that were never meant to stay."""
    results = copy / "results"
    for kind in ("full", "starts", "cloth"):
        newest = max(results.glob(f"*-{kind}"))
        later = shutil.copytree(newest, results / f"{FOLDER}-{kind}")
        for path in later.glob("*.json.gz"):
            record = read_json(path)
            for part in record.get("records", [record]):
                part["environment"]["date"] = "2099-01-01T00:00:00Z"
            path.write_bytes(gzip.compress(json.dumps(record).encode(), 1))
    texts = {"results/some-folder/half.json": "{", f"results/{FOLDER}.part/rope.json": "{}", "results/trust/2099-01-01-mutants.json": "{}",
             "results/history/some-machine/2099-01-01-0123456789.json": "{}", "scenes/mine.json": "{}",
             "core/base/scratch.h": '#pragma once\n#include  "bench/output/json.h"\n', "core/attic/scratch.cpp": "int  main( ) {}\n"}
    for name, text in texts.items():
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_text(text)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("checks", nargs="+", metavar="CHECK")
    checks = parser.parse_args().checks
    if not is_checkout(ROOT):
        print("this tree is no checkout, so git tells nothing of its files")
        return 77
    for name in MUST_NOTICE:
        if not any(name in check for check in checks):
            refuse(f"no check is of {name}; name it, or take it out of MUST_NOTICE")
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        environment = {**ENVIRONMENT, "CSCD_SCENES": str(copy / "scenes")}

        def ask(check):
            done = subprocess.run(shlex.split(check), cwd=copy, env=environment, capture_output=True, text=True)
            return done.returncode, done.stdout + done.stderr

        copy_tree(copy)
        leave_things_about(copy)
        for check in checks:
            status, said = ask(check)
            if status != 0:
                faults.append(f"{check}: fails for files that git does not track: {said[:2000]}")
        git(copy, "add", "--all")
        for check in checks:
            to_notice = [name for part, names in MUST_NOTICE.items() if part in check for name in names]
            status, said = ask(check) if to_notice else (0, "")
            for name in to_notice:
                if status == 0 or name not in said:
                    faults.append(f"{check}: does not notice {name} even where git tracks such files")
    print("\n".join(faults) if faults else f"{len(checks)} checks look at what git tracks, and at nothing else")
    return 1 if faults else 0
