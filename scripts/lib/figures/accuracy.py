"""Draws charts and writes the page of what accuracy costs, from records of `cscd accuracy`.

  scripts/figures accuracy RECORD.json.gz --out FOLDER
  scripts/figures accuracy RECORD.json.gz --pdf --out FOLDER      for a paper

accuracy.md            a page: this much truth costs this much time, with what to choose for what
accuracy-pareto        wrong answers against time, row by row, Pareto front marked
accuracy-tolerance     time, false alarms, misses and undecided answers against the tolerance
accuracy-hardness      time, wrong and undecided answers against hardness
The figures are PNG files, and with --pdf also PDF files whose text is text; the same record gives the same bytes.
"""
import pathlib

import accuracy_charts
from accuracy_sums import GROUPS, Accuracy
from markdown import built, number, picture, table
from script import made_folder, parser_of, program_option


def duration(ns):
    if ns is None:
        return ""
    for unit, size in (("ms", 1e6), ("µs", 1e3)):
        if ns >= size:
            return f"{number(ns / size)} {unit}"
    return f"{number(ns)} ns"


def share(count, of):
    if of == 0:
        return ""
    if count == 0:
        return "0"
    if count == of:
        return "100 %"
    percent = 100 * count / of
    return f"{percent:.2g} %" if percent < 50 else f"{percent:.0f} %" if percent < 99 else f"{min(percent, 99.99):.4g} %"


def guarantee(row):
    if row["apart_is_proof"] and row["contact_is_proof"]:
        return "both answers"
    return "“apart”" if row["apart_is_proof"] else "none"


def cells_of(r):
    if r is None:
        return ["", "", "", ""]
    return [duration(r.ns), share(r.lost, r.contacts), share(r.invented, r.queries - r.contacts),
            share(r.undecided, r.queries)]


def choose(rows, candidates, group_sums):
    """The fastest candidate over a group."""
    timed = [(group_sums[row["name"]].ns, row["name"]) for row in rows if row["name"] in candidates]
    return min(timed)[1] if timed else None


def recommendations(record, by_group):
    """By rule, so that a new row or machine changes them without a hand."""
    rows = [row for row in record.rows if not row["sweep"]]
    scenes = by_group.get("scenes") or by_group["hard"]
    proofs = {row["name"] for row in rows if row["apart_is_proof"] and row["contact_is_proof"]}
    no_miss = {row["name"] for row in rows if row["apart_is_proof"]}
    seen = [by_group[g] for g in ("scenes", "open") if g in by_group] or [scenes]

    def lost(name, group):
        r = group[name]
        return r.lost / max(1, r.contacts)

    game = {row["name"] for row in rows if all(lost(row["name"], g) <= 1e-3 for g in seen) and all(
        g[row["name"]].invented <= 1e-2 * (g[row["name"]].queries - g[row["name"]].contacts) for g in seen)}
    return [
        ("a game", "at most a thousandth of the contacts lost and a hundredth of the rest invented, on scenes and open "
         "set; then the fastest on scenes", choose(rows, game, scenes), scenes),
        ("a simulator", "no contact ever lost, by proof; then the fastest on scenes", choose(rows, no_miss, scenes),
         scenes),
        ("a proof", "no contact lost and none invented, by proof; then the fastest on scenes",
         choose(rows, proofs, scenes), scenes),
    ]


