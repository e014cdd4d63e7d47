"""What a recording says: poses seen from home, goals, suspicions, times."""

import csv
from dataclasses import dataclass

import numpy as np

from paths import conjugate, multiply, rotate, rotation_vector

WINDOW = 60    # Ticks for which a part must stand, while the hand moves on, to be looked at.
STOOD = 1e-6   # What moves less in a window stands [m].
LED = 2e-3     # What moves more in a window moves on [m].
SLIDES = 2e-5  # What moves faster in contact slides [m a tick]: 0.02 m/s.
DRAGS = 0.02   # A larger share of the wrench along the way is drag.
PRESSES = 0.5  # What pushes harder presses [N].
SETTLING = 150  # Ticks that noise at rest is given to die.


@dataclass
class Inertia:
    """Of a part [m]."""
    radius: float       # Of a sphere that holds it, roughly.
    centre: np.ndarray  # Of mass, in the part's own coordinates.
    gyration: float     # Mean radius of gyration.


class Recording:
    """Columns of a recording by name, and its poses as shift and turn from home."""

    def __init__(self, file, home, axis, inertia):
        with open(file, newline="") as text:
            names = next(csv.reader(text))
        data = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)
        self._columns = {name: data[:, i] for i, name in enumerate(names)}
        self.handle_shift, self.handle_rotation = home.shifts_and_rotations(self._pose("handle"))
        self.proxy_shift, self.proxy_rotation = home.shifts_and_rotations(self._pose("proxy"))
        self.handle_twist, self.handle_tilt = twist_and_tilt(self.handle_rotation, axis)
        self.proxy_twist, self.proxy_tilt = twist_and_tilt(self.proxy_rotation, axis)
        self.proxy_twist += nearest_turns(self.handle_twist[0] - self.proxy_twist[0])
        self.force = np.column_stack([self[f"force_{a}"] for a in "xyz"])
        self.torque = np.column_stack([self[f"torque_{a}"] for a in "xyz"])
        self.lag = np.linalg.norm(self.handle_shift - self.proxy_shift, axis=1)
        self.turn_lag = np.linalg.norm(
            rotation_vector(multiply(self.handle_rotation, conjugate(self.proxy_rotation))), axis=1)
        self.drag = self._drag(inertia)

    def __getitem__(self, name):
        return self._columns[name]

    def __len__(self):
        return len(self["t_s"])

    def _drag(self, inertia):
        """Of each tick in which the part slides under pressure: the share of the wrench that is along the way which the
        part goes, from 0 to 1; else NaN. Lengths in the metric of mass: a turn counts by the mean radius of gyration.

        What holds a part without friction is square to the way that it is free to go, so that a share beyond rounding
        is drag, or the part has come free and catches up.
        """
        poses, g = self._pose("proxy"), inertia.gyration
        centre = poses[:, :3] + rotate(poses[:, 3:], inertia.centre)
        turn = rotation_vector(multiply(poses[1:, 3:], conjugate(poses[:-1, 3:])))
        way = np.concatenate([np.zeros((1, 6)), np.column_stack([np.diff(centre, axis=0), g * turn])])
        wrench = np.column_stack([self.force, self.torque / g])
        going, pressing = np.linalg.norm(way, axis=1), np.linalg.norm(wrench, axis=1)
        held = self["contacts"] > 0
        slides = held & np.concatenate([[False], held[:-1]]) & (going > SLIDES) & (pressing > PRESSES)
        share = np.full(len(held), np.nan)
        share[slides] = np.abs(np.sum(way * wrench, axis=1)[slides]) / (going * pressing)[slides]
        return share

    def _pose(self, which):
        return np.column_stack([self[f"{which}_{c}"] for c in ("tx", "ty", "tz", "qw", "qx", "qy", "qz")])


def twist_and_tilt(rotations, axis):
    """Turn about a world axis, unwrapped, and how far that axis of the part leans [rad]."""
    about = rotations[:, 1 + axis]
    twist = np.unwrap(2 * np.arctan2(about, rotations[:, 0]))
    lean = np.hypot(rotations[:, 0], about)
    return twist, 2 * np.arccos(np.clip(lean, 0.0, 1.0))


def nearest_turns(angle):
    return 2 * np.pi * np.round(angle / (2 * np.pi))


@dataclass
class Finding:
    goal: object
    value: float

    @property
    def is_met(self):
        return self.goal.low <= self.value <= self.goal.high


def find_goals(evidence, recording):
    phases = evidence.hand.phases + [("", 0, len(recording))]
    return [Finding(goal, max((_value(goal, recording, first, end) for name, first, end in phases
                               if name == goal.phase), key=lambda v: abs(v - _middle(goal))))
            for goal in evidence.goals]


def _middle(goal):
    """The worst of several phases is farthest from here."""
    if np.isfinite(goal.low) and np.isfinite(goal.high):
        return (goal.low + goal.high) / 2
    return goal.high - 1e9 if np.isfinite(goal.high) else goal.low + 1e9


def _value(goal, recording, first, end):
    last = end - 1
    if goal.kind == "end":
        return recording.proxy_shift[last, goal.axis]
    if goal.kind == "along":
        return float(recording.proxy_shift[last] @ np.array(goal.axis))
    if goal.kind == "gap":
        return recording.lag[last]
    if goal.kind == "released":
        return float((recording["released"][first:end] > 0).mean())
    if goal.kind == "held":
        return float((recording["contacts"][first:end] > 0).mean())
    if goal.kind == "twist":
        return recording.proxy_twist[last]
    if goal.kind in ("lag", "slip"):
        apart = (recording.handle_shift - recording.proxy_shift)[first:end, goal.axis]
        if goal.kind == "slip":
            apart = apart - apart[0]
        return apart[np.argmax(np.abs(apart))]
    if goal.kind == "truncated":
        return float((recording["truncated"][first:end] > 0).mean())
    if goal.kind == "drag":
        return float(np.nan_to_num(recording.drag[first:end]).max())
    if goal.kind == "lead":
        twist = recording.proxy_twist[first:end]
        chosen = np.abs(twist - twist[-1]) < 2 * np.pi
        slope = np.polyfit(twist[chosen], recording.proxy_shift[first:end, 2][chosen], 1)[0]
        return slope * 2 * np.pi
    raise ValueError(f"no goal is of kind {goal.kind}")


