#include "core/import/document_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/import/companion_files.h"
#include "core/import/document_bytes.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr std::array<char, 8> kDocumentMagic{'N', 'F', 'C', 'A', 'D', 'D', 'O', 'C'};
/// To be raised with each change of the format: importer and program may come from different builds.
constexpr std::uint32_t kDocumentVersion = 2;
/// Reads differently on a machine of the other byte order.
constexpr std::uint32_t kDocumentByteOrder = 0x01020304;

/// Deviation of a unit vector's or quaternion's squared length from 1: far above what normalising in doubles leaves,
/// far below what would change a shape.
constexpr double kUnitTolerance = 1e-9;

[[noreturn]] void throwDamaged(std::string where, std::string problem) {
  throw Error(std::move(where), std::move(problem), "import the file again");
}

void require(bool isSo, const std::string& where, const char* problem) {
  if (!isSo) throwDamaged(where, problem);
}

bool isLength(double x) {
  return std::abs(x) <= kMaxDocumentLength;
}

bool isPlace(const glm::dvec3& p) {
  return isLength(p.x) && isLength(p.y) && isLength(p.z);
}

bool isUnit(const glm::dvec3& v) {
  return std::abs(glm::dot(v, v) - 1.0) <= kUnitTolerance;
}

bool isColour(const CadColour& colour) {
  return std::ranges::all_of(colour, [](float c) { return c >= 0.0F && c <= 1.0F; });
}

void checkWarnings(const std::vector<std::string>& warnings, const std::string& where) {
  require(warnings.size() <= kMaxWarnings, where, "it has too many warnings");
  for (const std::string& warning : warnings)
    require(warning.size() <= kMaxWarningBytes && isPrintableUtf8(warning), where,
            "a warning is too long or no printable text");
}

bool isRound(SurfaceKind kind) {
  return kind == SurfaceKind::Cylinder || kind == SurfaceKind::Sphere || kind == SurfaceKind::Torus;
}

bool isSound(const ExactSurface& s) {
  if (s.kind == SurfaceKind::Other) return true;
  const bool isAngle = s.halfAngle > 0.0 && s.halfAngle < std::numbers::pi / 2;
  return isPlace(s.point) && (s.kind == SurfaceKind::Sphere || isUnit(s.direction)) &&
         (!isRound(s.kind) || (s.radius > 0.0 && isLength(s.radius))) &&
         (s.kind != SurfaceKind::Torus || (s.minorRadius > 0.0 && isLength(s.minorRadius))) &&
         (s.kind != SurfaceKind::Cone || isAngle);
}

void checkSurfaces(const CadShape& shape, const std::string& where) {
  const SurfaceFaces& surfaces = shape.surfaces;
  require(surfaces.faceOfTriangle.size() == (surfaces.faces.empty() ? 0 : shape.triangles.size()), where,
          "not each triangle has a face");
  for (const std::uint32_t face : surfaces.faceOfTriangle)
    require(face < surfaces.faces.size(), where, "a triangle's face does not exist");
  for (const ExactSurface& surface : surfaces.faces)
    require(isSound(surface), where, "a face's surface has impossible sizes");
  require(shape.faceColours.empty() || shape.faceColours.size() == surfaces.faces.size(), where,
          "not each face has a colour");
  for (const std::optional<CadColour>& colour : shape.faceColours)
    require(!colour || isColour(*colour), where, "a face's colour is out of range");
}

void checkTriangles(const CadShape& shape, const std::string& where) {
  require(!shape.triangles.empty(), where, "it has no triangles");
  require(shape.vertices.size() <= TriangleMesh::kMaxTriangles &&
              shape.triangles.size() <= TriangleMesh::kMaxTriangles,
          where, "it has too many triangles");
  for (const glm::dvec3& vertex : shape.vertices)
    require(isPlace(vertex), where, "a vertex is out of range");
  const std::size_t count = shape.vertices.size();
  for (const Triangle& t : shape.triangles)
    require(t[0] < count && t[1] < count && t[2] < count && t[0] != t[1] && t[1] != t[2] && t[2] != t[0],
            where, "a triangle's corners do not exist or repeat");
}

void checkShape(const CadShape& shape, const std::string& where) {
  require(!shape.key.empty() && shape.key.size() <= kMaxDocumentKeyBytes && isPrintableUtf8(shape.key), where,
          "its key is empty, too long or no printable text");
  checkTriangles(shape, where);
  checkSurfaces(shape, where);
  checkWarnings(shape.warnings, where);
  require(shape.tessellation.chord >= 0.0 && isLength(shape.tessellation.chord) &&
              shape.tessellation.angle >= 0.0 && shape.tessellation.angle <= std::numbers::pi,
          where, "its tessellation is out of range");
  require(shape.exactVolume >= 0.0 && std::isfinite(shape.exactVolume), where, "its volume is out of range");
}

