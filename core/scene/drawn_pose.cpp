#include "core/scene/drawn_pose.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/scene/document_load.h"

namespace nearfit {
namespace {

/// Poses nearer than this, of the distance from the origin and in radians, are one place: they differ by rounding.
constexpr double kSamePlace = 1e-9;

bool isSamePlace(const RigidTransform& a, const RigidTransform& b) {
  const double reach = 1.0 + glm::length(a.translation);
  return glm::distance(a.translation, b.translation) <= kSamePlace * reach &&
         std::abs(glm::dot(a.rotation, b.rotation)) >= 1.0 - kSamePlace;
}

bool isSameShape(const PartGeometry& a, const PartGeometry& b) {
  return a.file == b.file && a.shapeKey == b.shapeKey;
}

/// Where a document places a shape.
std::vector<RigidTransform> placesOf(const LoadedDocument& document, const PartGeometry& geometry) {
  // Lengths of a document in a wrong unit are corrected by this factor.
  const double scale = storesUnit(geometry.file) ? geometry.metresPerUnit : 1.0;
  std::vector<RigidTransform> worldFromNode(document.nodes.size()), places;
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const CadNode& node = document.nodes[i];
    worldFromNode[i] = node.parent < 0
                           ? node.parentFromNode
                           : worldFromNode[static_cast<std::size_t>(node.parent)] * node.parentFromNode;
    if (node.shape < 0) continue;
    const PartGeometryPtr& shape = document.shapes[static_cast<std::size_t>(node.shape)];
    if (shape == nullptr || shape->shapeKey != geometry.shapeKey) continue;
    if (shape->sha256 != geometry.sha256)
      throw FileError(geometry.file.string(), "it was changed since the part was read",
                      "load the part anew, or give a pose");
    RigidTransform place = worldFromNode[i];
    place.translation *= scale;
    places.push_back(checkedPose(place.normalized()));
  }
  return places;
}

}  // namespace

RigidTransform drawnPose(const Scene& scene, PartId id, const ProgressCallback& progress) {
  const Part& part = scene.get(id);
  const std::string where = fmt::format("part \"{}\"", part.name);
  if (part.geometry == nullptr)
    throw UsageError(where, "it was not read from a file, so it was drawn nowhere", "give a pose");
  const PartGeometry& geometry = *part.geometry;
  if (geometry.shapeKey.empty()) return {};
  const LoadedDocument document =
      loadDocument(geometry.file, geometry.metresPerUnit, geometry.tessellation, progress);
  std::vector<RigidTransform> places = placesOf(document, geometry);
  if (places.empty())
    throw FileError(geometry.file.string(), "it places the part's shape nowhere",
                    "load the part anew, or give a pose");
  if (places.size() == 1) return places.front();
  std::erase_if(places, [&](const RigidTransform& place) {
    return std::ranges::any_of(scene.parts(), [&](const Scene::PartPtr& other) {
      return other->id != id && other->geometry && isSameShape(*other->geometry, geometry) &&
             isSamePlace(other->worldFromPart, place);
    });
  });
  const auto own = std::ranges::find_if(
      places, [&](const RigidTransform& place) { return isSamePlace(part.worldFromPart, place); });
  if (own != places.end()) return *own;
  if (places.size() == 1) return places.front();
  throw UsageError(where,
                   places.empty()
                       ? "other parts of its shape are at all places where it was drawn"
                       : fmt::format("its document has {} free places for its shape", places.size()),
                   "give a pose");
}

}  // namespace nearfit
