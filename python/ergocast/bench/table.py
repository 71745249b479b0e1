# SPDX-License-Identifier: BSD-3-Clause
"""Joins the rows of the bench's studies with rows from elsewhere, and makes table and heat maps.

python3 -m ergocast.bench.table DIR [ROWS.csv…] makes them without a run. docs/results/bench.md describes
the files.
"""

import csv
import html
import math
import sys
from pathlib import Path

from ergocast._errors import ErgocastError
from ergocast._interval import interval
from ergocast._simulate import shipped_folders

# Column: title, whether less is better, how numbers are written.
MEASURES = {
    "ergodic_metric": ("φ² in cosines", True, "{:.2e}"),
    "detection_probability": ("P(found)", False, "{:.3f}"),
    "time_to_half_s": ("half found after [s]", True, "{:.0f}"),
    "time_to_four_fifths_s": ("80 % found after [s]", True, "{:.0f}"),
    "sliced_wasserstein_m": ("sliced W₂ [m]", True, "{:.1f}"),
    "greatest_age_s": ("greatest age [s]", True, "{:.0f}"),
    "path_m": ("path [m]", True, "{:.0f}"),
}
PRINTED = ("ergodic_metric", "detection_probability", "time_to_four_fifths_s")
KEYS = ("target", "agents", "law", "seed")
LAWS = {
    "laws/smc.py:FirstOrder": "SMC",
    "laws/smc.py:SecondOrder": "SMC2",
    "laws/hedac.py:Hedac": "HEDAC",
    "laws/kernel.py:Kernel": "KERNEL",
    "laws/receding.py:Receding": "RECEDING",
    "laws/density_driven.py:DensityDriven": "D2OC",
    "laws/random_walk.py:RandomWalk": "WALK",
    "laws/random_walk.py:Waypoints": "WAYPOINTS",
}
ORDER = ["COVER", "MOW", "SEARCH", *LAWS.values()]
TARGETS = ("four_peaks", "uniform", "one_peak", "ring", "two_far", "strip", "lake", "rooms", "box")
HERE = Path(__file__).resolve().parent
MOST_ROWS = 1000000


class BenchError(ErgocastError):
    """What a person can mend: rows, targets, folders."""


def problem(text):
    raise BenchError(text)


def targets():
    """{target: its scenario}, in the order of the table."""
    for folder in shipped_folders():
        if (folder / "bench").is_dir():
            return {name: folder / "bench" / f"{name}.textproto" for name in TARGETS}
    problem("its scenarios are not installed (they come with the package ergocast)")


def number(text, where):
    """A measure: empty is unknown, inf is never."""
    try:
        value = float(text) if text else math.nan
    except ValueError:
        value = None
    if value is None or text.strip().lower() == "nan" or value < 0:
        problem(f"{where}: {text!r} is no number of 0 or more (leave it empty if it is unknown, inf for never)")
    return value


def name_of(law):
    """The name in the table of what law.kind has: a law in Python has that of its class."""
    return LAWS.get(law, law.rpartition(":")[2])


def rows_of_study(file):
    """The rows of a study.csv of the bench, with the names of this table."""
    with file.open(newline="") as opened:
        for row in csv.DictReader(opened):
            law = row["law.kind"]
            yield {"target": row["scenario"], "agents": int(row["agents"]), "seed": int(row["seed"]),
                   "law": name_of(law),
                   "from": law, **{key: number(row[key], file) for key in MEASURES}}


def rows_added(file):
    """The rows of a file of the form of rows.csv, each checked."""
    with open(file, newline="") as opened:
        reader = csv.DictReader(opened)
        missing = [key for key in KEYS if key not in (reader.fieldnames or [])]
        if missing:
            problem(f"{file}:1: there is no column {missing[0]} (the first line names {', '.join(KEYS)} and measures)")
        unknown = [key for key in reader.fieldnames if key not in KEYS and key not in MEASURES]
        if unknown:
            problem(f"{file}:1: {unknown[0]!r} is no column of the bench (it has {', '.join(MEASURES)})")
        for row in reader:
            where = f"{file}:{reader.line_num}"
            if None in row or None in row.values():
                problem(f"{where}: expected {len(reader.fieldnames)} cells (give one for each column)")
            if row["target"] not in TARGETS:
                problem(f"{where}: {row['target']!r} is no target of the bench (it has {', '.join(sorted(TARGETS))})")
            if not row["law"].strip():
                problem(f"{where}: the row names no law (write one into the column law)")
            for key in ("agents", "seed"):
                if not (row[key].isascii() and row[key].isdigit()):
                    problem(f"{where}: {key} {row[key]!r} is no whole number (write its digits)")
            yield {"target": row["target"], "agents": int(row["agents"]), "seed": int(row["seed"]),
                   "law": row["law"].strip(), "from": Path(file).name,
                   **{key: number(row.get(key) or "", f"{where}: {key}") for key in MEASURES}}


