"""The scenes, their hands, and what must come of each.

Poses and files are those of the shared models' README; lengths in metres, turns as axis times angle [rad].
"""

from dataclasses import dataclass, field
from typing import Callable, Optional

import dense
import numpy as np
from paths import Hand, Home, adversary

DEGREE = np.pi / 180
NO_TURN = (0.0, 0.0, 0.0)


@dataclass
class Body:
    name: str
    file: str
    metres_per_unit: float = 1.0
    position: tuple = (0.0, 0.0, 0.0)
    turn: tuple = NO_TURN
    make: Optional[Callable] = None  # Of the mesh that goes into the file, where it is none of the shared models.


@dataclass
class Goal:
    """A number that the recording must hold: see measures.py for how each kind is found."""
    text: str
    kind: str
    phase: str  # Empty for all of the recording.
    low: float = -np.inf
    high: float = np.inf
    axis: int = 2


@dataclass
class Evidence:
    name: str
    title: str
    part: Body
    others: list
    margin: float
    cutoff: float
    hand: Hand
    pivot: tuple = (0.0, 0.0, 0.0)  # In the part's coordinates, after scaling.
    axis: int = 2                   # Of the world: what "twist" is about.
    goals: list = field(default_factory=list)
    begins_overlapped: bool = False  # Drawn so: certified are the ticks in which nothing is released.

    @property
    def home(self):
        return Home(self.part.position, self.part.turn, self.pivot)


HOLE_TOP = 0.009


def _peg(name, title, peg, hole, margin, twist, shape):
    """Home is the peg as drawn: through the hole, its lower end at z = 0."""
    hand = Hand(shift=(0.003, -0.002, 0.016), turn=(3 * DEGREE, -2 * DEGREE, 3 * DEGREE))
    hand.move("rim, off and tilted", 0.7, (0.003, -0.002, HOLE_TOP - 0.002))
    hand.hold("still on the rim", 0.4)
    hand.move("lifted, aligned", 0.5, (0.0, 0.0, HOLE_TOP + 0.0005), NO_TURN)
    hand.move("slides in", 0.8, (0.0, 0.0, 0.0))
    hand.hold("still inside", 0.3)
    hand.wiggle("wiggles", 1.0, (0.001, 0.001, 0.0), (4 * DEGREE, 4 * DEGREE, 0), (3, 4, 3))
    hand.move("pushed aside", 0.3, (0.003, 0.001, 0.0))
    hand.hold("still aside", 0.4)
    hand.glide("slides down aside", 0.3, (0.003, 0.001, -0.010))
    hand.move("pushed other way", 0.3, (-0.003, -0.002, -0.010))
    hand.move("twisted", 0.5, (0.0, 0.0, -0.010), (0, 0, twist))
    hand.hold("still twisted", 0.3)
    hand.move("back", 0.4, (0.0, 0.0, -0.010), NO_TURN)
    hand.move("pulled out tilted", 0.8, (0.0005, 0.0, 0.016), (2 * DEGREE, 0, 0))
    hand.hold("still outside", 0.3)
    goals = [
        Goal("rests on the rim, tilted", "end", "still on the rim", low=HOLE_TOP - 5e-4),
        Goal("is inside", "end", "still inside", low=-1e-4, high=1e-4),
        Goal("slides down with the hand while pushed aside: hand less part, axially", "lag", "slides down aside",
             low=-5e-4, high=5e-4),
        Goal("is out again, where the hand is: gap", "gap", "still outside", high=1e-6),
    ]
    turned = Goal("turns with the hand [rad]", "twist", "still twisted", low=twist - 0.02, high=twist + 0.02)
    if shape == "rectangular":
        turned = Goal("is kept from turning by the hole [rad]", "twist", "still twisted", high=0.2)
    return Evidence(
        name, title, Body("peg", f"peghole/{peg}.obj"), [Body("hole", f"peghole/{hole}.obj")], margin, 0.001,
        hand, pivot=(0, 0, 0.025), goals=goals + [turned])


