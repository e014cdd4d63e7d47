"""Pictures of run time against error, and of error against the length of edges."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

import error_data as data
from plots import COLOURS, GREY, shrink  # Lies in tests/evidence.

INK, PALE, FRONT = "#333333", "#e9e9e9", "#f2dc9b"
STYLES = {  # Colour, marker, line.
    "exact tracked": (COLOURS[0], "o", "-"),
    "exact cold": ("#e08a1e", "s", "-"),
    "grouped": ("#7d3c98", "D", "--"),
    "normal span": (COLOURS[1], "v", "-"),
    "float leaves": ("#1aa6b7", "P", "-"),
    "decimated 4x": ("#7b5b3a", "X", "-"),
    "decimated 16x": ("#c2569b", "<", "-"),
    "points in field 32": ("#b3b3b3", ">", "-"),
    "points in field 64": ("#808080", ">", "-"),
    "points in field 128": ("#404040", ">", "-"),
    "FCL global distance": (COLOURS[2], "^", "-"),
}
MORE = [("#9a9a2a", "h", "-"), ("#a34a28", "p", "-")]
HEADLINE = {"sphere-sphere": "one contact", "ellipsoid-plane": "one contact, on a floor",
            "sphere-nest": "three contacts", "sphere-bowl": "surfaces that nearly conform"}
MICROSECONDS = "median time of a query [µs]"


def styles(table):
    spare = iter(MORE * 4)
    return {m: STYLES.get(m) or next(spare) for m in table.methods}


def _curve(axes, rows, quantity, style):
    colour, marker, line = style
    x, y = [r["paid_us"] for r in rows], [data.error(r, quantity) for r in rows]
    sizes = np.linspace(5, 34, max(len(rows), 2))[:len(rows)]
    filled = "none" if line == "--" else colour
    for row, e in zip(rows, y):
        axes.plot([row["paid_us"], row["paid_p99_us"]], [e, e], color=colour, lw=0.6, alpha=0.35, zorder=2)
    axes.plot(x, y, line, color=colour, lw=1.3, zorder=3)
    axes.scatter(x, y, s=sizes, marker=marker, facecolors=filled, edgecolors=colour, linewidths=1.0, zorder=4)


def _front(axes, rows, quantity):
    """Everything above and to the right of it is beaten."""
    kept = data.front([r for r in rows if np.isfinite(data.error(r, quantity))], quantity)
    x, y = [r["paid_us"] for r in kept], [data.error(r, quantity) for r in kept]
    axes.step(x + [1e9], y + y[-1:], where="post", color=FRONT, lw=4.5, zorder=1, solid_capstyle="round")


def _panel(axes, table, looks, pair, quantity):
    rows = [r for r in table.rows if r["pair"] == pair]
    axes.set_xscale("log")
    axes.set_yscale("log")
    _front(axes, rows, quantity)
    for method, style in looks.items():
        _curve(axes, table.of(pair, method), quantity, style)
    times = [r["paid_us"] for r in rows] + [r["paid_p99_us"] for r in rows]
    errors = [data.error(r, quantity) for r in rows if np.isfinite(data.error(r, quantity))]
    axes.set_xlim(min(times) / 1.5, max(times) * 1.5)
    axes.set_ylim(min(errors) / 3, max(errors) * 3)
    if max(errors) <= data.FLOOR:
        axes.set_ylim(data.FLOOR / 10, 1e3 * data.FLOOR)
        axes.text(0.97, 0.93, "rounding alone", transform=axes.transAxes, ha="right", va="top", fontsize=9, color=GREY)
    axes.set_axisbelow(True)
    axes.grid(True, which="major", color=PALE, lw=0.7)
    axes.tick_params(which="both", labelsize=8, colors=INK)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def _legend_entries(looks):
    entries = [Line2D([], [], color=c, marker=m, ls=line, ms=5.5, markerfacecolor="none" if line == "--" else c,
                      label=name)
               for name, (c, m, line) in looks.items()]
    entries.append(Line2D([], [], color=FRONT, lw=4.5, label="Pareto front"))
    entries.append(Line2D([], [], color=GREY, lw=0.8, alpha=0.6, label="from the median to p99"))
    return entries


def _save(figure, file):
    figure.savefig(file, dpi=110)
    plt.close(figure)
    shrink(file)


def headline(table, file):
    """Four pairs, distance and force: what error.md shows first."""
    looks = styles(table)
    pairs = [p for p in HEADLINE if p in table.pairs]
    figure, axes = plt.subplots(2, len(pairs), figsize=(3.6 * len(pairs), 7.4), squeeze=False)
    for column, pair in enumerate(pairs):
        for row, (quantity, label) in enumerate((("distance", "error of distance [m]"),
                                                 ("force", "error of force [share of a full spring]"))):
            _panel(axes[row][column], table, looks, pair, quantity)
            if column == 0:
                axes[row][column].set_ylabel(label, fontsize=9)
        axes[0][column].set_title(f"{pair}\n{HEADLINE[pair]}", fontsize=10.5, color=INK)
        axes[1][column].set_xlabel(MICROSECONDS, fontsize=9)
    figure.suptitle("Run time against error: each curve is one method, each point a mesh, the larger the finer",
                    fontsize=12, color=INK, y=0.985)
    entries = _legend_entries(looks)
    figure.legend(handles=entries, loc="lower center", ncol=min(len(entries), 7), fontsize=9, frameon=False)
    figure.tight_layout(rect=(0, 0.045 + 0.03 * ((len(entries) - 1) // 7), 1, 0.975), h_pad=1.6)
    _save(figure, file)


def all_pairs(table, quantity, file):
    looks = styles(table)
    columns = 4
    lines = -(-(len(table.pairs) + 1) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(3.5 * columns, 2.9 * lines), squeeze=False)
    flat = list(axes.flat)
    for pair, one in zip(table.pairs, flat):
        _panel(one, table, looks, pair, quantity)
        one.set_title(pair, fontsize=10, color=INK)
    for one in flat[len(table.pairs):]:
        one.axis("off")
    flat[len(table.pairs)].legend(handles=_legend_entries(looks), loc="center left", fontsize=9, frameon=False)
    _, name, unit, _ = data.QUANTITIES[quantity]
    figure.suptitle(f"Run time against the error of {name}, root mean square over random poses; larger points: finer meshes",
                    fontsize=12, color=INK)
    figure.supxlabel(MICROSECONDS, fontsize=10)
    figure.supylabel(f"error of {name} [{unit}]", fontsize=10)
    figure.tight_layout(rect=(0.005, 0.005, 1, 0.99))
    _save(figure, file)


def _guide(axes, slope, edges, errors):
    """A line of that slope under the curves."""
    x = np.array([min(edges), max(edges)])
    below = 0.5 * min(e / (edge / x[0]) ** slope for edge, e in zip(edges, errors))
    y = below * (x / x[0]) ** slope
    axes.plot(x, y, color=INK, lw=1.2, ls=":", zorder=5)
    middle = x[0] ** 0.45 * x[1] ** 0.55
    axes.annotate(f"slope {slope}", (middle, below * (middle / x[0]) ** slope), xytext=(8, -12),
                  textcoords="offset points", fontsize=9, color=INK)


def _falling(axes, table, method, quantity, colours):
    _, _, _, slope = data.QUANTITIES[quantity]
    edges, errors = [], []
    for pair, colour in colours.items():
        rows = table.of(pair, method)
        y = [data.error(r, quantity) for r in rows]
        if not np.nanmax(y) > data.FLOOR:
            continue
        x = [r["edge_m"] for r in rows]
        axes.loglog(x, y, color=colour, marker="o", ms=3.2, lw=1.3)
        edges += x
        errors += y
    _guide(axes, slope, edges, errors)
    axes.set_xlabel("longest edge [m]", fontsize=9)
    axes.grid(True, which="major", color=PALE, lw=0.7)
    axes.tick_params(which="both", labelsize=8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def convergence(table, file):
    """Errors of the exact engine against the edges' length."""
    panels = [("exact cold", "distance", "distance [m]"), ("exact cold", "position", "position [m]"),
              ("exact cold", "direction", "direction [rad]"), ("exact cold", "force", "force [N], a spring each minimum"),
              ("grouped", "force", "force [N], a spring each group")]
    panels = [p for p in panels if p[0] in table.methods]
    smooth = [p for p in table.pairs if max(r["position_rms_m"] for r in table.of(p, panels[0][0])) > data.FLOOR]
    colours = dict(zip(smooth, plt.get_cmap("tab20")(np.arange(20) % 20)))
    figure, axes = plt.subplots(1, len(panels), figsize=(3.7 * len(panels), 4.9))
    for one, (method, quantity, title) in zip(axes, panels):
        _falling(one, table, method, quantity, colours)
        one.set_title(title, fontsize=10.5, color=INK)
    axes[-1].set_ylim(axes[-2].get_ylim())
    entries = [Line2D([], [], color=c, marker="o", ms=4, label=pair) for pair, c in colours.items()]
    figure.legend(handles=entries, loc="lower center", ncol=6, fontsize=9, frameon=False)
    figure.suptitle("Errors of the exact minima as meshes grow finer; floors have no error of direction",
                    fontsize=12, color=INK)
    figure.tight_layout(rect=(0, 0.11, 1, 0.99))
    _save(figure, file)
