#!/usr/bin/env python3
"""Exports an assembly with nearfit-cli and reads it back with libraries that share no code with it.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install cadquery-ocp==7.8.1.1.post1 trimesh==5.2.0 numpy networkx lxml
    (cd /tmp && npm install gltf-validator)
    /tmp/venv/bin/python tests/app/export/read_back.py --validator /tmp/node_modules [--bin build/release/bin] [--csv FILE]

Parts of tests/app/import/models, of a mesh, and names and poses made to be hard are compared with the JSON export and the
scene: names must be equal, matrices to 1e-9 (metres; rotations as numbers), colours to half a step of 8 bits, and parts that
share their triangles in the scene must share them in the file. Prints a row for each format and ends with 1 if one of them
differs. STEP is read by OpenCASCADE's Python bindings, of another version than the exporter's, glTF and 3MF by trimesh, URDF by
the standard library; glTF is checked by the validator of its makers, without which (--no-validator) nothing says that it is
valid. --csv writes the rows for machines; results that are kept are of a clean revision: tests/app/results/read_back.csv, of which
resources/scripts/figures makes the table in resources/docs/cli.md.
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
import xml.etree.ElementTree as xml
import zipfile
from collections import namedtuple
from pathlib import Path

import numpy as np
import trimesh
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Quantity import Quantity_Color
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_AsciiString, TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence, TDF_Tool
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_ColorTool, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

ROOT = Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True  # The folder is the repository's.
sys.path.insert(0, str(ROOT / "resources" / "scripts" / "figure_sources"))
import heads  # noqa: E402

TOLERANCE = 1e-9
# Half a step of 8 bits, and what rounding of single precision adds.
COLOUR_TOLERANCE = 0.5 / 255 + 1e-6
NAMES = ['Grundplatte Ø16', '軸', 'a<b>&"c"', "d 'e'", 'f;g,(h)', 'tab and  spaces', '🔩 M16']


# A part: its colours (sRGB, 0 to 1), and what names its triangles.
Found = namedtuple("Found", "name matrix colours shape")


def rotation(axis, angle):
    x, y, z = axis / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def quaternion(m):
    """Of a rotation by less than a half turn: w, x, y, z."""
    w = np.sqrt(max(0.0, 1 + np.trace(m))) / 2
    return [w, (m[2, 1] - m[1, 2]) / (4 * w), (m[0, 2] - m[2, 0]) / (4 * w), (m[1, 0] - m[0, 1]) / (4 * w)]


def make_scene(program, folder):
    mesh = folder / "wedge.obj"
    mesh.write_text("v 0 0 0\nv 30 0 0\nv 0 20 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
    chance = random.Random(20261125)
    command = [program, "scene", "new", folder / "scene.nearfit", "--unit", "mm"]
    for name in NAMES:
        axis = np.array([chance.gauss(0, 1) for _ in range(3)])
        place = [chance.uniform(-2, 2) for _ in range(3)] + quaternion(rotation(axis, chance.uniform(0, 3)))
        command += ["--part", f"{name}={mesh}@" + ",".join(repr(float(x)) for x in place)]
    models = ROOT / "tests" / "app" / "import" / "models"
    for model in ("assembly_ap242.step", "two_solids.step"):
        command += ["--import", models / model]
    subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL)
    return folder / "scene.nearfit"


def srgb(linear):
    return [12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055 for x in linear]


def read_step(file):
    document = TDocStd_Document(TCollection_ExtendedString("XCAF"))
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    assert reader.ReadFile(str(file)) == IFSelect_ReturnStatus.IFSelect_RetDone
    assert reader.Transfer(document)
    found = []

    def name_of(label):
        name = TDataStd_Name()
        return name.Get().ToExtString() if label.FindAttribute(TDataStd_Name.GetID_s(), name) else ""

    def colours_of(*labels):
        """Colours of the instance, else of its shape."""
        for label in labels:
            for kind in (XCAFDoc_ColorSurf, XCAFDoc_ColorGen):
                colour = Quantity_Color()
                if XCAFDoc_ColorTool.GetColor_s(label, kind, colour):
                    return [np.array(srgb([colour.Red(), colour.Green(), colour.Blue()]))]
        return []

    def entry_of(label):
        entry = TCollection_AsciiString()
        TDF_Tool.Entry_s(label, entry)
        return entry.ToCString()

    def visit(label, above):
        place = above * XCAFDoc_ShapeTool.GetLocation_s(label)
        target = TDF_Label()
        if not XCAFDoc_ShapeTool.GetReferredShape_s(label, target):
            target = label
        if XCAFDoc_ShapeTool.IsAssembly_s(target):
            parts = TDF_LabelSequence()
            XCAFDoc_ShapeTool.GetComponents_s(target, parts)
            for i in range(1, parts.Length() + 1):
                visit(parts.Value(i), place)
            return
        t = place.Transformation()
        matrix = np.array([[t.Value(i, j) for j in range(1, 5)] for i in range(1, 4)] + [[0, 0, 0, 1.0]])
        matrix[:3, 3] *= 1e-3
        found.append(Found(name_of(label), matrix, colours_of(label, target), entry_of(target)))

    roots = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(roots)
    for i in range(1, roots.Length() + 1):
        visit(roots.Value(i), TopLoc_Location())
    return found


def read_glb(file):
    scene = trimesh.load(str(file), force="scene", process=False)
    # y is up in glTF.
    up = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
    # Trimesh rounds colours to 8 bits of linear light, which is coarse where it is dark.
    data = file.read_bytes()
    text = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
    colours = {node["name"]: [srgb(text["materials"][p["material"]]["pbrMetallicRoughness"]["baseColorFactor"][:3])
                              for p in text["meshes"][node["mesh"]]["primitives"]]
               for node in text["nodes"] if "mesh" in node}
    # A mesh of several materials becomes several nodes below that of its part.
    graph = scene.graph
    above = graph.transforms.parents
    parts = {}
    for node in graph.nodes_geometry:
        parts.setdefault(above[node] if node.startswith(above[node] + "_") else node, []).append(graph.get(node)[1])
    return [Found(part, up @ graph.get(part)[0],
                  colours.get(part, []),
                  tuple(sorted(geometries))) for part, geometries in parts.items()]


def read_3mf(file):
    scene = trimesh.load(str(file), file_type="3mf", force="scene", process=False)
    # Trimesh leaves colours out.
    core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    root = xml.fromstring(zipfile.ZipFile(file).read("3D/3dmodel.model"))
    bases = {group.get("id"): [base.get("displaycolor") for base in group] for group in root.iter(core + "basematerials")}
    colours = {o.get("name"): [int(bases[o.get("pid")][int(o.get("pindex"))][i:i + 2], 16) / 255 for i in (1, 3, 5)]
               for o in root.iter(core + "object") if o.get("pid")}
    found = []
    for node in scene.graph.nodes_geometry:
        matrix, geometry = scene.graph.get(node)
        matrix = np.array(matrix)
        matrix[:3, 3] *= 1e-3
        found.append(Found(geometry, matrix, [colours[geometry]] if geometry in colours else [], geometry))
    return found


def read_urdf(file):
    root = xml.parse(file).getroot()
    joints = {j.find("child").get("link"): j for j in root.findall("joint")}

    def place(link):
        if link not in joints:
            return np.eye(4)
        joint = joints[link]
        origin = joint.find("origin")
        m = np.eye(4)
        if origin is not None:
            r, p, y = map(float, origin.get("rpy", "0 0 0").split())
            m[:3, :3] = (rotation(np.array([0, 0, 1.0]), y) @ rotation(np.array([0, 1.0, 0]), p) @
                         rotation(np.array([1.0, 0, 0]), r))
            m[:3, 3] = list(map(float, origin.get("xyz", "0 0 0").split()))
        return place(joint.find("parent").get("link")) @ m

    materials = {m.get("name"): [float(x) for x in m.find("color").get("rgba").split()[:3]] for m in root.findall("material")}
    return [Found(link.get("name"), place(link.get("name")),
                  [materials[v.find("material").get("name")] for v in link.findall("visual") if v.find("material") is not None],
                  tuple(v.find("geometry/mesh").get("filename") for v in link.findall("visual")))
            for link in root.findall("link") if link.find("visual") is not None]


def differences(expected, found, are_names_kept):
    """What differs: names that are missing, the largest difference of a matrix, colours that are not there, and sets of parts
    that share triangles in the scene and not in the file."""
    missing, worst, colours, left, shapes = 0, 0.0, 0, list(found), {}
    for part in expected:
        same = [f for f in left if f.name == part.name] if are_names_kept else left
        if not same:
            missing += 1
            continue
        nearest = min(same, key=lambda f: np.abs(f.matrix - part.matrix).max())
        worst = max(worst, np.abs(nearest.matrix - part.matrix).max())
        if not any(np.abs(np.subtract(part.colours[0], c)).max() <= COLOUR_TOLERANCE for c in nearest.colours):
            colours += 1
        shapes.setdefault(part.shape, set()).add(nearest.shape)
        left = [f for f in left if f is not nearest]
    return missing, worst, colours, sum(len(each) > 1 for each in shapes.values())


def validate(file, modules):
    """(errors, warnings, version) by the validator of glTF's makers."""
    script = ("const v=require('gltf-validator');v.validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[1])))"
              ".then(r=>console.log(r.issues.numErrors,r.issues.numWarnings,v.version()))")
    result = subprocess.run(["node", "-e", script, str(file)], capture_output=True, text=True, env={
        "NODE_PATH": str(modules), "PATH": "/usr/local/bin:/usr/bin:/bin"})
    said = result.stdout.split()
    if result.returncode != 0 or len(said) != 3:
        sys.exit(f"the glTF validator does not run: {result.stderr.strip()[-200:]}")
    return int(said[0]), int(said[1]), said[2]


