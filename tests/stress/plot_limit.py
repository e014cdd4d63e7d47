#!/usr/bin/env python3
"""Draws what `nearfit-stress limit` prints: python3 plot_limit.py limit.csv limit.png"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def rows(path):
    with open(path, newline="") as file:
        table = csv.DictReader(line for line in file if not line.startswith("#"))
        # Of the proxy; older tables have no other mode, and no column for it.
        return [{key: float(value) for key, value in row.items() if key != "mode"}
                for row in table if row.get("mode", "proxy") == "proxy"]


def main(source, picture):
    data = rows(source)
    dampings = sorted({row["damping N s/m"] for row in data})
    colours = dict(zip(dampings, plt.cm.viridis([0.05 + 0.85 * i / (len(dampings) - 1) for i in range(len(dampings))])))
    figure, panels = plt.subplots(1, 2, figsize=(11, 5), sharey=True)
    for panel, has_rendered in zip(panels, (False, True)):
        for damping in dampings:
            chosen = [r for r in data if r["damping N s/m"] == damping and r["mass kg"] == 0.2
                      and (r["coupling damping N s/m"] > 0) == has_rendered]
            chosen.sort(key=lambda r: r["period ms"])
            periods = [r["period ms"] for r in chosen]
            panel.plot(periods, [r["enforced N/m"] for r in chosen], "-", color=colours[damping],
                       label=f"b = {damping:g} N s/m")
            panel.plot(periods, [r["simulated N/m"] for r in chosen], "o", color=colours[damping], mfc="none")
            light = [r for r in data if r["damping N s/m"] == damping and r["mass kg"] == 0.05
                     and (r["coupling damping N s/m"] > 0) == has_rendered]
            panel.plot([r["period ms"] for r in light], [r["simulated N/m"] for r in light], "+",
                       color=colours[damping])
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_xlabel("servo period [ms]")
        panel.set_title("B = 0.2 b rendered" if has_rendered else "no rendered damping")
        panel.grid(True, which="both", alpha=0.25)
    panels[0].set_ylabel("stiffness [N/m]")
    panels[0].set_ylim(top=2e5)  # Room for the legend.
    panels[1].legend(loc="upper right", title="lines: enforced\no: simulated, 0.2 kg\n+: simulated, 0.05 kg", fontsize=8)
    figure.suptitle("Largest stable stiffness of a device that leans on a wall, and what is enforced")
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
