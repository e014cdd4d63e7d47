#include "app/import/read_document.h"

#include <cstdio>
#include <new>

#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <Standard_Version.hxx>
#include <fmt/format.h>

#include "app/import/occ_progress.h"
#include "core/base/error.h"

namespace nearfit::importer {
namespace {

CadDocument readByFormat(const ImportJob& job) {
  switch (job.format) {
    case DocumentFormat::Step:
      return readStep(job);
    case DocumentFormat::Iges:
      return readIges(job);
    case DocumentFormat::Brep:
      return readBrep(job);
    case DocumentFormat::Gltf:
      return readGltf(job);
    case DocumentFormat::ThreeMf:
      return readThreeMf(job);
    case DocumentFormat::Urdf:
      return readUrdf(job);
  }
  return {};
}

}  // namespace

CadDocument readDocumentOf(const ImportJob& job) {
  setUpOcc();
  try {
    return readByFormat(job);
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    throw FileError(job.file.string(),
                    fmt::format("OpenCASCADE cannot read it: {}", failure.GetMessageString()),
                    "it may be damaged: export it again, or in another format");
  }
}

void printSummary(const CadDocument& document) {
  std::size_t triangles = 0, faces = 0;
  for (const CadShape& shape : document.shapes) {
    triangles += shape.triangles.size();
    faces += shape.surfaces.faces.size();
    fmt::print(stderr, "shape \"{}\": {} triangles, {} faces, volume {:.9g}\n", shape.key,
               shape.triangles.size(), shape.surfaces.faces.size(), shape.exactVolume);
    for (const std::string& warning : shape.warnings)
      fmt::print(stderr, "  {}\n", warning);
  }
  for (const std::string& warning : document.warnings)
    fmt::print(stderr, "{}\n", warning);
  for (const CadNode& node : document.nodes)
    fmt::print(stderr, "node \"{}\" of {}: shape {}{}\n", node.name, node.parent, node.shape,
               node.colour ? ", coloured" : "");
  fmt::print(stderr, "{} nodes, {} shapes, {} faces, {} triangles\n", document.nodes.size(),
             document.shapes.size(), faces, triangles);
}

std::string occVersion() {
  return OCC_VERSION_COMPLETE;
}

}  // namespace nearfit::importer
