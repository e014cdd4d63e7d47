"""Hand paths: one pose a millisecond, the same on every machine.

A hand is described by where it takes the part from its home pose: a shift [m] of a pivot that the part
carries, and a turn about that pivot (axis times angle [rad]), both in the world's axes.
"""

import numpy as np

TICK = 1e-3  # [s]


def ease(share):
    """Rises from 0 to 1 with velocity and acceleration zero at both ends."""
    x = np.clip(share, 0.0, 1.0)
    return x**3 * (10 - 15 * x + 6 * x**2)


def quaternion(turns):
    """Unit quaternions (w first) of rotation vectors, a row each."""
    turns = np.atleast_2d(turns)
    angle = np.linalg.norm(turns, axis=1)
    half_sinc = 0.5 * np.sinc(angle / (2 * np.pi))
    return np.column_stack([np.cos(angle / 2), turns * half_sinc[:, None]])


def multiply(a, b):
    """Products of quaternions, row by row."""
    a, b = np.atleast_2d(a), np.atleast_2d(b)
    w = a[:, :1] * b[:, :1] - np.sum(a[:, 1:] * b[:, 1:], axis=1, keepdims=True)
    return np.column_stack([w, a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] + np.cross(a[:, 1:], b[:, 1:])])


def conjugate(q):
    return np.atleast_2d(q) * np.array([1.0, -1.0, -1.0, -1.0])


def rotate(q, v):
    """Vectors turned by quaternions, row by row; either may be a single one."""
    q, v = np.broadcast_arrays(np.atleast_2d(q), np.column_stack([np.zeros(len(np.atleast_2d(v))), np.atleast_2d(v)]))
    return multiply(multiply(q, v), conjugate(q))[:, 1:]


def rotation_vector(q):
    """Axis times angle, the shorter way round."""
    q = np.where(np.atleast_2d(q)[:, :1] < 0, -np.atleast_2d(q), np.atleast_2d(q))
    length = np.linalg.norm(q[:, 1:], axis=1)
    angle = 2 * np.arctan2(length, q[:, 0])
    scale = np.divide(angle, length, out=np.full_like(angle, 2.0), where=length > 1e-12)
    return q[:, 1:] * scale[:, None]


class Home:
    """The pose that a part is led from: world from part."""

    def __init__(self, position=(0, 0, 0), turn=(0, 0, 0), pivot=(0, 0, 0)):
        """`pivot` is given in the part's own coordinates [m]."""
        self.position = np.array(position, float)
        self.rotation = quaternion(np.array(turn, float))[0]
        self.pivot = np.array(pivot, float)
        self.pivot_in_world = self.position + rotate(self.rotation, self.pivot)[0]

    def poses(self, shifts, turns):
        """Rows of tx, ty, tz, qw, qx, qy, qz."""
        rotation = multiply(quaternion(turns), self.rotation)
        return np.column_stack([self.pivot_in_world + shifts - rotate(rotation, self.pivot), rotation])

    def shifts_and_rotations(self, poses):
        """What `poses` was made of; the turns as quaternions."""
        poses = np.atleast_2d(poses)
        shifts = poses[:, :3] + rotate(poses[:, 3:], self.pivot) - self.pivot_in_world
        return shifts, multiply(poses[:, 3:], conjugate(self.rotation))


