#!/usr/bin/env python3
"""Draws what `nearfit-bench error --csv FILE` measured, and writes the page that says where each method wins.

See results/README.md beside this file.
"""

import argparse
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent

try:
    import matplotlib  # noqa: F401
    import numpy as np
except ImportError as missing:
    sys.exit(f"{missing}. Install python3-numpy and python3-matplotlib (Debian, Ubuntu), and run this with "
             "/usr/bin/python3.")

sys.dont_write_bytecode = True  # The folder is the repository's.
sys.path[:0] = [str(HERE), str(HERE.parent / "evidence")]
import error_data as data  # noqa: E402
import error_plots as plots  # noqa: E402

TARGETS = (("distance", 1e-2, "1 cm"), ("distance", 1e-3, "1 mm"), ("distance", 1e-4, "0.1 mm"),
           ("force", 1e-1, "10 %"), ("force", 1e-2, "1 %"))


def microseconds(value):
    return "–" if value is None else f"{value:.1f}" if value < 100 else f"{value:.0f}"


def small(value):
    return "0" if value == 0 else f"{value:.2g}"


def table_lines(head, rows):
    return ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)] + [
        "| " + " | ".join(row) + " |" for row in rows]


def best_in_bold(values):
    known = [v for v in values if v is not None]
    return [f"**{microseconds(v)}**" if v is not None and v <= data.MARGIN * min(known) else microseconds(v) for v in values]


def time_tables(table):
    lines = []
    for quantity, target, name in TARGETS:
        what = f"distance to {name}" if quantity == "distance" else f"force to {name} of a spring pressed all the way"
        rows = []
        for pair in table.pairs:
            times = [data.time_to(table.of(pair, m), quantity, target) for m in table.methods]
            rows.append([pair] + best_in_bold(times))
        lines += ["", f"### {what[0].upper()}{what[1:]}", ""] + table_lines(["pair"] + table.methods, rows)
    return lines


def set_tables(table):
    """Missed, spurious and extra minima on the finest mesh."""
    rows = []
    for pair in table.pairs:
        # Methods that are too slow for the finest mesh have no row of it.
        top = max(r["fineness"] for r in table.rows if r["pair"] == pair)
        finest = [next((r for r in table.of(pair, m) if r["fineness"] == top), None) for m in table.methods]
        row = [pair, small(next(r for r in finest if r is not None)["truths"])]
        rows.append(row + ["–" if r is None else f"{small(r['missed'])} / {small(r['spurious'])} / {small(r['extra'])}" for r in finest])
    return table_lines(["pair", "true"] + table.methods, rows)


def order_table(table, method):
    rows = []
    for pair in table.pairs:
        orders = [data.order(table.of(pair, method), q) for q in data.QUANTITIES]
        rows.append([pair] + ["rounding" if o is None else f"{o:.2f}" for o in orders])
    return table_lines(["pair"] + [q for q in data.QUANTITIES], rows)


def span(values, unit):
    low, high = f"{min(values):.2g}", f"{max(values):.2g}"
    return f"{low} {unit}" if low == high else f"{low} to {high} {unit}"


def in_words(errors, unit):
    return "rounding" if max(errors) <= data.FLOOR else span([0.0 if e <= data.FLOOR else e for e in errors], unit)


def exact_times(table, pair, quantity, rows):
    """For each row, the fastest exact method's time for as small an error, in times of the row's; None if it has none so small."""
    exact = [r for m in table.methods if data.is_exact(m) for r in table.of(pair, m)]
    limits = [data.error(r, quantity) * data.MARGIN for r in rows]
    times = [data.time_to(exact, quantity, limit) for limit in limits]
    return [None if t is None else t / r["paid_us"] for t, r in zip(times, rows)]


def win_line(table, pair, quantity, rows):
    _, name, unit, _ = data.QUANTITIES[quantity]
    text = (f"- {pair}, {name}: {rows[0]['method']} at {in_words([data.error(r, quantity) for r in rows], unit)} in "
            f"{span([r['paid_us'] for r in rows], 'µs')}")
    missed, truths = (np.mean([r[k] for r in rows]) for k in ("missed", "truths"))
    if missed > 0:
        return f"{text}, missing {small(missed)} of {small(truths)} minima a pose."
    ratios = exact_times(table, pair, quantity, rows)
    known = [r for r in ratios if r is not None]
    if not known:
        least = min(data.error(r, quantity) for m in table.methods if data.is_exact(m) for r in table.of(pair, m))
        return f"{text}; exact ones come to {least:.3g} {unit}."
    return (f"{text}; exact ones take {span(known, 'times')} as long" +
            (", or do not come to that." if len(known) < len(ratios) else "."))


def is_won(table, pair, quantity, row):
    """True if no exact method is as quick, to within the margin, with as small an error."""
    ratio = exact_times(table, pair, quantity, [row])[0]
    return ratio is None or ratio > data.MARGIN


