#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/import/document_import.h"
#include "core/math/aabb.h"
#include "tests/support/places.h"
#include "tests/support/scoped_variable.h"

/// Documents imported by the program that ships, and what is measured of them.
namespace nearfit::test {

inline std::filesystem::path importModel(const std::string& name) {
  return test::sourceFolder() / "tests" / "app" / "import" / "models" / name;
}

/// Public models beside the repository, where they are.
inline std::filesystem::path sharedModel(const std::string& name) {
  return test::sharedFolder() / "models" / name;
}

inline CadDocument imported(const std::filesystem::path& file, const DocumentOptions& options = {},
                            const ProgressCallback& progress = {}) {
  const ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  return importDocument(file, options, progress);
}

/// Product of the placements from the top to a node.
inline RigidTransform worldFromNode(const CadDocument& document, std::size_t node) {
  RigidTransform placed = document.nodes[node].parentFromNode;
  for (std::int32_t at = document.nodes[node].parent; at >= 0;
       at = document.nodes[static_cast<std::size_t>(at)].parent)
    placed = document.nodes[static_cast<std::size_t>(at)].parentFromNode * placed;
  return placed;
}

inline Aabb boxOf(const CadShape& shape, const RigidTransform& worldFromShape = {}) {
  Aabb box;
  for (const glm::dvec3& vertex : shape.vertices)
    box.add(worldFromShape.applyToPoint(vertex));
  return box;
}

/// Box of all that a document places.
inline Aabb boxOf(const CadDocument& document) {
  Aabb box;
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const std::int32_t shape = document.nodes[i].shape;
    if (shape < 0) continue;
    const Aabb one = boxOf(document.shapes[static_cast<std::size_t>(shape)], worldFromNode(document, i));
    box.add(one.lower);
    box.add(one.upper);
  }
  return box;
}

inline double volumeOf(const CadShape& shape) {
  double sum = 0.0;
  for (const Triangle& t : shape.triangles)
    sum += glm::dot(shape.vertices[t[0]], glm::cross(shape.vertices[t[1]], shape.vertices[t[2]]));
  return sum / 6.0;
}

inline double areaOf(const CadShape& shape) {
  double sum = 0.0;
  for (const Triangle& t : shape.triangles)
    sum += glm::length(
        glm::cross(shape.vertices[t[1]] - shape.vertices[t[0]], shape.vertices[t[2]] - shape.vertices[t[0]]));
  return sum / 2.0;
}

/// Edges of triangles without exactly one neighbour that runs the other way along them.
inline std::size_t unmatchedEdges(const CadShape& shape) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Triangle& t : shape.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      ++uses[{t[k], t[(k + 1) % 3]}];
  std::size_t unmatched = 0;
  for (const auto& [edge, count] : uses) {
    const auto back = uses.find({edge.second, edge.first});
    if (count != 1 || back == uses.end() || back->second != 1) ++unmatched;
  }
  return unmatched;
}

}  // namespace nearfit::test
