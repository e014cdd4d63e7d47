// STEP, IGES, BREP and glTF by OpenCASCADE.
#include <algorithm>
#include <cstddef>
#include <functional>
#include <istream>
#include <optional>
#include <streambuf>
#include <string>
#include <utility>
#include <vector>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message_ProgressRange.hxx>
#include <Message_ProgressScope.hxx>
#include <OSD_ThreadPool.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <RWGltf_CafReader.hxx>
#include <RWMesh_CoordinateSystem.hxx>
#include <RWMesh_NodeAttributes.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_Product.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFDoc_VisMaterial.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

#include "app/import/companion_list.h"
#include "app/import/early_meshes.h"
#include "app/import/gltf_scan.h"
#include "app/import/import_job.h"
#include "app/import/memory_file.h"
#include "app/import/occ_progress.h"
#include "app/import/shape_mesher.h"
#include "app/import/step_scan.h"
#include "app/import/xcaf_document.h"
#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/import/companion_files.h"
#include "core/import/mesh_file_check.h"
#include "core/text/utf8.h"

namespace nearfit::importer {
namespace {

/// OpenCASCADE's tolerances suit millimetres, which it converts lengths of STEP and IGES to by default.
constexpr double kMetresPerMillimetre = 1e-3;

/// Fraction of the reading stage in which OpenCASCADE parses a STEP file; in the rest it builds entities. Measured on files of 2 and 16 MB.
constexpr double kParsedFraction = 0.65;

/// Bytes in memory as an input stream, without a copy; it gives them piece by piece, to tell how far they are read.
class BytesBuffer : public std::streambuf {
 public:
  /// @param bytes  Outlive it.
  /// @param onRead  Called each time that a piece has been read, with that piece's fraction of all bytes; may be empty.
  explicit BytesBuffer(const std::vector<char>& bytes, std::function<void(double fraction)> onRead = {})
      : onRead_(std::move(onRead)), size_(bytes.size()), left_(bytes.size()) {
    char* begin = const_cast<char*>(bytes.data());
    setg(begin, begin, begin);
  }

 protected:
  int_type underflow() override {
    if (gptr() < egptr()) return traits_type::to_int_type(*gptr());
    if (piece_ > 0 && onRead_) onRead_(static_cast<double>(piece_) / static_cast<double>(size_));
    piece_ = std::min(left_, kPieceBytes);
    if (piece_ == 0) return traits_type::eof();
    left_ -= piece_;
    // All that has been read stays, so that characters can be put back across the border of two pieces.
    setg(eback(), egptr(), egptr() + piece_);
    return traits_type::to_int_type(*gptr());
  }

 private:
  /// About 0.2 s of parsing.
  static constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

  std::function<void(double)> onRead_;
  std::size_t size_, left_, piece_ = 0;
};

Handle(TDocStd_Document) newDocument() {
  // Without names such as "COMPOUND" for what has none.
  XCAFDoc_ShapeTool::SetAutoNaming(Standard_False);
  return new TDocStd_Document("BinXCAF");
}

[[noreturn]] void failUnreadable(const ImportJob& job, const char* format) {
  throw FileError(job.file.string(), std::string("OpenCASCADE cannot read it as ") + format,
                  "it may be damaged: export it again, or in another format");
}

/// OpenCASCADE's reader, and what it knows of the faces it has made.
class GltfReader : public RWGltf_CafReader {
 public:
  /// Colour of the material of a face, which it places anew, by a location, for each further material.
  std::optional<CadColour> colourOf(const TopoDS_Shape& face) const {
    const RWMesh_NodeAttributes* attributes = myAttribMap.Seek(face);
    if (attributes == nullptr || attributes->Style.Material().IsNull()) return std::nullopt;
    const Handle(XCAFDoc_VisMaterial)& material = attributes->Style.Material();
    return material->IsEmpty() ? std::nullopt : std::optional(cadColourOf(material->BaseColor().GetRGB()));
  }
};

CadDocument readGltfByOcc(const ImportJob& job) {
  OccProgress progress(job);
  GltfReader reader;
  const Handle(TDocStd_Document) document = newDocument();
  reader.SetDocument(document);
  // Up is z here and y there.
  reader.SetSystemLengthUnit(1.0);
  reader.SetSystemCoordinateSystem(RWMesh_CoordinateSystem_Zup);
  reader.SetParallel(true);
  reader.SetDoublePrecision(true);
  reader.SetSkipEmptyNodes(true);
  reader.SetMeshNameAsFallback(true);
  // Its buffers are found beside it, so that it is read from where it lies.
  const MemoryFile unpacked(job.bytes);
  const std::string path = job.wasPacked ? unpacked.path() : job.file.string();
  if (!reader.Perform(path.c_str(), progress.stageTo(stageEndsOf(job).transferred)))
    failUnreadable(job, "glTF");
  job.endStage("read");
  XcafOptions options{1.0};
  options.areTriangles = true;
  options.colourOfFace = [&reader](const TopoDS_Shape& face) { return reader.colourOf(face); };
  return readXcaf(*document, options, job, progress);
}

/// OpenCASCADE takes the id where a name has no ASCII character that is seen: names of products and instances in other
/// scripts would be lost.
void keepNamesOfOtherScripts(const Interface_InterfaceModel& model) {
  const auto keep = [](auto& entity) {
    const Handle(TCollection_HAsciiString) name = entity.Name();
    if (!name.IsNull() && name->Length() > 0 && name->UsefullLength() == 0) entity.SetId(name);
  };
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const Handle(Standard_Transient)& entity = model.Value(i);
    if (const auto product = Handle(StepBasic_Product)::DownCast(entity); !product.IsNull()) keep(*product);
    const auto instance = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(entity);
    if (!instance.IsNull()) keep(*instance);
  }
}

/// Gives the solids of a STEP file to be meshed while OpenCASCADE makes those after them. It binds each one to its
/// entity once its healing is done; assemblies only place it from then on.
class StepSolids {
 public:
  /// @param session  Kept, like the meshes, by reference.
  StepSolids(const XSControl_WorkSession& session, EarlyMeshes& meshes)
      : session_(session), meshes_(meshes) {}

