"""Reads what nearfit-cli exports with libraries that share no code with it. Every function returns metres and colours in sRGB."""
import json
import subprocess
import zipfile
from collections import namedtuple

import lib3mf
import numpy as np
import trimesh
import yourdfpy
from lxml import etree
from OCP.Bnd import Bnd_Box
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepGProp import BRepGProp
from OCP.GeomAbs import GeomAbs_Plane
from OCP.gp import gp_Trsf
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Quantity import Quantity_Color
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_AsciiString, TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence, TDF_Tool
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS
from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_ColorTool, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

# A part: names of the groups around it from the outermost on, its pose, colours (0 to 1), what names its triangles, and its
# geometry.
Found = namedtuple("Found", "name groups matrix colours shape geometry")
# Volume, and corners of the box in the part's frame; solids and faces that are not planar are None where a reader has triangles.
Geometry = namedtuple("Geometry", "volume box solids curved")
# y is up in glTF.
SCENE_FROM_GLTF = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
METRES = {"micron": 1e-6, "millimeter": 1e-3, "centimeter": 1e-2, "inch": 0.0254, "foot": 0.3048, "meter": 1.0}


def srgb(linear):
    return [12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055 for x in linear]


def explore(shape, kind):
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def exact_geometry(shape):
    """Returns the Geometry of an OpenCASCADE shape, in its own frame."""
    properties, box = GProp_GProps(), Bnd_Box()
    BRepGProp.VolumeProperties_s(shape, properties)
    BRepBndLib.AddOptimal_s(shape, box, False, False)
    corners = np.array(box.Get()).reshape(2, 3)
    curved = sum(BRepAdaptor_Surface(TopoDS.Face_s(face)).GetType() != GeomAbs_Plane for face in explore(shape, TopAbs_FACE))
    return Geometry(1e-9 * properties.Mass(), 1e-3 * corners, len(list(explore(shape, TopAbs_SOLID))), curved)


def moved_box(shape, matrix):
    """Returns the box of an OpenCASCADE shape at a pose in metres."""
    turn, rows = gp_Trsf(), matrix[:3].copy()
    rows[:, 3] *= 1e3
    turn.SetValues(*rows.ravel())
    return exact_geometry(shape.Moved(TopLoc_Location(turn))).box


def mesh_geometry(meshes, metres=1.0):
    """Returns the Geometry of trimesh meshes that bound one part together."""
    corners = np.array([mesh.bounds for mesh in meshes])
    return Geometry(metres**3 * sum(mesh.volume for mesh in meshes),
                    metres * np.array([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)]), None, None)


def read_step(file):
    return [found for found, _ in read_step_shapes(file)]


def read_step_shapes(file):
    """Pairs of a part and its shape."""
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

    def visit(label, above, groups):
        place = above * XCAFDoc_ShapeTool.GetLocation_s(label)
        target = TDF_Label()
        if not XCAFDoc_ShapeTool.GetReferredShape_s(label, target):
            target = label
        if XCAFDoc_ShapeTool.IsAssembly_s(target):
            parts = TDF_LabelSequence()
            XCAFDoc_ShapeTool.GetComponents_s(target, parts)
            for i in range(1, parts.Length() + 1):
                visit(parts.Value(i), place, (*groups, name_of(label)))
            return
        t = place.Transformation()
        matrix = np.array([[t.Value(i, j) for j in range(1, 5)] for i in range(1, 4)] + [[0, 0, 0, 1.0]])
        matrix[:3, 3] *= 1e-3
        shape = XCAFDoc_ShapeTool.GetShape_s(target)
        # The outermost assembly is the file.
        found.append((Found(name_of(label), groups[1:], matrix, colours_of(label, target), entry_of(target),
                            exact_geometry(shape)), shape))

    roots = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(roots)
    for i in range(1, roots.Length() + 1):
        visit(roots.Value(i), TopLoc_Location(), ())
    return found


def above_in(parents, node, end):
    """Names of nodes over one, from the outermost on, without `end` and what is over that."""
    groups = []
    while (node := parents.get(node, end)) != end:
        groups.insert(0, node)
    return tuple(groups)


def read_glb(file):
    scene = trimesh.load(str(file), force="scene", process=False)
    # Trimesh rounds colours to 8 bits of linear light, which is coarse where it is dark.
    data = file.read_bytes()
    text = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
    colours = {node["name"]: [srgb(text["materials"][p["material"]]["pbrMetallicRoughness"]["baseColorFactor"][:3])
                              for p in text["meshes"][node["mesh"]]["primitives"]]
               for node in text["nodes"] if "mesh" in node}
    root = text["nodes"][text["scenes"][0]["nodes"][0]]["name"]
    # A mesh of several materials becomes several nodes below that of its part.
    graph = scene.graph
    parents = graph.transforms.parents
    parts = {}
    for node in graph.nodes_geometry:
        parts.setdefault(parents[node] if node.startswith(parents[node] + "_") else node, []).append(graph.get(node)[1])
    return [Found(part, above_in(parents, part, root), SCENE_FROM_GLTF @ graph.get(part)[0], colours.get(part, []),
                  tuple(sorted(geometries)), mesh_geometry([scene.geometry[name] for name in geometries]))
            for part, geometries in parts.items()]


