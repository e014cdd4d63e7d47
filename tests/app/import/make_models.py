#!/usr/bin/env python3
"""Makes the files in models/ and the values in oracle.json that the tests of nearfit-import compare with.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install cadquery-ocp==7.8.1.1.post1
    /tmp/venv/bin/python tests/app/import/make_models.py [SHARED]     SHARED: the folder beside the repository

Values come from OpenCASCADE's Python bindings, of another version than the importer's and by the code below alone.
Lengths are in millimetres, as OpenCASCADE has them.
"""
import json
import struct
import sys
import zipfile
from pathlib import Path

from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import (BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere,
                             BRepPrimAPI_MakeTorus)
from OCP.BRepTools import BRepTools
from OCP.GProp import GProp_GProps
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.IGESCAFControl import IGESCAFControl_Writer
from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Reader, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_AsciiString, TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence, TDF_Tool
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound
from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

HERE = Path(__file__).parent
MODELS = HERE / "models"
SHARED = Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parents[3] / "shared") / "models" / "public"
SURFACE, GENERAL = XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen


def axis(x, y, z):
    return gp_Ax2(gp_Pnt(x, y, z), gp_Dir(0, 0, 1))


def box(x0, y0, z0, x1, y1, z1):
    return BRepPrimAPI_MakeBox(gp_Pnt(x0, y0, z0), gp_Pnt(x1, y1, z1)).Shape()


def moved(x, y, z, degrees=0.0):
    turn, shift = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), degrees * 3.14159265358979323846 / 180)
    shift.SetTranslation(gp_Vec(x, y, z))
    shift.Multiply(turn)
    return TopLoc_Location(shift)


def bracket():
    """A block with a bore of radius 4, its countersink, a spherical dimple of radius 6 and half a torus below."""
    shape = box(-30, -20, 0, 30, 20, 20)
    for tool in (BRepPrimAPI_MakeCylinder(axis(15, 0, -1), 4, 16).Shape(),
                 BRepPrimAPI_MakeCone(axis(15, 0, 14), 4, 11, 7).Shape(),
                 BRepPrimAPI_MakeSphere(gp_Pnt(-18, 0, 20), 6).Shape()):
        shape = BRepAlgoAPI_Cut(shape, tool).Shape()
    return BRepAlgoAPI_Fuse(shape, BRepPrimAPI_MakeTorus(axis(-10, 0, 0), 8, 2).Shape()).Shape()


def new_document():
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFDoc_DocumentTool.SetLengthUnit_s(document, 0.001)
    return document, XCAFDoc_DocumentTool.ShapeTool_s(document.Main()), XCAFDoc_DocumentTool.ColorTool_s(document.Main())


def set_name(label, name):
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name, True))


def colour(r, g, b):
    return Quantity_Color(r, g, b, Quantity_TypeOfColor.Quantity_TOC_sRGB)


def compound(shapes):
    builder, result = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(result)
    for shape in shapes:
        builder.Add(result, shape)
    return result


def write_step(document, name, unit="MM", schema="AP214IS"):
    Interface_Static.SetCVal_s("write.step.unit", unit)
    Interface_Static.SetCVal_s("write.step.schema", schema)
    writer = STEPCAFControl_Writer()
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    assert writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
    writer.Write(str(MODELS / name))


def make_step_files():
    document, shapes, colours = new_document()
    set_name(shapes.AddShape(bracket(), False), "bracket")
    write_step(document, "bracket.step")

    document, shapes, colours = new_document()
    bolt = shapes.AddShape(BRepPrimAPI_MakeCylinder(axis(0, 0, 0), 5, 30).Shape(), False)
    plate_shape = box(0, 0, 0, 100, 50, 10)
    plate = shapes.AddShape(plate_shape, False)
    set_name(bolt, "Bolzen")
    set_name(plate, "Platte \u00fc\u4e2d")
    colours.SetColor(bolt, colour(0.25, 0.5, 0.75), SURFACE)
    colours.SetColor(plate, colour(1, 0, 0), SURFACE)
    faces = TopExp_Explorer(plate_shape, TopAbs_ShapeEnum.TopAbs_FACE)
    colours.SetColor(shapes.AddSubShape(plate, faces.Current()), colour(0, 1, 0), SURFACE)
    carrier = shapes.NewShape()
    set_name(carrier, "Tr\u00e4ger")
    for name, part, place in (("bolt left", bolt, moved(20, 25, 10)), ("bolt right", bolt, moved(80, 25, 10)),
                              ("plate", plate, moved(0, 0, 0))):
        set_name(shapes.AddComponent(carrier, part, place), name)
    top = shapes.NewShape()
    set_name(top, "Ger\u00e4t")
    first = shapes.AddComponent(top, carrier, moved(0, 0, 0))
    second = shapes.AddComponent(top, carrier, moved(10, 200, 30, 90))
    set_name(first, "front")
    set_name(second, "back")
    shapes.UpdateAssemblies()
    write_step(document, "assembly_inch.step", unit="INCH")
    write_step(document, "assembly_ap242.step", unit="M", schema="AP242DIS")

    document, shapes, colours = new_document()
    set_name(shapes.AddShape(compound([box(0, 0, 0, 10, 10, 10), box(30, 0, 0, 50, 10, 10)]), False), "pair")
    write_step(document, "two_solids.step")


