#include "core/scene/document_load.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/import/mesh_file_check.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/scene/cached_geometry.h"
#include "core/scene/document_content.h"
#include "core/scene/document_outline.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

/// Progress after hashing the file, its companions too, and after importing; building the meshes follows. Roughly the
/// shares of time.
constexpr double kFileHashed = 0.01, kDocumentHashed = 0.02, kDocumentImported = 0.7;
/// Shapes named in an error.
constexpr std::size_t kNamedShapes = 20;

constexpr const char* kExportDocument = "export it again from the CAD system";

std::mutex importerMutex;
std::shared_ptr<const DocumentImporter> activeImporter;  ///< Guarded by the mutex; null: importDocument().

std::shared_ptr<const DocumentImporter> exchangeImporter(std::shared_ptr<const DocumentImporter> next) {
  const std::lock_guard lock(importerMutex);
  return std::exchange(activeImporter, std::move(next));
}

CadDocument runImporter(const fs::path& file, const DocumentOptions& options,
                        const ProgressCallback& progress) {
  std::shared_ptr<const DocumentImporter> chosen;
  {
    const std::lock_guard lock(importerMutex);
    chosen = activeImporter;
  }
  return chosen != nullptr ? (*chosen)(file, options, progress) : importDocument(file, options, progress);
}

/// Where and how a document is read.
struct Source {
  fs::path file;
  double metresPerUnit;  ///< 1 if the document stores its unit for certain.
  Tessellation tessellation;
};

Source sourceOf(const fs::path& file, double metresPerUnit, const Tessellation& tessellation) {
  checkMetresPerUnit(metresPerUnit);
  checkTessellation(tessellation);
  return {file, mayBeInWrongUnit(file) ? metresPerUnit : unitToOpen(file, metresPerUnit), tessellation};
}

CadDocument importAll(const Source& source, std::vector<std::string> onlyShapes,
                      const ProgressCallback& progress) {
  DocumentOptions options{source.tessellation, std::move(onlyShapes)};
  // The file's own units, where it stores none.
  options.tessellation.chord /= source.metresPerUnit;
  CadDocument document =
      runImporter(source.file, options, stageCallback(progress, kDocumentHashed, kDocumentImported));
  if (!document.hasUnit && storesUnit(source.file))
    throw FileError(source.file.string(), "it does not say its unit of length", kExportDocument);
  return document;
}

/// Names what is kept of a document in the cache.
/// @param content  DocumentContent::name.
std::string cacheNameOf(const Source& source, const std::string& content, std::string_view what) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return sha256OfBytes(fmt::format("{} {:016x} {:016x} {}", content, bits(source.tessellation.chord),
                                   bits(source.tessellation.angle), what));
}

std::string shapeNameOf(const Source& source, const DocumentContent& content, const std::string& shape) {
  return cacheNameOf(source, content.name, "shape " + shape);
}

TreeCacheKey outlineKeyOf(const Source& source, const DocumentContent& content) {
  return {cacheNameOf(source, content.name, "outline"), source.metresPerUnit};
}

