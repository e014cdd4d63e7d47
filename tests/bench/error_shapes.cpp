#include "tests/bench/error_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/bench/bench_shapes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;
using Profile = std::vector<glm::dvec2>;

/// Points on the way to `end`, from the last point on: the end with them.
void addLine(Profile& profile, const glm::dvec2& end, std::uint32_t steps) {
  const glm::dvec2 start = profile.back();
  for (std::uint32_t i = 1; i < steps; ++i)
    profile.push_back(start + (end - start) * (static_cast<double>(i) / steps));
  profile.push_back(end);
}

/// A quarter of a circle about (0, centre) and more points, from one angle to another, measured from +r to
/// +z; without its first point.
void addArc(Profile& profile, double radius, double centre, double from, double to, std::uint32_t steps) {
  for (std::uint32_t i = 1; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    profile.emplace_back(radius * std::cos(angle), centre + radius * std::sin(angle));
  }
}

/// Exactly on the axis, which cosines are not.
TriangleMesh closedOnAxis(Profile profile, std::uint32_t around) {
  profile.front().x = 0.0;
  profile.back().x = 0.0;
  return revolvedMesh(profile, around);
}

/// The grid of one side of a box, its points shared with the others through `index`.
class BoxDraft {
 public:
  explicit BoxDraft(std::uint32_t steps) : steps_(steps) {}

  void addSide(std::size_t axis, bool isUpper) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      std::array<std::uint32_t, 3> cell{};
      cell[axis] = isUpper ? steps_ : 0;
      cell[u] = i;
      cell[v] = j;
      return index(cell);
    };
    for (std::uint32_t i = 0; i < steps_; ++i) {
      for (std::uint32_t j = 0; j < steps_; ++j) {
        const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        triangles.push_back(isUpper ? Triangle{a, b, c} : Triangle{a, c, b});
        triangles.push_back(isUpper ? Triangle{a, c, d} : Triangle{a, d, c});
      }
    }
  }

  std::vector<glm::dvec3> vertices;  ///< In a cube of side 1 about the origin.
  std::vector<Triangle> triangles;

 private:
  std::uint32_t index(const std::array<std::uint32_t, 3>& cell) {
    const auto [entry, isNew] = indices_.try_emplace(cell, static_cast<std::uint32_t>(vertices.size()));
    if (isNew) vertices.push_back(glm::dvec3(cell[0], cell[1], cell[2]) / static_cast<double>(steps_) - 0.5);
    return entry->second;
  }

  std::uint32_t steps_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> indices_;
};

}  // namespace

TriangleMesh ellipsoidMesh(const glm::dvec3& halfAxes, std::uint32_t fineness) {
  const TriangleMesh sphere = geodesicSphereMesh(1.0, 2 * fineness);
  std::vector<glm::dvec3> vertices(sphere.vertices().begin(), sphere.vertices().end());
  for (glm::dvec3& p : vertices)
    p *= halfAxes;
  return {std::move(vertices), {sphere.triangles().begin(), sphere.triangles().end()}};
}

TriangleMesh fineTorusMesh(double majorRadius, double minorRadius, std::uint32_t majorSegments,
                           std::uint32_t minorSegments, std::uint32_t fineness) {
  return test::torusMesh(majorRadius, minorRadius, majorSegments * fineness, minorSegments * fineness);
}

TriangleMesh fineCylinderMesh(double radius, double height, std::uint32_t fineness) {
  Profile profile{{0.0, -0.5 * height}};
  addLine(profile, {radius, -0.5 * height}, fineness);
  addLine(profile, {radius, 0.5 * height}, 4 * fineness);
  addLine(profile, {0.0, 0.5 * height}, fineness);
  return closedOnAxis(std::move(profile), 8 * fineness);
}

TriangleMesh fineConeMesh(double radius, double height, std::uint32_t fineness) {
  Profile profile{{0.0, 0.0}};
  addLine(profile, {radius, 0.0}, fineness);
  addLine(profile, {0.0, height}, 3 * fineness);
  return closedOnAxis(std::move(profile), 8 * fineness);
}

TriangleMesh capsuleMesh(double radius, double halfLength, std::uint32_t fineness) {
  Profile profile{{0.0, -halfLength - radius}};
  addArc(profile, radius, -halfLength, -0.5 * pi, 0.0, fineness);
  addLine(profile, {radius, halfLength}, 3 * fineness);
  addArc(profile, radius, halfLength, 0.0, 0.5 * pi, fineness);
  return closedOnAxis(std::move(profile), 6 * fineness);
}

TriangleMesh bowlMesh(double innerRadius, double outerRadius, std::uint32_t fineness) {
  Profile profile{{0.0, -outerRadius}};
  addArc(profile, outerRadius, 0.0, -0.5 * pi, 0.0, 3 * fineness);
  addLine(profile, {innerRadius, 0.0}, 1 + fineness / 4);
  addArc(profile, innerRadius, 0.0, 0.0, -0.5 * pi, 3 * fineness);
  return closedOnAxis(std::move(profile), 9 * fineness);
}

TriangleMesh fineBoxMesh(const glm::dvec3& size, std::uint32_t fineness) {
  BoxDraft draft(fineness);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    draft.addSide(axis, false);
    draft.addSide(axis, true);
  }
  for (glm::dvec3& p : draft.vertices)
    p *= size;
  return {std::move(draft.vertices), std::move(draft.triangles)};
}

TriangleMesh revolvedMesh(std::span<const glm::dvec2> profile, std::uint32_t around) {
  std::vector<glm::dvec3> vertices{{0.0, 0.0, profile.front().y}, {0.0, 0.0, profile.back().y}};
  const auto rings = static_cast<std::uint32_t>(profile.size() - 2);
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2.0 * pi * i / around;
      const glm::dvec2& p = profile[ring + 1];
      vertices.emplace_back(p.x * std::cos(angle), p.x * std::sin(angle), p.y);
    }
  }
  std::vector<Triangle> triangles;
  triangles.reserve(2 * std::size_t{around} * rings);
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around, last = 2 + (rings - 1) * around;
    triangles.push_back({0, 2 + j, 2 + i});
    for (std::uint32_t lower = 2; lower < last; lower += around) {
      triangles.push_back({lower + i, lower + j, lower + around + j});
      triangles.push_back({lower + i, lower + around + j, lower + around + i});
    }
    triangles.push_back({1, last + i, last + j});
  }
  return {std::move(vertices), std::move(triangles)};
}

double longestEdge(const TriangleMesh& mesh) {
  double longest = 0.0;
  for (const MeshEdge& edge : mesh.edges())
    longest = std::max(longest, glm::distance(mesh.vertices()[edge.v0], mesh.vertices()[edge.v1]));
  return longest;
}

}  // namespace nearfit::bench
