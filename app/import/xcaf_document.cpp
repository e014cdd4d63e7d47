#include "app/import/xcaf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Message_ProgressRange.hxx>
#include <Message_ProgressScope.hxx>
#include <OSD_Parallel.hxx>
#include <OSD_ThreadPool.hxx>
#include <Quantity_Color.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <Standard_Failure.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFDoc_VisMaterial.hxx>
#include <XCAFDoc_VisMaterialTool.hxx>
#include <fmt/format.h>
#include <gp_Trsf.hxx>

#include "app/import/early_meshes.h"
#include "app/import/meshing_plan.h"
#include "app/import/occ_progress.h"
#include "app/import/placed_mesh.h"
#include "app/import/shape_mesher.h"
#include "app/import/solid_bodies.h"
#include "app/import/step_text.h"
#include "core/base/error.h"
#include "core/import/document_file.h"

namespace nearfit::importer {
namespace {

/// Gap between faces that are sewn, as a fraction of the diagonal of their product: programs write such faces with six
/// digits or so.
constexpr double kSewingFraction = 1e-5;
/// Shapes that are looked at within one product: a compound of compounds can stand for any number.
constexpr std::size_t kMaxVisits = 20 * kMaxDocumentNodes;

glm::dmat3 linearPartOf(const gp_Trsf& place) {
  glm::dmat3 map(1.0);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      map[column][row] = place.Value(row + 1, column + 1);
  return map;
}

glm::dvec3 translationOf(const gp_Trsf& place) {
  return {place.Value(1, 4), place.Value(2, 4), place.Value(3, 4)};
}

/// A placement: p to rotation * (scale * p) + translation. OpenCASCADE's scale is the same in all directions, and
/// negative if it mirrors.
struct Placement {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 translation{0.0};
  double scale = 1.0;
};

/// No value if it is flat or not finite.
std::optional<Placement> placementOf(const TopLoc_Location& location) {
  const gp_Trsf place = location.Transformation();
  const std::optional<SplitMap> split = splitMap(linearPartOf(place));
  if (!split) return std::nullopt;
  Placement placement{split->rotation, translationOf(place),
                      isIdentity(split->rest) ? 1.0 : split->rest[0][0]};
  // Half a rounding of the scale must not make another variant of each shape.
  if (std::abs(std::abs(placement.scale) - 1.0) < 1e-6) placement.scale = placement.scale < 0.0 ? -1.0 : 1.0;
  return placement;
}

/// Geometry within a product.
struct Piece {
  Body body;
  TopoDS_Shape whole;  ///< Of formats of triangles.
  bool isSolid = false;
  Placement productFromPiece;
  const void* identity = nullptr;  ///< The same for pieces that are the same geometry.
  std::optional<CadColour> colour;
};

struct Product {
  std::string name;
  std::optional<CadColour> colour;
  std::vector<Piece> pieces;
  ColourTable colours;
  std::map<std::pair<const void*, double>, std::int32_t> shapes;  ///< By identity of a piece and scale.
};

/// A shape to be meshed once the tree is known.
struct PendingShape {
  std::int32_t shape = -1;
  const Piece* piece = nullptr;
  const Product* product = nullptr;
  double scale = 1.0;
};

/// Loose faces and shells of a product.
struct LooseFaces {
  std::vector<TopoDS_Shape> shapes;
  std::size_t others = 0;  ///< Wires, edges and vertices.
};

class PieceFinder {
 public:
  /// @param name  Of the product, for messages.
  PieceFinder(const ImportJob& job, std::vector<Piece>& pieces) : job_(job), pieces_(pieces) {}

  void find(const TopoDS_Shape& shape) { visit(shape, 0); }
  LooseFaces& loose() { return loose_; }
  void addShell(const TopoDS_Shape& shell) { addPiece(Body{{shell.Located(TopLoc_Location())}}, shell); }

 private:
  void visit(const TopoDS_Shape& shape, int depth) {
    if (++visits_ > kMaxVisits || depth > kMaxNesting)
      throw FileError(job_.file.string(), "a product of it is nested too deep, or stands for too many shapes",
                      "export the parts as solids");
    switch (shape.ShapeType()) {
      case TopAbs_COMPOUND:
      case TopAbs_COMPSOLID:
        for (TopoDS_Iterator child(shape); child.More(); child.Next())
          visit(child.Value(), depth + 1);
        break;
      case TopAbs_SOLID:
        addSolid(shape);
        break;
      case TopAbs_SHELL:
        if (BRep_Tool::IsClosed(shape)) {
          addShell(shape);
        } else {
          loose_.shapes.push_back(shape);
        }
        break;
      case TopAbs_FACE:
        loose_.shapes.push_back(shape);
        break;
      default:
        ++loose_.others;
    }
  }