/// Names a shape of a document whose content has no name: by what it holds.
std::string contentNameOf(const Source& source, const CadShape& shape) {
  const auto hashOf = [](const auto& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return sha256OfBytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  std::vector<float> colours;
  for (const std::optional<CadColour>& colour : shape.faceColours) {
    const CadColour none{-1.0F, -1.0F, -1.0F};
    const CadColour& own = colour ? *colour : none;
    colours.insert(colours.end(), own.begin(), own.end());
  }
  return cacheNameOf(source,
                     hashOf(shape.vertices) + hashOf(shape.triangles) +
                         hashOf(shape.surfaces.faceOfTriangle) + hashOf(colours),
                     "content");
}

PartGeometry namedGeometry(const Source& source, const DocumentContent& content, const std::string& shape) {
  PartGeometry geometry;
  geometry.file = normalisedPath(source.file);
  geometry.sha256 = content.sha256;
  geometry.companions = content.companions;
  geometry.cacheName = shapeNameOf(source, content, shape);
  geometry.metresPerUnit = source.metresPerUnit;
  geometry.shapeKey = shape;
  geometry.tessellation = source.tessellation;
  geometry.hasOwnUnit = storesUnit(source.file);
  return geometry;
}

PartGeometryPtr fromCache(const Source& source, const DocumentContent& content, const std::string& shape,
                          const MeshRepairs& repairs = {}) {
  PartGeometry geometry = namedGeometry(source, content, shape);
  geometry.repairs = repairs;
  std::optional<CachedMesh> kept = cachedMeshOf(geometry);
  return kept ? cachedGeometry(std::move(geometry), std::move(*kept)) : nullptr;
}

/// The triangles as a soup whose polygon i is triangle i.
PolygonSoup soupOf(CadShape& shape) {
  PolygonSoup soup;
  soup.vertices = std::move(shape.vertices);
  soup.corners.reserve(3 * shape.triangles.size());
  soup.firstCorner.reserve(shape.triangles.size() + 1);
  for (const Triangle& triangle : shape.triangles) {
    soup.corners.insert(soup.corners.end(), triangle.begin(), triangle.end());
    soup.closePolygon();
  }
  return soup;
}

/// The faces of the mesh's triangles, in metres. A face that building turned round faces the other way.
SurfaceFaces surfacesOf(const SurfaceFaces& surfaces, const TriangleMesh& mesh, const PolygonSoup& soup,
                        std::span<const std::uint32_t> polygonOf, double metresPerUnit, bool mayBeTurned) {
  SurfaceFaces of;
  of.faces = surfaces.faces;
  of.faceOfTriangle.reserve(polygonOf.size());
  for (const std::uint32_t polygon : polygonOf)
    of.faceOfTriangle.push_back(surfaces.faceOfTriangle[polygon]);
  for (ExactSurface& surface : of.faces) {
    surface.point *= metresPerUnit;
    surface.radius *= metresPerUnit;
    surface.minorRadius *= metresPerUnit;
  }
  if (!mayBeTurned) return of;
  const auto normal = [](std::span<const glm::dvec3> points, std::uint32_t a, std::uint32_t b,
                         std::uint32_t c) {
    return glm::cross(points[b] - points[a], points[c] - points[a]);
  };
  std::vector<double> agreement(of.faces.size(), 0.0);
  for (std::size_t i = 0; i < polygonOf.size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    const std::span<const std::uint32_t> p =
        std::span(soup.corners).subspan(soup.firstCorner[polygonOf[i]], 3);
    agreement[of.faceOfTriangle[i]] +=
        glm::dot(normal(mesh.vertices(), t[0], t[1], t[2]), normal(soup.vertices, p[0], p[1], p[2]));
  }
  turnFaces(of.faces, agreement);
  return of;
}

/// Throws Error if faces and triangles do not fit together.
void checkFaces(const CadShape& shape) {
  const std::size_t faces = shape.surfaces.faces.size();
  const bool hasFaces = faces > 0;
  const bool fits = hasFaces ? shape.surfaces.faceOfTriangle.size() == shape.triangles.size() &&
                                   std::ranges::all_of(shape.surfaces.faceOfTriangle,
                                                       [faces](std::uint32_t face) { return face < faces; })
                             : shape.surfaces.faceOfTriangle.empty();
  const bool areColoursFine =
      (shape.faceColours.empty() || shape.faceColours.size() == faces) &&
      std::ranges::all_of(shape.faceColours, [](const std::optional<CadColour>& colour) {
        return !colour || std::ranges::all_of(*colour, [](float c) { return c >= 0.0F && c <= 1.0F; });
      });
  if (!fits || !areColoursFine) throw Error("", "its faces do not fit its triangles", kExportDocument);
}

/// Builds the mesh of a shape, and frees the shape's own. Throws Error.
CachedMesh built(CadShape& shape, double metresPerUnit, const std::function<void(double)>& onProgress) {
  checkFaces(shape);
  const PolygonSoup soup = soupOf(shape);
  MeshBuildOptions options;
  options.metresPerUnit = metresPerUnit;
  CachedMesh mesh;
  std::vector<std::uint32_t> polygonOf;
  const bool hasFaces = !shape.surfaces.faces.empty();
  mesh.mesh = buildMesh(soup, options, mesh.report, onProgress, hasFaces ? &polygonOf : nullptr);
  mesh.report.warnings.insert(mesh.report.warnings.begin(), shape.warnings.begin(), shape.warnings.end());
  for (std::string& warning : mesh.report.warnings) {
    if (!isPrintableUtf8(warning)) warning = printableText(warning);
  }
  mesh.mass = massProperties(mesh.mesh);
  mesh.shape.emplace();
  if (hasFaces) {
    mesh.shape->surfaces = std::make_shared<const SurfaceFaces>(
        surfacesOf(shape.surfaces, mesh.mesh, soup, polygonOf, metresPerUnit, mesh.report.turnedInsideOut));
  }
  mesh.shape->faceColours = std::move(shape.faceColours);
  mesh.shape->chord = metresPerUnit * shape.tessellation.chord;
  mesh.shape->angle = shape.tessellation.angle;
  mesh.shape->exactVolume = metresPerUnit * metresPerUnit * metresPerUnit * shape.exactVolume;
  mesh.shape->isExact = shape.isExact;
  const std::string key = std::exchange(shape.key, {});
  shape = {};
  shape.key = key;
  return mesh;
}

/// Unit in which an imported document's lengths are.
double unitOf(const CadDocument& document, const Source& source) {
  return document.hasUnit && !mayBeInWrongUnit(source.file) ? 1.0 : source.metresPerUnit;
}

/// Builds the geometry of an imported shape and caches it. Throws FileError that names the shape.
PartGeometryPtr geometryOf(CadShape& shape, const Source& source, const CadDocument& document,
                           const DocumentContent& content, const std::function<void(double)>& onProgress) {
  const std::string where = fmt::format("{}, shape \"{}\"", source.file.string(), shape.key);
  try {
    Source own = source;
    own.metresPerUnit = unitOf(document, source);
    PartGeometry geometry = namedGeometry(own, content, shape.key);
    geometry.hasOwnUnit = document.hasUnit;
    if (content.name.empty()) {
      geometry.cacheName = contentNameOf(own, shape);
      // Storing it again would drop its hierarchy.
      if (std::optional<CachedMesh> kept = cachedMeshOf(geometry))
        return cachedGeometry(std::move(geometry), std::move(*kept));
    }
    CachedMesh mesh = built(shape, own.metresPerUnit, onProgress);
    mesh.shape->statedUnit = document.statedUnit;
    storeMesh(geometry, mesh);
    return cachedGeometry(std::move(geometry), std::move(mesh));
  } catch (const FileError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw FileError(where, error.problem(), error.remedy());
  } catch (const std::bad_alloc&) {
    throw FileError(where, "there is not enough memory for it",
                    "close other programs, or take a coarser tessellation");
  }
}

/// Geometries of shapes, or why they have none, built in parallel.
std::vector<LoadedPart> geometriesOf(CadDocument& document, std::span<const std::size_t> shapes,
                                     const Source& source, const DocumentContent& content,
                                     const ProgressCallback& progress) {
  std::vector<LoadedPart> loaded(shapes.size());
  double total = 1.0;
  for (const std::size_t shape : shapes)
    total += static_cast<double>(document.shapes[shape].triangles.size());
  const ProgressCallback stage = stageCallback(progress, kDocumentImported, 1.0);
  SharedProgress all(stage, total);
  parallelFor(shapes.size(), [&](std::size_t i) {
    CadShape& shape = document.shapes[shapes[i]];
    const auto triangles = static_cast<double>(shape.triangles.size());
    // Within a shape, progress only serves to cancel.
    const auto onProgress = [&all](double) { all.add(0.0); };
    try {
      loaded[i].geometry = geometryOf(shape, source, document, content, onProgress);
    } catch (const Cancelled&) {
      throw;
    } catch (...) {
      loaded[i].problem = std::current_exception();
    }
    all.add(triangles);
  });
  return loaded;
}

std::string messageOf(const std::exception_ptr& problem) {
  try {
    std::rethrow_exception(problem);
  } catch (const Error& error) {
    return error.problem();
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// The whole document if the cache has it.
std::optional<LoadedDocument> documentFromCache(const Source& source, const DocumentContent& content) {
  const std::optional<std::string> text = TreeCache().findText(outlineKeyOf(source, content));
  std::optional<DocumentOutline> outline = text ? readOutline(*text, source.file) : std::nullopt;
  if (!outline) return std::nullopt;
  LoadedDocument document;
  document.shapes.resize(outline->shapes.size());
  parallelFor(document.shapes.size(), [&](std::size_t i) {
    if (outline->shapes[i].problem.empty())
      document.shapes[i] = fromCache(source, content, outline->shapes[i].key);
  });
  for (std::size_t i = 0; i < document.shapes.size(); ++i) {
    if (outline->shapes[i].problem.empty() && document.shapes[i] == nullptr) return std::nullopt;
  }
  document.file = normalisedPath(source.file);
  document.nodes = std::move(outline->nodes);
  document.warnings = std::move(outline->warnings);
  document.isFromCache = true;
  return document;
}

/// Builds the shapes of an imported document, and caches all of it.
LoadedDocument documentOf(CadDocument imported, const Source& source, const ProgressCallback& progress) {
  std::vector<std::size_t> all(imported.shapes.size());
  DocumentOutline outline;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = i;
    outline.shapes.push_back({imported.shapes[i].key, {}});
  }
  outline.nodes = std::move(imported.nodes);
  outline.warnings = std::move(imported.warnings);
  for (CadNode& node : outline.nodes)
    node.parentFromNode.translation *= unitOf(imported, source);
  outline = checkedOutline(std::move(outline), source.file);
  const DocumentContent content = contentOf(source.file, imported);
  const std::vector<LoadedPart> loaded = geometriesOf(imported, all, source, content, progress);
  LoadedDocument document;
  std::exception_ptr problem;
  for (std::size_t i = 0; i < all.size(); ++i) {
    document.shapes.push_back(loaded[i].geometry);
    if (!loaded[i].problem) continue;
    problem = loaded[i].problem;
    outline.shapes[i].problem = printableText(messageOf(problem));
    outline.warnings.push_back(
        fmt::format("Shape \"{}\" was left out: {}.", outline.shapes[i].key, outline.shapes[i].problem));
  }
  if (all.empty()) throw FileError(source.file.string(), "it holds no shape", "export solids or surfaces");
  const bool isAny = std::ranges::any_of(document.shapes, [](const auto& shape) { return shape != nullptr; });
  if (!isAny) std::rethrow_exception(problem);
  if (!content.name.empty()) {
    TreeCache().storeText(outlineKeyOf(source, content), outlineText(outline));
    storeCompanionNames(source.file, content, imported);
  }
  document.file = normalisedPath(source.file);
  document.nodes = std::move(outline.nodes);
  document.warnings = std::move(outline.warnings);
  return document;
}

[[noreturn]] void failShape(const Source& source, const std::string& shape) {
  throw FileError(source.file.string(), fmt::format("it holds no shape \"{}\"", shape),
                  "it may have been renamed in the CAD system: add the parts of the file again");
}

/// Throws UsageError: the document has several shapes, and none is named.
[[noreturn]] void failSeveral(const Source& source, const std::vector<std::string>& keys) {
  std::string named;
  for (std::size_t i = 0; i < std::min(keys.size(), kNamedShapes); ++i)
    named += fmt::format("{}\"{}\"", i > 0 ? ", " : "", keys[i]);
  if (keys.size() > kNamedShapes) named += fmt::format(" and {} more", keys.size() - kNamedShapes);
  throw UsageError(source.file.string(), fmt::format("it holds {} shapes: {}", keys.size(), named),
                   "name one of them");
}

/// Loads the only shape of a document.
PartGeometryPtr onlyShapeOf(const LoadedDocument& document, const Source& source) {
  if (document.shapes.size() == 1) return document.shapes.front();
  std::vector<std::string> keys;
  for (const PartGeometryPtr& shape : document.shapes) {
    if (shape != nullptr) keys.push_back(shape->shapeKey);
  }
  failSeveral(source, keys);
}

LoadedDocument loadWhole(const Source& source, const std::string& sha256, const ProgressCallback& progress) {
  const auto content = contentOnDisk(source.file, sha256, stageOf(progress, kFileHashed, kDocumentHashed));
  std::optional<LoadedDocument> kept = content ? documentFromCache(source, *content) : std::nullopt;
  if (kept) return std::move(*kept);
  CadDocument imported = importAll(source, {}, progress);
  // The file may have changed since it was hashed. Its content when it was read counts.
  if (imported.sha256.empty()) imported.sha256 = sha256;
  return documentOf(std::move(imported), source, progress);
}

/// Loads shapes whose keys are all given, by one import at most.
class ShapeLoad {
 public:
  ShapeLoad(std::span<const MeshSource> sources, const Source& source, std::string sha256)
      : sources_(sources), source_(source), sha256_(std::move(sha256)), loaded_(sources.size()) {}

  std::vector<LoadedPart> run(const ProgressCallback& progress) {
    content_ = contentOnDisk(source_.file, sha256_, stageOf(progress, kFileHashed, kDocumentHashed));
    if (content_) takeCached();
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (loaded_[i].geometry == nullptr && std::ranges::find(missing, sources_[i].shape) == missing.end())
        missing.push_back(sources_[i].shape);
    }
    if (!missing.empty()) importMissing(missing, progress);
    return std::move(loaded_);
  }

 private:
  void takeCached() {
    // Equal sources are looked for once.
    std::map<std::pair<std::string, std::string>, std::size_t> firstOf;
    std::vector<std::size_t> distinct;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (firstOf.try_emplace(keyOf(sources_[i]), i).second) distinct.push_back(i);
    }
    parallelFor(distinct.size(), [&](std::size_t i) {
      const MeshSource& wanted = sources_[distinct[i]];
      PartGeometryPtr& geometry = loaded_[distinct[i]].geometry;
      geometry = fromCache(source_, *content_, wanted.shape, wanted.repairs);
      if (geometry == nullptr && !wanted.repairs.empty())
        geometry = fromCache(source_, *content_, wanted.shape);
    });
    for (std::size_t i = 0; i < sources_.size(); ++i)
      loaded_[i] = loaded_[firstOf.at(keyOf(sources_[i]))];
  }

  static std::pair<std::string, std::string> keyOf(const MeshSource& source) {
    return {source.shape, textOf(source.repairs)};
  }

  void importMissing(const std::vector<std::string>& missing, const ProgressCallback& progress) {
    CadDocument imported = importAll(source_, missing, progress);
    if (imported.sha256.empty()) imported.sha256 = sha256_;
    const DocumentContent content = contentOf(source_.file, imported);
    const bool isAnyCached =
        std::ranges::any_of(loaded_, [](const LoadedPart& part) { return part.geometry != nullptr; });
    if (imported.sha256 != sha256_ || (isAnyCached && content.name != content_->name))
      throw FileError(source_.file.string(), "it has changed while it was read", "try again");
    storeCompanionNames(source_.file, content, imported);
    std::map<std::string, std::size_t> indexOf;
    for (std::size_t i = 0; i < imported.shapes.size(); ++i)
      indexOf.emplace(imported.shapes[i].key, i);
    std::vector<std::size_t> shapes;
    for (const std::string& key : missing) {
      if (const auto it = indexOf.find(key); it != indexOf.end()) shapes.push_back(it->second);
    }
    const std::vector<LoadedPart> built = geometriesOf(imported, shapes, source_, content, progress);
    std::map<std::string, LoadedPart> byKey;
    for (std::size_t i = 0; i < shapes.size(); ++i)
      byKey.emplace(imported.shapes[shapes[i]].key, built[i]);
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (loaded_[i].geometry == nullptr) take(i, byKey);
    }
  }

  void take(std::size_t i, const std::map<std::string, LoadedPart>& byKey) {
    const auto it = byKey.find(sources_[i].shape);
    if (it != byKey.end()) {
      loaded_[i] = it->second;
      return;
    }
    try {
      failShape(source_, sources_[i].shape);
    } catch (...) {
      loaded_[i].problem = std::current_exception();
    }
  }

  std::span<const MeshSource> sources_;
  const Source& source_;
  std::string sha256_;
  std::optional<DocumentContent> content_;  ///< Before anything is imported, if the cache can tell.
  std::vector<LoadedPart> loaded_;
};