def _peg_askew():
    """Pressed while it is brought over the hole, an edge falls in first: it wedges, as pegs do, and must come free."""
    hand = Hand(shift=(0.0006, -0.0004, 0.016), turn=(3 * DEGREE, -2 * DEGREE, 3 * DEGREE))
    hand.move("rim, off and tilted", 0.7, (0.0006, -0.0004, HOLE_TOP - 0.002))
    hand.move("aligned while pressed", 0.5, (0.0, 0.0, HOLE_TOP - 0.0015), NO_TURN)
    hand.move("pressed", 0.6, (0.0, 0.0, 0.0))
    hand.hold("still, pressed", 0.5)
    hand.move("pressed askew", 0.6, (-0.003, -0.002, -0.010), (0, 0, 0.8))
    hand.hold("still, askew", 0.5)
    hand.move("pulled up", 0.6, (0.0, 0.0, 0.016), NO_TURN)
    hand.hold("still outside", 0.3)
    return Evidence(
        "peg-askew", "Rectangular peg of 12 mm, pressed before it is aligned: wedges and comes free",
        Body("peg", "peghole/factory_rectangular_peg_12mm_loose_subdiv_3x.obj"),
        [Body("hole", "peghole/factory_rectangular_hole_12mm_subdiv_3x.obj")], 2e-5, 0.001, hand,
        pivot=(0, 0, 0.025), goals=[Goal("comes free: gap", "gap", "still outside", high=1e-6)])


def _pegs():
    loose, tight = ("factory_rectangular_peg_12mm_loose_subdiv_3x", "factory_rectangular_peg_12mm_tight_subdiv_3x")
    hole = "factory_rectangular_hole_12mm_subdiv_3x"
    return [
        _peg("peg-round", "Round peg of 16 mm in its hole, 0.26 mm gap", "factory_round_peg_16mm_loose",
             "factory_round_hole_16mm_subdiv_3x", 5e-5, 0.8, "round"),
        _peg("peg-rectangular-loose", "Rectangular peg of 12 mm, loose, gap about 0.1 mm", loose, hole, 2e-5, 0.8,
             "rectangular"),
        _peg("peg-rectangular-tight", "Rectangular peg of 12 mm, tight, gap about 0.07 mm", tight, hole, 1e-5, 0.8,
             "rectangular"),
        _peg_askew(),
    ]


NUT = Body("nut", "nutbolt/factory_nut_m16_loose_subdiv_3x.obj")
BOLT = Body("bolt", "nutbolt/factory_bolt_m16_loose.obj")
PITCH = 0.002


def _nut_engaged():
    """Home is the nut as drawn; 10 mm up it is engaged and free."""
    def turns(n):
        return (0, 0, 2 * np.pi * n)

    hand = Hand(shift=(0, 0, 0.010))
    hand.hold("still", 0.2)
    hand.move("pushed 10 mm down", 0.5, (0, 0, 0.0))
    hand.hold("still, pushed", 0.4)
    hand.move("pulled 10 mm up", 0.6, (0, 0, 0.020))
    hand.hold("still, pulled", 0.4)
    hand.move("let go", 0.3, (0, 0, 0.010))
    hand.glide("wound down 2 turns", 10.0, (0, 0, 0.010 - 2 * PITCH - 0.0003), turns(-2))
    hand.hold("still, wound", 0.3)
    hand.wiggle("wiggles", 0.6, (0.0015, 0.0015, 0.001), (3 * DEGREE, 3 * DEGREE, 0), (4, 5, 3))
    hand.glide("wound up 1 turn", 5.0, (0, 0, 0.010 - PITCH + 0.0003), turns(-1))
    hand.hold("still, wound up", 0.3)
    return Evidence(
        "nut-engaged", "M16 nut on its bolt: pushed, pulled, wound", NUT, [BOLT], 2e-5, 0.00015, hand,
        pivot=(0, 0, 0.0225), goals=[
            Goal("pushed axially it does not advance", "end", "still, pushed", low=0.0092, high=0.0101),
            Goal("pulled axially it does not come off", "end", "still, pulled", low=0.0099, high=0.0108),
            Goal("wound by 2 turns it advances by 4 mm", "end", "still, wound", low=0.0057, high=0.0061),
            Goal("twist after 2 turns [rad]", "twist", "still, wound", low=-4.01 * np.pi, high=-3.99 * np.pi),
            Goal("wound back by a turn it goes up by 2 mm", "end", "still, wound up", low=0.0079, high=0.0083),
        ])