def joined(folder, files):
    """All rows by (target, agents, law, seed); what ran here comes before what was added."""
    rows = {}
    for study in sorted([*folder.glob("*/study.csv"), *folder.glob("*/*-of-*/study.csv")]):
        for row in rows_of_study(study):
            rows.setdefault(tuple(row[key] for key in KEYS), row)
    here, repeated, elsewhere = {key[0] for key in rows}, 0, 0
    for file in files:
        for row in rows_added(file):
            key = tuple(row[key] for key in KEYS)
            if here and row["target"] not in here:
                elsewhere += 1
                continue
            repeated += key in rows
            rows.setdefault(key, row)
            if len(rows) > MOST_ROWS:
                problem(f"{file}: more than {MOST_ROWS} rows (give fewer)")
    for count, why in ((repeated, "their runs are here already"), (elsewhere, "their targets were not run here")):
        if count:
            print(f"{count} added rows left out: {why}", file=sys.stderr)
    if not rows:
        problem(f"{folder} has no study with a row (run ergocast bench)")
    return rows


def command_of(target, agents, law, source):
    scenario = f"{targets()[target]} --set agents.random_count={agents} --seed 1"
    if ".py:" in source:
        return f"/usr/bin/python3 -m ergocast --law {HERE / source} {scenario}"
    return f"ergocast run {scenario} --set law.kind={law}" if source == law else f"rows of {source}"


def cells_of(rows):
    """One a target, number of agents and law: the interval of each measure, and its rank."""
    groups = {}
    for row in rows.values():
        groups.setdefault((row["target"], row["agents"], row["law"]), []).append(row)
    cells = []
    # Laws of one row stay in the order of the first study.
    for (target, agents, law), runs in sorted(groups.items(), key=lambda group: group[0][:2]):
        measures = {key: interval([run[key] for run in runs]) for key in MEASURES}
        cells.append({"target": target, "agents": agents, "law": law, "runs": len(runs),
                      "command": command_of(target, agents, law, runs[0]["from"]),
                      "measures": measures, "rank": {}})
    for key, (_, less, _) in MEASURES.items():
        for place in {(cell["target"], cell["agents"]) for cell in cells}:
            rank([c for c in cells if (c["target"], c["agents"]) == place], key, less)
    return cells


def rank(cells, key, less):
    """Marks the law with the best median, and those whose interval overlaps with its own."""
    known = [c for c in cells if not math.isnan(c["measures"][key][1])]
    if not known or key == "path_m":
        return
    best = (min if less else max)(known, key=lambda c: c["measures"][key][1])
    low, middle, high = best["measures"][key]
    if math.isinf(middle):
        return  # nobody gets there
    for cell in known:
        if cell["measures"][key][0] <= high and cell["measures"][key][2] >= low:
            cell["rank"][key] = "near"
    best["rank"][key] = "best"


def text_of(cell, key, interval=True):
    form = MEASURES[key][2]
    low, middle, high = ("–" if math.isnan(v) else "never" if math.isinf(v) else form.format(v)
                         for v in cell["measures"][key])
    return f"{middle} [{low}, {high}]" if interval and middle != "–" and low != high else middle


def write_csv(folder, rows, cells):
    with (folder / "rows.csv").open("w", newline="") as opened:
        writer = csv.writer(opened, lineterminator="\n")
        writer.writerow([*KEYS, *MEASURES])
        for key in sorted(rows):
            values = (rows[key][measure] for measure in MEASURES)
            writer.writerow([*key, *("" if math.isnan(v) else f"{v:.6g}" for v in values)])
    with (folder / "bench.csv").open("w", newline="") as opened:
        writer = csv.writer(opened, lineterminator="\n")
        writer.writerow(["target", "agents", "law", "measure", "runs", "median", "low", "high", "rank", "command"])
        for cell in cells:
            for key, (low, middle, high) in cell["measures"].items():
                values = ("" if math.isnan(v) else f"{v:.6g}" for v in (middle, low, high))
                writer.writerow([cell["target"], cell["agents"], cell["law"], key, cell["runs"], *values,
                                 cell["rank"].get(key, ""), cell["command"]])


def in_order(values):
    return list(dict.fromkeys(values))


def laws_of(cells):
    """Those of the bench first, then those of others."""
    laws = in_order(cell["law"] for cell in cells)
    return sorted(laws, key=lambda law: ORDER.index(law) if law in ORDER else len(ORDER))


def marked(cell, key, interval):
    """The text of a cell: the best is bold, a star marks what is not separated from it."""
    text, kind = text_of(cell, key, interval), cell["rank"].get(key)
    return f"**{text}**" if kind == "best" else f"{text}\\*" if kind == "near" else text


def table_of(head, lines):
    return "\n".join("| " + " | ".join(line) + " |" for line in [head, *lines]).replace(
        "\n", "\n" + "|---" * len(head) + "|\n", 1)


def places_of(cells):
    return in_order((cell["target"], cell["agents"]) for cell in cells)


def at(cells, place):
    """{law: its cell} of a target and number of agents."""
    return {cell["law"]: cell for cell in cells if (cell["target"], cell["agents"]) == place}


