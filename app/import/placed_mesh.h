#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>

#include "core/import/cad_document.h"

namespace nearfit::importer {

/// A linear map as a rotation after a rest, which a rigid placement cannot express and is baked into shapes.
struct SplitMap {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dmat3 rest{1.0};  ///< map = rotation * rest; symmetric.
};

/// Splits a map (polar decomposition); the rotation is proper, so that a map that mirrors has a rest that does. No value
/// if the map is singular or not finite.
std::optional<SplitMap> splitMap(const glm::dmat3& map);

/// True if the rest is the identity, but for rounding.
bool isIdentity(const glm::dmat3& rest);

/// The rest as a text that is the same for equal ones, to tell variants of a shape apart; empty for the identity.
std::string restText(const glm::dmat3& rest);

/// A shape of triangles from a file of triangles, which repeats a corner for each of its normals: joins equal corners,
/// drops triangles that repeat one or have one that is not finite, and applies `map`, turning the triangles where it
/// mirrors.
CadShape triangleShape(std::span<const glm::dvec3> vertices, std::span<const Triangle> triangles,
                       const glm::dmat3& map);

/// Six times the signed volume within triangles: negative if they are inside out.
double sixVolumes(std::span<const glm::dvec3> vertices, std::span<const Triangle> triangles);

}  // namespace nearfit::importer
