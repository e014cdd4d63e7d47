"""Tables of what was found: text for the terminal, CSV and Markdown for keeping."""

import collections
import csv
import json
import pathlib
import subprocess
from dataclasses import dataclass

import numpy as np

import plots


@dataclass
class Result:
    evidence: object
    row: dict
    findings: list
    doubts: list

    @property
    def is_good(self):
        return self.row["poses_met"] in (0, "") and all(f.is_met for f in self.findings)


def revision(root):
    """The last commit that touched what was run."""
    command = ["git", "-C", str(root), "log", "-1", "--format=%h", "--", "core", "app", "device"]
    return subprocess.run(command, capture_output=True, text=True).stdout.strip()


def _processor(head):
    return next(line.partition(": ")[2] for line in head if line.startswith("processor: "))


def draw(evidence, recording, row, file):
    met = "not certified" if row["poses_met"] == "" else (
        f"{row['poses_met']} of {row['poses_certified']} poses meet the scene (exact predicates)")
    subtitle = (f"{evidence.name}: margin {1e3 * evidence.margin:g} mm, cutoff {1e3 * evidence.cutoff:g} mm, "
                f"{row['ticks']} ticks; {met}")
    plots.draw(evidence, recording, subtitle, file)


NOTHING = 1e-9  # What is less is rounding: of lengths [m], forces [N] and torques [N m] alike.


def number(value):
    if isinstance(value, (str, int)):
        return str(value)
    return "0" if abs(value) < NOTHING else f"{value:.4g}"


def times(row, name):
    """p50, p99, p99.9 and the longest of a column."""
    return ", ".join(f"{float(row[f'{name}_{part}']):.4g}" for part in ("p50", "p99", "p99.9", "max")
                     if row[f"{name}_{part}"] != "")


def drag(row):
    """Drag at p50 and p99, and how many of the ticks that slide have more than is allowed."""
    if not int(row["ticks_sliding"] or 0):
        return "does not slide"
    return (f"{100 * float(row['drag_p50']):.2g}, {100 * float(row['drag_p99']):.2g}, "
            f"{row['ticks_dragging']} of {row['ticks_sliding']}")


def text(result):
    row = result.row
    lines = [f"== {row['scene']}: {row['ticks']} ticks, met {row['poses_met']} of {row['poses_certified']}, "
             f"least {row['least_distance_margins']:.3g} margins, shortened {row['ticks_shortened']}, refused "
             f"{row['ticks_refused']}, wrench {times(row, 'wrench_us')} us, tick {times(row, 'tick_us')} us, behind in "
             f"{row['ticks_behind']} ticks, drag p50 {number(row['drag_p50'])} p99 {number(row['drag_p99'])}, beyond 2 % in "
             f"{row['ticks_dragging']} of {row['ticks_sliding']} ticks, noise at rest {number(row['rest_noise_N'])} N, steps in "
             f"{row['ticks_at_rest_that_step']} of {row['ticks_at_rest']} ticks at rest"]
    for f in result.findings:
        lines.append(f"   {'ok ' if f.is_met else 'NOT'} {f.goal.text}: {number(f.value)} "
                     f"({f.goal.low:.6g} to {f.goal.high:.6g})")
    kinds = {}
    for what, tick, value in result.doubts:
        kinds.setdefault(what, []).append((tick, value))
    for what, hits in kinds.items():
        worst = max(hits, key=lambda h: h[1])
        lines.append(f"   ?   {what}: {len(hits)} times, first at {1e-3 * hits[0][0]:.3f} s, worst "
                     f"{worst[1]:.3g} at {1e-3 * worst[0]:.3f} s")
    return "\n".join(lines)


def _merged(file, results):
    """Rows that are kept of scenes that did not run this time."""
    rows = {}
    if file.exists():
        with open(file, newline="") as old:
            rows = {r["scene"]: r for r in csv.DictReader(line for line in old if not line.startswith("#"))}
    rows.update({r.row["scene"]: {k: number(v) for k, v in r.row.items()} for r in results})
    return rows


def _goals(file, results):
    kept = json.loads(file.read_text()) if file.exists() else {}
    for r in results:
        kept[r.row["scene"]] = [
            {"what": f.goal.text, "value": float(number(f.value)), "met": bool(f.is_met)} for f in r.findings]
    return kept


def write(results, folder, head):
    """`head`: lines that describe machine, compiler, revision and load of this run; rows of others name their own revision."""
    from scenes import all_evidence
    names = [e.name for e in all_evidence()]
    rows = _merged(folder / "evidence.csv", results)
    goals = _goals(folder / "goals.json", results)
    order = [name for name in names if name in rows]
    fields = list(results[0].row) if results else []
    with open(folder / "evidence.csv", "w", newline="") as out:
        out.writelines(f"# {line}\n" for line in head)
        writer = csv.DictWriter(out, fields, extrasaction="ignore", restval="")
        writer.writeheader()
        writer.writerows(rows[name] for name in order)
    (folder / "goals.json").write_text(json.dumps({n: goals[n] for n in order if n in goals}, indent=1) + "\n")
    (folder / "README.md").write_text(markdown(head, [rows[n] for n in order], goals, {e.name: e for e in all_evidence()}))


def markdown(head, rows, goals, evidence):
    lines = ["# What the proxy did", "",
             "Written by `tests/evidence/run`, which says how; [../README.md](../README.md) tells what is shown.", "",
             f"Machine: {_processor(head)}. Revision and load (1 min) stand in [evidence.csv](evidence.csv), a row a scene.", "",
             "| scene | ticks | poses that meet | margin [mm] | least distance [margins] | ticks shortened | refused | "
             "noise at rest [N] | ticks at rest that step | ticks behind | drag p50, p99 [%], ticks beyond 2 % | wrench p50, p99, p99.9, longest [us] | "
             "tick p50, p99, p99.9, longest [us] |",
             "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"]
    for row in rows:
        r = collections.defaultdict(str, row)  # An older row may lack a column.
        lines.append(f"| [{r['scene']}]({r['scene']}.png) | {r['ticks']} | {r['poses_met']} of {r['poses_certified']} | "
                     f"{1e3 * float(r['margin_m']):g} | {r['least_distance_margins']} | {r['ticks_shortened']} | "
                     f"{r['ticks_refused']} | {r['rest_noise_N']} | "
                     f"{r['ticks_at_rest_that_step']} of {r['ticks_at_rest']} | {r['ticks_behind']} | {drag(r)} | "
                     f"{times(r, 'wrench_us')} | {times(r, 'tick_us')} |")
    for r in rows:
        lines += ["", f"## {evidence[r['scene']].title}", ""]
        for goal in goals.get(r["scene"], []):
            lines.append(f"- {'' if goal['met'] else '**not so:** '}{goal['what']}: {goal['value']:g}")
        lines += ["", f"![{r['scene']}]({r['scene']}.png)"]
    return "\n".join(lines) + "\n"