def _nut_on():
    """From off the bolt, tilted; the thread is found, wound on, and holds when pulled."""
    hand = Hand(shift=(0.0008, -0.0005, 0.028), turn=(2 * DEGREE, -1.5 * DEGREE, 0.0))
    hand.move("onto the end, tilted", 0.6, (0.0008, -0.0005, 0.0227))
    hand.move("aligned", 0.3, (0, 0, 0.0227), NO_TURN)
    hand.hold("still on the end", 0.3)
    hand.glide("wound on 3 turns", 6.0, (0, 0, 0.0227 - 2.5 * PITCH), (0, 0, -6 * np.pi))
    hand.hold("still, wound on", 0.3)
    hand.move("pulled hard", 0.5, (0, 0, 0.0300))
    hand.hold("still, pulled", 0.3)
    return Evidence(
        "nut-on", "M16 nut, from off the bolt: wound on, pulled", NUT, [BOLT], 2e-5, 0.00015, hand,
        pivot=(0, 0, 0.0225), goals=[
            Goal("rests on the bolt's end", "end", "still on the end", low=0.0228, high=0.0262),
            Goal("winds in by the pitch: height by turn, over the last turn [m]", "lead", "wound on 3 turns",
                 low=0.985 * PITCH, high=1.015 * PITCH),
            Goal("holds when pulled", "end", "still, pulled", low=0.0175, high=0.0225),
        ])


TEETH = 0.010  # Height above the seat at which the teeth begin to mesh.


def _gear():
    """Home is the small gear as drawn, on its shaft and in mesh with the middle gear."""
    hand = Hand(shift=(0.0008, 0.0005, 0.024), turn=(2 * DEGREE, -1.5 * DEGREE, 0.1))
    hand.move("shaft's end, off and tilted", 0.6, (0.0003, 0.0003, 0.0185))
    hand.hold("still on the end", 0.3)
    hand.move("aligned", 0.4, (0, 0, 0.0185), (0, 0, 0.1))
    hand.move("down to the teeth", 0.8, (0, 0, TEETH - 0.001), (0, 0, 0.15))
    hand.hold("still on the teeth", 0.3)
    hand.wiggle("searches", 1.0, (0.0002, 0.0002, 0), (0, 0, 0.1), (3, 4, 2))
    hand.move("turned into mesh", 0.3, turn=NO_TURN)
    hand.move("down", 0.8, (0, 0, -0.002))
    hand.hold("still, seated", 0.4)
    hand.wiggle("rocked between the flanks", 1.0, (0.0005, 0.0005, 0), (1 * DEGREE, 1 * DEGREE, 0.2), (3, 4, 2))
    hand.move("turned hard", 0.3, turn=(0, 0, 0.5))
    hand.hold("still, turned", 0.3)
    hand.move("eased", 0.3, turn=NO_TURN)
    hand.move("pulled off", 0.8, (0, 0, 0.024))
    hand.hold("still, off", 0.3)
    return Evidence(
        "gear-base", "Small gear onto its shaft (13 um gap) and into mesh", Body(
            "small gear", "gears/factory_gear_small_space_5e-4.obj"),
        [Body("base", "gears/factory_gear_base_loose_space_5e-4_subdiv_4x.obj"),
         Body("middle gear", "paper_counts/gear_6302.ply")], 5e-6, 0.00005, hand, pivot=(0.0505, 0, 0.015), goals=[
            Goal("rests on the shaft's end", "end", "still on the end", low=0.0185),
            Goal("rests on the other gear's teeth", "end", "still on the teeth", low=TEETH - 1e-4, high=TEETH + 5e-4),
            Goal("is seated on the plate", "end", "still, seated", low=0.0, high=1e-4),
            Goal("is kept from turning by the other gear [rad]", "twist", "still, turned", low=-0.1, high=0.1),
            Goal("is off, where the hand is: gap", "gap", "still, off", high=1e-6),
        ])


