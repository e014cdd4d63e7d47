"""One plot a scene: where hand and part were, what was felt, how near it was, what it cost."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

COLOURS = ("#c0392b", "#1e8449", "#1f4e9e")
GREY = "#888888"
MOST_POINTS = 2500  # A long recording is drawn by the least and greatest of each few ticks.


def _thin(t, *series):
    """The same curves with fewer points, none of whose peaks is lost."""
    step = int(np.ceil(len(t) / (MOST_POINTS / 2)))
    if step <= 2:
        return (t,) + series
    count = len(t) // step
    kept = []
    for y in series:
        block = y[:count * step].reshape(count, step)
        kept.append(np.column_stack([np.fmin.reduce(block, axis=1), np.fmax.reduce(block, axis=1)]).ravel())
    times = t[:count * step].reshape(count, step)
    return (np.column_stack([times[:, 0], times[:, step // 2]]).ravel(),) + tuple(kept)


def _positions(axes, r, t):
    for i, name in enumerate("xyz"):
        times, hand, part = _thin(t, 1e3 * r.handle_shift[:, i], 1e3 * r.proxy_shift[:, i])
        axes.plot(times, hand, color=COLOURS[i], lw=0.7, ls=":", alpha=0.9)
        axes.plot(times, part, color=COLOURS[i], lw=1.1, label=f"{name} of the part")
    axes.plot([], [], color=GREY, ls=":", label="hand")
    axes.set_ylabel("shift from home [mm]")


def _angles(axes, r, t, axis):
    degrees = 180 / np.pi
    for colour, name, hand, part in ((COLOURS[0], f"twist about {'xyz'[axis]}", r.handle_twist, r.proxy_twist),
                                     (COLOURS[2], "tilt of that axis", r.handle_tilt, r.proxy_tilt)):
        times, hand, part = _thin(t, degrees * hand, degrees * part)
        axes.plot(times, hand, color=colour, lw=0.7, ls=":")
        axes.plot(times, part, color=colour, lw=1.1, label=f"{name}, part")
    axes.plot([], [], color=GREY, ls=":", label="hand")
    axes.set_ylabel("turn from home [deg]")


def _lags(axes, r, t):
    """Where a hand turns in all directions, only how far the part is behind tells something."""
    times, turned = _thin(t, 180 / np.pi * r.turn_lag)
    axes.plot(times, turned, color=COLOURS[0], lw=0.8, label="part from hand, turn [deg]")
    times, lag = _thin(t, 1e3 * r.lag)
    axes.plot(times, lag, color=COLOURS[2], lw=0.8, label="part from hand, shift [mm]")
    axes.set_ylabel("lag [deg], [mm]")


def _wrench(axes, r, t):
    for i, name in enumerate("xyz"):
        times, force = _thin(t, r.force[:, i])
        axes.plot(times, force, color=COLOURS[i], lw=0.8, label=f"force {name}")
    axes.set_ylabel("force on the hand [N]")
    twin = axes.twinx()
    times, torque = _thin(t, 1e3 * np.linalg.norm(r.torque, axis=1))
    twin.plot(times, torque, color="#8e44ad", lw=0.7, alpha=0.8)
    axes.plot([], [], color="#8e44ad", lw=0.7, label="torque (right)")
    twin.set_ylabel("torque, length [mN m]")
    twin.set_ylim(bottom=0)


def _distance(axes, r, t, margin):
    # While something is overlapped the least of all minima says nothing of how near it is.
    distance = np.where(np.isfinite(r["distance"]) & (r["released"] == 0), r["distance"], np.nan)
    is_bound = r["distance_bound"] > 0
    for chosen, colour, label in ((~is_bound, COLOURS[2], "least distance"), (is_bound, "#d68910", "at least")):
        times, shown = _thin(t, 1e3 * np.where(chosen, distance, np.nan))
        axes.semilogy(times, shown, color=colour, lw=0.8, label=label)
    axes.axhline(1e3 * margin, color=COLOURS[0], lw=0.8, ls="--", label=f"margin {1e3 * margin:g} mm")
    axes.set_ylabel("distance [mm]")


def _cost(axes, r, t):
    times, steps, tick, wrench = _thin(t, r["sub_steps"], r["tick_us"], r["wrench_us"])
    axes.plot(times, steps, color=COLOURS[1], lw=0.7, label="sub-steps")
    for name, colour, mark in (("shortened", "#d68910", "v"), ("refused", COLOURS[0], "x")):
        hit = r[name] > 0
        axes.plot(t[hit], r["sub_steps"][hit], mark, color=colour, ms=3,
                  label=f"{name}: {int(hit.sum())} ticks")
    axes.set_ylabel("sub-steps a tick")
    twin = axes.twinx()
    twin.semilogy(times, tick, color=GREY, lw=0.6, alpha=0.8)
    twin.semilogy(times, wrench, color=COLOURS[2], lw=0.6, alpha=0.8)
    axes.plot([], [], color=GREY, lw=0.6, label="tick time (right)")
    axes.plot([], [], color=COLOURS[2], lw=0.6, label="time until the wrench (right)")
    twin.set_ylabel("time [us]")


def _released(all_axes, r, t):
    """Grey where the part overlaps something that it does not feel."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], (r["released"] > 0).astype(int), [0]])))
    for first, end in zip(edges[::2], edges[1::2]):
        for axes in all_axes:
            axes.axvspan(t[first], t[end - 1], color="#e8e8e8", zorder=-1)


def _phases(figure, all_axes, phases, last):
    named = [p for p in phases if p[0] not in ("still", "away")]
    for axes in all_axes:
        for _, first, _ in named:
            axes.axvline(1e-3 * first, color="#dddddd", lw=0.5, zorder=0)
    if len(named) > 24:
        return
    for k, (name, first, end) in enumerate(named):
        if first < last:
            all_axes[0].text(5e-4 * (first + min(end, last)), 1.01, name, rotation=40, fontsize=7, ha="left",
                             va="bottom", transform=all_axes[0].get_xaxis_transform())


def draw(evidence, recording, subtitle, file):
    figure, axes = plt.subplots(5, 1, figsize=(11, 13), sharex=True, height_ratios=(1.4, 1, 1.2, 1, 1))
    t = recording["t_s"]
    _positions(axes[0], recording, t)
    if evidence.name.startswith("pair-"):
        _lags(axes[1], recording, t)
    else:
        _angles(axes[1], recording, t, evidence.axis)
    _wrench(axes[2], recording, t)
    _distance(axes[3], recording, t, evidence.margin)
    _cost(axes[4], recording, t)
    axes[4].set_xlabel("time [s]")
    _released(axes, recording, t)
    for one in axes:
        one.grid(True, color="#eeeeee", lw=0.5)
        one.legend(loc="upper left", fontsize=7, ncol=5, framealpha=0.8)
        one.margins(x=0.005)
    _phases(figure, axes, evidence.hand.phases, len(recording))
    figure.suptitle(f"{evidence.title}\n{subtitle}", fontsize=11, y=0.995)
    figure.tight_layout(rect=(0, 0, 1, 0.985))
    figure.savefig(file, dpi=80)
    plt.close(figure)
    shrink(file)


def shrink(file):
    """To a palette, where Pillow is there: a third of the size."""
    try:
        from PIL import Image
    except ImportError:
        return
    with Image.open(file) as image:
        image.convert("RGB").quantize(160).save(file, optimize=True)