  void addSolid(const TopoDS_Shape& solid) {
    const void* identity = solid.TShape().get();
    const auto known = bodies_.find(identity);
    if (known == bodies_.end()) bodies_[identity] = bodiesOf(solid.Located(TopLoc_Location()));
    std::vector<Body>& bodies = bodies_[identity];
    for (Body& body : bodies)
      if (!body.shells.empty()) addPiece(body, solid);
  }

  void addPiece(const Body& body, const TopoDS_Shape& placed) {
    const std::optional<Placement> placement = placementOf(placed.Location());
    if (!placement) return;
    Piece piece;
    piece.body = body;
    piece.isSolid = true;
    piece.productFromPiece = *placement;
    piece.identity = body.shells.front().TShape().get();
    pieces_.push_back(std::move(piece));
    identities_.push_back(placed.TShape().get());
  }

 public:
  /// What each piece is a part of, for its colour.
  const std::vector<const void*>& identities() const { return identities_; }

 private:
  static constexpr int kMaxNesting = 200;

  const ImportJob& job_;
  std::vector<Piece>& pieces_;
  std::vector<const void*> identities_;
  std::unordered_map<const void*, std::vector<Body>> bodies_;
  LooseFaces loose_;
  std::size_t visits_ = 0;
};

/// Adds the colours of faces for the faces that sewing has made of them.
void keepColours(const BRepBuilderAPI_Sewing& sewing, const TopoDS_Shape& unsewn, ColourTable& colours) {
  for (TopExp_Explorer old(unsewn, TopAbs_FACE); old.More(); old.Next()) {
    const std::optional<CadColour> colour = findColour(colours, old.Current().TShape().get());
    if (!colour) continue;
    const TopoDS_Shape result = sewing.ModifiedSubShape(old.Current());
    // A face that is too small is gone.
    if (result.IsNull()) continue;
    for (TopExp_Explorer face(result, TopAbs_FACE); face.More(); face.Next())
      colours.try_emplace(face.Current().TShape().get(), *colour);
  }
}

/// Joins faces along edges that lie on each other.
TopoDS_Shape sewn(const std::vector<TopoDS_Shape>& shapes, ColourTable& colours) {
  const TopoDS_Compound all = compoundOf(shapes);
  Bnd_Box box;
  BRepBndLib::Add(all, box, Standard_False);
  if (box.IsVoid() || box.IsOpen()) return all;
  BRepBuilderAPI_Sewing sewing(std::sqrt(box.SquareExtent()) * kSewingFraction);
  sewing.Add(all);
  sewing.Perform();
  if (sewing.SewedShape().IsNull()) return all;
  keepColours(sewing, all, colours);
  return sewing.SewedShape();
}

/// Names that programs make up for instances that have none: "NAUO12", "=>[0:1:1:2]", numbers.
bool isMadeUp(const std::string& name) {
  const auto isDigits = [](std::string_view text) {
    return text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return name.starts_with("=>") || isDigits(name) ||
         (name.starts_with("NAUO") && isDigits(std::string_view(name).substr(4)));
}

class XcafReader {
 public:
  XcafReader(TDocStd_Document& document, const XcafOptions& options, const ImportJob& job,
             OccProgress& progress)
      : options_(options),
        job_(job),
        progress_(progress),
        builder_(job),
        shapes_(XCAFDoc_DocumentTool::ShapeTool(document.Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document.Main())),
        materials_(XCAFDoc_DocumentTool::VisMaterialTool(document.Main())) {}

  CadDocument read() {
    builder_.setHasUnit(options_.hasUnit);
    if (options_.areTriangles) builder_.setHasTrianglesOnly();
    TDF_LabelSequence top;
    shapes_->GetFreeShapes(top);
    checkInstances(top);
    for (TDF_LabelSequence::Iterator label(top); label.More(); label.Next())
      place(label.Value(), {});
    if (job_.takeExact) {
      giveExact();
      return {};
    }
    meshAll();
    if (looseParts_ > 0) {
      builder_.warn(
          fmt::format("{} wires, curves or points are left out: only faces make up parts.", looseParts_));
    }
    return builder_.take();
  }

 private:
  /// What a placed label takes from those around it.
  struct Context {
    std::int32_t parent = -1;
    double scale = 1.0;  ///< Of all placements around it.
    std::optional<CadColour> colour;
  };

  static TDF_Label targetOf(TDF_Label label) {
    // Chains are short; a cycle would never end.
    for (int i = 0; i < 16 && XCAFDoc_ShapeTool::IsReference(label); ++i) {
      TDF_Label next;
      if (!XCAFDoc_ShapeTool::GetReferredShape(label, next)) break;
      label = next;
    }
    return label;
  }

  /// Refuses trees that stand for too many nodes, before any is made.
  void checkInstances(const TDF_LabelSequence& top) {
    std::uint64_t count = 0;
    for (TDF_LabelSequence::Iterator label(top); label.More(); label.Next())
      count += countBelow(targetOf(label.Value()), 0);
    if (count > kMaxDocumentNodes) {
      throw FileError(job_.file.string(),
                      fmt::format("its assemblies stand for more than {} instances", kMaxDocumentNodes),
                      "open a part of the assembly");
    }
  }

  std::uint64_t countBelow(const TDF_Label& label, std::size_t depth) {
    if (depth > kMaxDocumentDepth) {
      throw FileError(job_.file.string(),
                      fmt::format("an assembly of it contains itself, or is nested more than {} levels deep",
                                  kMaxDocumentDepth),
                      "export it flatter");
    }
    const auto known = counts_.find(label);
    if (known != counts_.end()) return known->second;
    std::uint64_t count = 1;
    TDF_LabelSequence components;
    if (XCAFDoc_ShapeTool::IsAssembly(label)) XCAFDoc_ShapeTool::GetComponents(label, components);
    for (TDF_LabelSequence::Iterator child(components); child.More(); child.Next())
      count = std::min<std::uint64_t>(kMaxDocumentNodes + 1,
                                      count + countBelow(targetOf(child.Value()), depth + 1));
    counts_.emplace(label, count);
    return count;
  }

  std::string nameOf(const TDF_Label& label) const {
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
    const TCollection_AsciiString utf8(name->Get(), 0);
    const std::string_view text(utf8.ToCString(), static_cast<std::size_t>(utf8.Length()));
    return cleanName(options_.hasDirectives ? decodedStepText(text) : std::string(text));
  }

  std::optional<CadColour> colourOfLabel(const TDF_Label& label) const {
    Quantity_Color colour;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
      if (colours_->GetColor(label, type, colour)) return cadColourOf(colour);
    const Handle(XCAFDoc_VisMaterial) material = materials_->GetShapeMaterial(label);
    if (!material.IsNull() && !material->IsEmpty()) return cadColourOf(material->BaseColor().GetRGB());
    return std::nullopt;
  }

  void place(const TDF_Label& label, const Context& context) {
    const TDF_Label target = targetOf(label);
    const std::optional<Placement> placement = placementOf(XCAFDoc_ShapeTool::GetLocation(label));
    const std::string targetName = nameOf(target), ownName = target == label ? targetName : nameOf(label);
    const std::string& name =
        ownName.empty() || isMadeUp(ownName) ? (targetName.empty() ? ownName : targetName) : ownName;
    if (!placement) {
      builder_.warn(fmt::format("\"{}\" is left out: its placement is flat or not finite.", name));
      return;
    }
    const std::optional<CadColour> own = target == label ? std::nullopt : colourOfLabel(label);
    if (XCAFDoc_ShapeTool::IsAssembly(target)) {
      placeAssembly(target, name, *placement, context, own);
    } else {
      placeProduct(target, name, *placement, context, own);
    }
  }

  CadNode nodeOf(const std::string& name, const Placement& placement, const Context& context) const {
    CadNode node;
    node.parent = context.parent;
    // What has no name but what a program made up has none.
    node.name = name.starts_with("=>") ? std::string() : name;
    node.parentFromNode = {placement.rotation,
                           placement.translation * (context.scale * options_.metresPerUnit)};
    return node;
  }

  void placeAssembly(const TDF_Label& target, const std::string& name, const Placement& placement,
                     const Context& context, const std::optional<CadColour>& own) {
    const std::optional<CadColour> product = colourOfLabel(target);
    Context inside{builder_.addNode(nodeOf(name, placement, context)), context.scale * placement.scale,
                   own       ? own
                   : product ? product
                             : context.colour};
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(target, components);
    for (TDF_LabelSequence::Iterator child(components); child.More(); child.Next())
      place(child.Value(), inside);
  }

  void placeProduct(const TDF_Label& target, const std::string& name, const Placement& placement,
                    const Context& context, const std::optional<CadColour>& own) {
    Product& product = productOf(target);
    if (product.pieces.empty()) {
      if (!name.empty()) builder_.warn(fmt::format("\"{}\" is left out: it has no faces.", name));
      return;
    }
    Context inside{context.parent, context.scale * placement.scale, context.colour};
    if (product.pieces.size() > 1) inside.parent = builder_.addNode(nodeOf(name, placement, context));
    for (std::size_t i = 0; i < product.pieces.size(); ++i) {
      const Piece& piece = product.pieces[i];
      const std::optional<CadColour> colour = own              ? own
                                              : piece.colour   ? piece.colour
                                              : product.colour ? product.colour
                                                               : inside.colour;
      CadNode node;
      if (product.pieces.size() > 1) {
        // The group has been named by now, and its solids after it.
        node = nodeOf(cleanName(fmt::format("{} {}", name.empty() ? job_.stem : name, i + 1)),
                      piece.productFromPiece, inside);
      } else {
        node = nodeOf(name, placement, context);
        const RigidTransform inner = nodeOf({}, piece.productFromPiece, inside).parentFromNode;
        node.parentFromNode = (node.parentFromNode * inner).normalized();
      }
      node.colour = colour;
      node.shape = shapeOf(product, i, inside.scale * piece.productFromPiece.scale);
      builder_.addNode(node);
    }
  }

  std::int32_t shapeOf(Product& product, std::size_t index, double scale) {
    const Piece& piece = product.pieces[index];
    const auto [at, isNew] = product.shapes.try_emplace({piece.identity, scale}, -1);
    if (!isNew) return at->second;
    std::string key = product.name.empty() ? job_.stem : product.name;
    if (product.pieces.size() > 1) key += fmt::format("/{}", index + 1);
    if (scale != 1.0) key += fmt::format(" x {:.6g}", scale);
    at->second = builder_.addShape(key);
    pending_.push_back({at->second, &piece, &product, scale});
    return at->second;
  }

  Product& productOf(const TDF_Label& label) {
    const auto [at, isNew] = products_.try_emplace(label);
    if (isNew) fill(at->second, label);
    return at->second;
  }

  void fill(Product& product, const TDF_Label& label) {
    product.name = nameOf(label);
    product.colour = colourOfLabel(label);
    TDF_LabelSequence parts;
    XCAFDoc_ShapeTool::GetSubShapes(label, parts);
    for (TDF_LabelSequence::Iterator part(parts); part.More(); part.Next())
      takeColours(product, part.Value());
    TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    if (shape.IsNull()) return;
    if (options_.areTriangles) {
      addTriangles(product, shape);
    } else {
      addPieces(product, shape);
    }
  }

  void takeColours(Product& product, const TDF_Label& part) const {
    const std::optional<CadColour> colour = colourOfLabel(part);
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(part);
    if (!colour || shape.IsNull()) return;
    product.colours.insert_or_assign(shape.TShape().get(), *colour);
    // A coloured shell colours its faces.
    if (shape.ShapeType() == TopAbs_SHELL)
      for (TopoDS_Iterator face(shape); face.More(); face.Next())
        product.colours.try_emplace(face.Value().TShape().get(), *colour);
  }

  /// The colour of all shapes, if they have the same.
  static std::optional<CadColour> commonColour(const ColourTable& colours,
                                               const std::vector<TopoDS_Shape>& shapes) {
    if (shapes.empty()) return std::nullopt;
    const std::optional<CadColour> first = findColour(colours, shapes.front().TShape().get());
    const auto isFirst = [&](const TopoDS_Shape& shape) {
      return findColour(colours, shape.TShape().get()) == first;
    };
    return std::ranges::all_of(shapes, isFirst) ? first : std::nullopt;
  }

  void addTriangles(Product& product, const TopoDS_Shape& shape) {
    Piece piece;
    const std::optional<Placement> placement = placementOf(shape.Location());
    if (!placement) return;
    piece.whole = shape.Located(TopLoc_Location());
    piece.productFromPiece = *placement;
    piece.identity = shape.TShape().get();
    std::vector<TopoDS_Shape> faces;
    for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
      faces.push_back(face.Current());
    takeOwnColours(product, piece.whole);
    piece.colour = commonColour(product.colours, faces);
    product.pieces.push_back(std::move(piece));
  }

  /// Takes the colours of faces that several products have, each in a colour of its own or in none.
  void takeOwnColours(Product& product, const TopoDS_Shape& shape) const {
    if (!options_.colourOfFace) return;
    for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
      const void* identity = face.Current().TShape().get();
      product.colours.erase(identity);
      if (const std::optional<CadColour> colour = options_.colourOfFace(face.Current()))
        product.colours.emplace(identity, *colour);
    }
  }

  void addPieces(Product& product, const TopoDS_Shape& shape) {
    PieceFinder finder(job_, product.pieces);
    finder.find(shape);
    LooseFaces& loose = finder.loose();
    looseParts_ += loose.others;
    if (options_.sewsFaces && !loose.shapes.empty()) {
      const TopoDS_Shape joined = sewn(loose.shapes, product.colours);
      loose.shapes.clear();
      finder.find(joined);
    }
    for (std::size_t i = 0; i < product.pieces.size(); ++i)
      product.pieces[i].colour = findColour(product.colours, finder.identities()[i]);
    if (loose.shapes.empty()) return;
    Piece piece;
    piece.body.shells = loose.shapes;
    piece.identity = loose.shapes.front().TShape().get();
    piece.colour = commonColour(product.colours, loose.shapes);
    product.pieces.push_back(std::move(piece));
  }

  void giveExact() const {
    for (const PendingShape& pending : pending_) {
      if (!builder_.isWanted(pending.shape)) continue;
      job_.takeExact(ExactShape{builder_.keyOf(pending.shape), pending.piece->body, pending.piece->isSolid,
                                pending.scale * options_.metresPerUnit, pending.product->colours});
    }
  }

  /// Result of meshing.
  struct MeshedShape {
    CadShape shape;
    std::string problem = "it has no triangles";  ///< Why it has none.
    std::exception_ptr failure;                   ///< Ends the import.
  };

  void meshAll() {
    std::vector<PendingShape> wanted;
    for (const PendingShape& pending : pending_)
      if (builder_.isWanted(pending.shape)) wanted.push_back(pending);
    std::vector<MeshedShape> meshed(wanted.size());
    {
      const Message_ProgressRange range = progress_.stageTo(stageEndsOf(job_).meshed);
      const OccProgress::Steady steady(progress_);
      Message_ProgressScope scope(range, "mesh",
                                  static_cast<double>(std::max<std::size_t>(1, wanted.size())));
      // With their shares of the progress.
      std::vector<Message_ProgressRange> parts;
      std::vector<std::size_t> left;
      std::vector<const Body*> bodies;
      if (options_.early != nullptr) options_.early->finish();
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        parts.push_back(scope.Next());
        if (takeEarly(wanted[i], meshed[i])) continue;
        left.push_back(i);
        bodies.push_back(&wanted[i].piece->body);
      }
      const auto meshGroup = [&](const BodyGroup& group, bool usesAllThreads) {
        for (const std::size_t at : group)
          mesh(wanted[left[at]], parts[left[at]], usesAllThreads, meshed[left[at]]);
      };
      const int threads = OSD_ThreadPool::DefaultPool()->NbThreads();
      const MeshingPlan plan = planMeshing(bodies, static_cast<std::size_t>(std::max(threads, 1)));
      for (const BodyGroup& group : plan.large)
        meshGroup(group, true);
      OSD_Parallel::For(0, static_cast<int>(plan.small.size()),
                        [&](int i) { meshGroup(plan.small[static_cast<std::size_t>(i)], false); });
    }
    for (std::size_t i = 0; i < wanted.size(); ++i)
      keep(wanted[i], std::move(meshed[i]));
  }

