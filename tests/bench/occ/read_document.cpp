#include "tests/bench/occ/read_document.h"

#include <cmath>
#include <unordered_map>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Message_ProgressRange.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Version.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "app/import/default_tessellation.h"
#include "app/import/solid_bodies.h"
#include "core/base/error.h"
#include "tests/bench/bench_clock.h"

namespace nearfit::bench {
namespace {

/// OpenCASCADE converts lengths of STEP to millimetres.
constexpr double kMetresPerMillimetre = 1e-3;

double secondsSince(double start) {
  return secondsBy(BenchClock::Wall) - start;
}

TopoDS_Compound compoundOf(const std::vector<TopoDS_Shape>& shapes) {
  const BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes)
    builder.Add(compound, shape);
  return compound;
}

/// Shapes of one product: each body of its solids, each closed shell, and what is loose together, as the importer takes
/// them apart.
class ProductShapes {
 public:
  explicit ProductShapes(const TopoDS_Shape& product) {
    visit(product);
    if (!loose_.empty()) instances_.push_back(keep(loose_));
  }

  /// Each once.
  const std::vector<TopoDS_Compound>& shapes() const { return shapes_; }
  /// For each place in the product, the index of the shape there.
  const std::vector<std::size_t>& instances() const { return instances_; }

 private:
  void visit(const TopoDS_Shape& shape) {
    switch (shape.ShapeType()) {
      case TopAbs_COMPOUND:
      case TopAbs_COMPSOLID:
        for (TopoDS_Iterator child(shape); child.More(); child.Next())
          visit(child.Value());
        break;
      case TopAbs_SOLID:
        addSolid(shape.Located(TopLoc_Location()));
        break;
      case TopAbs_SHELL:
        if (BRep_Tool::IsClosed(shape)) {
          instances_.push_back(keep({shape.Located(TopLoc_Location())}));
        } else {
          loose_.push_back(shape);
        }
        break;
      case TopAbs_FACE:
        loose_.push_back(shape);
        break;
      default:
        break;
    }
  }

  void addSolid(const TopoDS_Shape& solid) {
    for (const importer::Body& body : importer::bodiesOf(solid))
      if (!body.shells.empty()) instances_.push_back(keep(body.shells));
  }

  std::size_t keep(const std::vector<TopoDS_Shape>& shells) {
    const auto [at, isNew] = indexOf_.try_emplace(shells.front().TShape().get(), shapes_.size());
    if (isNew) shapes_.push_back(compoundOf(shells));
    return at->second;
  }

  std::vector<TopoDS_Compound> shapes_;
  std::vector<std::size_t> instances_;
  std::vector<TopoDS_Shape> loose_;
  std::unordered_map<const void*, std::size_t> indexOf_;
};

/// Products of a document, and how often each is placed.
class Products {
 public:
  explicit Products(const Handle(TDocStd_Document) & document) {
    TDF_LabelSequence top;
    XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(top);
    for (TDF_LabelSequence::Iterator label(top); label.More(); label.Next())
      visit(label.Value());
  }

  struct Product {
    TopoDS_Shape shape;
    std::size_t places = 0;
  };
  const std::vector<Product>& all() const { return products_; }

 private:
  void visit(TDF_Label label) {
    TDF_Label referred;
    while (XCAFDoc_ShapeTool::GetReferredShape(label, referred))
      label = referred;
    if (!XCAFDoc_ShapeTool::IsAssembly(label)) return place(XCAFDoc_ShapeTool::GetShape(label));
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(label, components);
    for (TDF_LabelSequence::Iterator component(components); component.More(); component.Next())
      visit(component.Value());
  }

  void place(const TopoDS_Shape& shape) {
    if (shape.IsNull()) return;
    const auto [at, isNew] = indexOf_.try_emplace(shape.TShape().get(), products_.size());
    if (isNew) products_.push_back({shape});
    ++products_[at->second].places;
  }

