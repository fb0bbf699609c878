"""Damages sample models at random and gives each copy to the program, as anyone would.

  scripts/find-faults hostile [COPIES]            so many copies of each sample, default 300
  scripts/find-faults hostile --record [COPIES]   adds the figures to results/trust

The samples are generated characters, those of shared/models where it is there, and Debian's assimp-testmodels. No copy may crash
the program, outlast its limits of time and memory, or be accepted with a number that is not finite. Builds the tests first;
then it takes about half an hour on 2 idle cores, a kind of file on each. Exit status: 0 nothing found, 1 a test failed, 2 it
could not run.
"""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import tempfile

from script import ROOT, build, install, parser_of, refuse
from trust import write_record

BUILD = "build-test-gcc-release"
FILTER = "Damaged/HostileKinds.DamagedSamplesNeverCrashHangOrFillTheMemory/"
KINDS = ("gltf", "glb", "fbx", "dae", "x", "bvh")  # the one with the most samples first


def attack(kind, copies, folder):
    """The figures of one kind, and whether its test passed; no figures where there is no sample."""
    report = folder / f"{kind}.json"
    done = subprocess.run(["./bench_query_test", f"--gtest_filter={FILTER}{kind}", f"--gtest_output=json:{report}"],
                          cwd=ROOT / BUILD, env={**os.environ, "CSCD_HOSTILE": str(copies)}, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout)
    test = json.loads(report.read_text())["testsuites"][0]["testsuite"][0] if report.exists() else {}
    figures = {name: int(test[name]) for name in ("samples", "runs", "accepted", "lost_importers", "late", "slowest_ms",
                                                  "largest_mib", "exported_frames") if name in test}
    # A program that crashes writes no report, and its kind must not look like one without samples.
    if done.returncode != 0 and not figures:
        refuse(f"the tests of {kind} ended with status {done.returncode} and without figures; run them by themselves")
    print(f"{kind}: {figures or 'no samples'}{'' if done.returncode == 0 else ', FAILED'}", flush=True)
    return figures, done.returncode == 0


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--record", action="store_true")
    parser.add_argument("copies", type=int, nargs="?", default=300)
    options = parser.parse_args()
    if options.copies < 1:
        refuse(f"{options.copies} copies; give at least 1")
    install("build", "tests")
    build(BUILD, "test", "bench_query_test", "cscd")
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = dict(zip(KINDS, pool.map(lambda kind: attack(kind, options.copies, pathlib.Path(folder)), KINDS)))
    met = {kind: figures for kind, (figures, _) in results.items() if figures}
    failed = [kind for kind, (_, passed) in results.items() if not passed]
    if options.record:
        total = {name: sum(figures[name] for figures in met.values())
                 for name in ("samples", "runs", "accepted", "late", "lost_importers")}
        write_record({
            "kind": "hostile",
            "title": "Damaged models",
            "says": "Copies of sample models with bits flipped, bytes written over, numbers exchanged or ends cut off, each read, "
                    "asked and exported by the program under its usual limits. None may crash the program, outlast the limits, "
                    "or be accepted with a number that is not finite. A copy is late where the limit on its time ended it.",
            "command": f"scripts/find-faults hostile --record {options.copies}",
            "headline": f"{len(failed)} of {len(met)} kinds fail, {total['runs']:,} damaged copies of {total['samples']} samples",
            "figures": [["copies of each sample", options.copies], ["samples", total["samples"]],
                        ["runs", f"{total['runs']:,}"], ["accepted", f"{total['accepted']:,}"],
                        ["importers lost to a crash or a limit", total["lost_importers"]], ["late", total["late"]]],
            "tables": [{
                "title": "By kind",
                "head": ["kind", "samples", "runs", "accepted", "late", "slowest ms", "largest MiB", "frames exported"],
                "rows": [[kind, str(f["samples"]), f"{f['runs']:,}", f"{f['accepted']:,}", str(f["late"]),
                          f"{f['slowest_ms']:,}", str(f["largest_mib"]), f"{f['exported_frames']:,}"] for kind, f in met.items()],
                "text_columns": 1}],
        })
    return 1 if failed else 0