def make_coloured_faces():
    """Products with colours of faces alone, of a shell and a face of it, and of a part and a face of it."""
    document, shapes, colours = new_document()
    striped_shape, lidded_shape = box(0, 0, 0, 30, 20, 10), box(0, 0, 0, 20, 20, 20)
    drum_shape = BRepPrimAPI_MakeCylinder(axis(0, 0, 0), 8, 25).Shape()
    striped, lidded, drum = (shapes.AddShape(shape, False) for shape in (striped_shape, lidded_shape, drum_shape))
    red, green, blue = colour(1, 0, 0), colour(0, 1, 0), colour(0, 0, 1)
    faces = subshapes(striped_shape, TopAbs_ShapeEnum.TopAbs_FACE)
    for face, value in zip(faces, (red, blue, red)):
        colours.SetColor(shapes.AddSubShape(striped, face), value, SURFACE)
    shell = subshapes(lidded_shape, TopAbs_ShapeEnum.TopAbs_SHELL)[0]
    colours.SetColor(shapes.AddSubShape(lidded, shell), blue, SURFACE)
    colours.SetColor(shapes.AddSubShape(lidded, subshapes(lidded_shape, TopAbs_ShapeEnum.TopAbs_FACE)[5]), green, SURFACE)
    colours.SetColor(drum, colour(0.5, 0.5, 0.5), SURFACE)
    colours.SetColor(shapes.AddSubShape(drum, subshapes(drum_shape, TopAbs_ShapeEnum.TopAbs_FACE)[0]),
                     colour(1, 0.5, 0), SURFACE)
    whole = shapes.NewShape()
    set_name(whole, "set")
    for name, part, x in (("striped", striped, 0), ("lidded", lidded, 40), ("drum", drum, 80), ("striped again", striped, 110)):
        if name != "striped again":
            set_name(part, name)
        set_name(shapes.AddComponent(whole, part, moved(x, 0, 0)), name)
    shapes.UpdateAssemblies()
    write_step(document, "coloured_faces.step")


def make_peg_and_bore():
    """A plate with a bore of radius 8 from its upper face, z = 0, down, and a peg of radius 7.8 with a chamfer at its
    lower end, 5 above the bore; all of it tilted, so that no axis of a bore is one of the file's."""
    plate = BRepAlgoAPI_Cut(box(-25, -20, -15, 25, 20, 0), BRepPrimAPI_MakeCylinder(axis(6.5, -4.25, -16), 8, 18).Shape())
    peg = BRepAlgoAPI_Fuse(BRepPrimAPI_MakeCone(axis(0, 0, 0), 6.8, 7.8, 1).Shape(),
                           BRepPrimAPI_MakeCylinder(axis(0, 0, 1), 7.8, 29).Shape())
    tilt, shift = gp_Trsf(), gp_Trsf()
    tilt.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 3)), 40 * 3.14159265358979323846 / 180)
    shift.SetTranslation(gp_Vec(31, -12, 7))
    shift.Multiply(tilt)
    document, shapes, _ = new_document()
    labels_of = {"plate": shapes.AddShape(plate.Shape(), False), "peg": shapes.AddShape(peg.Shape(), False)}
    fit = shapes.NewShape()
    set_name(fit, "fit")
    for name, place in (("plate", TopLoc_Location(shift)), ("peg", TopLoc_Location(shift).Multiplied(moved(6.5, -4.25, 5)))):
        set_name(labels_of[name], name)
        set_name(shapes.AddComponent(fit, labels_of[name], place), name)
    shapes.UpdateAssemblies()
    write_step(document, "peg_and_bore.step")


