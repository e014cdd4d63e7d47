#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/import/document_file.h"
#include "tests/fuzz/fuzz_target.h"

/// What holds of any document that was read, whatever file it came from.
namespace nearfit::fuzz {

inline bool isColour(const CadColour& colour) {
  return std::ranges::all_of(colour, [](float c) { return c >= 0.0F && c <= 1.0F; });
}

inline void requireShape(const CadShape& shape) {
  require(!shape.triangles.empty(), "shapes have triangles");
  for (const glm::dvec3& v : shape.vertices)
    require(isFinite(v), "vertices are finite");
  for (const Triangle& t : shape.triangles) {
    for (const std::uint32_t corner : t)
      require(corner < shape.vertices.size(), "corners are vertices");
    require(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "corners differ");
  }
  const std::size_t faces = shape.surfaces.faces.size();
  require(shape.surfaces.faceOfTriangle.size() == (faces == 0 ? 0 : shape.triangles.size()),
          "each triangle has a face, or none has");
  for (const std::uint32_t face : shape.surfaces.faceOfTriangle)
    require(face < faces, "faces of triangles exist");
  require(shape.faceColours.empty() || shape.faceColours.size() == faces,
          "each face has a colour, or none has");
  for (const std::optional<CadColour>& colour : shape.faceColours)
    require(!colour || isColour(*colour), "colours are within range");
  require(std::isfinite(shape.exactVolume) && shape.exactVolume >= 0.0, "volumes are finite");
}

inline void requireNode(const CadDocument& document, std::size_t index) {
  const CadNode& node = document.nodes[index];
  require(node.parent >= -1 && (node.parent < 0 || static_cast<std::size_t>(node.parent) < index),
          "parents come first");
  require(
      node.shape >= -1 && (node.shape < 0 || static_cast<std::size_t>(node.shape) < document.shapes.size()),
      "shapes of nodes exist");
  // Less exact than a pose of a scene, which is normalised.
  constexpr double kUnit = 1e-6;
  require(
      node.parentFromNode.isFinite() && std::abs(glm::length(node.parentFromNode.rotation) - 1.0) <= kUnit,
      "placements are finite and rigid");
  require(!node.colour || isColour(*node.colour), "colours are within range");
}

inline void requireDocument(const CadDocument& document) {
  std::set<std::string_view> keys;
  for (const CadShape& shape : document.shapes) {
    requireShape(shape);
    require(!shape.key.empty() && keys.insert(shape.key).second, "each shape has a key of its own");
  }
  for (std::size_t i = 0; i < document.nodes.size(); ++i)
    requireNode(document, i);
}

/// The result file of a document. Throws Error if it exceeds a limit.
inline std::vector<std::byte> resultFileOf(const CadDocument& document) {
  std::vector<std::byte> file;
  writeDocument(document, [&](std::span<const std::byte> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
  });
  return file;
}

/// A document within the limits comes back from its result file as it was. Throws Error if it exceeds one.
inline void requireReadAsWritten(const CadDocument& document) {
  const std::vector<std::byte> file = resultFileOf(document);
  try {
    const CadDocument again = readDocument(file, "a result file");
    requireDocument(again);
    require(resultFileOf(again) == file, "documents are read as written");
  } catch (const Error&) {
    require(false, "what is written can be read");
  }
}

}  // namespace nearfit::fuzz