  /// Takes what was meshed while the document was transferred; false if this shape was not.
  bool takeEarly(const PendingShape& pending, MeshedShape& result) const {
    const bool isAsMeshed = pending.piece->isSolid && pending.scale == 1.0;
    if (options_.early == nullptr || !isAsMeshed) return false;
    std::optional<EarlyMeshes::Mesh> mesh = options_.early->take(pending.piece->body);
    if (!mesh) return false;
    result.shape = std::move(mesh->shape);
    colourFaces(mesh->faces, pending.product->colours, result.shape);
    return true;
  }

  void mesh(const PendingShape& pending, const Message_ProgressRange& range, bool usesAllThreads,
            MeshedShape& result) const {
    const double scale = pending.scale * options_.metresPerUnit;
    try {
      result.shape = options_.areTriangles ? meshGiven(pending, scale)
                                           : meshExact(pending, scale, range, usesAllThreads);
    } catch (const Standard_Failure& failure) {
      result.problem = failure.GetMessageString();
      result.shape = {};
    } catch (...) {
      result.failure = std::current_exception();
    }
  }

  void keep(const PendingShape& pending, MeshedShape meshed) {
    if (meshed.failure) std::rethrow_exception(meshed.failure);
    CadShape& shape = meshed.shape;
    if (shape.triangles.empty() && !shape.warnings.empty())
      meshed.problem = withoutFullStop(shape.warnings.front());
    if (shape.triangles.empty())
      builder_.warn(fmt::format("\"{}\" is left out: {}.", builder_.keyOf(pending.shape), meshed.problem));
    if (!isWithinLimits(shape)) {
      builder_.warn(fmt::format("\"{}\" is left out: its coordinates are beyond range.",
                                builder_.keyOf(pending.shape)));
      shape = {};
    }
    builder_.setShape(pending.shape, std::move(shape));
  }

