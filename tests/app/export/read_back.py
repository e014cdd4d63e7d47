#!/usr/bin/env python3
"""Exports with nearfit-cli and reads it back with libraries that share no code with it.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install cadquery-ocp==7.8.1.1.post1 trimesh==5.2.0 numpy networkx lxml \\
        lib3mf==2.5.0 yourdfpy==0.0.60
    (cd /tmp && npm install gltf-validator three)
    /tmp/venv/bin/python tests/app/export/read_back.py --modules /tmp/node_modules [--bin build/release/bin] [--csv FILE]

Assemblies and placements: parts of tests/app/import/models, of a mesh, and names and poses made to be hard. Names and the groups
around them must be equal; poses must be those of the JSON export, and those that this script chose or that OpenCASCADE finds in
the imported documents, to 1e-9 (metres; rotations as numbers); colours to half a step of 8 bits; parts that share their triangles
in the scene must share them in the file. Volume and box of each part must be those of the wedge's formula or of the document's
exact solid: to 1e-9 in STEP, which must also have its curved faces, and to single precision where flat faces became triangles;
curved faces may lose what facets of 10 degrees lose.
Meshes: each part alone as STL, OBJ and PLY must be closed, with that volume and its box in the world; all in one file must have all
triangles. A path's animation: vertices must be where the path has them, at its poses and halfway between, to 1e-6 of the scene. A
swept volume: it must be closed, hold the union of boxes that a straight way passes, and go beyond it by less than the resolution.

STEP is read by OpenCASCADE's Python bindings, of another version than the exporter's, glTF and meshes by trimesh, 3MF by lib3mf,
URDF by yourdfpy, JSON and CSV by Python; the glTF validator of its makers checks both glTF files, and three.js plays the animation.
Prints a row for each file and ends with 1 if one is not right. --csv writes the rows for machines; results that are kept are of a
clean revision: tests/app/results/read_back.csv, of which resources/scripts/figures makes the tables in resources/docs/cli.md.
"""
import argparse
import csv
import importlib.metadata
import json
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter, namedtuple
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True  # The folder is the repository's.
sys.path.insert(0, str(ROOT / "resources" / "scripts" / "figure_sources"))
import heads  # noqa: E402
import readers as r  # noqa: E402

TOLERANCE = 1e-9
# Numbers in files of single precision, as a share of the largest: a few roundings of 6e-8.
SINGLE = 1e-6
# Half a step of 8 bits, and what rounding of single precision adds.
COLOUR_TOLERANCE = 0.5 / 255 + SINGLE
NAMES = ['Grundplatte Ø16', '軸', 'a<b>&"c"', "d 'e'", 'f;g,(h)', 'tab and  spaces', '🔩 M16']
WEDGE = np.array([[0, 0, 0], [0.03, 0, 0], [0, 0.02, 0], [0, 0, 0.01]])
MODELS = ("assembly_ap242.step", "two_solids.step")
# Max angle between facets. A polygon of such facets has less area than its circle by that share, and is within it by that share
# of the radius.
FACET_DEGREES = 10.0
FACET = np.radians(FACET_DEGREES)
LOST_VOLUME, LOST_RADIUS = 1 - np.sin(FACET) / FACET, 1 - np.cos(FACET / 2)

# A part as it must be found: `matrix` as the program's JSON has it, `chosen` as this script or the document has it.
# world_box() gives its box in the world for a pose.
Expected = namedtuple("Expected", "name groups matrix chosen colours shape geometry world_box")


def rotation(axis, angle):
    x, y, z = axis / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def quaternion(m):
    """Of a rotation by less than a half turn: w, x, y, z."""
    w = np.sqrt(max(0.0, 1 + np.trace(m))) / 2
    return [float(x) for x in (w, *(np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]) / (4 * w)))]


def pose(turn, place):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, place
    return matrix


def pose_text(matrix):
    return ",".join(repr(float(x)) for x in [*matrix[:3, 3], *quaternion(matrix[:3, :3])])


def box_of(points):
    return np.array([points.min(axis=0), points.max(axis=0)])


def write_mesh(file, vertices, triangles):
    """In millimetres."""
    lines = ["v {!r} {!r} {!r}".format(*(float(1e3 * x) for x in vertex)) for vertex in vertices]
    file.write_text("\n".join(lines + ["f {} {} {}".format(*triangle) for triangle in triangles]) + "\n")
    return file


def write_wedge(file):
    return write_mesh(file, WEDGE, [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)])