PISTON_SCALE = 1e-4  # Of the millimetres that it is drawn in: a crank of 200 mm.


def _piston_part(name, position=(0, 0, 0)):
    return Body(name, f"piston/{name}.stl", PISTON_SCALE, position)


def _piston_head():
    """Home is the head as drawn; it comes along y, and the cylinder is open towards +y."""
    hand = Hand(shift=(0.0020, 0.085, 0.0015), turn=(2 * DEGREE, 0, -2 * DEGREE))
    hand.move("rim, off and tilted", 0.7, (0.0030, 0.073, 0.0025))
    hand.hold("still on the rim", 0.4)
    hand.move("aligned", 0.5, (0.0, 0.076, 0.0), NO_TURN)
    hand.move("slides in", 1.0, (0.0, 0.0, 0.0))
    hand.hold("still inside", 0.3)
    hand.wiggle("wiggles", 1.0, (0.002, 0, 0.002), (3 * DEGREE, 0, 3 * DEGREE), (3, 4, 5))
    hand.move("pushed aside", 0.3, (0.004, 0.0, 0.002))
    hand.hold("still aside", 0.3)
    hand.glide("slides aside at 0.5 m/s", 0.1, (0.004, 0.045, 0.002))
    hand.glide("and back", 0.1, (0.004, 0.0, 0.002))
    hand.move("twisted", 0.5, (0.0, 0.0, 0.0), (0, 1.5, 0))
    hand.move("on to the other end", 0.6, (0.0, -0.070, 0.0), (0, 1.5, 0))
    hand.hold("still at the other end", 0.3)
    hand.move("pulled out", 0.9, (0.0, 0.085, 0.0), NO_TURN)
    hand.hold("still outside", 0.3)
    return Evidence(
        "piston-head", "Piston head into its cylinder, 0.3 to 0.5 mm gap (at a tenth of its size)",
        _piston_part("head"), [_piston_part("cylinder")], 5e-5, 0.002, hand, pivot=(0, -0.17, 0.023), axis=1, goals=[
            Goal("rests on the rim", "end", "still on the rim", low=0.0745, axis=1),
            Goal("is inside", "end", "still inside", low=-1e-4, high=1e-4, axis=1),
            Goal("keeps up while sliding: hand less part, axially", "lag", "slides aside at 0.5 m/s", low=-2e-4,
                 high=2e-4, axis=1),
            Goal("turns with the hand [rad]", "twist", "twisted", low=1.48, high=1.52),
            Goal("goes along with the hand to the other end", "end", "still at the other end", low=-0.0701, high=-0.0699,
                 axis=1),
            Goal("is out again, where the hand is: gap", "gap", "still outside", high=1e-6),
        ])


