"""Tables of the Python package and of sweeps."""

import common as c
import numbers_text as n
from scenes import UNITS

PYTHON = "tests/app/results/python.csv"
SWEEP_COST = "tests/app/results/sweep_cost.csv"
# Measures of bench.py, with words for each.
MEASURES = (
    ("cold_cpp_us", "cold `lmds`, time of a pose in C++"),
    ("cold_python_us", "the same from Python, one thread"),
    ("cold_python_over_cpp", "Python over C++"),
    ("cold_python_all_processors_us", "from Python on all processors"),
    ("tracked_python_us", "tracked, one thread"),
    ("tracked_python_all_processors_us", "tracked, on all processors"),
    ("call_without_query_us", "call of one pose, all out of reach"),
    ("call_over_batch_us", "call of one pose, over that pose in a batch"),
    ("wheel_s", "wheel built from nothing"),
)


def missed_of_python(results):
    """Goals of the package that are missed, a few words each."""
    table = results.table(PYTHON)
    return [f"{what}: {_value(value, unit)} ({_value(float(goal), unit)})" for name, what in MEASURES
            for value, unit, goal in [(table.number("value", measure=name), table.text("unit", measure=name), table.text("goal", measure=name))]
            if goal and value > float(goal)]


def missed_of_sweeps(results):
    speedup = results.table(SWEEP_COST).number("value", quantity="two workers over one")
    return [] if speedup >= LEAST_SPEEDUP else [f"two workers over one: {n.times(speedup)} ({LEAST_SPEEDUP:g})"]


def _value(value, unit):
    return n.time(UNITS[unit] * value) if unit in UNITS else n.times(value)


@c.needs(PYTHON)
def python_package(results):
    table = results.table(PYTHON)
    rows = []
    for name, what in MEASURES:
        value, unit, goal = table.number("value", measure=name), table.text("unit", measure=name), table.text("goal", measure=name)
        said = ""
        if goal:
            said = f"{'met' if value <= float(goal) else '**missed**'} (at most {_value(float(goal), unit)})"
        rows.append([what, _value(value, unit), said])
    minima = n.count(table.number("value", measure="cold_minima"))
    return n.table([f"10,000 poses, {minima} minima", "measured", "goal"], rows)


def _quantity(value, unit):
    if unit in UNITS:
        return n.time(UNITS[unit] * value)
    if not unit:
        return n.count(value)
    return n.times(value) if unit.startswith("times") else f"{n.plain(value)} {unit}"


# Goal of two workers, in times as fast as one.
LEAST_SPEEDUP = 1.8


@c.needs(SWEEP_COST)
def sweep_cost(results):
    table = results.table(SWEEP_COST)
    rows = []
    for row in table.where():
        value = float(row["value"])
        goal = ""
        if row["quantity"] == "two workers over one":
            goal = f"{'met' if value >= LEAST_SPEEDUP else '**missed**'} (at least {LEAST_SPEEDUP:g})"
        rows.append([row["quantity"], _quantity(value, row["unit"]), goal])
    return n.table(["quantity", "measured", "goal"], rows)


FIGURES = {"python package": python_package, "sweep cost": sweep_cost}