def versions(program):
    """Of what writes: Nearfit, and the OpenCASCADE of the importer beside it."""
    says = subprocess.run([str(program.parent / "nearfit-import"), "--version"], check=True, capture_output=True, text=True).stdout
    own = subprocess.run([str(program), "--version"], check=True, capture_output=True, text=True).stdout.strip()
    return f"{own}, {re.search('OpenCASCADE [0-9.]+', says).group()}"


def expected_parts(placement, scene):
    """Parts by the JSON export, with colours and shapes by the scene file."""
    parts = json.loads(scene.read_text())["parts"]
    matrices = {part["name"]: np.array(part["matrix"]) for part in json.loads(placement.read_text())["parts"]}
    assert matrices.keys() == {part["name"] for part in parts}
    return [Found(part["name"], matrices[part["name"]], [part["colour"]],
                  (part["mesh"], part["shape"] and part["shape"]["key"], tuple(part["colour"]))) for part in parts]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin")
    options.add_argument("--validator", type=Path, help="node_modules with gltf-validator")
    options.add_argument("--no-validator", action="store_true", help="do without the glTF validator")
    options.add_argument("--csv", type=Path, help="write the rows to this file too")
    given = options.parse_args()
    if (given.validator is None) != given.no_validator:
        options.error("give the glTF validator (--validator /tmp/node_modules), or --no-validator")
    at_work = heads.others_at_work()
    try:
        # Nothing is timed.
        heads.check_repeatable(given.csv, ROOT, at_work, allows_busy=True)
    except heads.NotRepeatable as refusal:
        options.error(str(refusal))
    head = heads.head(ROOT, given.bin.resolve().parent, at_work)
    program = given.bin / "nearfit-cli"
    readers = {name: f"{name} {importlib.metadata.version(name)}" for name in ("cadquery-ocp", "trimesh")}
    readers["python"] = f"Python {sys.version.split()[0]}"
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        scene = make_scene(program, folder)

        def export(name):
            subprocess.run([str(program), "export", str(scene), "-o", str(folder / name)], check=True,
                           stdout=subprocess.DEVNULL)
            return folder / name

        expected = expected_parts(export("placement.json"), scene)
        good = True
        for name, read, reader, are_names_kept in (
                ("scene.step", read_step, "cadquery-ocp", True), ("scene.glb", read_glb, "trimesh", True),
                ("scene.3mf", read_3mf, "trimesh", False), ("scene.urdf", read_urdf, "python", True)):
            file = export(name)
            found = read(file)
            missing, worst, colours, unshared = differences(expected, found, are_names_kept)
            is_right = (missing == 0 and worst <= TOLERANCE and colours == 0 and unshared == 0 and len(found) == len(expected))
            errors = warnings = validator = ""
            if name.endswith("glb") and given.validator:
                errors, warnings, validator = validate(file, given.validator.resolve())
                is_right = is_right and errors == 0
            note = f", validator {validator}: {errors} errors, {warnings} warnings" if validator else ""
            print(f"{name}: {len(found)} of {len(expected)} parts, {missing} names missing, poses differ by {worst:.1e}, "
                  f"{colours} colours differ, {unshared} shapes not shared{note}{'' if is_right else '  NOT RIGHT'}")
            good = good and is_right
            if not is_right:
                print("  found:", sorted(f.name for f in found))
            rows.append({"writer": versions(program), "format": file.suffix[1:],
                         "reader": readers[reader], "parts": len(found),
                         "names_equal": ("yes" if missing == 0 else "no") if are_names_kept else "not compared",
                         "max_pose_error": f"{worst:.3g}", "colours_differing": colours, "shapes_not_shared": unshared,
                         "validator": validator and f"gltf-validator {validator}", "validator_errors": errors,
                         "validator_warnings": warnings, "right": "yes" if is_right else "no"})
        if given.csv:
            given.csv.parent.mkdir(parents=True, exist_ok=True)
            with given.csv.open("w", newline="", encoding="utf-8") as out:
                out.writelines(f"# {line}\n" for line in head)
                writer = csv.DictWriter(out, rows[0].keys(), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
        return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
