"""Words that several tables share: names of pairs and scenes, machines by letter, goals, and rows of the same kind."""

import functools
import re

import numbers_text as n
import provenance
from results import FigureError

# Goals of a whole tick, p50 and p99 [us].
TICK_GOALS = (100.0, 400.0)
PAIRS = ("bunny-sphere", "spring-teapot", "gear-disc", "gear-gear", "crankshaft-gear", "crankshaft-sphere")
CONFORMING = {"cylinder-tube": "cylinder in a tube", "box-hole": "box in a hole", "wheels": "toothed wheels",
              "round-peg": "round peg in its hole", "rectangular-peg": "rectangular peg in its hole",
              "gears": "two gears", "nut-bolt": "nut on its bolt, 0.02 mm margin"}
MACHINES = {"A": "with AVX-512, AVX-VNNI and VP2INTERSECT", "B": "with AVX-512, without VP2INTERSECT",
            "D": "without AVX-512", "E": "with AVX-512", "C": "not described further by the files"}


# Scenes of tests/stress whose name does not say what they are.
STRESS_SCENES = {"huge": "`huge`, rings of 1 km", "tiny": "`tiny`, rings of 1 mm"}


def stress_scene(name):
    return STRESS_SCENES.get(name, f"`{name}`")


def needs(*files, command="resources/scripts/measure"):
    """For a figure whose results may not be committed yet: it says so until they are."""

    def of(make):
        @functools.wraps(make)
        def made(results):
            missing = [f"`{file.rsplit('/', 1)[1]}`" for file in files if not results.has(file)]
            if missing:
                return f"*No results are committed yet: {', '.join(missing)} of `{command}`.*"
            return make(results)

        return made

    return of


def machine_letter(table):
    """Processors of different kinds have one model name here: maker and vector instructions tell them apart."""
    flags = table.head.get("vector instructions", "").split()
    if not flags:
        return "C"
    if "avx512_vp2intersect" in flags:
        return "A"
    if not any(flag.startswith("avx512") for flag in flags):
        return "D"
    return "E" if "Intel" in provenance.machine(table) else "B"


def pair_name(scene):
    return ", ".join(scene.removeprefix("paper-").split("-"))


def worst(table, columns, conditions):
    """The largest value of each column over all rows that fit one of the conditions."""
    return [max(value for where in conditions for value in table.numbers(column, **where)) for column in columns]


def refined(table, scene, mode, quantity, column):
    """The least value of a quantity of smoothness on the ways that are refined ten times."""
    same = {"group": "smoothness", "scene": scene, "quantity": quantity}
    slower = table.number(column, run=f"{mode} x10", **same)
    return min([slower, *(float(row[column]) for row in table.where(**same) if row["run"] == f"{mode} x10 same speed")])


def tick_rows(run, scenes, quantity="tick [us]"):
    return [{"group": "cost", "scene": scene, "run": run, "quantity": quantity} for scene in scenes]


def paper_ticks(run, quantity="tick [us]"):
    return tick_rows(run, [f"paper-{pair}" for pair in PAIRS], quantity)


def drawn(table, **conditions):
    """(triangles that a picture has, triangles that there are) by the remark of a row of window.csv; the second may be None."""
    remark = table.text("remark", **conditions)
    said = re.search(r"(\d+)(?: of (\d+))? triangles a picture", remark)
    if not said:
        raise FigureError(table.file, f'the remark "{remark}" does not say how many triangles a picture had',
                          "measure the window anew")
    return int(said.group(1)), int(said.group(2)) if said.group(2) else None


def the_way(table, figure, start):
    """The only way of a figure of window.csv that starts so: sizes are in its name."""
    found = [row["way"] for row in table.where(figure=figure) if row["way"].startswith(start)]
    if len(found) != 1:
        raise FigureError(table.file, f'{len(found)} rows of "{figure}" start with "{start}"', "measure the window anew")
    return found[0]


def sizes_in(text):
    said = re.search(r"\d+", text)
    return int(said.group()) if said else 0


def stale(table):
    """A remark where a table stands on results that cannot be repeated as they are."""
    note = provenance.note(table)
    return f" ({note})" if note else ""
