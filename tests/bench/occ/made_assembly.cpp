#include "tests/bench/occ/made_assembly.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Wire.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <fmt/format.h>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Dir.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>

#include "core/base/error.h"
#include "tests/bench/occ/read_document.h"

namespace nearfit::bench {
namespace {

/// Distance of neighbouring holes, and thickness of the plates [mm].
constexpr double kPitch = 12.0, kThickness = 8.0;
/// Radii of holes [mm]: the angle, not the chord, decides on their facets, so that plates differ in size alone.
constexpr double kMinRadius = 3.0, kMaxRadius = 4.0;
/// Gap between plates of the assembly [mm].
constexpr double kGap = 5.0;

struct Plate {
  TopoDS_Shape shape;
  double width = 0.0, depth = 0.0;  ///< [mm]
};

TopoDS_Wire holeAt(double x, double y, double radius) {
  const gp_Circ circle(gp_Ax2(gp_Pnt(x, y, 0.0), gp_Dir(0.0, 0.0, 1.0)), radius);
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(circle).Edge());
  // Around a hole the material is on the other side.
  return TopoDS::Wire(wire.Wire().Reversed());
}

/// A plate with its holes in rows.
Plate plateOf(std::size_t holes, double radius) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(holes))));
  const std::size_t rows = (holes + columns - 1) / columns;
  Plate plate;
  plate.width = kPitch * static_cast<double>(columns);
  plate.depth = kPitch * static_cast<double>(rows);
  BRepBuilderAPI_MakePolygon outline(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(plate.width, 0.0, 0.0),
                                     gp_Pnt(plate.width, plate.depth, 0.0), gp_Pnt(0.0, plate.depth, 0.0),
                                     Standard_True);
  BRepBuilderAPI_MakeFace face(gp_Pln(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0)), outline.Wire());
  for (std::size_t i = 0; i < holes; ++i) {
    const double x = kPitch * (static_cast<double>(i % columns) + 0.5);
    const double y = kPitch * (static_cast<double>(i / columns) + 0.5);
    face.Add(holeAt(x, y, radius));
  }
  plate.shape = BRepPrimAPI_MakePrism(face.Face(), gp_Vec(0.0, 0.0, kThickness)).Shape();
  return plate;
}

/// Triangles that the importer makes of a plate.
double trianglesOfPlate(std::size_t holes) {
  const Plate plate = plateOf(holes, kMaxRadius);
  meshByDefault(plate.shape);
  return static_cast<double>(trianglesOf(plate.shape));
}

/// Number of holes of a plate of so many triangles; at least one.
std::size_t holesFor(double triangles) {
  // Each hole adds as many as another, whatever the version of OpenCASCADE makes of it.
  constexpr std::size_t kFew = 16, kMany = 64;
  const double few = trianglesOfPlate(kFew);
  const double each = (trianglesOfPlate(kMany) - few) / static_cast<double>(kMany - kFew);
  const double holes = static_cast<double>(kFew) + (triangles - few) / std::max(each, 1.0);
  return static_cast<std::size_t>(std::max(1.0, std::round(holes)));
}

void setName(const TDF_Label& label, const std::string& name) {
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), Standard_True));
}

/// Place of an instance: in layers of ten by ten.
TopLoc_Location placeOf(std::size_t instance, const Plate& plate) {
  constexpr std::size_t kInARow = 10;
  const auto step = [](std::size_t count, double size) { return static_cast<double>(count) * (size + kGap); };
  gp_Trsf place;
  place.SetTranslation(gp_Vec(step(instance % kInARow, plate.width),
                              step(instance / kInARow % kInARow, plate.depth),
                              step(instance / (kInARow * kInARow), kThickness)));
  return TopLoc_Location(place);
}

}  // namespace

void writeAssembly(const AssemblyOptions& options, const std::filesystem::path& file) {
  if (options.shapes < 1 || options.instances < options.shapes) {
    throw UsageError("--shapes", "there are more shapes than instances, or none",
                     "give as many as --instances at most");
  }
  const std::size_t holes =
      holesFor(static_cast<double>(options.triangles) / static_cast<double>(options.instances));
  const Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  std::vector<Plate> plates;
  std::vector<TDF_Label> products;
  for (std::size_t i = 0; i < options.shapes; ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(options.shapes);
    plates.push_back(plateOf(holes, kMinRadius + fraction * (kMaxRadius - kMinRadius)));
    products.push_back(tool->AddShape(plates.back().shape, Standard_False));
    setName(products.back(), fmt::format("plate {}", i + 1));
  }
  const TDF_Label assembly = tool->NewShape();
  setName(assembly, "plates");
  for (std::size_t i = 0; i < options.instances; ++i) {
    const std::size_t shape = i % options.shapes;
    const TDF_Label instance = tool->AddComponent(assembly, products[shape], placeOf(i, plates[shape]));
    setName(instance, fmt::format("plate {}, {}", shape + 1, i / options.shapes + 1));
  }
  tool->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  writer.SetNameMode(Standard_True);
  if (!writer.Transfer(document) || writer.Write(file.c_str()) != IFSelect_RetDone)
    throw FileError(file.string(), "OpenCASCADE cannot write it", "choose a folder that you may write to");
}

}  // namespace nearfit::bench
