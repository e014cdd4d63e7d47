#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>

#include "app/import/import_job.h"
#include "app/import/placed_mesh.h"

namespace nearfit::importer {

/// An object placed in another one, or in the scene of a 3MF file.
struct ThreeMfPlacement {
  std::uint32_t object = 0;
  glm::dmat3 map{1.0};
  glm::dvec3 translation{0.0};
};

/// An object of a 3MF file: a mesh, or placements of others.
struct ThreeMfObject {
  std::string name;
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<ThreeMfPlacement> components;
  std::optional<CadColour> colour;  ///< Colour of its triangles that have none of their own.
  /// Colours by base materials and groups of colours; empty, or one for each triangle.
  TriangleColours triangleColours;
};

/// A 3MF file as lib3mf reads it. Its two versions differ in all names, so that each has a source file of its own.
struct ThreeMfModel {
  double metresPerUnit = 1e-3;
  std::map<std::uint32_t, ThreeMfObject> objects;
  std::vector<ThreeMfPlacement> items;
};

/// Throws FileError.
ThreeMfModel loadThreeMf(const ImportJob& job);

/// A colour from bytes of sRGB.
inline CadColour threeMfColour(std::uint8_t red, std::uint8_t green, std::uint8_t blue) noexcept {
  constexpr float kMax = 255.0F;
  return {static_cast<float>(red) / kMax, static_cast<float>(green) / kMax, static_cast<float>(blue) / kMax};
}

/// Metres of the units of 3MF in the order of both versions of lib3mf; no value for others.
std::optional<double> threeMfUnit(std::uint32_t unit);

}  // namespace nearfit::importer
