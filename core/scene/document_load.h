#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/import/document_import.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

/// Limits of a tessellation that is asked for: a tenth of a micrometre is below what is machined, half a degree makes
/// 720 facets of a cylinder, and a right angle a square bar of it [m, rad].
constexpr double kMinChord = 1e-7, kMaxChord = 1e4, kMinFacetAngle = 0.0087, kMaxFacetAngle = 1.571;
/// Throws UsageError if a tolerance is neither 0 nor within these limits.
void checkTessellation(const Tessellation& tessellation);

/// Tessellation of the options --chord [m] and --angle [degrees]. Throws UsageError, naming the option, as
/// checkTessellation().
Tessellation tessellationOfOptions(double chord, double angleDegrees);

/// Max length of a shape's key [bytes of UTF-8].
constexpr std::size_t kMaxShapeKeyBytes = 1000;

/// True if files of this name store their unit: all CAD documents except BREP. Mesh files do not.
bool storesUnit(const std::filesystem::path& file);
/// True if files of this name may be in another unit than they are read in: glTF and URDF are in metres by their format,
/// but often written in another unit, and 3MF files state a unit that programs take for a formality. Their unit is not
/// asked for, yet it can be changed afterwards: metresPerUnit is then the factor by which lengths are corrected.
bool mayBeInWrongUnit(const std::filesystem::path& file);
/// True if the geometry can be read in another unit.
bool canChangeUnit(const PartGeometry& geometry);
/// Unit in which a file is opened: 1 if it stores one, else the one that is given.
double unitToOpen(const std::filesystem::path& file, double given);

/// A CAD document as scenes use it: its tree, and the geometry of each of its shapes.
struct LoadedDocument {
  std::filesystem::path file;  ///< As normalisedPath() returns it.
  std::vector<CadNode> nodes;  ///< Parents first; in metres. Names are printable UTF-8.
  /// By CadNode::shape; null for a shape without any area, which a warning names.
  std::vector<PartGeometryPtr> shapes;
  std::vector<std::string> warnings;  ///< About the document as a whole.
  bool isFromCache = false;           ///< Nothing was imported.
};

/// Imports a document and builds the mesh of each shape, once however often it is placed; or takes all of it from the
/// cache, if its file and its companions are as they were. Blocking.
/// @param metresPerUnit  For a document that stores no unit.
/// Throws FileError (also if it has no shape), UsageError, Cancelled.
LoadedDocument loadDocument(const std::filesystem::path& file, double metresPerUnit,
                            const Tessellation& tessellation = {}, const ProgressCallback& progress = {});

/// Loads shapes of one document for loadPartGeometries(), in the order of `sources`. Repairs are not made: a shape is
/// repaired as wanted if the cache has it so, else as it was read.
/// @param sources  Not empty; they differ in their shapes and repairs only.
/// Throws only Cancelled.
std::vector<LoadedPart> loadShapes(std::span<const MeshSource> sources,
                                   const ProgressCallback& progress = {});

/// Reads a document, as importDocument() does.
using DocumentImporter = std::function<CadDocument(
    const std::filesystem::path& file, const DocumentOptions& options, const ProgressCallback& progress)>;

/// All loads import by this function instead of importDocument() until the end of the scope. For tests, which then need
/// no program to import with. Scopes nest; loads may run in any thread.
class ScopedDocumentImporter {
 public:
  explicit ScopedDocumentImporter(DocumentImporter importer);
  ~ScopedDocumentImporter();
  ScopedDocumentImporter(const ScopedDocumentImporter&) = delete;
  ScopedDocumentImporter& operator=(const ScopedDocumentImporter&) = delete;

 private:
  std::shared_ptr<const DocumentImporter> before_;
};

}  // namespace nearfit