def _piston_cylinder():
    """The cylinder in hand goes over the head, with rod and crank behind it: all four parts."""
    hand = Hand(shift=(0.0008, -0.080, 0.0005), turn=(2 * DEGREE, 0, -2 * DEGREE))
    hand.move("head, off and tilted", 0.6, (0.0012, -0.072, 0.0008))
    hand.hold("still on the head", 0.3)
    hand.move("aligned", 0.4, (0.0, -0.076, 0.0), NO_TURN)
    hand.move("over the head", 1.0, (0.0, 0.0, 0.0))
    hand.hold("still over it", 0.3)
    hand.wiggle("wiggles", 1.0, (0.002, 0, 0.002), (3 * DEGREE, 0, 3 * DEGREE), (3, 4, 5))
    hand.move("on towards the crank", 0.6, (0.001, 0.120, 0.001))
    hand.hold("still on the crank", 0.3)
    hand.move("pulled off", 1.0, (0.0, -0.080, 0.0))
    hand.hold("still, off", 0.3)
    return Evidence(
        "piston-cylinder", "Cylinder over head, rod and crank (at a tenth of its size)", _piston_part("cylinder"),
        [_piston_part("head"), _piston_part("connecting-rod"), _piston_part("crank")], 5e-5, 0.002, hand,
        pivot=(0, -0.20, 0.023), axis=1, goals=[
            Goal("rests on the head", "end", "still on the head", high=-0.0735, axis=1),
            Goal("is over the head", "end", "still over it", low=-1e-4, high=1e-4, axis=1),
            Goal("is off, where the hand is: gap", "gap", "still, off", high=1e-6),
        ])


# file, seated position, seated turn, approach, middle of the part in its own coordinates, how far beyond the seat it is
# pressed
ARIAC = {
    "battery": ("battery_collision", (-0.15, 0.035, 0.043), (0, 0, np.pi / 2), (0, 1, 0), (0.001, 0, 0.02), 0.005),
    "pump": ("pump_base", (0.14, 0, 0.02), (0, 0, -np.pi / 2), (0, 0, -1), (0, 0, 0.06), 0.012),
    "sensor": ("sensor_collision", (-0.1, 0.395, 0.045), (0, 0, -np.pi / 2), (0, -1, 0), (0.005, 0.015, 0.035), 0.005),
    "regulator": ("regulator_collision", (0.175, -0.223, 0.215), None, (0, 0, -1), (0.015, -0.0225, 0.035), 0.005),
}


def _roll_pitch_yaw(roll, pitch, yaw):
    """Fixed axes x, y, z, as in URDF; as axis times angle."""
    from paths import multiply, quaternion, rotation_vector
    q = multiply(quaternion((0, 0, yaw)), multiply(quaternion((0, pitch, 0)), quaternion((roll, 0, 0))))
    return tuple(rotation_vector(q)[0])


def _ariac(name):
    """Home is the seated pose. The part comes from 60 mm before it and is pressed in, then aside, then pulled."""
    file, position, turn, approach, pivot, press = ARIAC[name]
    turn = turn or _roll_pitch_yaw(np.pi / 2, 0, -np.pi / 2)
    way = np.array(approach, float)
    aside = np.roll(way, 1)
    axis = int(np.argmax(np.abs(way)))
    tilt = 3 * DEGREE * np.roll(way, 2)
    hand = Hand(shift=-0.06 * way + 0.002 * aside, turn=tilt)
    hand.move("comes, off and tilted", 0.8, -0.02 * way + 0.002 * aside)
    hand.move("aligned", 0.4, -0.02 * way, NO_TURN)
    hand.move("pressed in", 0.8, press * way)
    hand.hold("still, pressed", 0.4)
    hand.move("pushed aside", 0.3, press * way + press * aside)
    hand.hold("still aside", 0.3)
    hand.wiggle("wiggles", 1.0, 0.8 * press * (np.abs(aside) + np.roll(np.abs(aside), 1)), (0.05, 0.04, 0.03), (3, 4, 5))
    hand.move("pulled out", 0.8, -0.06 * way, NO_TURN)
    hand.hold("still outside", 0.3)
    return Evidence(
        f"ariac-{name}", f"ARIAC: {name} into the tray", Body(name, f"ariac/{file}.stl", 1.0, position, turn),
        [Body("tray", "ariac/insert_collision.stl")], 1e-4, 0.003, hand, pivot=pivot, axis=axis, goals=[
            Goal("is seated: along the approach, from the seated pose", "along", "still, pressed", low=-0.003,
                 high=0.0065, axis=tuple(approach)),
            Goal("is out again, where the hand is: gap", "gap", "still outside", high=1e-6),
        ])