std::vector<LoadedPart> loadShapesUnguarded(std::span<const MeshSource> sources,
                                            const ProgressCallback& progress) {
  const MeshSource& first = sources.front();
  const Source source = sourceOf(first.file, first.metresPerUnit, first.tessellation);
  checkMeshFile(first.file);
  const std::string sha256 = sha256OfFile(first.file, stageOf(progress, 0.0, kFileHashed));
  if (!first.sha256.empty() && first.sha256 != sha256) return std::vector<LoadedPart>(sources.size());
  const bool areAllNamed = std::ranges::none_of(sources, [](const MeshSource& s) { return s.shape.empty(); });
  if (areAllNamed) return ShapeLoad(sources, source, sha256).run(progress);
  const LoadedDocument document = loadWhole(source, sha256, progress);
  std::vector<LoadedPart> loaded(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::string& wanted = sources[i].shape;
    try {
      const auto it = std::ranges::find_if(document.shapes, [&wanted](const PartGeometryPtr& shape) {
        return shape != nullptr && shape->shapeKey == wanted;
      });
      if (it == document.shapes.end() && !wanted.empty()) failShape(source, wanted);
      loaded[i].geometry = wanted.empty() ? onlyShapeOf(document, source) : *it;
      if (!first.sha256.empty() && loaded[i].geometry->sha256 != first.sha256) loaded[i].geometry = nullptr;
    } catch (...) {
      loaded[i].problem = std::current_exception();
    }
  }
  return loaded;
}

}  // namespace