  static bool isWithinLimits(const CadShape& shape) {
    return std::ranges::all_of(shape.vertices, [](const glm::dvec3& p) {
      return std::abs(p.x) <= kMaxDocumentLength && std::abs(p.y) <= kMaxDocumentLength &&
             std::abs(p.z) <= kMaxDocumentLength;
    });
  }

  /// Triangles of a piece whose colour is that of all its faces have none of their own: a part is given another colour by
  /// that of its node.
  static CadShape meshGiven(const PendingShape& pending, double scale) {
    const ColourTable none;
    const ColourTable& colours = pending.piece->colour ? none : pending.product->colours;
    return meshTriangulated(pending.piece->whole, glm::dmat3(scale), colours);
  }

  CadShape meshExact(const PendingShape& pending, double scale, const Message_ProgressRange& range,
                     bool usesAllThreads) const {
    MeshRequest request;
    request.body = pending.piece->body;
    request.isSolid = pending.piece->isSolid;
    request.map = glm::dmat3(scale);
    request.hasUnit = options_.hasUnit;
    request.wanted = job_.tessellation;
    request.colours = &pending.product->colours;
    request.usesAllThreads = usesAllThreads;
    return meshBody(request, range);
  }

  struct LabelOrder {
    bool operator()(const TDF_Label& a, const TDF_Label& b) const {
      if (a.Depth() != b.Depth()) return a.Depth() < b.Depth();
      if (a == b) return false;
      if (a.Tag() != b.Tag() || a.IsRoot() || b.IsRoot()) return a.Tag() < b.Tag();
      return (*this)(a.Father(), b.Father());
    }
  };

  const XcafOptions& options_;
  const ImportJob& job_;
  OccProgress& progress_;
  DocumentBuilder builder_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  Handle(XCAFDoc_VisMaterialTool) materials_;
  std::map<TDF_Label, std::uint64_t, LabelOrder> counts_;
  std::map<TDF_Label, Product, LabelOrder> products_;
  std::vector<PendingShape> pending_;
  std::size_t looseParts_ = 0;
};

}  // namespace

CadColour cadColourOf(const Quantity_Color& colour) {
  std::array<double, 3> srgb{};
  colour.Values(srgb[0], srgb[1], srgb[2], Quantity_TOC_sRGB);
  CadColour result{};
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = static_cast<float>(std::isfinite(srgb[i]) ? std::clamp(srgb[i], 0.0, 1.0) : 0.0);
  return result;
}

CadDocument readXcaf(TDocStd_Document& document, const XcafOptions& options, const ImportJob& job,
                     OccProgress& progress) {
  return XcafReader(document, options, job, progress).read();
}

}  // namespace nearfit::importer