def _travel(shift, rotation, radius):
    turn = rotation_vector(multiply(rotation[1:], conjugate(rotation[:-1])))
    return np.linalg.norm(np.diff(shift, axis=0), axis=1) + radius * np.linalg.norm(turn, axis=1)


def suspicions(recording, radius):
    """Times at which something looks wrong: a list of (what, first tick, value), worst first of each kind."""
    found = []
    proxy = np.concatenate([[0.0], _travel(recording.proxy_shift, recording.proxy_rotation, radius)])
    hand = np.concatenate([[0.0], _travel(recording.handle_shift, recording.handle_rotation, radius)])

    # Sticks: stands though the hand goes on. A straight push does that too: the plot tells.
    stands = np.convolve(proxy, np.ones(WINDOW), "valid") < STOOD
    led = np.convolve(hand, np.ones(WINDOW), "valid") > LED
    for k in _starts(stands & led):
        found.append(("stands for 60 ms while the hand moves on: pushed straight, or stuck [m]", k, recording.lag[k]))

    # Jumps: the part moves much farther than the hand did of late.
    of_late = np.convolve(hand, np.ones(20), "full")[:len(hand)]
    jump = proxy - of_late
    for k in _starts(jump > 1e-4):
        found.append(("moves farther in a tick than the hand in 20 [m]", k, proxy[k]))

    # Buzzes: the hand has been still for a while, the wrench is not.
    still = at_rest(recording)
    change = np.concatenate([[0.0], np.linalg.norm(np.diff(recording.force, axis=0), axis=1)])
    for k in _starts(still & (change > 0.01)):
        found.append(("force changes by more than 0.01 N in a tick at rest", k, change[k]))
    return found


def at_rest(recording):
    """Of each tick, whether the hand has been still for a while."""
    hand = np.concatenate([[0.0], np.abs(np.diff(recording.handle_shift, axis=0)).max(axis=1)
                           + np.abs(np.diff(recording.handle_rotation, axis=0)).max(axis=1)])
    still = np.convolve(hand > 1e-12, np.ones(SETTLING), "full")[:len(hand)] == 0
    still[:SETTLING] = False
    return still


def rest_noise(recording):
    """Greatest change of force [N] and torque [N m] in a tick while the hand has been still for a while."""
    still = at_rest(recording)
    if not still.any():
        return float("nan"), float("nan")
    force = np.linalg.norm(np.diff(recording.force, axis=0, prepend=recording.force[:1]), axis=1)
    torque = np.linalg.norm(np.diff(recording.torque, axis=0, prepend=recording.torque[:1]), axis=1)
    return force[still].max(), torque[still].max()


def _starts(flags):
    flags = np.concatenate([[False], flags])
    return np.flatnonzero(flags[1:] & ~flags[:-1])


def _percentile(values, percent):
    known = values[np.isfinite(values)]
    return np.percentile(known, percent) if len(known) else float("nan")


def summary(evidence, recording):
    """The row of the table."""
    force_noise, torque_noise = rest_noise(recording)
    distance = recording["distance"][recording["released"] == 0]  # What is not felt may come as near as it likes.
    near = distance[distance < 2 * evidence.margin]
    row = {
        "scene": evidence.name,
        "ticks": len(recording),
        "margin_m": evidence.margin,
        "least_distance_margins": distance.min() / evidence.margin,
        "p1_near_margins": np.percentile(near, 1) / evidence.margin if len(near) else float("nan"),
        "ticks_in_contact": int((recording["contacts"] > 0).sum()),
        "ticks_shortened": int((recording["shortened"] > 0).sum()),
        "ticks_refused": int((recording["refused"] > 0).sum()),
        "ticks_behind": int((recording["behind"] > 0).sum()),
        "ticks_late": int((recording["late_bodies"] > 0).sum()),
        "ticks_released": int((recording["released"] > 0).sum()),
        "most_sub_steps": int(recording["sub_steps"].max()),
        "most_constraints": int(recording["constraints"].max()),
        "ticks_at_rest": int(at_rest(recording).sum()),
        "ticks_at_rest_that_step": int((at_rest(recording) & (recording["sub_steps"] > 0)).sum()),
        "ticks_sliding": int(np.isfinite(recording.drag).sum()),
        "ticks_dragging": int((np.nan_to_num(recording.drag) > DRAGS).sum()),
        "drag_p50": _percentile(recording.drag, 50),
        "drag_p99": _percentile(recording.drag, 99),
        "peak_force_N": np.linalg.norm(recording.force, axis=1).max(),
        "peak_torque_Nm": np.linalg.norm(recording.torque, axis=1).max(),
        "rest_noise_N": force_noise,
        "rest_noise_Nm": torque_noise,
        "most_energy_J": recording["energy"].max(),
    }
    for name in ("wrench_us", "tick_us", "proxy_us", "query_us"):
        for percent in (50, 99, 99.9):
            row[f"{name}_p{percent}"] = np.percentile(recording[name], percent)
        row[f"{name}_max"] = recording[name].max()
    return row