void checkTessellation(const Tessellation& tessellation) {
  const auto [chord, angle] = tessellation;
  if (!(chord == 0.0 || (chord >= kMinChord && chord <= kMaxChord))) {
    throw UsageError(
        "chord", fmt::format("{} m is out of range", chord),
        fmt::format("give a value from {} to {} m, or 0 for one that suits the size", kMinChord, kMaxChord));
  }
  if (!(angle == 0.0 || (angle >= kMinFacetAngle && angle <= kMaxFacetAngle))) {
    throw UsageError(
        "angle", fmt::format("{} rad is out of range", angle),
        fmt::format("give a value from {} to {} rad, or 0 for the default", kMinFacetAngle, kMaxFacetAngle));
  }
}

Tessellation tessellationOfOptions(double chord, double angleDegrees) {
  const Tessellation tessellation{chord, angleDegrees * std::numbers::pi / 180.0};
  try {
    checkTessellation(tessellation);
  } catch (const UsageError& error) {
    throw UsageError("--" + error.where(), error.problem(), error.remedy());
  }
  return tessellation;
}

bool storesUnit(const fs::path& file) {
  return isDocumentFile(file) && documentFormat(file) != "brep";
}

bool mayBeInWrongUnit(const fs::path& file) {
  constexpr std::array<std::string_view, 4> kDoubtful{"gltf", "glb", "urdf", "3mf"};
  return std::ranges::find(kDoubtful, documentFormat(file)) != kDoubtful.end();
}

