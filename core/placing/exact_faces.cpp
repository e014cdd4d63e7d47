#include "core/placing/exact_faces.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <utility>

#include <glm/geometric.hpp>

#include "core/placing/mesh_region.h"
#include "core/placing/round_corners.h"
#include "core/placing/surface_pairs.h"

namespace nearfit {
namespace {

/// Max distance between surfaces that are one, as a fraction of the mesh: files round numbers to some eight digits, and
/// modelling kernels close their faces to 1e-7 of a part or better.
constexpr double kSameSurface = 1e-7;
/// Max distance of a chain's corners from the circle or line that its surfaces determine, as a fraction of the radius
/// or of the mesh. Beyond it the triangles are not of these surfaces, and their corners count.
constexpr double kOffExactCircle = 2e-3, kOffExactLine = 1e-5;

std::uint32_t farEnd(const MeshEdge& edge, std::uint32_t vertex) noexcept {
  return edge.v0 == vertex ? edge.v1 : edge.v0;
}

/// The point of the surface's axis in the middle of the triangles' length along it.
glm::dvec3 middleOnAxis(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles,
                        const ExactSurface& surface) {
  const auto heightOf = [&](const glm::dvec3& p) { return glm::dot(p - surface.point, surface.direction); };
  const std::vector<glm::dvec3> corners = cornersOf(mesh, triangles);
  const auto [lowest, highest] = std::ranges::minmax_element(corners, {}, heightOf);
  return surface.point + 0.5 * (heightOf(*lowest) + heightOf(*highest)) * surface.direction;
}

AlignFeature exactFeature(FeatureShape shape, const ExactSurface& surface) {
  AlignFeature feature{shape, surface.point, surface.direction, surface.radius};
  feature.minorRadius = surface.minorRadius;
  feature.surface = surface.kind;
  feature.isExact = true;
  return feature;
}

/// As a circle if it has a radius, else as an edge whose middle is between the chain's ends.
AlignFeature featureOfCurve(const Circle& curve, const TriangleMesh& mesh,
                            const std::vector<std::uint32_t>& chain) {
  AlignFeature feature{FeatureShape::Circle, curve.centre, curve.axis, curve.radius};
  feature.isExact = true;
  if (curve.radius > 0.0) return feature;
  feature.shape = FeatureShape::Axis;
  const glm::dvec3 middle = 0.5 * (mesh.vertices()[chain.front()] + mesh.vertices()[chain.back()]);
  feature.point += glm::dot(middle - curve.centre, curve.axis) * curve.axis;
  return feature;
}

bool isNearCurve(const Circle& curve, const glm::dvec3& point, double size) noexcept {
  if (curve.radius > 0.0) return curve.distanceFrom(point) <= kOffExactCircle * curve.radius;
  return glm::length(glm::cross(point - curve.centre, curve.axis)) <= kOffExactLine * size;
}

}  // namespace

ExactFaces::ExactFaces(const TriangleMesh& mesh, const SurfaceFaces& faces)
    : mesh_(mesh), faces_(faces), slack_(kSameSurface * mesh.bounds().diagonal()) {
  assert(faces.faceOfTriangle.size() == mesh.triangles().size());
}

const ExactSurface& ExactFaces::surfaceOf(std::uint32_t triangle) const noexcept {
  return faces_.faces[faces_.faceOfTriangle[triangle]];
}

bool ExactFaces::areSameFace(std::uint32_t a, std::uint32_t b, const glm::dvec3& near) const noexcept {
  return faces_.faceOfTriangle[a] == faces_.faceOfTriangle[b] ||
         areOneSurface(surfaceOf(a), surfaceOf(b), near, slack_);
}

bool ExactFaces::isEdge(std::uint32_t edge) const noexcept {
  const auto faces = mesh_.facesOfEdge(edge);
  if (faces.size() != 2) return true;
  if (areSameFace(faces[0], faces[1], mesh_.vertices()[mesh_.edges()[edge].v0])) return false;
  const bool areKnown =
      surfaceOf(faces[0]).kind != SurfaceKind::Other && surfaceOf(faces[1]).kind != SurfaceKind::Other;
  return areKnown || isSharp(mesh_, edge);
}

/// True if the same two surfaces meet at both edges.
bool ExactFaces::haveSameFaces(std::uint32_t edge, std::uint32_t other) const noexcept {
  const auto a = mesh_.facesOfEdge(edge), b = mesh_.facesOfEdge(other);
  if (a.size() != 2 || b.size() != 2) return false;
  const glm::dvec3& near = mesh_.vertices()[mesh_.edges()[other].v0];
  const auto areSame = [&](std::uint32_t first, std::uint32_t second) {
    return areSameFace(a[0], first, near) && areSameFace(a[1], second, near);
  };
  return areSame(b[0], b[1]) || areSame(b[1], b[0]);
}

bool ExactFaces::isCorner(std::uint32_t vertex, const std::vector<std::uint32_t>& edges) const noexcept {
  if (edges.size() != 2) return !edges.empty();
  const auto wayTo = [&](std::uint32_t edge) {
    const std::uint32_t other = farEnd(mesh_.edges()[edge], vertex);
    return glm::normalize(mesh_.vertices()[other] - mesh_.vertices()[vertex]);
  };
  // A curve between two surfaces is smooth, however coarsely it is cut.
  return !haveSameFaces(edges[0], edges[1]) &&
         glm::dot(wayTo(edges[0]), -wayTo(edges[1])) < std::cos(kSharpTurn);
}

/// The only other edge at a vertex where the same surfaces meet.
std::optional<std::uint32_t> ExactFaces::nextEdge(std::uint32_t vertex, std::uint32_t edge) const noexcept {
  std::optional<std::uint32_t> next;
  for (const std::uint32_t other : mesh_.edgesOfVertex(vertex)) {
    if (other == edge || !isEdge(other) || !haveSameFaces(edge, other)) continue;
    if (next) return std::nullopt;
    next = other;
  }
  return next;
}

/// Vertices along the edges where the surfaces of one meet; if closed, the first is repeated at the end.
std::vector<std::uint32_t> ExactFaces::chainAlong(std::uint32_t edge) const {
  const MeshEdge& first = mesh_.edges()[edge];
  std::deque<std::uint32_t> chain{first.v0, first.v1};
  // Each end is followed in turn, no further than every edge once: on a damaged mesh it could run in circles.
  const auto follow = [&](auto add, auto end) {
    std::optional<std::uint32_t> at = nextEdge(end(), edge);
    for (std::size_t count = 0; at && count < mesh_.edges().size(); ++count) {
      if (*at == edge) return true;
      add(farEnd(mesh_.edges()[*at], end()));
      at = nextEdge(end(), *at);
    }
    return false;
  };
  const bool isClosed = follow([&](std::uint32_t v) { chain.push_back(v); }, [&] { return chain.back(); });
  if (!isClosed) follow([&](std::uint32_t v) { chain.push_front(v); }, [&] { return chain.front(); });
  return {chain.begin(), chain.end()};
}

std::optional<PickedFeature> ExactFaces::edgeAt(std::uint32_t edge) const {
  const auto faces = mesh_.facesOfEdge(edge);
  if (faces.size() != 2) return std::nullopt;
  const glm::dvec3& on = mesh_.vertices()[mesh_.edges()[edge].v0];
  const ExactSurface &a = surfaceOf(faces[0]), &b = surfaceOf(faces[1]);
  std::optional<Circle> curve = lineBetween(a, b, on);
  if (!curve) curve = circleBetween(a, b, on, slack_);
  if (!curve) return std::nullopt;
  PickedFeature picked;
  picked.vertices = chainAlong(edge);
  const double size = mesh_.bounds().diagonal();
  const bool fits = std::ranges::all_of(picked.vertices, [&](std::uint32_t vertex) {
    return isNearCurve(*curve, mesh_.vertices()[vertex], size);
  });
  if (!fits) return std::nullopt;
  picked.feature = featureOfCurve(*curve, mesh_, picked.vertices);
  return picked;
}

/// Triangles of the face that a triangle is of, and of faces connected to it on the same surface.
std::vector<std::uint32_t> ExactFaces::trianglesAround(std::uint32_t triangle) const {
  const std::vector<std::uint32_t> connected = grownRegion(mesh_, triangle, [&](std::uint32_t other) {
    return areSameFace(triangle, other, mesh_.vertices()[mesh_.triangles()[other][0]]);
  });
  std::vector<bool> isWanted(faces_.faces.size(), false);
  for (const std::uint32_t t : connected)
    isWanted[faces_.faceOfTriangle[t]] = true;
  // Cracks and non-manifold edges may part a face.
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < faces_.faceOfTriangle.size(); ++t) {
    if (isWanted[faces_.faceOfTriangle[t]]) triangles.push_back(t);
  }
  return triangles;
}