  /// Looks for solids made since the last call.
  void look() noexcept {
    if (hasFailed_) return;
    try {
      const Handle(Transfer_TransientProcess) process = session_.MapReader();
      if (process.IsNull()) return;
      if (unfinished_ > 0) give(*process, std::exchange(unfinished_, 0));
      while (seen_ < process->NbMapped())
        give(*process, ++seen_);
    } catch (...) {
      // Nothing is lost but time.
      hasFailed_ = true;
    }
  }
  std::size_t givenCount() const noexcept { return given_; }

 private:
  void give(const Transfer_TransientProcess& process, int number) {
    const Handle(Standard_Transient)& entity = process.Mapped(number);
    if (entity.IsNull() || !entity->IsKind(STANDARD_TYPE(StepShape_ManifoldSolidBrep))) return;
    const TopoDS_Shape solid = TransferBRep::ShapeResult(process.MapItem(number));
    if (solid.IsNull()) {
      unfinished_ = number;
      return;
    }
    ++given_;
    meshes_.add(solid);
  }

  const XSControl_WorkSession& session_;
  EarlyMeshes& meshes_;
  int seen_ = 0;        ///< Items of the process looked at.
  int unfinished_ = 0;  ///< The solid that is being made, if its entity is known already; 0: none.
  std::size_t given_ = 0;
  bool hasFailed_ = false;
};

MeshRequest earlyRequestOf(const ImportJob& job) {
  MeshRequest request;
  request.isSolid = true;
  request.map = glm::dmat3(kMetresPerMillimetre);
  request.wanted = job.tessellation;
  return request;
}

/// Threads to mesh by while a document is transferred; 0 if none of its solids may be meshed before it is known.
std::size_t earlyThreadsFor(const ImportJob& job) {
  // Bodies that share faces are healed together once all are there.
  const bool isManifold = Interface_Static::IVal("read.step.nonmanifold") == 0;
  if (!isManifold || !job.onlyShapes.empty() || job.takeExact) return 0;
  return static_cast<std::size_t>(std::max(OSD_ThreadPool::DefaultPool()->NbThreads() - 1, 0));
}

}  // namespace

