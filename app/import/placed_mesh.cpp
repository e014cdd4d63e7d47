#include "app/import/placed_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "app/import/document_builder.h"
#include "core/import/document_file.h"

namespace nearfit::importer {
namespace {

/// Deviations of a placement from a rigid one that are rounding: files write seven digits and more.
constexpr double kRigidTolerance = 1e-6;
/// Below this a map is flat: its inverse has no digits left.
constexpr double kFlatDeterminant = 1e-12;
/// Steps of the iteration below; five are enough for what CAD programs write, since each doubles the digits.
constexpr int kMaxPolarSteps = 60;

double maxDifference(const glm::dmat3& a, const glm::dmat3& b) {
  double max = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      max = std::max(max, std::abs(a[i][j] - b[i][j]));
  return max;
}

bool isFiniteMap(const glm::dmat3& map) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(map[i][j]) <= kMaxDocumentLength)) return false;
  return true;
}

struct PointHash {
  std::size_t operator()(const glm::dvec3& p) const noexcept {
    std::array<std::uint64_t, 3> bits{};
    // Zero has two signs, which are equal.
    const std::array<double, 3> values{p.x + 0.0, p.y + 0.0, p.z + 0.0};
    std::memcpy(bits.data(), values.data(), sizeof(bits));
    std::uint64_t hash = 0;
    for (const std::uint64_t b : bits)
      hash = (hash ^ b ^ (b >> 29)) * 0x9E3779B97F4A7C15U;
    return hash ^ (hash >> 32);
  }
};

bool isUsable(const glm::dvec3& p) {
  return std::abs(p.x) <= kMaxDocumentLength && std::abs(p.y) <= kMaxDocumentLength &&
         std::abs(p.z) <= kMaxDocumentLength;
}

}  // namespace

std::optional<SplitMap> splitMap(const glm::dmat3& map) {
  if (!isFiniteMap(map)) return std::nullopt;
  const double determinant = glm::determinant(map);
  const double size = std::cbrt(std::abs(determinant));
  const double longest = std::max({glm::length(map[0]), glm::length(map[1]), glm::length(map[2])});
  if (!(std::abs(determinant) > kFlatDeterminant * longest * longest * longest)) return std::nullopt;
  // The nearest orthogonal matrix (Higham 1986): the mean of a matrix and its inverse transpose, over and over.
  glm::dmat3 rotation = map * (1.0 / size);
  for (int step = 0; step < kMaxPolarSteps; ++step) {
    const glm::dmat3 next = 0.5 * (rotation + glm::transpose(glm::inverse(rotation)));
    const double change = maxDifference(next, rotation);
    rotation = next;
    if (change < 1e-15) break;
  }
  if (determinant < 0.0) rotation *= -1.0;
  const glm::dmat3 rest = glm::transpose(rotation) * map;
  return SplitMap{glm::normalize(glm::quat_cast(rotation)), isIdentity(rest) ? glm::dmat3(1.0) : rest};
}

bool isIdentity(const glm::dmat3& rest) {
  return maxDifference(rest, glm::dmat3(1.0)) <= kRigidTolerance;
}

std::string restText(const glm::dmat3& rest) {
  if (isIdentity(rest)) return {};
  std::string text;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      text += fmt::format("{}{:.6g}", text.empty() ? "" : " ", rest[i][j] + 0.0);
  return text;
}

void TriangleColours::add(const std::optional<CadColour>& colour) {
  std::uint32_t number = 0;
  if (colour) {
    const bool isRoom = numberAt_.size() < kMaxColours;
    auto at = numberAt_.find(*colour);
    if (at == numberAt_.end() && isRoom) {
      at = numberAt_.emplace(*colour, static_cast<std::uint32_t>(colours_.size())).first;
      colours_.push_back(colour);
    }
    areTooMany_ = areTooMany_ || at == numberAt_.end();
    number = at == numberAt_.end() ? 0 : at->second;
  }
  numbers_.push_back(number);
}

std::optional<CadColour> TriangleColours::common() const {
  const auto isFirst = [this](std::uint32_t number) { return number == numbers_.front(); };
  return numbers_.empty() || !std::ranges::all_of(numbers_, isFirst) ? std::nullopt
                                                                     : colours_[numbers_.front()];
}

void TriangleColours::setOwn(const CadColour& own) {
  const auto at = numberAt_.find(own);
  if (at != numberAt_.end()) std::ranges::replace(numbers_, at->second, 0U);
}

CadShape triangleShape(std::span<const glm::dvec3> vertices, std::span<const Triangle> triangles,
                       const glm::dmat3& map, const TriangleColours& colours) {
  CadShape shape;
  // Faces in the order of their first triangles.
  constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();
  const bool hasColours = colours.size() == triangles.size();
  std::vector<std::uint32_t> faceAt(colours.colourCount(), kNoFace);
  const auto addToFace = [&](std::size_t triangle) {
    const std::uint32_t number = colours.numberOf(triangle);
    if (faceAt[number] == kNoFace) {
      faceAt[number] = static_cast<std::uint32_t>(shape.faceColours.size());
      shape.faceColours.push_back(colours.colour(number));
    }
    shape.surfaces.faceOfTriangle.push_back(faceAt[number]);
  };
  const bool mirrors = glm::determinant(map) < 0.0;
  std::unordered_map<glm::dvec3, std::uint32_t, PointHash> indexOf;
  const auto cornerOf = [&](std::uint32_t vertex) -> std::optional<std::uint32_t> {
    if (vertex >= vertices.size()) return std::nullopt;
    const glm::dvec3 p = map * vertices[vertex];
    if (!isUsable(p)) return std::nullopt;
    const auto [at, isNew] = indexOf.try_emplace(p, static_cast<std::uint32_t>(shape.vertices.size()));
    if (isNew) shape.vertices.push_back(p);
    return at->second;
  };
  std::size_t bad = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const auto a = cornerOf(t[0]), b = cornerOf(t[1]), c = cornerOf(t[2]);
    if (!a || !b || !c) {
      ++bad;
    } else if (*a != *b && *b != *c && *c != *a) {
      shape.triangles.push_back(mirrors ? Triangle{*a, *c, *b} : Triangle{*a, *b, *c});
      if (hasColours) addToFace(i);
    }
  }
  if (std::ranges::none_of(shape.faceColours, [](const auto& colour) { return colour.has_value(); })) {
    shape.faceColours.clear();
    shape.surfaces.faceOfTriangle.clear();
  }
  shape.surfaces.faces.resize(shape.faceColours.size());
  if (colours.areTooMany())
    addWarning(shape.warnings,
               fmt::format("It has more than {} colours; triangles of others have that of the part.",
                           TriangleColours::kMaxColours));
  if (bad > 0)
    addWarning(shape.warnings,
               fmt::format("{} triangles with corners that are missing or not finite were left out.", bad));
  return shape;
}

double sixVolumes(std::span<const glm::dvec3> vertices, std::span<const Triangle> triangles) {
  if (triangles.empty()) return 0.0;
  // About a corner, so that a part far from the origin loses no digits.
  const glm::dvec3 origin = vertices[triangles[0][0]];
  double sum = 0.0;
  for (const Triangle& t : triangles)
    sum += glm::dot(vertices[t[0]] - origin, glm::cross(vertices[t[1]] - origin, vertices[t[2]] - origin));
  return sum;
}

}  // namespace nearfit::importer
