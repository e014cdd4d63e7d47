#!/usr/bin/env python3
"""Exports an assembly with nearfit-cli and reads it back with libraries that share no code with it.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install cadquery-ocp==7.8.1.1.post1 trimesh==5.2.0 numpy networkx lxml
    (cd /tmp && npm install gltf-validator)
    /tmp/venv/bin/python tests/app/export/read_back.py [--bin build/release/bin] [--validator /tmp/node_modules]

Parts of tests/app/import/models, of a mesh, and names and poses made to be hard are compared with the JSON export:
names must be equal, and matrices to 1e-9 (metres; rotations as numbers). Prints a row for each format and ends with 1 if
one of them differs. STEP is read by OpenCASCADE's Python bindings, of another version than the exporter's, glTF and 3MF
by trimesh, URDF by the standard library; glTF is checked by the validator of its makers, if that is there.
"""
import argparse
import json
import random
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np
import trimesh
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

ROOT = Path(__file__).resolve().parents[3]
TOLERANCE = 1e-9
NAMES = ['Grundplatte Ø16', '軸', 'a<b>&"c"', "d 'e'", 'f;g,(h)', 'tab and  spaces', '🔩 M16']


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


def read_step(file):
    document = TDocStd_Document(TCollection_ExtendedString("XCAF"))
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    assert reader.ReadFile(str(file)) == IFSelect_ReturnStatus.IFSelect_RetDone
    assert reader.Transfer(document)
    found = []

    def name_of(label):
        name = TDataStd_Name()
        return name.Get().ToExtString() if label.FindAttribute(TDataStd_Name.GetID_s(), name) else ""

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
        found.append((name_of(label), matrix))

    roots = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(roots)
    for i in range(1, roots.Length() + 1):
        visit(roots.Value(i), TopLoc_Location())
    return found


def read_glb(file):
    scene = trimesh.load(str(file), force="scene", process=False)
    # y is up in glTF.
    up = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
    # A mesh of several materials becomes several nodes below that of its part.
    graph = scene.graph
    above = graph.transforms.parents
    parts = {above[node] if node.startswith(above[node] + "_") else node for node in graph.nodes_geometry}
    return [(node, up @ graph.get(node)[0]) for node in parts]


def read_3mf(file):
    scene = trimesh.load(str(file), file_type="3mf", force="scene", process=False)
    found = []
    for node in scene.graph.nodes_geometry:
        matrix, geometry = scene.graph.get(node)
        matrix = np.array(matrix)
        matrix[:3, 3] *= 1e-3
        found.append((geometry, matrix))
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

    return [(link.get("name"), place(link.get("name"))) for link in root.findall("link") if link.find("visual") is not None]


def differences(expected, found, are_names_kept):
    """(names that are missing, the largest difference of a matrix)."""
    missing, worst, left = 0, 0.0, list(found)
    for name, matrix in expected:
        same = [f for f in left if f[0] == name] if are_names_kept else left
        if not same:
            missing += 1
            continue
        nearest = min(same, key=lambda f: np.abs(f[1] - matrix).max())
        worst = max(worst, np.abs(nearest[1] - matrix).max())
        left = [f for f in left if f is not nearest]
    return missing, worst


def validate(file, modules):
    script = ("const v=require('gltf-validator');v.validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[1])))"
              ".then(r=>console.log(r.issues.numErrors,r.issues.numWarnings))")
    result = subprocess.run(["node", "-e", script, str(file)], capture_output=True, text=True, env={
        "NODE_PATH": str(modules), "PATH": "/usr/local/bin:/usr/bin:/bin"})
    return f"validator: {result.stdout.strip() or result.stderr.strip()[-80:]} (errors, warnings)"


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin")
    options.add_argument("--validator", type=Path)
    options = options.parse_args()
    program = options.bin / "nearfit-cli"
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        scene = make_scene(program, folder)

        def export(name):
            subprocess.run([str(program), "export", str(scene), "-o", str(folder / name)], check=True,
                           stdout=subprocess.DEVNULL)
            return folder / name

        placement = json.loads(export("placement.json").read_text())
        expected = [(part["name"], np.array(part["matrix"])) for part in placement["parts"]]
        good = True
        for name, read, are_names_kept in (("scene.step", read_step, True), ("scene.glb", read_glb, True),
                                           ("scene.3mf", read_3mf, False), ("scene.urdf", read_urdf, True)):
            file = export(name)
            found = read(file)
            missing, worst = differences(expected, found, are_names_kept)
            is_right = missing == 0 and worst <= TOLERANCE and len(found) == len(expected)
            note = validate(file, options.validator) if name.endswith("glb") and options.validator else ""
            print(f"{name}: {len(found)} of {len(expected)} parts, {missing} names missing, "
                  f"poses differ by {worst:.1e}{'' if is_right else '  NOT RIGHT'} {note}")
            good = good and is_right
            if not is_right:
                print("  found:", sorted(n for n, _ in found))
        return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