def page(record, drawn):
    by_group = {g: s for g in GROUPS if (s := record.sums(f"group {g}"))}
    everything = record.sums("all")
    environment = record.raw["environment"]
    text = ["# This much truth costs this much time", ""]
    text += ["Elementary tests (a vertex and a face, or two edges, over one interval) asked the same queries, each answer "
             "held against the exact oracle.", ""]
    text += ["## What to choose", ""]
    lines = []
    for user, rule, name, group in recommendations(record, by_group):
        r = group.get(name) if name else None
        hard = by_group["hard"].get(name) if name else None
        lines.append([f"**{user}**", f"`{name}`" if name else "none of these rows", duration(r.ns) if r else "",
                      duration(hard.ns) if hard else "", rule])
    text += table(["for", "test", "on scene pairs", "on the hard suite", "chosen by"], lines) + [""]
    for group, title in GROUPS.items():
        if group not in by_group:
            continue
        rows = by_group[group]
        one = next(iter(rows.values()))
        text += [f"## {title[0].upper() + title[1:]}: {one.queries:,} queries, {one.contacts:,} in contact", ""]
        lines = []
        for row in record.rows:
            if row["sweep"] or row["name"] not in rows:
                continue
            r = rows[row["name"]]
            lines.append([f"`{row['name']}`", guarantee(row)] + cells_of(r) +
                         [duration(r.ns_near), duration(r.ns_contact), f"{r.distance:.1g}" if r.distance else "",
                          f"{r.p99:.1g}", f"{r.early:.1g}", f"{r.late:.1g}"])
        text += table(["test", "proves", "time", "contacts lost", "contacts invented", "undecided", "near misses",
                       "contacts", "farthest invented", "time error, 99 %", "earliest", "latest"], lines) + [""]
    text += cost_of_exactness(record)
    worst = record.raw["promises"]
    proofs = [row["name"] for row in record.rows if row["apart_is_proof"] and not row["sweep"]]
    counted = ", ".join(f"{n} {everything[n].queries:,}" for n in proofs)
    text += ["## How to read it", "",
             f"- Queries asked of the rows that prove “apart”: {counted}. Promises "
             f"{'all kept' if worst['ok'] else 'BROKEN: ' + '; '.join(worst['broken'])}; the oracle contradicts "
             f"{record.raw['published_truths']['contradicted']} of {record.raw['published_truths']['queries']:,} published truths.",
             "- *Contacts lost*: “apart” where the features touch, as a share of the contacts. *Invented*: “contact” where "
             "they do not, as a share of the rest. *Undecided* is neither; a caller takes it for a contact.",
             "- *Farthest invented*: the largest least distance among (the first) invented contacts, in extents of the "
             "query. Errors in time are in intervals, of contacts found; *latest* above 0 means that a time may come after "
             "the first contact. *99 %* is the largest over the workloads.",
             "- The scenes' pairs are those that the complete reference's bounds and the certified filter leave over.",
             f"- Times are medians over blocks of queries, the tests taking turns in random order, {record.raw['passes']} pass{'es' if record.raw['passes'] > 1 else ''}; "
             f"{built(environment)}. On a shared machine take their ratios.", ""]
    for name, title in (("pareto", "wrong answers against time"), ("tolerance", "time and wrong answers by tolerance"),
                        ("hardness", "time and wrong answers by hardness")):
        if name in drawn:
            text += picture(f"accuracy-{name}", title)
    text += family_table(record)
    sweep = [row for row in record.rows if row["sweep"]]
    if sweep:
        text += ["## Other parameters", "", "On the first queries of every workload of the hard suite and the open set.", ""]
        rows = record.sums("sweep")
        text += table(["test", "proves", "time", "contacts lost", "contacts invented", "undecided"],
                      [[f"`{row['name']}`", guarantee(row)] + cells_of(rows[row["name"]]) for row in sweep
                       if row["name"] in rows]) + [""]
    text += [f"Command: `{' '.join(record.raw['command'])}`"]
    return "\n".join(text) + "\n"


def cost_of_exactness(record):
    """filtered_exact against newton on the same blocks, and how far it had to go."""
    ratios = {(r["group"], r.get("name")): r for r in record.raw.get("ratios", [])}
    if not ratios:
        return []
    lines = []
    for group, title in GROUPS.items():
        names = dict.fromkeys(w["name"] for w in record.raw["workloads"] if w["group"] == group)
        for name in [None] + (list(names) if group in ("scenes", "open") else []):
            if (group, name) not in ratios:
                continue
            stages = record.stages(f"group {group}" if name is None else f"{group} {name}")
            queries = sum(stages.values())
            r = ratios[group, name]
            lines.append([f"**{title}**" if name is None else f"`{name}`", f"{queries:,}",
                          f"{number(r['value'])} [{number(r['low'])}, {number(r['high'])}]"] +
                         [share(stages[s], queries) for s in ("filter", "doubles")] +
                         [share(stages["integers"] + stages["referee"], queries), share(stages["referee"], queries)])
    return (["## What being exact costs: `filtered_exact` over `newton`", "",
             "Time of all queries over the time of all queries, both asked the same blocks in turn (95 % bootstrap interval over "
             "blocks); and the share of queries that `filtered_exact` answers by its filter, in doubles, those that leave doubles "
             "for multi-word integers, and those of them that end at the oracle.", ""] +
            table(["queries of", "queries", "time over `newton`", "filter", "doubles", "leave doubles", "reach GMP"], lines) +
            [""])


def family_table(record):
    names = [row["name"] for row in record.rows if not row["sweep"]]
    families = list(dict.fromkeys(w["name"] for w in record.raw["workloads"] if w["group"] == "hard"))
    lines = []
    for family in families:
        rows = record.sums(f"family {family}")
        cells = []
        for name in names:
            r = rows[name]
            wrong = ", ".join(f"{share(count, of)} {what}" for count, of, what in (
                (r.lost, r.contacts, "lost"), (r.invented, r.queries - r.contacts, "invented"),
                (r.undecided, r.queries, "open")) if count)
            cells.append(duration(r.ns) + (f"; {wrong}" if wrong else ""))
        lines.append([f"`{family}`"] + cells)
    return (["## The hard suite, family by family", "", "Time a query; contacts lost, contacts invented, left undecided. "
             "`cscd list families` tells each family's story.", ""] + table(["family"] + names, lines) + [""])


def main():
    parser = parser_of(__doc__)
    parser.add_argument("record", type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path, help="the folder, which is made where it is missing")
    program_option(parser)
    parser.add_argument("--pdf", action="store_true", help="every chart as PDF too")
    arguments = parser.parse_args()
    made_folder(arguments.out)
    record = Accuracy(arguments.record, arguments.program)
    drawn = accuracy_charts.draw_all(record, arguments.out, arguments.pdf)
    (arguments.out / "accuracy.md").write_text(page(record, drawn))
