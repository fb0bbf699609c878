"""Writes the record of a search with libFuzzer into results/trust, from the logs that scripts/fuzz keeps.

  python3 scripts/lib/fuzz_record.py SECONDS LOG...     SECONDS: for each target
"""
import pathlib
import re
import sys

from trust import write_record


def row(log):
    text = log.read_text(errors="replace")
    runs = re.search(r"stat::number_of_executed_units: *(\d+)", text)
    covered = re.findall(r" cov: (\d+) ", text)
    found = re.search(r"^(broken:.*|.*ERROR:.*|.*runtime error:.*)$", text, re.MULTILINE)
    return [log.stem, f"{int(runs[1]):,}" if runs else "–", covered[-1] if covered else "–",
            found[1][:200] if found else "nothing"], int(runs[1]) if runs else 0, found is not None


def main(seconds, logs):
    rows, runs, found = zip(*map(row, logs))
    hours = int(seconds) * len(logs) / 3600
    print(write_record({
        "kind": "fuzz",
        "title": "Bytes that libFuzzer tries",
        "says": "Each target reads any bytes and breaks off where a promise is broken: a crash, undefined behaviour, memory or time "
                "without end, and answers of elementary tests, orientations and the engine that differ from exact ones. Built by clang "
                "with AddressSanitizer and UBSan. Searches go on from what earlier ones found to cover new code.",
        "command": f"scripts/fuzz --record {seconds}",
        "headline": f"{sum(found)} found in {sum(runs):,} inputs, {len(logs)} targets, {hours:.1f} hours in all",
        "figures": [["targets", len(logs)], ["seconds for each", int(seconds)], ["inputs", f"{sum(runs):,}"], ["found", sum(found)]],
        "tables": [{"title": "By target", "head": ["target", "inputs", "edges covered", "found"], "rows": list(rows), "text_columns": 1}],
    }))


if __name__ == "__main__":
    main(sys.argv[1], [pathlib.Path(name) for name in sys.argv[2:]])
