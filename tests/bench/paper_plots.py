#!/usr/bin/env python3
"""Draws what `nearfit-bench paper --csv FILE [--samples FILE]` measured: rates beside the paper's, time against cutoff and
triangles, errors of the paper's rule, time against error, and force and its change against time.

    /usr/bin/python3 tests/bench/paper_plots.py paper.csv [--samples paper_force.csv] [--out FOLDER]
"""

import argparse
import csv
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sys.dont_write_bytecode = True  # The folder is the repository's.
HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "resources" / "scripts" / "figure_sources"), str(HERE.parent / "evidence")]
import fronts  # noqa: E402
from plots import shrink  # noqa: E402

LOOKS = {  # Colour and marker.
    "nearfit-tracked": ("#c0392b", "o"), "nearfit-cold": ("#e08a1e", "s"), "fcl": ("#888888", "^"),
    "paper-spans": ("#1f4e9e", "v"), "paper-cones": ("#1aa6b7", "D"), "exact tracked": ("#c0392b", "o"),
    "exact cold": ("#e08a1e", "s"), "paper spans": ("#1f4e9e", "v"), "paper cones": ("#1aa6b7", "D"),
    "grouped": ("#b7950b", "p"), "springs' tick": ("#7d3c98", "P"), "proxy's tick": ("#1e8449", "X"), "printed": ("black", "*"),
    "FCL global distance": ("#888888", "^"),
}
OTHER = ("#b08050", "h")
# Grouping drops minima: what it leaves is no exact set, though it is measured under that name.
NAMES = {"exact grouped": "grouped"}
# The paper's methods answer a fraction of the poses: counts of minima along a path are of other poses than the exact ones'.
FEWER_POSES = ("paper-spans", "paper-cones")


def read(file):
    """Rows as dictionaries; comment lines are left out."""
    lines = (line for line in file.read_text().splitlines() if not line.startswith("#"))
    rows = list(csv.DictReader(lines))
    for row in rows:
        for key in ("method", "mode"):
            if key in row:
                row[key] = NAMES.get(row[key], row[key])
    return rows


def of(rows, **wanted):
    return [r for r in rows if all(r[key] == value for key, value in wanted.items())]


def names(rows, key):
    return list(dict.fromkeys(r[key] for r in rows))


def look(method):
    colour, marker = LOOKS.get(method, OTHER)
    return {"color": colour, "marker": marker}


