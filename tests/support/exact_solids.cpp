#include "tests/support/exact_solids.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace nearfit::test {

ExactSolid turnedSolid(std::span<const glm::dvec2> profile, std::vector<ExactSurface> surfaces,
                       std::span<const std::uint32_t> faceOfBand, std::uint32_t segments) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> faces;
  for (const glm::dvec2& p : profile) {
    for (std::uint32_t s = 0; s < segments; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / segments;
      vertices.emplace_back(p.x * std::cos(angle), p.x * std::sin(angle), p.y);
    }
  }
  const auto corner = [&](std::size_t ring, std::uint32_t s) {
    return static_cast<std::uint32_t>(ring) * segments + s % segments;
  };
  for (std::size_t band = 0; band + 1 < profile.size(); ++band) {
    for (std::uint32_t s = 0; s < segments; ++s) {
      triangles.push_back({corner(band, s), corner(band, s + 1), corner(band + 1, s + 1)});
      triangles.push_back({corner(band, s), corner(band + 1, s + 1), corner(band + 1, s)});
      faces.insert(faces.end(), 2, faceOfBand[band]);
    }
  }
  for (const std::size_t end : {std::size_t{0}, profile.size() - 1}) {
    const auto middle = static_cast<std::uint32_t>(vertices.size());
    const glm::dvec3 point(0.0, 0.0, profile[end].y);
    vertices.push_back(point);
    for (std::uint32_t s = 0; s < segments; ++s) {
      if (end == 0)
        triangles.push_back({middle, corner(end, s + 1), corner(end, s)});
      else
        triangles.push_back({middle, corner(end, s), corner(end, s + 1)});
      faces.push_back(static_cast<std::uint32_t>(surfaces.size()));
    }
    surfaces.push_back({SurfaceKind::Plane, point, {0.0, 0.0, end == 0 ? -1.0 : 1.0}});
  }
  return {TriangleMesh(std::move(vertices), std::move(triangles)), {std::move(surfaces), std::move(faces)}};
}

ExactSolid moved(const ExactSolid& solid, const RigidTransform& motion) {
  std::vector<glm::dvec3> vertices;
  for (const glm::dvec3& p : solid.mesh.vertices())
    vertices.push_back(motion.applyToPoint(p));
  ExactSolid result{
      TriangleMesh(std::move(vertices), {solid.mesh.triangles().begin(), solid.mesh.triangles().end()}),
      solid.surfaces};
  for (ExactSurface& surface : result.surfaces.faces) {
    surface.point = motion.applyToPoint(surface.point);
    surface.direction = motion.applyToVector(surface.direction);
  }
  return result;
}

ExactSurface cylinderAboutZ(double radius, bool isHollow) {
  ExactSurface surface{SurfaceKind::Cylinder, {}, {0.0, 0.0, 1.0}, radius};
  surface.isHollow = isHollow;
  return surface;
}

ExactSurface torusAboutZ(double height, double radius, double minorRadius) {
  return {SurfaceKind::Torus, {0.0, 0.0, height}, {0.0, 0.0, 1.0}, radius, minorRadius};
}

ExactSurface sphereAboutZ(double height, double radius) {
  return {SurfaceKind::Sphere, {0.0, 0.0, height}, {}, radius};
}

ExactSurface coneAboutZ(double apexHeight, double angle) {
  ExactSurface surface{SurfaceKind::Cone, {0.0, 0.0, apexHeight}, {0.0, 0.0, angle > 0.0 ? 1.0 : -1.0}};
  surface.halfAngle = std::abs(angle);
  return surface;
}

}  // namespace nearfit::test
