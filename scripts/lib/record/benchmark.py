"""Scores this project's strategies and other packages on the public benchmark.

  scripts/record benchmark

Makes the public benchmark (bench/BENCHMARK.md) in .cache/benchmark, has it answered by this project's strategies and the packages
at hand, and writes their scores and a page of them to a new folder results/DATE-MACHINE-COMMIT-benchmark. Installs what is missing
from Debian's packages, and takes a quarter of an hour on 2 idle cores when everything is built.
"""

from markdown import built, number, table
from records import read_json
from scale_record import MARK
from script import ROOT, call, measured_program, new_results, output_of, parser_of

# A strategy, or a strategy and an elementary test. Strategies differ in what they cull, and the tests in what they decide.
ENTRIES = ("base", "aabb", "mcd", "selfccd", "embree", "cgal_boxes", "rvbc", "drvbc", "drvbc_fast", "drvbc_fast_all",
           "drvbc_fast_complete", "fcl", "base+newton", "base+cubic", "base+inclusion", "base+additive", "base+fcl")
HEAD = ["answered", "expected", "misses", "inventions", "undecided", "broken", "late", "latest", "early", "earliest",
        "median ms", "sum of ms"]


def counts(score):
    ms, mark = score.get("milliseconds"), MARK if "shortfall" in score else ""
    return [f"{score['answered']} of {score['intervals']}", *(str(score[key]) for key in ("expected", "misses", "inventions")),
            str(score["undecided"]), str(score["broken"]), str(score["late"]), number(score["latest"]), str(score["early"]),
            number(score["earliest"]), *(number(ms and ms[key]) + (mark if ms else "") for key in ("median", "sum"))]


def page(scores):
    first = scores[0]
    lines = ["# Scores of the public benchmark", "",
             "Made by `scripts/record benchmark` from the scores beside it. [BENCHMARK.md](../../bench/BENCHMARK.md) defines every column.",
             "", f"Benchmark `{first['benchmark'][:16]}`, {first['all']['intervals']} intervals. "
             f"Answered on {built(first['notes']['environment'])}.", "",
             "A strategy decides what is culled, and an elementary test decides single pairs. Entries without a test's name use "
             "`filtered_exact`. Rows that need closed surfaces or bones leave out what they cannot take. `fcl` brings tests of "
             "its own and promises nothing.", "", "## All intervals", ""]
    lines += table(["entry", "promises", *HEAD],
                   [[f"`{entry(score)}`", f"`{score['notes']['guarantee']}`", *counts(score["all"])] for score in scores],
                   text_columns=2)
    for name in first["sets"]:
        lines += ["", f"## {name.capitalize()}", ""]
        lines += table(["entry", *HEAD], [[f"`{entry(score)}`", *counts(score["sets"][name])] for score in scores])
    lacking = [f"- `{entry(score)}`: {score['all']['shortfall']}" for score in scores if "shortfall" in score["all"]]
    if lacking:
        lines += ["", f"## What {MARK} stands for", "", f"{MARK} The answers lack some that complete ones have, so their time is not for the same work. Of all "
                  "intervals:", "", *lacking]
    return "\n".join(lines) + "\n"


def entry(score):
    test = score["notes"]["elementary"]
    return score["notes"]["strategy"] + ("" if test in ("filtered_exact", "its own") else f" with {test}")


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--smoke", action="store_true", help="a minute, with 60 small meshes: shows that everything works")
    smoke = ["--smoke"] if parser.parse_args().smoke else []
    cscd = measured_program("a minute" if smoke else "a quarter of an hour")
    kind = "benchmark-smoke" if smoke else "benchmark"
    made = ROOT / ".cache" / kind
    call(cscd, "benchmark", "make", "--out", made, "--force", *smoke)
    known = {name for what in ("strategies", "tests") for name in output_of(cscd, "list", what, "--names").split()}
    with new_results(kind) as folder:
        scores = []
        for name in ENTRIES:
            strategy, _, test = name.partition("+")
            test = test or "filtered_exact"
            if not {strategy, test} <= known:  # a build without a package has no rows of it
                print(f"no {name} in this build")
                continue
            answers, score = made / "answers.json.gz", folder / f"{name}.json.gz"
            call(cscd, "benchmark", "answer", made, "--strategy", strategy, "--elementary", test, "--force", "--json", answers)
            call(cscd, "benchmark", "judge", made, answers, "--json", score)
            scores.append(read_json(score))
        scores.sort(key=lambda score: (score["notes"]["elementary"] != "filtered_exact", entry(score)))
        (folder / "benchmark.md").write_text(page(scores))
