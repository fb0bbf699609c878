"""Searches with libFuzzer for inputs that crash, hang, fill the memory or are answered wrongly.

  scripts/find-faults fuzz [SECONDS] [TARGET]...             seconds for each target, default 60; targets are the .cpp files of fuzz/
                                                             with a function `target`, default all of them
  scripts/find-faults fuzz --record [SECONDS] [TARGET]...    adds what was done to results/trust

Installs clang and what a build takes where it is missing, and builds the targets under sanitizers, ten minutes on 2 idle cores. Then
it searches with one target on each core. What is found lies in build-fuzz/found. What covers new code is kept in .cache/fuzz, from
where the next search goes on. Exit status: 0 nothing found, 1 something, 2 it could not run.
"""
import concurrent.futures
import os
import pathlib
import re
import subprocess

from script import ROOT, build, install, parser_of, refuse
from trust import write_record

MODELS = pathlib.Path("/usr/share/assimp/models")
# Beside what is stored: small files of the kind that the machine has.
SEEDS = {"scene": ROOT / "scenes", "fbx": MODELS / "FBX", "gltf": MODELS / "glTF2", "surface_file": MODELS / "PLY"}
FOUND = ROOT / "build-fuzz" / "found"


def search(target, seconds):
    """Searches; returns a row of the record, how many inputs were tried, and whether one of them broke a promise."""
    kept, log = ROOT / ".cache" / "fuzz" / target, FOUND / f"{target}.log"
    kept.mkdir(parents=True, exist_ok=True)
    seeds = [folder for folder in (ROOT / "fuzz" / "corpus" / target, SEEDS.get(target)) if folder and folder.is_dir()]
    with log.open("w") as out:
        status = subprocess.run([ROOT / "build-fuzz" / f"fuzz_{target}", f"-max_total_time={seconds}", "-timeout=20", "-rss_limit_mb=4096",
                                 "-malloc_limit_mb=3072", "-max_len=65536", "-print_final_stats=1", f"-artifact_prefix={FOUND}/{target}-",
                                 kept, *seeds], stdout=out, stderr=subprocess.STDOUT).returncode
    text = log.read_text(errors="replace")
    runs, covered = re.search(r"stat::number_of_executed_units: *(\d+)", text), re.findall(r" cov: (\d+) ", text)
    broken = re.search(r"^(broken:.*|.*ERROR:.*|.*runtime error:.*)$", text, re.MULTILINE)
    found = "nothing" if status == 0 else broken[1][:200] if broken else f"exit status {status}"
    print(f"{target}: {runs[1] if runs else '–'} inputs, {covered[-1] if covered else 0} edges covered, found {found}", flush=True)
    return ([target, f"{int(runs[1]):,}" if runs else "–", covered[-1] if covered else "–", found], int(runs[1]) if runs else 0, status != 0)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--record", action="store_true")
    parser.add_argument("words", nargs="*", metavar="[SECONDS] [TARGET]")
    options = parser.parse_args()
    seconds = int(options.words.pop(0)) if options.words and options.words[0].isdigit() else 60
    every = sorted(path.stem for path in (ROOT / "fuzz").glob("*.cpp") if "\nvoid target(Bytes bytes) {" in path.read_text())
    targets = options.words or every
    if unknown := [target for target in targets if target not in every]:
        refuse(f"no target {unknown[0]}; there are {', '.join(every)}")
    install("build", "clang")
    build("build-fuzz", "fuzzing", *(f"fuzz_{target}" for target in targets), compiler="clang")
    FOUND.mkdir(exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        rows, runs, found = zip(*pool.map(lambda target: search(target, seconds), targets))
    if options.record:
        write_record({
            "kind": "fuzz",
            "title": "Bytes that libFuzzer tries",
            "says": "Each target reads any bytes and breaks off where a promise is broken: a crash, undefined behaviour, memory or time "
                    "without end, and answers of elementary tests, orientations and the engine that differ from exact ones. Built by clang "
                    "with AddressSanitizer and UBSan. Searches go on from what earlier ones found to cover new code.",
            "command": f"scripts/find-faults fuzz --record {seconds}",
            "headline": f"{sum(found)} found in {sum(runs):,} inputs, {len(targets)} targets, {seconds * len(targets) / 3600:.1f} hours in all",
            "figures": [["targets", len(targets)], ["seconds for each", seconds], ["inputs", f"{sum(runs):,}"], ["found", sum(found)]],
            "tables": [{"title": "By target", "head": ["target", "inputs", "edges covered", "found"], "rows": list(rows), "text_columns": 1}],
        })
    return 1 if any(found) else 0