CadDocument readStep(const ImportJob& job) {
  scanStep(job.bytes, job.file.string());
  job.endStage("scan");
  OccProgress progress(job);
  STEPCAFControl_Reader reader;
  reader.SetColorMode(Standard_True);
  reader.SetNameMode(Standard_True);
  reader.SetLayerMode(Standard_False);
  reader.SetPropsMode(Standard_False);
  reader.SetGDTMode(Standard_False);
  reader.SetMatMode(Standard_False);
  reader.SetViewMode(Standard_False);
  // OpenCASCADE cuts a text off at the first byte that is not UTF-8.
  if (!isUtf8({job.bytes.data(), job.bytes.size()}) &&
      !Interface_Static::SetCVal("read.step.codepage", "iso8859-1"))
    Interface_Static::SetCVal("read.step.codepage", "ISO8859-1");
  {
    const Message_ProgressRange range = progress.stageTo(stageEndsOf(job).read);
    const OccProgress::Steady steady(progress);
    Message_ProgressScope scope(range, "read", 1.0);
    BytesBuffer buffer(job.bytes, [&](double fraction) { scope.Next(kParsedFraction * fraction); });
    std::istream stream(&buffer);
    if (reader.ChangeReader().ReadStream(job.file.filename().c_str(), stream) != IFSelect_RetDone)
      failUnreadable(job, "STEP");
  }
  keepNamesOfOtherScripts(*reader.ChangeReader().WS()->Model());
  job.endStage("read");
  const Handle(TDocStd_Document) document = newDocument();
  Handle(TDocStd_Document) target = document;
  EarlyMeshes early(earlyRequestOf(job), earlyThreadsFor(job));
  {
    StepSolids solids(*reader.ChangeReader().WS(), early);
    const OccProgress::Listening listening(progress, [&solids] { solids.look(); });
    if (!reader.Transfer(target, progress.stageTo(stageEndsOf(job).transferred))) failUnreadable(job, "STEP");
    if (job.tellEarly) job.tellEarly(solids.givenCount(), early.meshedCount());
  }
  job.endStage("transfer");
  XcafOptions options{kMetresPerMillimetre};
  options.hasDirectives = true;
  options.early = &early;
  return readXcaf(*document, options, job, progress);
}

CadDocument readIges(const ImportJob& job) {
  OccProgress progress(job);
  IGESCAFControl_Reader reader;
  reader.SetColorMode(Standard_True);
  reader.SetNameMode(Standard_True);
  reader.SetLayerMode(Standard_False);
  const MemoryFile file(job.bytes);
  {
    const Message_ProgressRange range = progress.stageTo(stageEndsOf(job).read);
    const OccProgress::Steady steady(progress);
    if (reader.ReadFile(file.path().c_str()) != IFSelect_RetDone) failUnreadable(job, "IGES");
  }
  job.endStage("read");
  Handle(TDocStd_Document) document = newDocument();
  if (!reader.Transfer(document, progress.stageTo(stageEndsOf(job).transferred))) failUnreadable(job, "IGES");
  job.endStage("transfer");
  XcafOptions options{kMetresPerMillimetre};
  options.sewsFaces = true;
  return readXcaf(*document, options, job, progress);
}

CadDocument readBrep(const ImportJob& job) {
  OccProgress progress(job);
  BytesBuffer buffer(job.bytes);
  std::istream stream(&buffer);
  TopoDS_Shape shape;
  const BRep_Builder builder;
  // The reader would try to read on behind the end of a file that is cut off, over and over.
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  try {
    BRepTools::Read(shape, stream, builder, progress.stageTo(stageEndsOf(job).transferred));
  } catch (const std::ios_base::failure&) {
    throw FileError(job.file.string(), "it is cut off or damaged", "export or copy it again");
  }
  if (shape.IsNull()) failUnreadable(job, "BREP");
  job.endStage("read");
  const Handle(TDocStd_Document) document = newDocument();
  const TDF_Label label = XCAFDoc_DocumentTool::ShapeTool(document->Main())->AddShape(shape, Standard_False);
  TDataStd_Name::Set(label, TCollection_ExtendedString(job.stem.c_str(), Standard_True));
  XcafOptions options{1.0};
  options.hasUnit = false;
  return readXcaf(*document, options, job, progress);
}

CadDocument readGltf(const ImportJob& job) {
  const std::vector<std::string> buffers = scanGltf(job);
  job.endStage("scan");
  const CompanionFinder finder(job.file, buffers);
  CompanionList companions;
  std::string problem;
  for (const std::string& buffer : buffers) {
    const FoundFile found = finder.find(buffer);
    companions.add(buffer, found);
    // OpenCASCADE would wait for the writer of a pipe.
    if (found.problem.empty()) checkMeshFile(found.path);
    if (!found.problem.empty() && problem.empty())
      problem = fmt::format("its buffer {} cannot be read: {}", printableText(truncatedUtf8(buffer, 200)),
                            found.problem);
  }
  try {
    CadDocument document = readGltfByOcc(job);
    for (const std::string& buffer : buffers)
      companions.add(buffer, finder.find(buffer));
    // OpenCASCADE has read it once more.
    if (!job.wasPacked && sha256OfFile(job.file) != job.sha256) companions.setIncomplete();
    std::move(companions).giveTo(document);
    return document;
  } catch (const FileError&) {
    if (problem.empty()) throw;
    throw FileError(job.file.string(), problem, "put it beside the file, or export it as .glb");
  }
}

}  // namespace nearfit::importer