void checkNode(const CadNode& node, std::size_t index, std::size_t shapes, const std::string& where) {
  require(node.parent >= -1 && node.parent < static_cast<std::int64_t>(index), where,
          "its parent does not come before it");
  require(node.shape >= -1 && node.shape < static_cast<std::int64_t>(shapes), where,
          "its shape does not exist");
  require(node.name.size() <= kMaxNodeNameBytes && isPrintableUtf8(node.name), where,
          "its name is too long or no printable text");
  const glm::dquat& q = node.parentFromNode.rotation;
  require(std::abs(glm::dot(q, q) - 1.0) <= kUnitTolerance && isPlace(node.parentFromNode.translation), where,
          "its place is out of range");
  require(!node.colour || isColour(*node.colour), where, "its colour is out of range");
}

void checkNodes(const CadDocument& document) {
  require(document.nodes.size() <= kMaxDocumentNodes, "nodes", "there are too many");
  std::vector<std::size_t> levels;
  levels.reserve(document.nodes.size());
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const CadNode& node = document.nodes[i];
    const std::string where = fmt::format("node {}", i);
    checkNode(node, i, document.shapes.size(), where);
    levels.push_back(node.parent < 0 ? 1 : levels[static_cast<std::size_t>(node.parent)] + 1);
    require(levels.back() <= kMaxDocumentDepth, where, "it is nested too deep");
    require(node.parent < 0 || document.nodes[static_cast<std::size_t>(node.parent)].shape < 0, where,
            "its parent is an instance of a shape");
  }
}

bool isSha256(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

void checkCompanions(const std::vector<CadCompanion>& companions) {
  require(companions.size() <= kMaxCompanions, "companions", "there are too many");
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < companions.size(); ++i) {
    const std::string where = fmt::format("companion {}", i);
    require(isCompanionName(companions[i].name), where,
            "its name is too long, absolute or no printable text");
    require(isSha256(companions[i].sha256), where, "its checksum is no SHA-256");
    require(names.insert(companions[i].name).second, where, "its name repeats");
  }
}

constexpr std::size_t kColourBytes = 1 + 3 * sizeof(float);
constexpr std::size_t kSurfaceBytes = 1 + 9 * sizeof(double) + 1;
/// Without the texts and arrays in them.
constexpr std::size_t kShapeBytes = 7 * sizeof(std::uint64_t), kNodeBytes = 2 * sizeof(std::int32_t),
                      kCompanionBytes = 2 * sizeof(std::uint64_t);

void writeSurface(const ExactSurface& s, DocumentWriter& out) {
  out.value(s.kind);
  out.point(s.point);
  out.point(s.direction);
  for (const double x : {s.radius, s.minorRadius, s.halfAngle})
    out.value(x);
  out.value(static_cast<std::uint8_t>(s.isHollow));
}

ExactSurface readSurface(DocumentReader& in) {
  ExactSurface s;
  const auto kind = in.value<std::uint8_t>();
  if (kind > static_cast<std::uint8_t>(SurfaceKind::Torus)) in.fail("there is no such kind of surface");
  s.kind = static_cast<SurfaceKind>(kind);
  s.point = in.point();
  s.direction = in.point();
  s.radius = in.value<double>();
  s.minorRadius = in.value<double>();
  s.halfAngle = in.value<double>();
  s.isHollow = in.flag();
  return s;
}

void writeShape(const CadShape& shape, DocumentWriter& out) {
  out.text(shape.key);
  out.values(std::span(shape.vertices));
  out.values(std::span(shape.triangles));
  out.value(std::uint64_t{shape.surfaces.faces.size()});
  for (const ExactSurface& surface : shape.surfaces.faces)
    writeSurface(surface, out);
  out.values(std::span(shape.surfaces.faceOfTriangle));
  out.value(std::uint64_t{shape.faceColours.size()});
  for (const std::optional<CadColour>& colour : shape.faceColours)
    out.colour(colour);
  out.value(shape.tessellation.chord);
  out.value(shape.tessellation.angle);
  out.value(static_cast<std::uint8_t>(shape.isExact));
  out.value(shape.exactVolume);
  out.texts(shape.warnings);
}

CadShape readShape(DocumentReader& in) {
  CadShape shape;
  shape.key = in.text();
  shape.vertices = in.values<glm::dvec3>();
  shape.triangles = in.values<Triangle>();
  shape.surfaces.faces.resize(in.count(kSurfaceBytes));
  for (ExactSurface& surface : shape.surfaces.faces)
    surface = readSurface(in);
  shape.surfaces.faceOfTriangle = in.values<std::uint32_t>();
  shape.faceColours.resize(in.count(kColourBytes));
  for (std::optional<CadColour>& colour : shape.faceColours)
    colour = in.colour();
  shape.tessellation.chord = in.value<double>();
  shape.tessellation.angle = in.value<double>();
  shape.isExact = in.flag();
  shape.exactVolume = in.value<double>();
  shape.warnings = in.texts();
  return shape;
}