def _drawn_overlapped(name, title, part, others, margin, cutoff, way, aside, pivot, press, out):
    """Home is the pose as drawn, which overlaps. The part is led out along `way`, brought back, pressed, led out."""
    way, aside = np.array(way, float), np.array(aside, float)
    axis = int(np.argmax(np.abs(way)))
    hand = Hand()
    hand.hold("overlapped", 0.2)
    hand.wiggle("wiggles, overlapped", 0.5, 1e-4 * (way + aside), (0.002, 0.002, 0.002), (3, 4, 5))
    hand.move("led apart", 0.8, out * way)
    hand.hold("apart", 0.3)
    hand.move("brought back", 0.8, -press * way)
    hand.hold("still, pressed", 0.4)
    hand.wiggle("wiggles, pressed", 1.0, 0.5 * press * aside, (0.02, 0.02, 0.02), (3, 4, 5))
    hand.move("led out", 0.8, out * way)
    hand.hold("still outside", 0.3)
    along = tuple(way)
    return Evidence(name, title, part, others, margin, cutoff, hand, pivot=pivot, axis=axis, begins_overlapped=True, goals=[
        Goal("overlaps as drawn, and is not felt: share of ticks", "released", "overlapped", low=1.0),
        Goal("goes with the hand while it overlaps: gap", "gap", "wiggles, overlapped", high=1e-6),
        Goal("is felt once apart: share of ticks released", "released", "apart", high=0.0),
        Goal("is felt when it comes back: share of ticks released", "released", "still, pressed", high=0.0),
        Goal("is held by contact: share of ticks", "held", "still, pressed", low=1.0),
        Goal("does not come back to where it is drawn: along the way out", "along", "still, pressed", low=1e-5, axis=along),
        Goal("is out again, where the hand is: gap", "gap", "still outside", high=1e-6),
    ])


def _battery_drawn():
    file, position, turn, approach, pivot, _ = ARIAC["battery"]
    return _drawn_overlapped(
        "drawn-battery", "ARIAC: battery as drawn, overlapping the tray by 0.16 %",
        Body("battery", f"ariac/{file}.stl", 1.0, position, turn), [Body("tray", "ariac/insert_collision.stl")], 1e-4, 0.003,
        -np.array(approach, float), (0, 0, 1), pivot, 0.005, 0.06)


def _pump_drawn():
    """Both halves are in millimetres, in one frame; the axis is y."""
    return _drawn_overlapped(
        "drawn-pump", "Pump: upper half as drawn, overlapping the lower one by 0.06 %",
        Body("top", "pump/Top.stl", 0.001), [Body("bottom", "pump/Bottom.stl", 0.001)], 1e-4, 0.002,
        (0, 1, 0), (1, 0, 0), (-0.063, -0.086, 0.0), 0.005, 0.04)


FOLLOWS = 1e-5  # What is led along what is free must follow within [m].
DRAG = 0.02     # Most of the wrench that may be along what is free, as a share of all of it.


def _cut(name, solid, count, seed):
    """A body of flat faces that are cut finely and unevenly into so many triangles."""
    return Body(name, f"dense-{name}-{count}.obj", make=lambda: solid.quartered(4).cut_to(count, seed))