def markdown(cells, key):
    """A line for each target and number of agents, with the medians of all laws."""
    laws, lines = laws_of(cells), []
    for place in places_of(cells):
        found = at(cells, place)
        lines.append(["{}, {}".format(*place),
                      *(marked(found[law], key, interval=False) if law in found else "" for law in laws)])
    return table_of([MEASURES[key][0], *laws], lines)


def with_intervals(cells):
    """A table for each target and number of agents, with a line for each law."""
    tables = []
    for place in places_of(cells):
        found = at(cells, place)
        lines = [[law, str(found[law]["runs"]), *(marked(found[law], key, interval=True) for key in PRINTED)]
                 for law in laws_of(cells) if law in found]
        head = ["{}, {}".format(*place), "runs", *(MEASURES[key][0] for key in PRINTED)]
        tables.append(table_of(head, lines))
    return "\n\n".join(tables)


def shade(cell, key, others):
    """0 for the worst law of the row, 1 for the best."""
    less, scale = MEASURES[key][1], math.log if key == "ergodic_metric" else float
    values = [scale(c["measures"][key][1]) for c in others
              if math.isfinite(c["measures"][key][1]) and c["measures"][key][1] > 0]
    own = cell["measures"][key][1]
    if not values or not math.isfinite(own) or own <= 0 or max(values) == min(values):
        return 0
    share = (scale(own) - min(values)) / (max(values) - min(values))
    return 1 - share if less else share


def heat_map(cells, key):
    laws = laws_of(cells)
    head = "".join(f"<th>{html.escape(law)}" for law in laws)
    lines = [f"<table data-key={key}><tr><th>target<th>agents{head}<th>best"]
    for target, agents in in_order((cell["target"], cell["agents"]) for cell in cells):
        row = [c for c in cells if (c["target"], c["agents"]) == (target, agents)]
        line, best = f"<tr><th>{html.escape(target)}<th>{agents}", ""
        for law in laws:
            cell = next((c for c in row if c["law"] == law), None)
            if cell is None:
                line += "<td class=none>–"
                continue
            kind = cell["rank"].get(key, "")
            best = law if kind == "best" else best
            title = html.escape(f"{cell['runs']} runs; one of them: {cell['command']}", quote=True)
            line += (f'<td class="{kind}" title="{title}" style="--s:{shade(cell, key, row):.3f}">'
                     f"{html.escape(text_of(cell, key)).replace(' [', '<br>[')}")
        lines.append(f"{line}<td>{html.escape(best)}")
    return "\n".join(lines) + "</table>"


PAGE = """<!doctype html><meta charset=utf-8><title>Ergocast's bench</title><style>
body{font:14px system-ui,sans-serif;margin:24px;color:#1b1f24;background:#fff}table{border-collapse:collapse;display:none}
table.on{display:table}td,th{padding:5px 8px;text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums;border:1px solid #fff}
th{font-weight:600;text-align:left}td[style]{background:color-mix(in srgb,#2f7ebc calc(var(--s)*70%),#eef2f5)}
td.best{font-weight:700;outline:2px solid #1b1f24;outline-offset:-2px}td.near::before{content:"● ";font-size:9px}
td.none{color:#888}pre{white-space:pre-wrap;background:#eef2f5;padding:8px}</style>
<h1>Laws on one table</h1><p>Medians over the seeds with intervals of 95 %. A frame marks the best law of a row, and a dot
those whose interval overlaps with its own. The colour compares the laws of a row. A click on a cell shows its command.
<p><label>Measure <select id=measure>OPTIONS</select></label><pre id=command>–</pre>TABLES<script>
const choose=()=>document.querySelectorAll('table').forEach(t=>t.classList.toggle('on',t.dataset.key===measure.value));
measure.onchange=choose;choose();
document.onclick=e=>{const td=e.target.closest('td[title]');if(td)command.textContent=td.title;};
</script>"""


def write_page(folder, cells):
    options = "".join(f"<option value={key}>{title}" for key, (title, _, _) in MEASURES.items())
    tables = "\n".join(heat_map(cells, key) for key in MEASURES)
    (folder / "bench.html").write_text(PAGE.replace("OPTIONS", options).replace("TABLES", tables), encoding="utf-8")


def write(folder, files, intervals=False):
    """Makes the files of the table from the studies in `folder` and the rows of `files`; prints it."""
    folder = Path(folder)
    rows = joined(folder, files)
    cells = cells_of(rows)
    write_csv(folder, rows, cells)
    write_page(folder, cells)
    text = "\n\n".join(markdown(cells, key) for key in PRINTED)
    (folder / "bench.md").write_text(f"{text}\n", encoding="utf-8")
    text = with_intervals(cells) if intervals else text
    print(f"\n{text}\n\n{len(rows)} runs: {folder}/bench.html, bench.md, bench.csv, rows.csv")


if __name__ == "__main__":
    try:
        write(sys.argv[1], sys.argv[2:])
    except BenchError as why:
        sys.exit(str(why))