void writeNode(const CadNode& node, DocumentWriter& out) {
  out.value(node.parent);
  out.value(node.shape);
  out.text(node.name);
  const glm::dquat& q = node.parentFromNode.rotation;
  for (const double x : {q.w, q.x, q.y, q.z})
    out.value(x);
  out.point(node.parentFromNode.translation);
  out.colour(node.colour);
}

CadNode readNode(DocumentReader& in) {
  CadNode node;
  node.parent = in.value<std::int32_t>();
  node.shape = in.value<std::int32_t>();
  node.name = in.text();
  glm::dquat& q = node.parentFromNode.rotation;
  for (double* x : {&q.w, &q.x, &q.y, &q.z})
    *x = in.value<double>();
  node.parentFromNode.translation = in.point();
  node.colour = in.colour();
  return node;
}

void readHead(DocumentReader& in) {
  for (const char c : kDocumentMagic)
    if (in.value<char>() != c) in.fail("it is no such file");
  if (in.value<std::uint32_t>() != kDocumentByteOrder) in.fail("it is of another machine");
  if (in.value<std::uint32_t>() != kDocumentVersion) in.fail("it is of another version of the program");
}

CadDocument readUnchecked(std::span<const std::byte> bytes) {
  DocumentReader in(bytes);
  readHead(in);
  CadDocument document;
  document.hasUnit = in.flag();
  document.statedUnit = in.value<double>();
  document.sha256 = in.text();
  document.areCompanionsKnown = in.flag();
  document.companions.resize(in.count(kCompanionBytes));
  for (CadCompanion& companion : document.companions) {
    companion.name = in.text();
    companion.sha256 = in.text();
  }
  document.warnings = in.texts();
  document.shapes.resize(in.count(kShapeBytes));
  for (CadShape& shape : document.shapes)
    shape = readShape(in);
  document.nodes.resize(in.count(kNodeBytes));
  for (CadNode& node : document.nodes)
    node = readNode(in);
  if (!in.isAtEnd()) in.fail("it goes on after its end");
  return document;
}

}  // namespace

void checkDocument(const CadDocument& document) {
  require(isSha256(document.sha256), "checksum", "it is no SHA-256");
  // NaN compares false.
  require(document.statedUnit >= kMinStatedUnit && document.statedUnit <= kMaxStatedUnit, "unit",
          "it is out of range");
  checkCompanions(document.companions);
  checkWarnings(document.warnings, "document");
  // Each shape is placed by a node at least.
  require(document.shapes.size() <= kMaxDocumentNodes, "shapes", "there are too many");
  std::unordered_set<std::string_view> keys;
  for (std::size_t i = 0; i < document.shapes.size(); ++i) {
    const std::string where = fmt::format("shape {}", i);
    checkShape(document.shapes[i], where);
    require(keys.insert(document.shapes[i].key).second, where, "its key repeats");
  }
  checkNodes(document);
}

void writeDocument(const CadDocument& document, const DocumentSink& sink) {
  checkDocument(document);
  DocumentWriter out(sink);
  for (const char c : kDocumentMagic)
    out.value(c);
  out.value(kDocumentByteOrder);
  out.value(kDocumentVersion);
  out.value(static_cast<std::uint8_t>(document.hasUnit));
  out.value(document.statedUnit);
  out.text(document.sha256);
  out.value(static_cast<std::uint8_t>(document.areCompanionsKnown));
  out.value(std::uint64_t{document.companions.size()});
  for (const CadCompanion& companion : document.companions) {
    out.text(companion.name);
    out.text(companion.sha256);
  }
  out.texts(document.warnings);
  out.value(std::uint64_t{document.shapes.size()});
  for (const CadShape& shape : document.shapes)
    writeShape(shape, out);
  out.value(std::uint64_t{document.nodes.size()});
  for (const CadNode& node : document.nodes)
    writeNode(node, out);
}

CadDocument readDocument(std::span<const std::byte> bytes, const std::string& name) {
  try {
    CadDocument document = readUnchecked(bytes);
    checkDocument(document);
    return document;
  } catch (const Error& error) {
    throw FileError(
        name, fmt::format("what its import returned is damaged ({}: {})", error.where(), error.problem()),
        "import it again; reinstall Nearfit if programs of two versions are mixed");
  }
}

}  // namespace nearfit
