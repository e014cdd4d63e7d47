#!/usr/bin/env python3
"""Draws what `nearfit-bench-window hour --csv FILE` measured, memory and lateness by the minute:

    /usr/bin/python3 tests/bench/hour_plot.py window_hour.csv window_hour.png
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

LATENESS = (("late_p50_us", "p50", "#1e8449"), ("late_p99_us", "p99", "#1f4e9e"), ("late_p99_9_us", "p99.9", "#e08a1e"),
            ("late_max_us", "max", "#c0392b"))


def rows(path):
    with open(path, newline="") as file:
        return [{key: float(value) for key, value in row.items()}
                for row in csv.DictReader(line for line in file if not line.startswith("#"))]


def main(source, picture):
    data = rows(source)
    minutes = [row["minute"] for row in data]
    figure, (memory, lateness) = plt.subplots(2, 1, figsize=(9, 6.5), sharex=True)
    memory.plot(minutes, [row["memory_MB"] for row in data], color="#7d3c98")
    memory.set_ylim(0, 1.2 * max(row["memory_MB"] for row in data))
    memory.set_ylabel("resident memory [MB]")
    for column, name, colour in LATENESS:
        lateness.plot(minutes, [max(row[column], 0.1) for row in data], label=name, color=colour)
    lateness.set_yscale("log")
    lateness.set_ylabel("lateness of ticks [us]")
    lateness.set_xlabel("wall clock [min]")
    lateness.legend(fontsize=8, ncol=4, loc="upper center", bbox_to_anchor=(0.5, -0.16), frameon=False)  # Below the data.
    for panel in (memory, lateness):
        panel.grid(True, which="both", alpha=0.25)
    figure.suptitle("The demo in the scripted hand, its window open")
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