def legend_below(figure, axes, columns):
    """One legend under all panels, where it covers none of them; returns the share of the height that it takes."""
    entries = {label: handle for one in axes for handle, label in zip(*one.get_legend_handles_labels())}
    figure.legend(entries.values(), entries.keys(), loc="lower center", ncol=columns, fontsize=8, frameon=False)
    lines = -(-len(entries) // columns)
    return (0.1 + 0.2 * lines) / figure.get_figheight()


def save(figure, folder, name, bottom=0.0):
    figure.tight_layout(rect=(0, bottom, 1, 1))
    figure.savefig(folder / name, dpi=110)
    plt.close(figure)
    shrink(folder / name)
    print(folder / name)


def draw_rates(rows, folder):
    """Rate of the whole loop of each row of the appendix: median as the mark, slowest tick as the end of the line."""
    times = of(rows, part="appendix", quantity="loop [us]")
    rows = of(rows, part="appendix", quantity="loop [Hz]")
    scenes = names(rows, "scene")
    figure, axes = plt.subplots(figsize=(9, 5))
    methods = names(rows, "method")
    for k, method in enumerate(methods):
        style = look(method)
        for i, scene in enumerate(scenes):
            x = i + 0.08 * (k - len(methods) / 2)
            for r in of(rows, scene=scene, method=method):
                axes.plot(x, float(r["p50"]), ls="", label=method if i == 0 else None, **style)
            for r in of(times, scene=scene, method=method):
                axes.plot([x, x], [1e6 / float(r["max"]), 1e6 / float(r["p50"])], color=style["color"], lw=1)
    axes.axhline(1000, color="#cccccc", lw=1)
    axes.set_xticks(range(len(scenes)), scenes, rotation=20, ha="right")
    axes.set_yscale("log")
    axes.set_ylabel("query and forces [Hz], median to slowest")
    save(figure, folder, "paper_rates.png", legend_below(figure, [axes], 5))


def draw_sweep(rows, folder, part, label):
    """Median time of all methods, and number of minima of the exact ones, against the setting of a sweep."""
    rows = of(rows, part=part)
    scenes = names(rows, "scene")
    if not scenes:
        return
    figure, axes = plt.subplots(2, len(scenes), figsize=(3.6 * len(scenes), 6.5), squeeze=False, sharex=True, sharey="row")
    for i, scene in enumerate(scenes):
        for line, quantity in enumerate(("query [us]", "minima")):
            for method in names(rows, "method"):
                chosen = of(rows, scene=scene, method=method, quantity=quantity)
                if not chosen or (quantity == "minima" and method in FEWER_POSES):
                    continue
                name = f"{method}, of fewer poses" if method in FEWER_POSES else method
                axes[line][i].plot([float(r["setting"]) for r in chosen], [float(r["p50"]) for r in chosen], label=name, lw=1,
                                   **look(method))
            axes[line][i].set_xscale("log")
            axes[line][i].set_yscale("log" if line == 0 else "symlog")
        axes[0][i].set_title(scene, fontsize=9)
        axes[1][i].set_xlabel(label)
    axes[0][0].set_ylabel("median time of a query [us]")
    axes[1][0].set_ylabel("exact minima, median")
    save(figure, folder, f"paper_{part}.png", legend_below(figure, axes[0], 3 if len(scenes) < 3 else 5))


def draw_errors(rows, folder):
    """Error of force at the judged poses: median as the mark, greatest as the end of the line."""
    rows = of(rows, part="judge", quantity="force error [relative]")
    scenes = names(rows, "scene")
    if not scenes:
        return
    figure, axes = plt.subplots(figsize=(9, 4.5))
    methods = names(rows, "method")
    for k, method in enumerate(methods):
        style = look(method)
        for i, scene in enumerate(scenes):
            for r in of(rows, scene=scene, method=method):
                x = i + 0.12 * (k - len(methods) / 2)
                axes.plot(x, max(float(r["p50"]), fronts.FLOOR), ls="", label=method if i == 0 else None, **style)
                axes.plot([x, x], [max(float(r[p]), fronts.FLOOR) for p in ("p50", "max")], color=style["color"], lw=1)
    axes.set_xticks(range(len(scenes)), scenes, rotation=20, ha="right")
    axes.set_yscale("log")
    axes.set_ylabel("error of the summed force [of the exact one]")
    save(figure, folder, "paper_errors.png", legend_below(figure, [axes], 6))


def points_of(rows, scene):
    """(time of all threads, error of the force, method) of each judged method of a row, both means."""
    points = []
    for method in names(of(rows, part="judge", scene=scene, quantity="force error [relative]"), "method"):
        errors = of(rows, part="judge", scene=scene, method=method, quantity="force error [relative]")
        # A pair that is judged alone has its times there.
        times = [r for r in of(rows, scene=scene, method=method, quantity="loop and search beside it [us]")
                 if r["part"] in ("appendix", "judge")]
        if errors and times and int(errors[0]["samples"]) > 0:
            points.append((float(times[0]["mean"]), float(errors[0]["mean"]), method))
    return points


def draw_front(rows, folder):
    """Time of all threads against error of the force, a panel a row of the appendix; whoever is on the front is ringed."""
    scenes = [s for s in names(of(rows, part="judge"), "scene") if points_of(rows, s)]
    if not scenes:
        return
    columns = min(4, -(-len(scenes) // 2))
    lines = -(-len(scenes) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(4.2 * columns, 3.5 * lines), squeeze=False, sharey=True)
    for spare in axes.flat[len(scenes):]:
        spare.axis("off")
    for one, scene in zip(axes.flat, scenes):
        points = points_of(rows, scene)
        for time, error, method in points:
            one.plot(time, max(error, fronts.FLOOR), ls="", label=method, alpha=0.8, **look(method))
        for time, error, _ in fronts.front(points):
            one.plot(time, max(error, fronts.FLOOR), "o", ms=14, mfc="none", color="black")
        one.set_xscale("log")
        one.set_yscale("log")
        one.margins(0.12)
        one.set_title(scene, fontsize=9)
        one.set_xlabel("all threads [us]")
    figure.supylabel("mean error of the force [of the exact one]", fontsize=10)
    save(figure, folder, "paper_front.png", legend_below(figure, axes.flat, 6))


def changes(force):
    """Length of the change of the force vector in each tick but the first, so that a turn without a change of length shows [N]."""
    return [sum((b - a) ** 2 for a, b in zip(before, after)) ** 0.5 for before, after in zip(force, force[1:])]


def stands_out(change):
    """Ticks whose change is more than 0.01 N and ten times the median of the ten around: a jump, or a quick motion."""
    found = []
    for i, value in enumerate(change):
        around = change[max(0, i - 5):i] + change[i + 1:i + 6]
        if value > 0.01 and value > 10 * statistics.median(around):
            found.append(i)
    return found


def jumps_in_words(rows, scene, mode):
    """Jumps found by halving the motion of the largest changes, from the file of figures."""
    found = {r["quantity"]: r for r in of(rows, part="arguments", scene=scene, method=mode)}
    if "ticks with a jump" not in found:
        return "jumps not examined"
    jumps, examined = (round(float(found[q]["p50"])) for q in ("ticks with a jump", "ticks examined for one"))
    if examined == 0:
        return "no tick to examine: no change above 0.01 N"
    return (f"jumps in {jumps} of {examined} ticks examined" +
            (f", the largest {float(found['jump of force [N]']['max']):.2g} N" if jumps else ""))


def draw_forces(rows, samples, folder):
    """Components of the force, and its change a tick, a line of panels for each choice of springs."""
    for scene in names(samples, "scene"):
        chosen = of(samples, scene=scene)
        modes = names(chosen, "mode")
        figure, axes = plt.subplots(len(modes), 2, figsize=(13, 1.55 * len(modes) + 0.8), sharex=True, squeeze=False)
        for (left, right), mode in zip(axes, modes):
            mine = of(chosen, mode=mode)
            ticks = [int(r["tick"]) for r in mine]
            force = [[float(r[k]) for k in ("fx", "fy", "fz")] for r in mine]
            for k, (name, colour) in enumerate(zip("xyz", ("#c0392b", "#1e8449", "#1f4e9e"))):
                left.plot(ticks, [f[k] for f in force], lw=0.9, color=colour, label=f"force along {name}")
            change = changes(force)
            marked = stands_out(change)
            right.plot(ticks[1:], [max(c, 1e-5) for c in change], lw=0.7, color="#555555", label="change of the force vector in a tick")
            right.plot([ticks[i + 1] for i in marked], [change[i] for i in marked], "o", ms=4, mfc="none", color="#c0392b",
                       label="more than 0.01 N and ten times the median of the ten ticks around: a jump or a quick motion")
            right.set_yscale("log")
            left.set_ylabel("[N]")
            left.set_title(mode, fontsize=9, loc="left")
            right.set_title(jumps_in_words(rows, scene, mode), fontsize=9, loc="left")
        for one in axes[-1]:
            one.set_xlabel("tick [ms]")
        figure.suptitle(f"{scene}: force on one path, and its change", fontsize=11)
        save(figure, folder, f"paper_force_{scene[0]}.png", legend_below(figure, axes[0], 5))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", type=pathlib.Path)
    parser.add_argument("--samples", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent / "results")
    options = parser.parse_args()
    rows = read(options.csv)
    if not rows or "quantity" not in rows[0]:
        sys.exit(f"{options.csv}: not a file of `nearfit-bench paper --csv`")
    if of(rows, part="appendix"):
        draw_rates(rows, options.out)
    draw_errors(rows, options.out)
    draw_front(rows, options.out)
    draw_sweep(rows, options.out, "cutoff", "cutoff [of the larger body's diagonal]")
    draw_sweep(rows, options.out, "triangles", "triangles of both meshes")
    if options.samples:
        draw_forces(rows, read(options.samples), options.out)


if __name__ == "__main__":
    main()
