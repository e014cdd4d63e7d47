#include "core/report/step_export.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/import/document_file.h"
#include "core/import/document_import.h"
#include "core/import/import_process.h"
#include "core/report/assembly_tree.h"
#include "core/scene/names.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

/// Time without progress that the program may take [s]: within a source, a shape and the file's text it tells little of
/// how far it is, and 100,000 facets take it a minute.
constexpr double kStepSilence = 300.0;
/// Progress once the program is done.
constexpr double kStepMade = 0.95;
/// Formats of files with exact surfaces.
constexpr std::array<std::string_view, 5> kExactFormats{"step", "stp", "iges", "igs", "brep"};

bool isOfExactFormat(const std::filesystem::path& file) {
  return std::ranges::find(kExactFormats, documentFormat(file)) != kExactFormats.end();
}

std::optional<StepSource> sourceOf(const PartGeometry& geometry) {
  if (!geometry.isExact || geometry.shapeKey.empty() || !geometry.repairs.empty() ||
      !isOfExactFormat(geometry.file))
    return std::nullopt;
  return StepSource{geometry.file, geometry.sha256, geometry.shapeKey, geometry.metresPerUnit};
}

CadShape shapeOf(const PartGeometry& geometry, std::string key) {
  CadShape shape;
  shape.key = std::move(key);
  shape.vertices.assign(geometry.mesh.vertices().begin(), geometry.mesh.vertices().end());
  shape.triangles.assign(geometry.mesh.triangles().begin(), geometry.mesh.triangles().end());
  if (geometry.faceColours.empty() || geometry.surfaces == nullptr) return shape;
  // Only which triangles have a colour counts, not on which surface they lie.
  shape.faceColours = geometry.faceColours;
  shape.surfaces.faces.resize(geometry.faceColours.size());
  shape.surfaces.faceOfTriangle = geometry.surfaces->faceOfTriangle;
  return shape;
}

/// Places a tree's nodes in a document, at most as deep as one may be.
class NodePlacer {
 public:
  explicit NodePlacer(const AssemblyTree& tree) : tree_(tree) {}

  std::vector<CadNode> nodes() {
    for (const AssemblyNode& node : tree_.nodes)
      place(node);
    return std::move(nodes_);
  }

 private:
  void place(const AssemblyNode& node) {
    const std::int32_t parent = node.parent < 0 ? -1 : nodeAt_[static_cast<std::size_t>(node.parent)];
    const std::size_t level = parent < 0 ? 1 : levels_[static_cast<std::size_t>(parent)] + 1;
    // The deepest level is left to parts.
    if (node.part == nullptr && level >= kMaxDocumentDepth) {
      nodeAt_.push_back(parent);
      return;
    }
    CadNode placed;
    placed.parent = parent;
    placed.name = truncatedUtf8(node.name, kMaxNodeNameBytes);
    if (node.part != nullptr) {
      placed.parentFromNode = node.part->worldFromPart.normalized();
      placed.shape = node.geometry;
      placed.colour = CadColour{node.part->colour.r, node.part->colour.g, node.part->colour.b};
    }
    nodeAt_.push_back(static_cast<std::int32_t>(nodes_.size()));
    levels_.push_back(level);
    nodes_.push_back(std::move(placed));
  }

  const AssemblyTree& tree_;
  std::vector<CadNode> nodes_;
  std::vector<std::int32_t>
      nodeAt_;  ///< By node of the tree; of one that is left out that of the group around it.
  std::vector<std::size_t> levels_;  ///< By node of the document.
};

}  // namespace

StepRequest stepRequest(const Scene& scene, std::span<const Scene::PartPtr> parts, StepSchema schema,
                        const std::string& name) {
  const AssemblyTree tree = assemblyTree(scene, parts);
  StepRequest request;
  request.schema = schema;
  request.name = truncatedUtf8(name, kMaxStepNameBytes);
  request.document.sha256 = std::string(64, '0');  // It came from no file.
  std::vector<std::string> names(tree.geometries.size());
  for (const AssemblyNode& node : tree.nodes)
    if (node.part != nullptr) names[static_cast<std::size_t>(node.geometry)] = node.name;
  TakenNames taken(kMaxDocumentKeyBytes);
  for (std::size_t i = 0; i < tree.geometries.size(); ++i) {
    const PartGeometry& geometry = *tree.geometries[i];
    // A product of one part has the part's name.
    const std::string key = taken.takeFree(tree.uses[i] == 1 ? names[i] : geometryName(geometry));
    taken.add(key);
    request.document.shapes.push_back(shapeOf(geometry, key));
    request.sources.push_back(sourceOf(geometry));
  }
  request.document.nodes = NodePlacer(tree).nodes();
  return request;
}

StepExport exportStep(const Scene& scene, std::span<const Scene::PartPtr> parts, StepSchema schema,
                      const std::filesystem::path& file, const ProgressCallback& progress) {
  checkReplaceable(file);
  try {
    std::vector<std::byte> request;
    writeStepRequest(
        stepRequest(scene, parts, schema, assemblyName(file)),
        [&](std::span<const std::byte> more) { request.insert(request.end(), more.begin(), more.end()); });
    const std::vector<std::byte> result =
        runExporter(exportProgram(), file, request, {kStepSilence}, stageCallback(progress, 0.0, kStepMade));
    const StepResult made = readStepResult(result);
    if (progress && !progress(1.0)) throw Cancelled();
    atomicWrite(file, {reinterpret_cast<const char*>(made.file.data()), made.file.size()});
    return {made.file.size(), made.notes};
  } catch (const std::bad_alloc&) {
    throw FileError(file.string(), "there is not enough memory to export it",
                    "export fewer parts, or close other programs");
  }
}

}  // namespace nearfit