def _dense_peg():
    """Home is the peg through the hole, its lower end level with the tray's lower face. The tray is as thick as the peg's
    centre of mass is high, where the hand pulls: pushed aside, the peg lies along the wall."""
    top, deep = 0.026, (0.0008, -0.0005, 0.0)
    hand = Hand(shift=(0.0008, -0.0005, top + 0.006), turn=(2 * DEGREE, -1.5 * DEGREE, 0.0))
    hand.move("rim, off and tilted", 0.7, (0.0008, -0.0005, top - 0.001))
    hand.hold("still on the rim", 0.4)
    hand.move("aligned", 0.4, turn=NO_TURN)
    hand.move("in along its chamfer", 0.8, deep)
    hand.hold("still inside, pushed aside", 0.4)
    hand.glide("down at 0.1 m/s", 0.11, (deep[0], deep[1], -0.010))
    hand.hold("still below", 0.2)
    hand.glide("up at 0.1 m/s", 0.11, deep)
    hand.wiggle("wiggles", 1.0, (0.001, 0.001, 0.0), (4 * DEGREE, 4 * DEGREE, 0), (3, 4, 3))
    hand.move("twisted", 0.4, (0.0, 0.0, 0.0), (0, 0, 0.3))
    hand.hold("still twisted", 0.3)
    hand.move("back", 0.3, turn=NO_TURN)
    hand.move("pulled out tilted", 0.8, (0.0005, 0.0, top + 0.006), (2 * DEGREE, 0, 0))
    hand.hold("still outside", 0.3)
    goals = [
        Goal("slips in along its chamfer, off by a millimetre as it is", "end", "still inside, pushed aside",
             low=-1e-5, high=1e-5),
        Goal("is kept from turning by the hole [rad]", "twist", "still twisted", high=0.1),
        Goal("is out again, where the hand is: gap", "gap", "still outside", high=1e-6),
        Goal("ticks that are truncated, of all", "truncated", "", high=0.0),
    ]
    for name in ("down at 0.1 m/s", "up at 0.1 m/s"):
        goals += [Goal("follows along the hole, without friction: change of hand less part", "slip", name, low=-FOLLOWS, high=FOLLOWS),
                  Goal("drags along the hole: share of the wrench", "drag", name, high=DRAG)]
    return Evidence(
        "dense-peg", "Square peg of 16 mm (25,000 triangles) into a tray (29,000), 0.1 mm of play each side, chamfers",
        _cut("peg", dense.chamfered_peg(0.016, 0.040, 0.001), 25000, 1),
        [_cut("tray", dense.tray(0.060, 0.026, 0.0162, 0.001), 29000, 2)], 2e-5, 0.001, hand, pivot=(0, 0, 0.020),
        goals=goals)


def _dense_block():
    """Home is the block on the plate."""
    pressed = -0.0025
    hand = Hand(shift=(-0.03, -0.02, 0.006), turn=(2 * DEGREE, -1.5 * DEGREE, 0.1))
    hand.move("down, tilted", 0.6, (-0.03, -0.02, pressed))
    hand.hold("still on an edge or corner", 0.3)
    hand.move("aligned", 0.3, turn=(0, 0, 0.1))
    hand.hold("still, pressed flat", 0.3)
    hand.glide("along at 0.1 m/s", 0.66, (0.03, -0.02, pressed))
    hand.hold("still, pressed flat", 0.3)
    hand.glide("across at 0.1 m/s", 0.44, (0.03, 0.02, pressed))
    hand.hold("still, pressed flat", 0.3)
    hand.move("turned", 0.4, turn=(0, 0, -0.5))
    hand.wiggle("rocked", 1.0, (0, 0, 0.001), (4 * DEGREE, 4 * DEGREE, 0), (3, 4, 3))
    hand.hold("still, pressed flat", 0.3)
    hand.move("lifted", 0.5, (0.03, 0.02, 0.010))
    hand.hold("still, lifted", 0.3)
    goals = [Goal("is out of contact, where the hand is: gap", "gap", "still, lifted", high=1e-6)]
    goals += [Goal("ticks that are truncated, of all", "truncated", "", high=0.0)]
    for name, axis in (("along at 0.1 m/s", 0), ("across at 0.1 m/s", 1)):
        goals += [Goal("follows along the plate, without friction: change of hand less part", "slip", name, low=-FOLLOWS,
                       high=FOLLOWS, axis=axis),
                  Goal("drags along the plate: share of the wrench", "drag", name, high=DRAG)]
    return Evidence(
        "dense-block", "Block of 50 x 40 x 30 mm on a plate (24,300 triangles each), pressed and slid",
        _cut("block", dense.box(0.05, 0.04, 0.03), 24300, 3), [Body(
            "plate", "dense-plate-24300.obj", position=(0.0, 0.0, -0.025),
            make=lambda: dense.box(0.2, 0.2, 0.02).quartered(4).cut_to(24300, 4))], 1e-4, 0.001, hand, goals=goals)