def read_3mf(file):
    """Objects, names, colours and meshes by lib3mf. It keeps poses in single precision, so the numbers are taken from the text
    and must be those of lib3mf but for that."""
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(file))
    assert reader.GetWarningCount() == 0, reader.GetWarning(0)
    root = etree.fromstring(zipfile.ZipFile(file).read("3D/3dmodel.model"))
    core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    metres = METRES[root.get("unit")]
    assert model.GetUnit().name.lower() == root.get("unit").replace("micron", "micrometer")
    texts = {int(element.get("id")): element for element in root.iter(core + "object")}
    found = []

    def colours_of(item):
        group, index, is_given = item.GetObjectLevelProperty()
        if not is_given:
            return []
        colour = model.GetBaseMaterialGroupByID(group).GetDisplayColor(index)
        return [np.array([colour.Red, colour.Green, colour.Blue]) / 255]

    def geometry_of(item):
        vertices = np.array([list(vertex.Coordinates) for vertex in item.GetVertices()])
        faces = np.array([list(triangle.Indices) for triangle in item.GetTriangleIndices()])
        return mesh_geometry([trimesh.Trimesh(vertices, faces, process=False)], metres)

    def placed(place, element):
        """Rows are multiplied in the format."""
        text = element.get("transform")
        numbers = np.array(text.split() if text else np.eye(4)[:, :3].ravel(), float).reshape(4, 3)
        read = np.array([list(row) for row in place.Fields]).reshape(4, 3)
        assert np.allclose(read, numbers, rtol=1e-6, atol=1e-6), f"lib3mf has {read} for {text}"
        matrix = np.eye(4)
        matrix[:3] = numbers.T
        matrix[:3, 3] *= metres
        return matrix

    def visit(item, above, groups, name):
        element = texts[item.GetModelResourceID()]
        if item.IsMeshObject():
            found.append(Found(name or item.GetName(), groups, above, colours_of(item), item.GetModelResourceID(),
                               geometry_of(item)))
            return
        item = model.GetComponentsObjectByID(item.GetUniqueResourceID())
        components = element.findall(f"{core}components/{core}component")
        assert item.GetComponentCount() == len(components)
        for i, component in enumerate(components):
            inner = item.GetComponent(i)
            target = inner.GetObjectResource()
            # An object of one mesh alone, in its own frame, names a part of a shared mesh.
            is_name = len(components) == 1 and target.IsMeshObject() and component.get("transform") is None
            place = above @ placed(inner.GetTransform(), component)
            visit(target, place, groups if is_name else (*groups, item.GetName()), item.GetName() if is_name else "")

    items = model.GetBuildItems()
    for element in root.findall(f"{core}build/{core}item"):
        assert items.MoveNext()
        item = items.GetCurrent()
        visit(item.GetObjectResource(), placed(item.GetObjectTransform(), element), (), "")
    return found


def read_urdf(file):
    robot = yourdfpy.URDF.load(str(file))
    parents = robot.scene.graph.transforms.parents
    meshes = {parents[node]: robot.scene.geometry[robot.scene.graph.get(node)[1]] for node in robot.scene.graph.nodes_geometry}
    materials = {material.name: material.color.rgba[:3] for material in robot.robot.materials}
    return [Found(name, above_in(parents, name, robot.base_link), robot.get_transform(name),
                  [materials[visual.material.name] for visual in link.visuals],
                  tuple(visual.geometry.mesh.filename for visual in link.visuals), mesh_geometry([meshes[name]]))
            for name, link in robot.link_map.items() if link.visuals]


def read_mesh(file, metres):
    """(geometry, number of triangles, closed) of a mesh file: every edge has two triangles once equal vertices are merged."""
    mesh = trimesh.load(str(file), force="mesh", process=False)
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    return mesh_geometry([mesh], metres), len(mesh.faces), bool(mesh.is_watertight and mesh.is_winding_consistent)


def run_node(modules, script, *arguments):
    """Runs a JavaScript module, and returns the JSON that it prints."""
    result = subprocess.run(["node", "--input-type=module", "-e", script, *map(str, arguments)], capture_output=True, text=True,
                            cwd=modules.parent)
    assert result.returncode == 0, result.stderr.strip()[-400:]
    return json.loads(result.stdout)


def validate_gltf(file, modules):
    """(errors, warnings, version) by the validator of glTF's makers."""
    return run_node(modules, """
        import v from 'gltf-validator';
        import fs from 'fs';
        const report = await v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1])));
        console.log(JSON.stringify([report.issues.numErrors, report.issues.numWarnings, v.version()]));""", file.resolve())


def play_gltf(file, times, modules):
    """(vertices in the scene by name of a mesh's node, at each of the times, duration, version) of a file's first animation,
    played by three.js."""
    meshes, duration, version = run_node(modules, """
        import * as three from 'three';
        import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
        import fs from 'fs';
        globalThis.self = globalThis;
        const bytes = fs.readFileSync(process.argv[1]);
        const gltf = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
        const mixer = new three.AnimationMixer(gltf.scene);
        const action = mixer.clipAction(gltf.animations[0]);
        action.setLoop(three.LoopOnce);
        action.clampWhenFinished = true;
        action.play();
        const meshes = {};
        for (const time of JSON.parse(process.argv[2])) {
            mixer.setTime(time);
            gltf.scene.updateMatrixWorld(true);
            gltf.scene.traverse(node => {
                if (!node.isMesh) return;
                const at = node.geometry.getAttribute('position'), points = [];
                for (let i = 0; i < at.count; ++i)
                    points.push(new three.Vector3().fromBufferAttribute(at, i).applyMatrix4(node.matrixWorld).toArray());
                (meshes[node.userData.name] ??= []).push(points);
            });
        }
        console.log(JSON.stringify([meshes, gltf.animations[0].duration, three.REVISION]));""", file.resolve(), json.dumps(list(times)))
    return {name: [np.array(points) @ SCENE_FROM_GLTF[:3, :3].T for points in each] for name, each in meshes.items()}, duration, version