class Hand:
    """Puts a path together from named phases."""

    def __init__(self, shift=(0, 0, 0), turn=(0, 0, 0)):
        self._rows = [np.concatenate([shift, turn]).astype(float)[None, :]]
        self.phases = []  # (name, first tick, tick after the last)

    @property
    def ticks(self):
        return sum(len(rows) for rows in self._rows)

    @property
    def here(self):
        return self._rows[-1][-1]

    def _add(self, name, rows):
        first = self.ticks
        self._rows.append(np.asarray(rows, float))
        if name:
            self.phases.append((name, first, self.ticks))
        return self

    def move(self, name, seconds, shift=None, turn=None):
        """Goes to a shift and turn, smoothly; to where it is in what is not given."""
        goal = self._goal(shift, turn)
        share = ease(np.arange(1, round(seconds / TICK) + 1) * TICK / seconds)[:, None]
        return self._add(name, self.here + share * (goal - self.here))

    def glide(self, name, seconds, shift=None, turn=None):
        """The same at a steady speed, with a start and an end of a tenth of the time each."""
        goal = self._goal(shift, turn)
        x = np.arange(1, round(seconds / TICK) + 1) * TICK / seconds
        ramp = 0.1
        share = np.where(x < ramp, x**2 / (2 * ramp),
                         np.where(x > 1 - ramp, 1 - ramp - (1 - x)**2 / (2 * ramp), x - ramp / 2)) / (1 - ramp)
        return self._add(name, self.here + share[:, None] * (goal - self.here))

    def hold(self, name, seconds):
        return self._add(name, np.repeat(self.here[None, :], round(seconds / TICK), axis=0))

    def wiggle(self, name, seconds, shift=(0, 0, 0), turn=(0, 0, 0), hertz=(1, 1, 1)):
        """Sways about where it is; a frequency for each of the axes. Begins and ends at rest."""
        t = np.arange(1, round(seconds / TICK) + 1) * TICK
        window = ease(t / (0.15 * seconds)) * ease((seconds - t) / (0.15 * seconds))
        waves = window[:, None] * np.sin(2 * np.pi * np.outer(t, hertz))
        return self._add(name, self.here + np.column_stack([waves * np.array(shift), waves * np.array(turn)]))

    def teleport(self, name, shift=None, turn=None, hold=0.1):
        return self._add(name, np.repeat(self._goal(shift, turn)[None, :], round(hold / TICK), axis=0))

    def walk(self, name, rows):
        """Any rows of shift and turn."""
        return self._add(name, rows)

    def _goal(self, shift, turn):
        goal = self.here.copy()
        if shift is not None:
            goal[:3] = shift
        if turn is not None:
            goal[3:] = turn
        return goal

    def rows(self):
        rows = np.concatenate(self._rows)
        return rows[:, :3], rows[:, 3:]


def _random_direction(random):
    v = random.standard_normal(3)
    return v / np.linalg.norm(v)


def adversary(seed, size, start, reach, ticks=20000):
    """A hand that means ill.

    @param size   Of the bodies [m]: what shakes and steps go by.
    @param start  First shift [m], where the part is free.
    @param reach  Half the box [m] that the hand roams in, by axis, about a shift of 0.
    """
    random = np.random.default_rng(seed)
    reach = np.array(reach, float)
    hand = Hand(shift=start)

    def anywhere():
        return random.uniform(-1, 1, 3) * reach

    def turn():
        return _random_direction(random) * random.uniform(0, np.pi)

    def impact():
        # Across the scene and back, 2 m/s all the way but for a few ticks.
        for _ in range(2):
            goal = anywhere()
            seconds = max(0.02, np.linalg.norm(goal - hand.here[:3]) / (0.9 * 2.0))
            hand.glide("", round(seconds, 3), goal)
            hand.hold("", 0.06)

    def teleports():
        for _ in range(6):
            hand.teleport("", anywhere(), turn(), random.uniform(0.02, 0.12))

    def shake():
        hand.move("", 0.1, 0.5 * anywhere())
        hand.wiggle("", 0.8, 0.1 * size * _random_direction(random), 0.5 * _random_direction(random),
                    (20, 20, 20))

    def spin():
        hand.move("", 0.1, 0.4 * anywhere())
        turns = hand.here[3:] + np.outer(np.arange(1, 601) * TICK, 2 * np.pi * 8 * _random_direction(random))
        hand.walk("", np.column_stack([np.repeat(hand.here[None, :3], 600, axis=0), turns]))

    def stray():
        step = 0.01 * size
        rows = [hand.here]
        for _ in range(800):
            row = rows[-1] + np.concatenate([random.normal(0, step, 3), random.normal(0, 0.05, 3)])
            row[:3] = np.clip(row[:3], -reach, reach)
            rows.append(row)
        hand.walk("", rows[1:])

    def press():
        hand.move("", 0.2, 0.2 * anywhere())
        hand.hold("", 0.5)  # The part may be far behind.
        hand.hold("still", 0.5)

    def leave():
        hand.move("", 0.25, start)
        hand.hold("away", 0.6)

    while hand.ticks < ticks:
        for deed, name in ((impact, "impacts"), (teleports, "teleports"), (shake, "shaking"), (spin, "spin"),
                           (stray, "random walk"), (press, "press"), (leave, "leave")):
            first = hand.ticks
            deed()
            hand.phases.append((name, first, hand.ticks))
    return hand