def make_other_files():
    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(box(0, 0, 0, 40, 20, 10))
    writer.ComputeModel()
    writer.Write(str(MODELS / "box.igs"))
    BRepTools.Write_s(box(0, 0, 0, 4, 2, 1), str(MODELS / "box.brep"))

    # A tetrahedron of unit legs, placed as it is, moved, and mirrored.
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    corners = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    # Each corner on its own, as files with normals have it.
    positions = b"".join(struct.pack("<3f", *points[i]) for t in corners for i in t)
    indices = struct.pack("<12H", *range(12))
    gltf = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "rack", "children": [1, 2, 3]}, {"name": "one", "mesh": 0},
                  {"name": "moved", "mesh": 0, "translation": [2, 0, 0]},
                  {"name": "scaled", "mesh": 0, "translation": [0, 3, 0], "scale": [2, 2, 2]}],
        "meshes": [{"name": "tetrahedron", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.0, 1.0, 0.0, 1.0]}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 12, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 144}, {"buffer": 0, "byteOffset": 144, "byteLength": 24}],
        "buffers": [{"byteLength": 168}],
    }
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    data = positions + indices
    (MODELS / "tetrahedra.glb").write_bytes(
        struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text +
        struct.pack("<I4s", len(data), b"BIN\0") + data)

    make_iges_of_parts()
    make_threemf(points, corners)
    make_coloured_threemf(points, corners)


def make_iges_of_parts():
    """A plate of 2 x 1 x 0.5 in whose face at x = 0 is green, and beside it a block of 1 in; both as loose faces."""
    document, shapes, colours = new_document()
    plate_shape = box(0, 0, 0, 50.8, 25.4, 12.7)
    plate, block = shapes.AddShape(plate_shape, False), shapes.AddShape(box(76.2, 0, 0, 101.6, 25.4, 25.4), False)
    set_name(plate, "plate")
    set_name(block, "block")
    faces = TopExp_Explorer(plate_shape, TopAbs_ShapeEnum.TopAbs_FACE)
    colours.SetColor(shapes.AddSubShape(plate, faces.Current()), colour(0, 1, 0), SURFACE)
    # Without it there is no such setting yet.
    IGESControl_Controller.Init_s()
    Interface_Static.SetCVal_s("write.iges.unit", "INCH")
    writer = IGESCAFControl_Writer()
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    assert writer.Transfer(document)
    writer.Write(str(MODELS / "parts_inch.igs"))


def make_threemf(points, corners):
    """Two instances of a tetrahedron, in inches, the second turned about z; its material is the second of a group."""
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in points)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in corners)
    model = ('<?xml version="1.0" encoding="UTF-8"?><model unit="inch" xml:lang="en-US" '
             'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
             '<basematerials id="5"><base name="red" displaycolor="#FF0000"/><base name="teal" displaycolor="#008040"/></basematerials>'
             f'<object id="1" name="H\u00fclse" type="model" pid="5" pindex="1"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>'
             '<object id="2" name="set" type="model"><components><component objectid="1"/>'
             '<component objectid="1" transform="0 1 0 -1 0 0 0 0 1 5 6 7"/></components></object></resources>'
             '<build><item objectid="2" transform="1 0 0 0 1 0 0 0 1 10 0 0"/></build></model>')
    write_threemf("set.3mf", model)


def make_coloured_threemf(points, corners):
    """Three tetrahedra: one red by its object, with a teal and two blue triangles; one whose triangles are all green; and
    one without a colour."""
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in points)

    def tetrahedron(number, name, of_object, of_triangles):
        triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"{of}/>' for (a, b, c), of in zip(corners, of_triangles))
        return (f'<object id="{number}" name="{name}" type="model"{of_object}><mesh><vertices>{vertices}</vertices>'
                f'<triangles>{triangles}</triangles></mesh></object>')

    blue, green = ' pid="6" p1="0"', ' pid="6" p1="1"'
    write_threemf("colours.3mf", (
        '<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xml:lang="en-US" '
        'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" '
        'xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"><resources>'
        '<basematerials id="5"><base name="red" displaycolor="#FF0000"/><base name="teal" displaycolor="#008040"/></basematerials>'
        '<m:colorgroup id="6"><m:color color="#0000FF"/><m:color color="#00FF00"/></m:colorgroup>'
        + tetrahedron(1, "mixed", ' pid="5" pindex="0"', ["", ' pid="5" p1="1"', blue, blue])
        + tetrahedron(2, "green", "", [green] * 4) + tetrahedron(3, "plain", "", [""] * 4) +
        '</resources><build><item objectid="1"/><item objectid="2"/><item objectid="3"/></build></model>'))


