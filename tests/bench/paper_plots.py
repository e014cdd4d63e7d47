#!/usr/bin/env python3
"""Draws what `nearfit-bench paper --csv FILE [--samples FILE]` measured: rates beside the paper's, time against cutoff and
triangles, errors of the paper's rule, time against error, and force against time.

    /usr/bin/python3 tests/bench/paper_plots.py paper.csv [--samples paper_force.csv] [--out FOLDER]
"""

import argparse
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

LOOKS = {  # Colour and marker.
    "nearfit-tracked": ("#c0392b", "o"), "nearfit-cold": ("#e08a1e", "s"), "fcl": ("#888888", "^"),
    "paper-spans": ("#1f4e9e", "v"), "paper-cones": ("#1aa6b7", "D"), "exact tracked": ("#c0392b", "o"),
    "exact cold": ("#e08a1e", "s"), "paper spans": ("#1f4e9e", "v"), "paper cones": ("#1aa6b7", "D"),
    "exact grouped": ("#b7950b", "p"), "springs' tick": ("#7d3c98", "P"), "proxy's tick": ("#1e8449", "X"), "printed": ("black", "*"),
    "FCL global distance": ("#888888", "^"),
}
OTHER = ("#b08050", "h")


def read(file):
    """Rows as dictionaries; comment lines are left out."""
    lines = (line for line in file.read_text().splitlines() if not line.startswith("#"))
    return list(csv.DictReader(lines))


def of(rows, **wanted):
    return [r for r in rows if all(r[key] == value for key, value in wanted.items())]


def names(rows, key):
    return list(dict.fromkeys(r[key] for r in rows))


def look(method):
    colour, marker = LOOKS.get(method, OTHER)
    return {"color": colour, "marker": marker}


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(folder / name, dpi=110)
    plt.close(figure)
    print(folder / name)


def draw_rates(rows, folder):
    """Rate of the whole loop of each row of the appendix: median as the mark, slowest hundredth as the end of the line."""
    times = of(rows, part="appendix", quantity="loop [us]")
    rows = of(rows, part="appendix", quantity="loop [Hz]")
    scenes = names(rows, "scene")
    figure, axes = plt.subplots(figsize=(9, 5))
    for method in names(rows, "method"):
        style = look(method)
        for i, scene in enumerate(scenes):
            for r in of(rows, scene=scene, method=method):
                axes.plot(i, float(r["p50"]), ls="", label=method if i == 0 else None, **style)
            for r in of(times, scene=scene, method=method):
                axes.plot([i, i], [1e6 / float(r["p99"]), 1e6 / float(r["p50"])], color=style["color"], lw=1)
    axes.axhline(1000, color="#cccccc", lw=1)
    axes.set_xticks(range(len(scenes)), scenes, rotation=20, ha="right")
    axes.set_yscale("log")
    axes.set_ylabel("query and forces [Hz], median and p99")
    axes.legend(fontsize=8)
    save(figure, folder, "paper_rates.png")


def draw_sweep(rows, folder, part, label):
    """Median time and number of minima against the setting of a sweep."""
    rows = of(rows, part=part)
    scenes = names(rows, "scene")
    if not scenes:
        return
    figure, axes = plt.subplots(2, len(scenes), figsize=(3.6 * len(scenes), 6.5), squeeze=False, sharex=True, sharey="row")
    for i, scene in enumerate(scenes):
        for line, quantity in enumerate(("query [us]", "minima")):
            for method in names(rows, "method"):
                chosen = of(rows, scene=scene, method=method, quantity=quantity)
                if chosen:
                    axes[line][i].plot([float(r["setting"]) for r in chosen], [float(r["p50"]) for r in chosen],
                                       label=method, lw=1, **look(method))
            axes[line][i].set_xscale("log")
            axes[line][i].set_yscale("log" if line == 0 else "symlog")
        axes[0][i].set_title(scene, fontsize=9)
        axes[1][i].set_xlabel(label)
    axes[0][0].set_ylabel("median time of a query [us]")
    axes[1][0].set_ylabel("minima, median")
    axes[0][0].legend(fontsize=7)
    save(figure, folder, f"paper_{part}.png")


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
                axes.plot(x, max(float(r["p50"]), 1e-16), ls="", label=method if i == 0 else None, **style)
                axes.plot([x, x], [max(float(r["p50"]), 1e-16), max(float(r["max"]), 1e-16)], color=style["color"], lw=1)
    axes.set_xticks(range(len(scenes)), scenes, rotation=20, ha="right")
    axes.set_yscale("log")
    axes.set_ylabel("error of the summed force [of the exact one]")
    axes.legend(fontsize=8)
    save(figure, folder, "paper_errors.png")


def on_front(points):
    """Those that no other point is both as quick and as near as; `points` are (time, error, method)."""
    return [p for p in points if not any(q[0] <= p[0] and q[1] <= p[1] and q[:2] != p[:2] for q in points)]


def points_of(rows, scene):
    """(time of all threads, error of the force, method) of each judged method of a row, both means."""
    points = []
    for method in names(of(rows, part="judge", scene=scene, quantity="force error [relative]"), "method"):
        errors = of(rows, part="judge", scene=scene, method=method, quantity="force error [relative]")
        times = of(rows, part="appendix", scene=scene, method=method, quantity="loop and search beside it [us]")
        if errors and times and int(errors[0]["samples"]) > 0:
            points.append((float(times[0]["mean"]), float(errors[0]["mean"]), method))
    return points


def draw_front(rows, folder):
    """Time of all threads against error of the force, a panel a row of the appendix; whoever is on the front is ringed."""
    scenes = [s for s in names(of(rows, part="judge"), "scene") if points_of(rows, s)]
    if not scenes:
        return
    figure, axes = plt.subplots(1, len(scenes), figsize=(3.4 * len(scenes), 3.8), squeeze=False, sharey=True)
    for one, scene in zip(axes[0], scenes):
        points = points_of(rows, scene)
        for time, error, method in points:
            one.plot(time, max(error, 1e-16), ls="", label=method, **look(method))
        for time, error, _ in on_front(points):
            one.plot(time, max(error, 1e-16), "o", ms=14, mfc="none", color="black")
        one.set_xscale("log")
        one.set_yscale("log")
        one.set_title(scene, fontsize=9)
        one.set_xlabel("all threads [us]")
    axes[0][0].set_ylabel("mean error of the force [of the exact one]")
    axes[0][-1].legend(fontsize=7)
    save(figure, folder, "paper_front.png")


def draw_forces(samples, folder):
    """Force against time, a panel for each choice of springs: their scales differ by orders of magnitude."""
    for scene in names(samples, "scene"):
        rows = of(samples, scene=scene)
        modes = names(rows, "mode")
        figure, axes = plt.subplots(len(modes), 1, figsize=(9, 1.5 * len(modes) + 0.6), sharex=True, squeeze=False)
        for one, mode in zip(axes[:, 0], modes):
            chosen = of(rows, mode=mode)
            force = [sum(float(r[k]) ** 2 for k in ("fx", "fy", "fz")) ** 0.5 for r in chosen]
            one.plot([int(r["tick"]) for r in chosen], force, lw=0.8, color="#1f4e9e")
            one.set_ylabel("[N]")
            one.set_title(f"{scene}: {mode}", fontsize=8, loc="left")
        axes[-1][0].set_xlabel("tick [ms]")
        save(figure, folder, f"paper_force_{scene[0]}.png")


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
        draw_forces(read(options.samples), options.out)


if __name__ == "__main__":
    main()