def write_box(file, size):
    """About the origin."""
    corners = [[(0.5 if i >> k & 1 else -0.5) * s for k, s in enumerate(size)] for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return write_mesh(file, corners, [triangle for a, b, c, d in quads for triangle in ((a + 1, b + 1, c + 1), (a + 1, c + 1, d + 1))])


def call(program, *arguments):
    result = subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{program.name} {' '.join(map(str, arguments))} ended with {result.returncode}: {result.stderr.strip()}")
    return result.stdout


def make_scene(program, folder):
    """(scene file, chosen poses of the wedges by name)"""
    mesh = write_wedge(folder / "wedge.obj")
    chance = random.Random(20261125)
    command = ["scene", "new", folder / "scene.nearfit", "--unit", "mm", "--angle", FACET_DEGREES]
    chosen = {}
    for name in NAMES:
        axis = np.array([chance.gauss(0, 1) for _ in range(3)])
        place = [chance.uniform(-2, 2) for _ in range(3)]
        chosen[name] = pose(rotation(axis, chance.uniform(0, 3)), place)
        command += ["--part", f"{name}={mesh}@{pose_text(chosen[name])}"]
    for model in MODELS:
        command += ["--import", ROOT / "tests" / "app" / "import" / "models" / model]
    call(program, *command)
    return folder / "scene.nearfit", chosen


def imported_parts():
    """By name in the scene: (pose, geometry, world_box) of what OpenCASCADE finds in the documents. A leaf of several solids
    comes as a part for each, with a number behind its name; so does a name that is taken."""
    parts, taken = {}, Counter()
    for model in MODELS:
        for leaf, shape in r.read_step_shapes(ROOT / "tests" / "app" / "import" / "models" / model):
            solids = list(r.explore(shape, r.TopAbs_SOLID))
            for i, solid in enumerate(solids):
                taken[leaf.name] += 1
                is_plain = len(solids) == 1 and taken[leaf.name] == 1
                name = leaf.name if is_plain else f"{leaf.name} {taken[leaf.name]}"
                parts[name] = (leaf.matrix, r.exact_geometry(solid), lambda matrix, solid=solid: r.moved_box(solid, matrix))
    return parts


def expected_parts(placement, scene, chosen):
    """Names, groups, colours and shapes by the scene file."""
    content = json.loads(scene.read_text())
    matrices = {part["name"]: np.array(part["matrix"]) for part in json.loads(placement.read_text())["parts"]}
    wedge = r.Geometry(0.03 * 0.02 * 0.01 / 6, box_of(WEDGE), 1, 0)
    truth = {name: (matrix, wedge, lambda m: box_of(WEDGE @ m[:3, :3].T + m[:3, 3])) for name, matrix in chosen.items()}
    truth |= imported_parts()
    assert matrices.keys() == truth.keys() == {part["name"] for part in content["parts"]}

    def groups(index):
        if index is None:
            return ()
        group = content["groups"][index]
        return (*groups(group["group"]), group["name"])

    return [Expected(part["name"], groups(part["group"]), matrices[part["name"]], truth[part["name"]][0], [part["colour"]],
                     (part["mesh"], part["shape"] and part["shape"]["key"], tuple(part["colour"])), *truth[part["name"]][1:])
            for part in content["parts"]]


def off(found, expected):
    """(share that a volume is off, largest distance of sides of boxes as a share of the diagonal)"""
    diagonal = np.linalg.norm(expected.box[1] - expected.box[0])
    return abs(found.volume / expected.volume - 1), np.abs(found.box - expected.box).max() / diagonal


def largest(values):
    return max(values, default=0.0)


class Row(dict):
    """A line of the result; `faults` says what is not right."""

    COLUMNS = ("writer", "content", "format", "reader", "parts", "names_equal", "groups_equal", "max_pose_error",
               "max_error_to_chosen_pose", "max_volume_error", "max_box_error", "max_curved_volume_error", "max_curved_box_error",
               "exact_parts", "closed", "colours_differing", "shapes_not_shared", "validator", "validator_errors",
               "validator_warnings", "right")

    def __init__(self, content, format, reader, parts):
        super().__init__(dict.fromkeys(self.COLUMNS, ""), content=content, format=format, reader=reader, parts=parts)
        self.faults = []

    def expect(self, is_right, fault):
        if not is_right:
            self.faults.append(fault)

    def yes(self, column, is_right):
        self[column] = "yes" if is_right else "no"
        self.expect(is_right, column)

    def within(self, column, value, limit):
        self[column] = f"{value:.3g}"
        self.expect(value <= limit, f"{column} is {value:.3g}, beyond {limit:.3g}")

    def none(self, column, count):
        self[column] = count
        self.expect(count == 0, f"{column}: {count}")

    def geometries(self, pairs, flat_limit, is_exact):
        """`pairs` of found and expected geometries. STEP keeps curved faces; other files have facets."""
        errors = [(off(found, expected), expected.curved > 0 and not is_exact) for found, expected in pairs]
        for column, i in (("max_volume_error", 0), ("max_box_error", 1)):
            self.within(column, largest(e[i] for e, is_faceted in errors if not is_faceted), flat_limit)
        if is_exact:
            return
        for column, i, limit in (("max_curved_volume_error", 0, LOST_VOLUME), ("max_curved_box_error", 1, LOST_RADIUS)):
            self.within(column, largest(e[i] for e, is_faceted in errors if is_faceted), limit)

    def validated(self, file, modules):
        errors, self["validator_warnings"], version = r.validate_gltf(file, modules)
        self["validator"] = f"gltf-validator {version}"
        self.none("validator_errors", errors)


def matched(row, expected, found):
    """Pairs by name; the row tells which are missing."""
    left, pairs = list(found), []
    for part in expected:
        same = [f for f in left if f.name == part.name]
        if not same:
            continue
        nearest = min(same, key=lambda f: np.abs(f.matrix - part.chosen).max())
        pairs.append((nearest, part))
        left = [f for f in left if f is not nearest]
    row.yes("names_equal", len(pairs) == len(expected) and not left)
    if left or len(pairs) < len(expected):
        print("  found:", sorted(f.name for f in found))
    row.within("max_pose_error", largest(np.abs(f.matrix - part.matrix).max() for f, part in pairs), TOLERANCE)
    row.within("max_error_to_chosen_pose", largest(np.abs(f.matrix - part.chosen).max() for f, part in pairs), TOLERANCE)
    return pairs


def compare_assembly(row, expected, found, flat_limit):
    pairs = matched(row, expected, found)
    row.yes("groups_equal", all(f.groups == part.groups for f, part in pairs))
    row.none("colours_differing", sum(not any(np.abs(np.subtract(part.colours[0], c)).max() <= COLOUR_TOLERANCE for c in f.colours)
                                      for f, part in pairs))
    shapes = {}
    for f, part in pairs:
        shapes.setdefault(part.shape, set()).add(f.shape)
    row.none("shapes_not_shared", sum(len(each) > 1 for each in shapes.values()))
    is_exact = all(f.geometry.curved is not None for f in found)
    row.geometries([(f.geometry, part.geometry) for f, part in pairs], flat_limit, is_exact)
    if is_exact:
        exact = sum((f.geometry.solids, f.geometry.curved) == (part.geometry.solids, part.geometry.curved) for f, part in pairs)
        row["exact_parts"] = f"{exact} of {len(pairs)}"
        row.expect(exact == len(pairs), "solids or curved faces are missing")


def placements(expected, export):
    """Poses of all parts as text."""
    matrices = {"json": {part["name"]: part["matrix"] for part in json.loads(export("placement.json").read_text())["parts"]}}
    with export("placement.csv").open(newline="", encoding="utf-8") as file:
        # A spreadsheet's mark of text is not part of a name.
        matrices["csv"] = {re.sub("^'(?=[=+\\-@＝＋－＠\t\r\n])", "", line["part"]): [[line[f"m{i}{j}"] for j in range(4)] for i in range(4)]
                           for line in csv.DictReader(file)}
    for format, named in matrices.items():
        found = [r.Found(name, None, np.array(matrix, float), None, None, None) for name, matrix in named.items()]
        row = Row("placement", format, "Python", len(found))
        matched(row, expected, found)
        yield row


ASSEMBLIES = (("ap214.step", "step AP214", (), r.read_step, "cadquery-ocp", TOLERANCE),
              ("ap242.step", "step AP242", ("--schema", "ap242"), r.read_step, "cadquery-ocp", TOLERANCE),
              ("scene.glb", "glb", (), r.read_glb, "trimesh", SINGLE), ("scene.3mf", "3mf in mm", (), r.read_3mf, "lib3mf", SINGLE),
              ("inches.3mf", "3mf in inches", ("--unit", "in"), r.read_3mf, "lib3mf", SINGLE),
              ("scene.urdf", "urdf", (), r.read_urdf, "yourdfpy", SINGLE))


def assemblies(expected, export, modules):
    for name, format, options, read, reader, limit in ASSEMBLIES:
        file = export(name, *options)
        if name.endswith("step"):
            schema = re.search(r"FILE_SCHEMA\s*\(\(\s*'(\w+)", file.read_text(encoding="latin-1")).group(1)
            assert schema.startswith("AUTOMOTIVE_DESIGN" if "214" in format else "AP242"), schema
        found = read(file)
        row = Row("assembly", format, reader, len(found))
        compare_assembly(row, expected, found, limit)
        if name.endswith("glb") and modules:
            row.validated(file, modules)
        yield row


def meshes(expected, export):
    """Each part alone, and all in one file, in metres and in inches."""
    for format, unit, metres in (("stl", "m", 1.0), ("obj", "in", 0.0254), ("ply", "m", 1.0)):
        pairs, triangles, are_closed = [], 0, True
        for i, part in enumerate(expected):
            file = export(f"part{i}.{format}", "--unit", unit, "--part", part.name)
            geometry, count, is_closed = r.read_mesh(file, metres)
            pairs.append((geometry, part.geometry._replace(box=part.world_box(part.chosen))))
            triangles, are_closed = triangles + count, are_closed and is_closed
        row = Row("mesh", format, "trimesh", len(expected))
        # A small part far out has coordinates larger than its diagonal.
        reach = largest(np.abs(e.box).max() / np.linalg.norm(e.box[1] - e.box[0]) for _, e in pairs)
        row.geometries(pairs, reach * SINGLE if format == "stl" else TOLERANCE, False)
        row.yes("closed", are_closed)
        _, count, _ = r.read_mesh(export(f"all.{format}", "--unit", unit), metres)
        row.expect(count == triangles, f"{count} of {triangles} triangles in one file")
        yield row


def write_path(file, parts, centre, poses, seconds):
    """Poses at equal times."""
    rows = [[seconds * i / (len(poses) - 1), *map(float, m[:3, 3]), *quaternion(m[:3, :3])] for i, m in enumerate(poses)]
    file.write_text(json.dumps({"path": 1, "program": "read_back.py", "parts": parts, "centre": list(centre), "poses": rows}))


def animation(program, folder, modules):
    """Two wedges that move as one, turning about a point that is not their frame's, past one that stands."""
    axis, centre, count, seconds = np.array([0.3, -0.5, 0.8]), np.array([0.012, 0.005, 0.004]), 41, 4.0
    wedge = write_wedge(folder / "wedge.obj")
    standing = {"Lead Ø16": pose(rotation(axis, 0.4), [0.2, 0.1, 0.3]), "軸 <2>": pose(rotation(axis[::-1], 1.0), [0.25, 0.1, 0.3]),
                "Wall": pose(np.eye(3), [0.0, 0.5, 0.0])}
    scene, path, file = folder / "path.nearfit", folder / "way.nfpath", folder / "way.glb"
    call(program, "scene", "new", scene, "--unit", "mm", *(word for name, m in standing.items()
                                                         for word in ("--part", f"{name}={wedge}@{pose_text(m)}")))
    lead = next(iter(standing))

    def lead_at(share):
        """The centre goes along a screw, straight between poses; turns between them are at a constant rate about one axis."""
        step = min(int(share * (count - 1)), count - 2)
        at = [np.array([0.2 + 0.1 * np.sin(3 * s), 0.1 + 0.1 * np.cos(3 * s), 0.3 - 0.2 * s])
              for s in (step / (count - 1), (step + 1) / (count - 1))]
        way = at[0] + (share * (count - 1) - step) * (at[1] - at[0])
        turn = rotation(axis, 0.4 + 2 * share)
        return pose(turn, way - turn @ centre)

    write_path(folder / "in.nfpath", [lead, "軸 <2>"], centre, [lead_at(i / (count - 1)) for i in range(count)], seconds)
    call(program, "path", folder / "in.nfpath", scene, "-o", path, "--gltf", file)
    shares = np.arange(2 * count - 1) / (2 * count - 2)
    played, duration, version = r.play_gltf(file, seconds * shares, modules)
    row = Row("animation", "glb", f"three.js r{version}", len(played))
    row.yes("names_equal", played.keys() == standing.keys())
    row.expect(abs(duration - seconds) <= SINGLE, f"it takes {duration} s")
    worst = 0.0
    for name in played.keys() & standing.keys():
        lead_from_part = np.linalg.inv(standing[lead]) @ standing[name]
        for share, points in zip(shares, played[name]):
            m = standing[name] if name == "Wall" else lead_at(share) @ lead_from_part
            apart = np.linalg.norm((WEDGE @ m[:3, :3].T + m[:3, 3])[:, None] - points[None], axis=2)
            worst = max(worst, apart.min(axis=0).max(), apart.min(axis=1).max())
    row.within("max_error_to_chosen_pose", worst, SINGLE)
    row.validated(file, modules)
    return row


def swept_volumes(program, folder):
    """A box that goes along x, then along z: what it passes is a union of two boxes."""
    size, along, up, resolution = np.array([0.012, 0.012, 0.05]), 0.04, 0.055, 0.001
    scene = folder / "swept.nearfit"
    box = write_box(folder / "box.obj", size)
    call(program, "scene", "new", scene, "--unit", "mm", "--part", f"Peg={box}", "--moving", "Peg")
    corners = [np.array([0, 0, 0]), np.array([along, 0, 0]), np.array([along, 0, up])]
    write_path(folder / "swept_in.nfpath", ["Peg"], (0, 0, 0),
               [pose(np.eye(3), a + s * (b - a)) for a, b in zip(corners, corners[1:]) for s in (0, 0.5, 1)], 4.0)
    exact = np.array([-size / 2, size / 2 + [along, 0, up]])

    def union(d):
        """Volume of the two boxes, grown by d to each side."""
        x, y, z = size + 2 * d
        return (x + along) * y * z + x * y * up

    for format, unit, metres in (("stl", "mm", 1e-3), ("obj", "in", 0.0254), ("ply", "mm", 1e-3)):
        file = folder / f"swept.{format}"
        call(program, "path", folder / "swept_in.nfpath", scene, "-o", folder / "swept.nfpath", "--swept", file, "--unit", unit,
             "--resolution", resolution)
        geometry, _, is_closed = r.read_mesh(file, metres)
        row = Row("swept volume", format, "trimesh", 1)
        row.yes("closed", is_closed)
        row["max_volume_error"] = f"{geometry.volume / union(0) - 1:.3g}"
        row.expect(union(0) <= geometry.volume <= union(resolution), f"its volume is {geometry.volume:.4g} m^3")
        beyond = np.array([exact[0] - geometry.box[0], geometry.box[1] - exact[1]])
        row["max_box_error"] = f"{beyond.max() / np.linalg.norm(exact[1] - exact[0]):.3g}"
        row.expect(beyond.min() >= 0 and beyond.max() <= resolution, f"its box goes beyond by {beyond.min():.3g} to {beyond.max():.3g} m")
        yield row


def versions(program):
    """Of what writes: Nearfit, and the OpenCASCADE of the importer beside it."""
    says = call(program.parent / "nearfit-import", "--version")
    return f"{call(program, '--version').strip()}, {re.search('OpenCASCADE [0-9.]+', says).group()}"


def version_of(reader):
    if reader == "Python":
        return f"Python {sys.version.split()[0]}"
    return reader if " " in reader else f"{reader} {importlib.metadata.version(reader)}"


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin")
    options.add_argument("--modules", type=Path, help="node_modules with gltf-validator and three")
    options.add_argument("--no-modules", action="store_true", help="do without the glTF validator and the animation")
    options.add_argument("--csv", type=Path, help="write the rows to this file too")
    given = options.parse_args()
    if (given.modules is None) != given.no_modules:
        options.error("give the modules of Node.js (--modules /tmp/node_modules), or --no-modules")
    modules = given.modules and given.modules.resolve()
    # Nothing is timed.
    head = heads.head_or_exit("read_back.py", given.csv, ROOT, given.bin.resolve().parent, allows_busy=True)
    program = given.bin / "nearfit-cli"
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        scene, chosen = make_scene(program, folder)

        def export(name, *options):
            call(program, "export", scene, "-o", folder / name, *options)
            return folder / name

        expected = expected_parts(export("truth.json"), scene, chosen)

        def all_rows():
            yield from placements(expected, export)
            yield from assemblies(expected, export, modules)
            yield from meshes(expected, export)
            if modules:
                yield animation(program, folder, modules)
            yield from swept_volumes(program, folder)

        for row in all_rows():
            if row["content"] in ("placement", "assembly"):
                row.expect(row["parts"] == len(expected), f"{row['parts']} of {len(expected)} parts")
            row.update(writer=versions(program), reader=version_of(row["reader"]), right="no" if row.faults else "yes")
            said = ", ".join(f"{key} {value}" for key, value in row.items() if value != "" and key not in ("writer", "content", "format"))
            print(f"{row['content']} {row['format']}: {said}{'  NOT RIGHT' if row.faults else ''}")
            for fault in row.faults:
                print("  " + fault)
            rows.append(row)
    if given.csv:
        heads.write_csv(given.csv, head, Row.COLUMNS, rows)
    return 1 if any(row.faults for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