bool canChangeUnit(const PartGeometry& geometry) {
  return !geometry.hasOwnUnit || mayBeInWrongUnit(geometry.file);
}

double unitToOpen(const fs::path& file, double given) {
  return storesUnit(file) ? 1.0 : given;
}

LoadedDocument loadDocument(const fs::path& file, double metresPerUnit, const Tessellation& tessellation,
                            const ProgressCallback& progress) {
  checkMetresPerUnit(metresPerUnit);
  const Source source = sourceOf(file, unitToOpen(file, metresPerUnit), tessellation);
  checkMeshFile(file);
  const std::string sha256 = sha256OfFile(file, stageOf(progress, 0.0, kFileHashed));
  LoadedDocument document = loadWhole(source, sha256, progress);
  stageOf(progress, kDocumentImported, 1.0)(1.0);
  return document;
}

std::vector<LoadedPart> loadShapes(std::span<const MeshSource> sources, const ProgressCallback& progress) {
  try {
    std::vector<LoadedPart> loaded = loadShapesUnguarded(sources, progress);
    stageOf(progress, kDocumentImported, 1.0)(1.0);
    return loaded;
  } catch (const Cancelled&) {
    throw;
  } catch (...) {
    std::vector<LoadedPart> failed(sources.size());
    for (LoadedPart& each : failed)
      each.problem = std::current_exception();
    return failed;
  }
}

ScopedDocumentImporter::ScopedDocumentImporter(DocumentImporter importer)
    : before_(exchangeImporter(std::make_shared<const DocumentImporter>(std::move(importer)))) {}

ScopedDocumentImporter::~ScopedDocumentImporter() {
  exchangeImporter(before_);
}

}  // namespace nearfit