std::optional<PickedFeature> ExactFaces::plane(std::uint32_t triangle) const {
  const ExactSurface& surface = surfaceOf(triangle);
  if (surface.kind != SurfaceKind::Plane) return std::nullopt;
  PickedFeature picked{exactFeature(FeatureShape::Plane, surface), trianglesAround(triangle), {}};
  picked.feature.point = nearestOnSurface(surface, centroidOf(mesh_, picked.triangles));
  return picked;
}

std::optional<PickedFeature> ExactFaces::wall(std::uint32_t triangle) const {
  const ExactSurface& surface = surfaceOf(triangle);
  switch (surface.kind) {
    case SurfaceKind::Torus:
      return PickedFeature{exactFeature(FeatureShape::Circle, surface), trianglesAround(triangle), {}};
    case SurfaceKind::Cylinder:
    case SurfaceKind::Cone:
      break;
    default:
      return std::nullopt;
  }
  PickedFeature picked{exactFeature(FeatureShape::Axis, surface), trianglesAround(triangle), {}};
  picked.feature.point = middleOnAxis(mesh_, picked.triangles, surface);
  if (surface.kind == SurfaceKind::Cone) {
    picked.feature.halfAngle = surface.halfAngle;
    picked.feature.radius = glm::distance(picked.feature.point, surface.point) * std::tan(surface.halfAngle);
  }
  return picked;
}

std::optional<PickedFeature> ExactFaces::sphere(std::uint32_t triangle) const {
  const ExactSurface& surface = surfaceOf(triangle);
  if (surface.kind != SurfaceKind::Sphere) return std::nullopt;
  return PickedFeature{exactFeature(FeatureShape::Point, surface), trianglesAround(triangle), {}};
}

}  // namespace nearfit