def won_fronts(table):
    """Parts of fronts that methods hold that are not exact: (where they miss no minimum, where they miss some)."""
    whole, partial = [], []
    for quantity in data.QUANTITIES:
        for pair in table.pairs:
            kept = data.front([r for r in table.rows if r["pair"] == pair], quantity)
            others = [r for r in kept if not data.is_exact(r["method"]) and is_won(table, pair, quantity, r)]
            for method in dict.fromkeys(r["method"] for r in others):
                for found, rows in ((True, whole), (False, partial)):
                    chosen = [r for r in others if r["method"] == method and (r["missed"] == 0) == found]
                    if chosen:
                        rows.append((pair, win_line(table, pair, quantity, chosen)))
    return whole, partial


def win_lines(table):
    whole, partial = won_fronts(table)
    if not whole and not partial:
        return ["Nowhere: each point of each front is an exact method's."]
    pairs = list(dict.fromkeys(pair for pair, _ in whole))
    lines = [f"With no minimum missed, on {', '.join(pairs) if pairs else 'no pair'}:", ""] + [line for _, line in whole]
    if partial:
        lines += ["", "With minima missed; errors but those of force and torque are of the others alone:", ""]
        lines += [line for _, line in partial]
    return lines


def shares(table):
    """Each method's share of all fronts: its points on them, of all points on them."""
    rows = []
    for quantity, (_, name, _, _) in data.QUANTITIES.items():
        points = [r for p in table.pairs for r in data.front([r for r in table.rows if r["pair"] == p], quantity)]
        counts = [sum(r["method"] == m for r in points) for m in table.methods]
        rows.append([name] + [f"{c} of {len(points)}" for c in counts])
    return table_lines(["error of"] + table.methods, rows)


def same_mesh_table(table, base):
    """Times in times of an exact method's, least and greatest over the meshes."""
    others = [m for m in table.methods if not data.is_exact(m)]
    rows = []
    for pair in table.pairs:
        times = {r["fineness"]: r["paid_us"] for r in table.of(pair, base)}
        row = [pair]
        for method in others:
            ratios = [r["paid_us"] / times[r["fineness"]] for r in table.of(pair, method) if r["fineness"] in times]
            text = f"{min(ratios):.2g} to {max(ratios):.2g}"
            row.append(f"**{text}**" if min(ratios) * data.MARGIN < 1 else text)
        rows.append(row)
    return table_lines(["pair"] + others, rows)


def page(table):
    lines = ["# Run time against error", "",
             "Written by `tests/bench/error_page.py` from [error.csv](error.csv), which `nearfit-bench error` measured; "
             "[README.md](README.md#run-time-against-error) says how.", ""]
    lines += [f"    {comment}" for comment in table.comments]
    lines += ["", "![Run time against error](error_headline.png)", "",
              "## Who is on the Pareto front", "",
              "Points (a method on a mesh) that no other beats, over all pairs: one beats another if it is as quick and as near, and more than 2 % "
              "quicker or nearer. Times and errors that differ by less count as equal, and so do errors below 1e-12, which are rounding. "
              "*grouped* drops minima, which the program does only if asked to: it is measured, and stands on no front. "
              + ("Times are medians of an answer and, on average, what another thread does for it: the search ahead of *exact tracked*."
                 if table.pays_for_all_threads else "Times of *exact tracked* leave out the thread that searches ahead."), ""]
    lines += shares(table)
    lines += ["", "## Where a method that is not exact wins", "",
              "Points on a front whose error no exact method has in the same time, to within 2 %.", ""]
    lines += win_lines(table)
    base = next((m for m in table.methods if m == "exact tracked"), table.methods[0])
    lines += ["", "## On the same mesh", "",
              f"Median times in those of \"{base}\", least and greatest over the meshes; bold where the method is the faster "
              "on some mesh, whatever its error.", ""]
    lines += same_mesh_table(table, base)
    lines += ["", "## Least time to an error", "",
              "Median microseconds on the mesh that is the cheapest for the method; the best in bold, – where no mesh will do."]
    lines += time_tables(table)
    lines += ["", "## The set on the finest mesh", "",
              "Missed / spurious / extra minima a pose, beside the number of true ones.", ""]
    lines += set_tables(table)
    exact = next(m for m in table.methods if data.is_exact(m))
    lines += ["", "## Order of convergence", "",
              f"Slope of the error of \"{exact}\" over the longest edge, in logarithms, on meshes of a fineness of "
              f"{data.COARSE} and more.", ""]
    lines += order_table(table, exact)
    lines += ["", "![Errors as meshes grow finer](error_edge.png)", "", "## All pairs", "",
              "![Distance](error_distance.png)", "", "![Force](error_force.png)"]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("csv", type=pathlib.Path, nargs="?", default=HERE / "results" / "error.csv",
                        help="what was measured (%(default)s)")
    parser.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="pictures and page (%(default)s)")
    options = parser.parse_args()
    table = data.read(options.csv)
    options.out.mkdir(parents=True, exist_ok=True)
    plots.headline(table, options.out / "error_headline.png")
    for quantity in ("distance", "force"):
        plots.all_pairs(table, quantity, options.out / f"error_{quantity}.png")
    plots.convergence(table, options.out / "error_edge.png")
    (options.out / "error.md").write_text(page(table))
    return 0


if __name__ == "__main__":
    sys.exit(main())