def write_threemf(name, model):
    with zipfile.ZipFile(MODELS / name, "w", zipfile.ZIP_DEFLATED) as package:
        for member, content in (
                ("[Content_Types].xml",
                 '<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
                 '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
                 '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'),
                ("_rels/.rels",
                 '<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                 '<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'),
                ("3D/3dmodel.model", model)):
            package.writestr(zipfile.ZipInfo(member, (2026, 1, 1, 0, 0, 0)), content)


def volume_of(shape):
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, 1e-7, False, False)
    return properties.Mass()


def box_of(shape):
    bounds = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, bounds, False, False)
    low, high = bounds.CornerMin(), bounds.CornerMax()
    return [low.X(), low.Y(), low.Z()], [high.X(), high.Y(), high.Z()]


def count(shape, kind):
    explorer, number = TopExp_Explorer(shape, kind), 0
    while explorer.More():
        number, _ = number + 1, explorer.Next()
    return number


def name_of(label):
    name = TDataStd_Name()
    return name.Get().ToExtString() if label.FindAttribute(TDataStd_Name.GetID_s(), name) else ""


def colour_of(label):
    value = Quantity_Color()
    for kind in (SURFACE, GENERAL):
        if XCAFDoc_ColorTool.GetColor_s(label, kind, value):
            return [round(x, 4) for x in value.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)]
    return None


def subshapes(shape, kind):
    explorer, found = TopExp_Explorer(shape, kind), []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def face_colours(product, of_part):
    """Colours of a product's faces with their numbers, sorted: [r, g, b, number]. The colour of a subshape is that of its
    faces, unless a smaller subshape has one; other faces have the part's. Faces without a colour are not counted."""
    coloured, parts, counts = [], TDF_LabelSequence(), {}
    XCAFDoc_ShapeTool.GetSubShapes_s(product, parts)
    for part in labels(parts):
        faces = subshapes(XCAFDoc_ShapeTool.GetShape_s(part), TopAbs_ShapeEnum.TopAbs_FACE)
        if colour_of(part):
            coloured.append((len(faces), faces, colour_of(part)))
    coloured.sort(key=lambda entry: entry[0])
    for face in subshapes(XCAFDoc_ShapeTool.GetShape_s(product), TopAbs_ShapeEnum.TopAbs_FACE):
        own = next((value for _, faces, value in coloured if any(face.IsPartner(other) for other in faces)), of_part)
        if own:
            counts[tuple(own)] = counts.get(tuple(own), 0) + 1
    return [[*value, number] for value, number in sorted(counts.items())]


def labels(sequence):
    return [sequence.Value(i) for i in range(1, sequence.Length() + 1)]


def instances(label, place, path, found):
    """Adds what a label stands for: each product with the names down to it, its colour, and its exact box in the scene."""
    target = TDF_Label()
    if not XCAFDoc_ShapeTool.GetReferredShape_s(label, target):
        target = label
    place = place.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(label))
    path = path + [[name_of(label), name_of(target)]]
    if XCAFDoc_ShapeTool.IsAssembly_s(target):
        components = TDF_LabelSequence()
        XCAFDoc_ShapeTool.GetComponents_s(target, components)
        for component in labels(components):
            instances(component, place, path, found)
        return
    shape = XCAFDoc_ShapeTool.GetShape_s(target)
    entry = TCollection_AsciiString()
    TDF_Tool.Entry_s(target, entry)
    low, high = box_of(shape.Moved(place))
    of_part = colour_of(label) or colour_of(target)
    found.append({"path": path, "product": entry.ToCString(), "solids": count(shape, TopAbs_ShapeEnum.TopAbs_SOLID),
                  "faces": count(shape, TopAbs_ShapeEnum.TopAbs_FACE), "volume": volume_of(shape),
                  "colour": of_part, "face_colours": face_colours(target, of_part), "low": low, "high": high})


def examine(file):
    reader = STEPCAFControl_Reader()
    reader.SetColorMode(True)
    reader.SetNameMode(True)
    reader.ReadFile(str(file))
    document, shapes, _ = new_document()
    assert reader.Transfer(document)
    free, found = TDF_LabelSequence(), []
    shapes.GetFreeShapes(free)
    for label in labels(free):
        instances(label, TopLoc_Location(), [], found)
    return found


def main():
    MODELS.mkdir(exist_ok=True)
    make_step_files()
    make_coloured_faces()
    make_peg_and_bore()
    make_other_files()
    files = sorted(MODELS.glob("*.step")) + sorted(f for f in SHARED.iterdir() if f.suffix.lower() in (".stp", ".step"))
    result = {file.name: examine(file) for file in files}
    (HERE / "oracle.json").write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
