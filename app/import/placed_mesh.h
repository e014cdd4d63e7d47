#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
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

/// Colours of a mesh's triangles.
class TriangleColours {
 public:
  /// Max number of colours that are told apart; triangles of further ones have none. More would show nothing, and each
  /// becomes a face.
  static constexpr std::size_t kMaxColours = 4096;

  /// Adds the next triangle; std::nullopt: it has the colour of its part.
  void add(const std::optional<CadColour>& colour);
  std::size_t size() const noexcept { return numbers_.size(); }
  /// The colour of all triangles, if they have the same.
  std::optional<CadColour> common() const;
  /// Triangles of this colour have that of their part.
  void setOwn(const CadColour& own);

  /// Number of a triangle's colour: the same for the same one, 0 for the part's.
  std::uint32_t numberOf(std::size_t triangle) const { return numbers_[triangle]; }
  /// The colour of a number; std::nullopt for the part's.
  const std::optional<CadColour>& colour(std::uint32_t number) const { return colours_[number]; }
  std::size_t colourCount() const noexcept { return colours_.size(); }
  bool areTooMany() const noexcept { return areTooMany_; }

 private:
  std::vector<std::optional<CadColour>> colours_{std::nullopt};
  std::map<CadColour, std::uint32_t> numberAt_;
  std::vector<std::uint32_t> numbers_;  ///< Number of each triangle's colour.
  bool areTooMany_ = false;
};

/// A shape of triangles from a file of triangles, which repeats a corner for each of its normals: joins equal corners,
/// drops triangles that repeat one or have one that is not finite, and applies `map`, turning the triangles where it
/// mirrors.
/// @param colours  One for each triangle, or empty. Triangles of one colour become a face of no known surface, if any has
///                 a colour.
CadShape triangleShape(std::span<const glm::dvec3> vertices, std::span<const Triangle> triangles,
                       const glm::dmat3& map, const TriangleColours& colours = {});

/// Six times the signed volume within triangles: negative if they are inside out.
double sixVolumes(std::span<const glm::dvec3> vertices, std::span<const Triangle> triangles);

}  // namespace nearfit::importer
