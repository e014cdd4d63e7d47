#include "core/mesh/oriented_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/matrix.hpp>

namespace nearfit {
namespace {

/// Number of triangles whose sides are tried as axes: enough to include a flat side of most parts.
constexpr std::size_t kTriangleCandidates = 24;

/// Vertices that triangles use, relative to the bounding box's centre.
std::vector<glm::dvec3> usedPoints(const TriangleMesh& mesh) {
  std::vector<glm::dvec3> points;
  for (std::uint32_t v = 0; v < mesh.vertices().size(); ++v) {
    if (!mesh.edgesOfVertex(v).empty()) points.push_back(mesh.vertices()[v] - mesh.bounds().centre());
  }
  return points;
}

OrientedBox boxAlong(const std::vector<glm::dvec3>& points, const glm::dmat3& axes) {
  const glm::dmat3 boxFromMesh = glm::transpose(axes);
  Aabb box;
  for (const glm::dvec3& p : points)
    box.add(boxFromMesh * p);
  return {axes * box.centre(), axes, 0.5 * (box.upper - box.lower)};
}

/// Compares volumes; for flat boxes, the largest side faces.
bool isSmaller(const OrientedBox& a, const OrientedBox& b) {
  const auto largestFace = [](const glm::dvec3& h) { return std::max({h.x * h.y, h.y * h.z, h.z * h.x}); };
  constexpr double kFlat = 1e-9;
  const double size = std::max(glm::length(a.halfSize), glm::length(b.halfSize));
  const double flatVolume = kFlat * size * size * size;
  if (a.volume() > flatVolume || b.volume() > flatVolume) return a.volume() < b.volume();
  return largestFace(a.halfSize) < largestFace(b.halfSize);
}

/// Eigenvectors of a symmetric matrix as columns, by Jacobi rotations.
glm::dmat3 eigenvectors(glm::dmat3 m) {
  constexpr int kSweeps = 16;  // Converges quadratically; five usually suffice.
  glm::dmat3 vectors(1.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (m[q][p] == 0.0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2.0 * m[q][p]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
        glm::dmat3 rotation(1.0);
        rotation[p][p] = rotation[q][q] = c;
        rotation[q][p] = s;
        rotation[p][q] = -s;
        m = glm::transpose(rotation) * m * rotation;
        vectors = vectors * rotation;
      }
    }
  }
  return vectors;
}

/// Right-handed axes from a direction and a second one not parallel to it.
glm::dmat3 axesFrom(const glm::dvec3& first, const glm::dvec3& second) {
  const glm::dvec3 x = glm::normalize(first);
  const glm::dvec3 z = glm::normalize(glm::cross(x, second));
  return {x, glm::cross(z, x), z};
}

bool isFinite(const glm::dmat3& m) {
  return std::isfinite(glm::dot(m[0] + m[1] + m[2], glm::dvec3(1.0)));
}

/// Second moments of the surface about its centroid, in coordinates centred on the box and
/// scaled to unit size.
glm::dmat3 surfaceMoments(const TriangleMesh& mesh) {
  const glm::dvec3 origin = mesh.bounds().centre();
  const double scale = 1.0 / mesh.bounds().diagonal();
  double area = 0.0;
  glm::dvec3 first(0.0);
  glm::dmat3 second(0.0);
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 a = scale * (mesh.vertices()[t[0]] - origin),
                     b = scale * (mesh.vertices()[t[1]] - origin),
                     c = scale * (mesh.vertices()[t[2]] - origin);
    const double weight = glm::length(glm::cross(b - a, c - a));
    const glm::dvec3 sum = a + b + c;
    area += weight;
    first += weight / 3.0 * sum;
    second += weight / 12.0 *
              (glm::outerProduct(sum, sum) + glm::outerProduct(a, a) + glm::outerProduct(b, b) +
               glm::outerProduct(c, c));
  }
  return area > 0.0 ? second - glm::outerProduct(first, first) / area : glm::dmat3(1.0);
}

std::vector<std::uint32_t> largestTriangles(const TriangleMesh& mesh) {
  std::vector<double> areas;
  areas.reserve(mesh.triangles().size());
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 a = mesh.vertices()[t[0]];
    areas.push_back(glm::length(glm::cross(mesh.vertices()[t[1]] - a, mesh.vertices()[t[2]] - a)));
  }
  std::vector<std::uint32_t> order(areas.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto count = static_cast<std::ptrdiff_t>(std::min(kTriangleCandidates, order.size()));
  std::partial_sort(order.begin(), order.begin() + count, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return areas[a] != areas[b] ? areas[a] > areas[b] : a < b;
  });
  order.resize(static_cast<std::size_t>(count));
  return order;
}

}  // namespace

OrientedBox orientedBox(const TriangleMesh& mesh) {
  if (mesh.triangles().empty()) return {};
  const std::vector<glm::dvec3> points = usedPoints(mesh);
  OrientedBox best = boxAlong(points, glm::dmat3(1.0));
  const auto tryAxes = [&](const glm::dmat3& axes) {
    if (!isFinite(axes)) return;
    const OrientedBox box = boxAlong(points, axes);
    if (isSmaller(box, best)) best = box;
  };
  const glm::dmat3 principal = eigenvectors(surfaceMoments(mesh));
  tryAxes(axesFrom(principal[0], principal[1]));
  for (const std::uint32_t i : largestTriangles(mesh)) {
    const Triangle& t = mesh.triangles()[i];
    const std::array corners{mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
    for (int k = 0; k < 3; ++k)
      tryAxes(axesFrom(corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]));
  }
  best.centre += mesh.bounds().centre();
  return best;
}

}  // namespace nearfit