  std::vector<Product> products_;
  std::unordered_map<const void*, std::size_t> indexOf_;
};

struct Tolerances {
  double chord, angle;  ///< [mm], [rad]
};

/// @return The chord is 0 for what has no size.
Tolerances tolerancesOf(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, Standard_False);
  const double diagonal = box.IsVoid() || box.IsOpen() ? 0.0 : std::sqrt(box.SquareExtent());
  return {diagonal > 0.0 ? importer::defaultChord(diagonal, kMetresPerMillimetre, true) : 0.0,
          importer::kDefaultAngle};
}

void meshBy(const TopoDS_Shape& shape, const Tolerances& tolerances) {
  if (!(tolerances.chord > 0.0)) return;
  IMeshTools_Parameters parameters;
  parameters.Deflection = tolerances.chord;
  parameters.Angle = tolerances.angle;
  parameters.InParallel = Standard_True;
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(shape);
  mesher.ChangeParameters() = parameters;
  mesher.Perform(Message_ProgressRange());
}

/// Meshes all shapes and counts them. Only the meshing is timed.
void meshAll(const Products& products, OccRun& run) {
  for (const Products::Product& product : products.all()) {
    const ProductShapes parts(product.shape);
    std::vector<std::size_t> triangles;
    for (const TopoDS_Compound& shape : parts.shapes()) {
      const Tolerances tolerances = tolerancesOf(shape);
      const double start = secondsBy(BenchClock::Wall);
      meshBy(shape, tolerances);
      run.meshSeconds += secondsSince(start);
      triangles.push_back(trianglesOf(shape));
      run.counts.shapes += triangles.back() > 0 ? 1 : 0;
      run.counts.triangles += triangles.back();
    }
    for (const std::size_t shape : parts.instances()) {
      if (triangles[shape] == 0) continue;
      run.counts.instances += product.places;
      run.counts.placedTriangles += product.places * triangles[shape];
    }
  }
}

[[noreturn]] void failToRead(const std::filesystem::path& file) {
  throw FileError(file.string(), "OpenCASCADE cannot read it as STEP", "give a STEP file");
}

}  // namespace

OccRun readAndMesh(const std::filesystem::path& file) {
  OccRun run;
  run.version = OCC_VERSION_COMPLETE;
  // Without names such as "COMPOUND" for what has none, as the importer reads it.
  XCAFDoc_ShapeTool::SetAutoNaming(Standard_False);
  double start = secondsBy(BenchClock::Wall);
  STEPCAFControl_Reader reader;
  reader.SetColorMode(Standard_True);
  reader.SetNameMode(Standard_True);
  reader.SetLayerMode(Standard_False);
  reader.SetPropsMode(Standard_False);
  reader.SetGDTMode(Standard_False);
  reader.SetMatMode(Standard_False);
  reader.SetViewMode(Standard_False);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) failToRead(file);
  run.readSeconds = secondsSince(start);
  start = secondsBy(BenchClock::Wall);
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  if (!reader.Transfer(document)) failToRead(file);
  run.transferSeconds = secondsSince(start);
  meshAll(Products(document), run);
  if (run.counts.triangles == 0) failToRead(file);
  run.peakBytes = peakResidentBytes();
  return run;
}

void meshByDefault(const TopoDS_Shape& shape) {
  meshBy(shape, tolerancesOf(shape));
}

std::size_t trianglesOf(const TopoDS_Shape& shape) {
  std::size_t triangles = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    const TopAbs_Orientation side = face.Current().Orientation();
    if (side != TopAbs_FORWARD && side != TopAbs_REVERSED) continue;
    TopLoc_Location location;
    const Handle(Poly_Triangulation)& mesh = BRep_Tool::Triangulation(TopoDS::Face(face.Current()), location);
    if (!mesh.IsNull()) triangles += static_cast<std::size_t>(mesh->NbTriangles());
  }
  return triangles;
}

}  // namespace nearfit::bench
