#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "app/import/document_builder.h"
#include "app/import/import_job.h"
#include "app/import/placed_mesh.h"
#include "app/import/threemf_model.h"
#include "core/base/error.h"
#include "core/import/document_file.h"

namespace nearfit::importer {
namespace {

class ThreeMfReader {
 public:
  explicit ThreeMfReader(const ImportJob& job) : job_(job), builder_(job) { builder_.setHasTrianglesOnly(); }

  CadDocument read() {
    model_ = loadThreeMf(job_);
    builder_.setStatedUnit(model_.metresPerUnit);
    for (auto& [id, object] : model_.objects)
      settleColours(object);
    job_.progress(0.5);
    job_.endStage("read");
    for (const ThreeMfPlacement& item : model_.items)
      place(item, -1, glm::dmat3(1.0), 0);
    return builder_.take();
  }

 private:
  /// A colour that all triangles have is the object's, and those of the object's have none of their own: a part is given
  /// another colour by that of its node.
  static void settleColours(ThreeMfObject& object) {
    if (const std::optional<CadColour> common = object.triangleColours.common()) {
      object.colour = common;
      object.triangleColours = {};
    } else if (object.colour) {
      object.triangleColours.setOwn(*object.colour);
    }
  }

  /// @param rest  What placements around it cannot express; applied within it.
  void place(const ThreeMfPlacement& placement, std::int32_t parent, const glm::dmat3& rest,
             std::size_t depth) {
    const auto found = model_.objects.find(placement.object);
    if (found == model_.objects.end()) return;
    // Of an object that contains itself too: the format forbids it, and the library lets it pass.
    if (depth >= kMaxDocumentDepth)
      throw FileError(job_.file.string(), "an object of it contains itself, or is nested too deep",
                      "export it again");
    const ThreeMfObject& object = found->second;
    const std::optional<SplitMap> split = splitMap(rest * placement.map);
    CadNode node;
    node.parent = parent;
    node.name = cleanName(object.name);
    node.colour = object.colour;
    if (!split) {
      builder_.warn(fmt::format("\"{}\" is left out: its placement is flat or not finite.", node.name));
      return;
    }
    node.parentFromNode = {split->rotation, rest * placement.translation * model_.metresPerUnit};
    if (object.components.empty()) {
      node.shape = shapeOf(placement.object, object, split->rest);
      builder_.addNode(node);
      return;
    }
    const std::int32_t group = builder_.addNode(node);
    for (const ThreeMfPlacement& component : object.components)
      place(component, group, split->rest, depth + 1);
  }

  std::int32_t shapeOf(std::uint32_t id, const ThreeMfObject& object, const glm::dmat3& rest) {
    const std::string variant = restText(rest);
    const auto [at, isNew] = shapes_.try_emplace({id, variant}, -1);
    if (!isNew) return at->second;
    const std::string name = cleanName(object.name);
    std::string key = name.empty() ? fmt::format("object {}", id) : name;
    if (!variant.empty()) key += " x " + variant;
    at->second = builder_.addShape(key);
    if (builder_.isWanted(at->second))
      builder_.setShape(at->second, triangleShape(object.vertices, object.triangles,
                                                  rest * model_.metresPerUnit, object.triangleColours));
    return at->second;
  }

  const ImportJob& job_;
  DocumentBuilder builder_;
  ThreeMfModel model_;
  std::map<std::pair<std::uint32_t, std::string>, std::int32_t> shapes_;
};

}  // namespace

std::optional<double> threeMfUnit(std::uint32_t unit) {
  constexpr std::array kUnits{1e-6, 1e-3, 1e-2, 0.0254, 0.3048, 1.0};
  return unit < kUnits.size() ? std::optional(kUnits[unit]) : std::nullopt;
}

CadDocument readThreeMf(const ImportJob& job) {
  return ThreeMfReader(job).read();
}

}  // namespace nearfit::importer
