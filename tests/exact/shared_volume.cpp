#include "tests/exact/shared_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/convert_nef_polyhedron_to_polygon_mesh.h>
#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"
#include "tests/exact/box_tree.h"

namespace nearfit::test {
namespace {

using NefKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using NefMesh = CGAL::Surface_mesh<NefKernel::Point_3>;
using Nef = CGAL::Nef_polyhedron_3<NefKernel>;

std::vector<glm::dvec3> placedVertices(const TriangleMesh& mesh, const RigidTransform& pose) {
  std::vector<glm::dvec3> out;
  out.reserve(mesh.vertices().size());
  for (const glm::dvec3& p : mesh.vertices())
    out.push_back(pose.applyToPoint(p));
  return out;
}

std::optional<Nef> nefOf(const TriangleMesh& mesh, const RigidTransform& pose) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  std::vector<NefKernel::Point_3> points;
  for (const glm::dvec3& p : placedVertices(mesh, pose))
    points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Triangle& t : mesh.triangles()) {
    // Nef polyhedra are made of faces with a plane.
    if (CGAL::collinear(points[t[0]], points[t[1]], points[t[2]])) return std::nullopt;
    faces.push_back({t[0], t[1], t[2]});
  }
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) return std::nullopt;
  NefMesh surface;
  pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
  if (!CGAL::is_closed(surface)) return std::nullopt;
  return Nef(surface);
}

double volumeOf(const Nef& nef) {
  std::vector<NefKernel::Point_3> points;
  std::vector<std::vector<std::size_t>> faces;
  CGAL::convert_nef_polyhedron_to_polygon_soup(nef, points, faces, true);
  if (points.empty()) return 0.0;
  NefKernel::FT sixfold = 0;
  for (const std::vector<std::size_t>& f : faces) {
    for (std::size_t k = 2; k < f.size(); ++k)
      sixfold +=
          CGAL::determinant(points[f[0]] - points[0], points[f[k - 1]] - points[0], points[f[k]] - points[0]);
  }
  return CGAL::to_double(sixfold) / 6.0;
}

/// Where a ray crosses a surface, and by how much the winding number rises there.
struct Crossing {
  double height;
  std::uint8_t body;
  std::int8_t rise;
};

/// Rays along z, by cell.
class RayGrid {
 public:
  RayGrid(const Box& box, std::size_t cells)
      : box_(box),
        cells_(cells),
        step_((box.upper - box.lower) / static_cast<double>(cells)),
        crossings_(cells * cells) {}

  void add(std::uint8_t body, const Corners& t) {
    const double area = crossZ(t[1] - t[0], t[2] - t[0]);
    if (area == 0.0) return;
    const Box box = boxAround(t);
    const auto [x0, x1] = range(box, 0);
    const auto [y0, y1] = range(box, 1);
    for (std::size_t y = y0; y < y1; ++y) {
      for (std::size_t x = x0; x < x1; ++x) {
        const glm::dvec3 ray = at(x, y);
        const double u = crossZ(t[1] - ray, t[2] - ray) / area, v = crossZ(t[2] - ray, t[0] - ray) / area;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        const double z = u * t[0].z + v * t[1].z + (1.0 - u - v) * t[2].z;
        crossings_[y * cells_ + x].push_back(
            {z - box_.lower.z, body, static_cast<std::int8_t>(area > 0.0 ? -1 : 1)});
      }
    }
  }

  double sharedVolume() {
    double length = 0.0;
    for (std::vector<Crossing>& ray : crossings_)
      length += sharedLength(ray);
    return length * step_.x * step_.y;
  }

 private:
  static double crossZ(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.y - a.y * b.x; }
  glm::dvec3 at(std::size_t x, std::size_t y) const {
    return box_.lower +
           glm::dvec3((static_cast<double>(x) + 0.5) * step_.x, (static_cast<double>(y) + 0.5) * step_.y, 0);
  }
  /// Range of the cells whose middles a box spans.
  std::array<std::size_t, 2> range(const Box& box, glm::length_t axis) const {
    const auto cellAt = [&](double place) {
      const double cell = std::ceil((place - box_.lower[axis]) / step_[axis] - 0.5);
      return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(cells_)));
    };
    return {cellAt(box.lower[axis]), cellAt(box.upper[axis])};
  }
  static double sharedLength(std::vector<Crossing>& ray) {
    std::ranges::sort(ray, {}, &Crossing::height);
    std::array<int, 2> winding{};
    double length = 0.0, since = 0.0;
    for (const Crossing& c : ray) {
      if (winding[0] != 0 && winding[1] != 0) length += c.height - since;
      since = c.height;
      winding.at(c.body) += c.rise;
    }
    return length;
  }

  Box box_;
  std::size_t cells_;
  glm::dvec3 step_;
  std::vector<std::vector<Crossing>> crossings_;
};

Box boxOf(const std::vector<glm::dvec3>& points) {
  Box box;
  for (const glm::dvec3& p : points)
    box.add(p);
  return box;
}

}  // namespace

std::optional<double> sharedVolumeByNef(const TriangleMesh& scene, const TriangleMesh& part,
                                        const RigidTransform& sceneFromPart) {
  try {
    const std::optional<Nef> a = nefOf(scene, {}), b = nefOf(part, sceneFromPart);
    if (!a || !b) return std::nullopt;
    return volumeOf(*a * *b);
  } catch (const std::exception&) {
    // CGAL's checks of what it is given.
    return std::nullopt;
  }
}

double sharedVolumeByRays(const TriangleMesh& scene, const TriangleMesh& part,
                          const RigidTransform& sceneFromPart, std::size_t cells) {
  // No flat of a part that is square to an axis is along the rays.
  const RigidTransform aslant{rotationOf({0.3, 0.5, 0.7}), {}};
  const std::array<std::vector<glm::dvec3>, 2> placed{placedVertices(scene, aslant),
                                                      placedVertices(part, aslant * sceneFromPart)};
  const Box a = boxOf(placed[0]), b = boxOf(placed[1]);
  Box shared{glm::max(a.lower, b.lower), glm::min(a.upper, b.upper)};
  if (shared.lower.x >= shared.upper.x || shared.lower.y >= shared.upper.y) return 0.0;
  RayGrid grid(shared, cells);
  for (std::uint8_t body = 0; body < 2; ++body) {
    const auto& vertices = placed.at(body);
    for (const Triangle& t : (body == 0 ? scene : part).triangles())
      grid.add(body, {vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  }
  return grid.sharedVolume();
}

}  // namespace nearfit::test
