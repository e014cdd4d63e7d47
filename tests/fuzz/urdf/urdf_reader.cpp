// URDF files: what urdfdom makes of any text becomes a document within the limits, or there is an error. No solid is
// meshed and no mesh file is there: OpenCASCADE is reached by import_process.
#include <exception>
#include <string>
#include <string_view>

#include <Standard_Failure.hxx>
#include <TopoDS_Shape.hxx>

#include "app/import/import_job.h"
#include "app/import/placed_mesh.h"
#include "app/import/shape_mesher.h"
#include "core/base/error.h"
#include "tests/fuzz/document_checks.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::importer {

std::vector<Body> bodiesOf(const TopoDS_Shape& solid) {
  return {{{solid}}};
}

/// No mesh file is there.
CadDocument readGltf(const ImportJob& /*job*/) {
  return {};
}

/// A tetrahedron stands for each solid.
CadShape meshBody(const MeshRequest& request, const Message_ProgressRange& /*progress*/) {
  static const std::vector<glm::dvec3> kVertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const std::vector<Triangle> kTriangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return triangleShape(kVertices, kTriangles, request.map);
}

}  // namespace nearfit::importer

namespace nearfit::fuzz {
namespace {

void read(const importer::ImportJob& job) {
  try {
    const CadDocument document = importer::readUrdf(job);
    // What exceeds a limit is refused where it is written.
    requireReadAsWritten(document);
    requireDocument(document);
    require(!document.shapes.empty() && !document.nodes.empty(), "a document holds something");
  } catch (const Error& error) {
    require(!error.problem().empty(), "an error says what is wrong");
  } catch (const Standard_Failure&) {
    // As the importer, which says that the file cannot be read.
  } catch (const std::exception&) {
    // The same, for what urdfdom throws.
  }
}

void run(std::string_view text) {
  static const test::TemporaryFolder folder;
  importer::ImportJob job;
  job.file = folder.path() / "robot.urdf";
  job.stem = "robot";
  job.sha256 = std::string(64, 'a');
  job.format = importer::DocumentFormat::Urdf;
  job.bytes.assign(text.begin(), text.end());
  job.progress = [](double fraction) {
    require(fraction >= 0.0 && fraction <= 1.0, "progress is a fraction");
  };
  job.endStage = [](const char*) {};
  read(job);
}

}  // namespace
}  // namespace nearfit::fuzz

// The sanitizer's own name. NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {
  // What libraries do not free ends with the importer.
  return "leak:libTK\n"
         "leak:liburdfdom\n";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
