// Result files of the importer: any bytes, or a small document with any numbers in it. What is read is sound, is the
// same written and read again, and becomes parts of a scene like what an importer returns; or there is a FileError.
#include "core/import/document_file.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/scene/document_load.h"
#include "core/scene/document_parts.h"
#include "core/scene/scene.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/document_checks.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::fuzz {
namespace {

std::string someText(ByteSource& bytes) {
  constexpr std::array<const char*, 8> kTexts{"", "pin", "body", "\xC3\xBC", "\xFF", "\n", "a b", "pin (2)"};
  if (bytes.flag()) return kTexts[bytes.below(kTexts.size())];
  std::string text(bytes.below(12), ' ');
  for (char& c : text)
    c = static_cast<char>(bytes.byte());
  return text;
}

std::optional<CadColour> someColour(ByteSource& bytes) {
  if (bytes.flag()) return std::nullopt;
  // Read in a fixed order.
  CadColour colour{};
  for (float& c : colour)
    c = bytes.flag() ? 0.5F : static_cast<float>(bytes.number());
  return colour;
}

ExactSurface someSurface(ByteSource& bytes) {
  ExactSurface surface;
  surface.kind = static_cast<SurfaceKind>(bytes.below(6));
  surface.point = bytes.vector();
  surface.direction = bytes.flag() ? glm::dvec3(0.6, 0.0, 0.8) : bytes.vector();
  surface.radius = bytes.number();
  surface.minorRadius = bytes.number();
  surface.halfAngle = bytes.number();
  surface.isHollow = bytes.flag();
  return surface;
}

CadShape someShape(ByteSource& bytes) {
  CadShape shape;
  shape.key = someText(bytes);
  shape.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = bytes.below(8); i > 0; --i)
    shape.vertices.push_back(bytes.vector());
  shape.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  // One beyond the last is no vertex.
  const std::size_t corners = shape.vertices.size() + (bytes.byte() == 0 ? 1 : 0);
  for (std::size_t i = bytes.below(8); i > 0; --i) {
    Triangle& t = shape.triangles.emplace_back();
    for (std::uint32_t& corner : t)
      corner = static_cast<std::uint32_t>(bytes.below(corners));
  }
  for (std::size_t i = bytes.below(4); i > 0; --i)
    shape.surfaces.faces.push_back(someSurface(bytes));
  const std::size_t faces = shape.surfaces.faces.size();
  for (std::size_t i = 0; faces > 0 && i < shape.triangles.size(); ++i)
    shape.surfaces.faceOfTriangle.push_back(static_cast<std::uint32_t>(bytes.below(faces)));
  for (std::size_t i = bytes.flag() ? faces : 0; i > 0; --i)
    shape.faceColours.push_back(someColour(bytes));
  if (bytes.flag()) shape.tessellation = {std::abs(bytes.number()), std::abs(bytes.number())};
  shape.isExact = bytes.flag();
  if (bytes.flag()) shape.exactVolume = bytes.number();
  return shape;
}

CadNode someNode(ByteSource& bytes, std::size_t index, std::size_t shapes) {
  CadNode node;
  node.parent = static_cast<std::int32_t>(bytes.below(index + 1)) - 1;
  node.shape = static_cast<std::int32_t>(bytes.below(shapes + 1)) - 1;
  node.name = someText(bytes);
  if (bytes.flag()) node.parentFromNode = bytes.flag() ? bytes.anyPose() : bytes.anyPose().normalized();
  node.colour = someColour(bytes);
  return node;
}

CadDocument someDocument(ByteSource& bytes) {
  CadDocument document;
  document.hasUnit = bytes.flag();
  document.sha256 = std::string(64, 'a');
  for (std::size_t i = bytes.below(4); i > 0; --i)
    document.shapes.push_back(someShape(bytes));
  for (std::size_t i = 0, count = bytes.below(40); i < count; ++i)
    document.nodes.push_back(someNode(bytes, i, document.shapes.size()));
  if (bytes.flag()) document.warnings.push_back(someText(bytes));
  if (bytes.flag()) document.statedUnit = bytes.number();
  for (std::size_t i = bytes.below(3); i > 0; --i)
    document.companions.push_back({someText(bytes), std::string(64, 'b')});
  document.areCompanionsKnown = bytes.flag();
  return document;
}

/// Opens a document as a scene does.
void use(const CadDocument& document) {
  static const test::TemporaryFolder folder;
  static const std::filesystem::path kWithUnit = folder.write("document.step", "a document"),
                                     kWithout = folder.write("document.brep", "a document");
  const ScopedDocumentImporter importer([&](const std::filesystem::path&, const DocumentOptions&,
                                            const ProgressCallback&) { return document; });
  const LoadedDocument loaded = loadDocument(document.hasUnit ? kWithUnit : kWithout, 0.001);
  for (const PartGeometryPtr& shape : loaded.shapes) {
    if (shape == nullptr) continue;
    require(!shape->mesh.triangles().empty(), "what is loaded has triangles");
    require(std::isfinite(shape->mass.volume) && isFinite(shape->mass.centre), "mass properties are finite");
    require(shape->surfaces == nullptr ||
                shape->surfaces->faceOfTriangle.size() == shape->mesh.triangles().size(),
            "triangles keep their faces");
  }
  Scene scene;
  addTo(scene, partsOfDocument(loaded, scene));
  for (const Scene::PartPtr& part : scene.parts())
    require(isPose(part->worldFromPart), "parts have poses");
}

void check(const CadDocument& document) {
  requireDocument(document);
  requireReadAsWritten(document);
  requireReadOrRefused<Error>([&] { use(document); });
}

void run(ByteSource& bytes) {
  if (bytes.flag()) {
    const auto rest = std::as_bytes(bytes.rest());
    requireReadOrRefused<FileError>([&] { check(readDocument(rest, "a result file")); });
  } else {
    const CadDocument document = someDocument(bytes);
    requireReadOrRefused<Error>([&] {
      checkDocument(document);
      check(document);
    });
  }
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::ByteSource bytes(data, size);
  nearfit::fuzz::run(bytes);
  return 0;
}