PAIR_SIZE = 0.1  # Diagonal that the benchmark's bodies of diagonal 1 are given [m].


def _pair(name, title, scene, part, seed, reach=0.06):
    """Bodies of one size about the origin: scene = (file, least corner, greatest corner), in its own units."""
    def body(role, file, low, high):
        low, high = np.array(low, float), np.array(high, float)
        scale = PAIR_SIZE / np.linalg.norm(high - low)
        return Body(role, f"paper_counts/{file}", scale, tuple(-scale * (low + high) / 2)), scale * (low + high) / 2

    fixed, _ = body("scene", *scene)
    moved, centre = body("part", *part)
    hand = adversary(seed, PAIR_SIZE, (0.11, 0.0, 0.0), (reach,) * 3)
    return Evidence(name, title, moved, [fixed], PAIR_SIZE * 5e-4, PAIR_SIZE * 0.05, hand, pivot=tuple(centre),
                    goals=[Goal("comes back to the hand when led away: gap", "gap", "away", high=1e-6)])


BUNNY = ("bunny_2204.ply", (-0.09408163, 0.03340257, -0.06165008), (0.06105929, 0.18704361, 0.05912527))
SPHERE = ("sphere_128.obj", (-1, -1, -1), (1, 1, 1))
SPRING = ("spring_23578.ply", (-0.055, -0.055, 0.006137), (0.055, 0.055, 0.478957))
TEAPOT = ("teapot_5648.ply", (-3, 0, -2), (3.434, 3.15, 2))
GEAR = ("gear_6302.ply", (-0.00095821, -0.02095839, 0.00499486), (0.04095839, 0.02095839, 0.02500005))
CRANKSHAFT = ("crankshaft_12802.ply", (-40, -50, -29.99795), (165, 50, 29.99745))


def _gear_disc():
    """The disc fills 0.9 of the bore, which it does not leave, as in the benchmark."""
    file, low, high = GEAR
    low, high = np.array(low), np.array(high)
    scale = PAIR_SIZE / np.linalg.norm(high - low)
    radius, length = 0.005 * scale, 0.02 * scale
    gear = Body("gear", f"paper_counts/{file}", scale, tuple(-scale * (low + high) / 2))
    disc = Body("disc", "paper_counts/disc_512.stl", 0.9 * radius)
    hand = adversary(3, 4 * radius, (0.0, 0.0, 0.0), (2 * radius, 2 * radius, 0.3 * length))
    return Evidence("pair-gear-disc", "Disc (512) in the bore of a gear (6,302), ill-meaning hand", disc, [gear],
                    PAIR_SIZE * 5e-4, PAIR_SIZE * 0.05, hand,
                    goals=[Goal("comes back to the hand when led home: gap", "gap", "away", high=1e-6)])


def _pairs():
    ill = "ill-meaning hand"
    return [
        _pair("pair-bunny-sphere", f"Sphere (128) on bunny (2,204), {ill}", BUNNY, SPHERE, 1),
        _pair("pair-spring-teapot", f"Teapot (5,648) on spring (23,578), {ill}", SPRING, TEAPOT, 2),
        _gear_disc(),
        _pair("pair-gear-gear", f"Gear on gear (6,302 each), {ill}", GEAR, GEAR, 4),
        _pair("pair-crankshaft-gear", f"Gear (6,302) on crankshaft (12,802), {ill}", CRANKSHAFT, GEAR, 5),
        _pair("pair-crankshaft-sphere", f"Sphere (128) on crankshaft (12,802), {ill}", CRANKSHAFT, SPHERE, 6),
    ]


def all_evidence():
    return (_pegs() + [_nut_engaged(), _nut_on(), _gear(), _piston_head(), _piston_cylinder()]
            + [_ariac(name) for name in ARIAC] + [_battery_drawn(), _pump_drawn(), _dense_peg(), _dense_block()] + _pairs())
