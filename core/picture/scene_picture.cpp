#include "core/picture/scene_picture.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>

#include "core/mesh/flat_groups.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"

namespace nearfit {
namespace {

constexpr Colour kPaper{1.0F, 1.0F, 1.0F}, kEdgeColour{0.18F, 0.18F, 0.20F};
/// Share of a picture that is left free on each side of what is fitted into it.
constexpr double kRim = 0.04;
/// Edges lie on the surfaces that they are to be in front of, and marks mostly [pixels].
constexpr double kEdgeToViewer = 1.0, kMarkToViewer = 1.5;
/// Meshes with more sharp edges than this, and more than this share of all, are rough: edges would only blacken them.
constexpr std::size_t kRoughEdges = 20'000;
constexpr double kRoughShare = 0.25;

/// Places of a view's picture.
class PictureMap {
 public:
  PictureMap(const PictureView& view, int width, int height)
      : view_(view),
        away_(view.away()),
        middle_(0.5 * width, 0.5 * height, 0.0),
        pixelsPerMetre_(width / view.extent) {}

  glm::dvec3 placeOf(const glm::dvec3& point) const noexcept {
    const glm::dvec3 p = point - view_.centre;
    return middle_ +
           pixelsPerMetre_ * glm::dvec3(glm::dot(p, view_.right), -glm::dot(p, view_.up), glm::dot(p, away_));
  }
  /// Direction to the light, in the world.
  glm::dvec3 light() const noexcept {
    const glm::dvec3 l = pictureLight();
    return l.x * view_.right + l.y * view_.up - l.z * away_;
  }

 private:
  PictureView view_;
  glm::dvec3 away_, middle_;
  double pixelsPerMetre_;
};

/// True if a box of places is outside the picture.
bool isOutside(const Aabb& box, const Raster& raster) noexcept {
  return box.upper.x < 0.0 || box.upper.y < 0.0 || box.lower.x > raster.width() ||
         box.lower.y > raster.height();
}

void drawEdges(const DrawnShapes::Shape& shape, const std::vector<glm::dvec3>& places, Raster& raster) {
  const auto edges = shape.geometry->mesh.edges();
  const std::size_t sharp = shape.shaded.sharpEdges.size();
  if (sharp > kRoughEdges && static_cast<double>(sharp) > kRoughShare * static_cast<double>(edges.size()))
    return;
  const Raster::Pen pen{.colour = kEdgeColour, .width = 1.0, .toViewer = kEdgeToViewer};
  for (const std::uint32_t edge : shape.shaded.sharpEdges)
    raster.drawLine(places[edges[edge].v0], places[edges[edge].v1], pen);
}

/// A part with the box that it has on the picture.
struct BoxedPart {
  const DrawnPart* part;
  Aabb box;
};

/// The parts of which something may be seen, the nearest first: most of what they hide need not be drawn.
std::vector<BoxedPart> partsFromTheFront(const ScenePicture& scene, const PictureMap& map,
                                         const Raster& raster) {
  std::vector<BoxedPart> boxed;
  for (const DrawnPart& part : scene.parts) {
    Aabb box;
    for (const glm::dvec3& corner : boxCorners(part.geometry->mesh, part.worldFromPart))
      box.add(map.placeOf(corner));
    if (!isOutside(box, raster)) boxed.push_back({&part, box});
  }
  std::ranges::stable_sort(boxed, {}, [](const BoxedPart& each) { return each.box.lower.z; });
  return boxed;
}

void drawPart(const BoxedPart& boxed, const DrawnShapes& shapes, const PictureMap& map, Raster& raster) {
  const DrawnPart& part = *boxed.part;
  const Aabb& box = boxed.box;
  if (raster.hides({box.lower.x, box.lower.y}, {box.upper.x, box.upper.y}, box.lower.z - kEdgeToViewer))
    return;
  const DrawnShapes::Shape& shape = shapes.of(*part.geometry);
  std::vector<glm::dvec3> places;
  places.reserve(part.geometry->mesh.vertices().size());
  for (const glm::dvec3& vertex : part.geometry->mesh.vertices())
    places.push_back(map.placeOf(part.worldFromPart.applyToPoint(vertex)));
  const glm::dvec3 light = glm::conjugate(part.worldFromPart.rotation) * map.light();
  const std::vector<std::uint32_t>& vertexOf = shape.shaded.vertices;
  for (const Triangle& triangle : shape.shaded.triangles) {
    const glm::dvec3 &a = places[vertexOf[triangle[0]]], &b = places[vertexOf[triangle[1]]],
                     &c = places[vertexOf[triangle[2]]];
    // Anticlockwise from outside is clockwise where y is down. The inside of an open mesh is lit like its outside.
    const double side = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) <= 0.0 ? 1.0 : -1.0;
    std::array<Raster::Corner, 3> corners{{{a}, {b}, {c}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const double facing = side * glm::dot(glm::dvec3(shape.shaded.normals[triangle[k]]), light);
      corners[k].light = kDarkest + (1.0 - kDarkest) * 0.5 * (1.0 + facing);
    }
    raster.drawTriangle(corners, part.colour, part.cover);
  }
  drawEdges(shape, places, raster);
}

void drawMark(const DrawnMark& mark, const PictureMap& map, Raster& raster) {
  const Raster::Pen pen{.colour = mark.colour,
                        .width = mark.width,
                        .toViewer = kMarkToViewer,
                        .hidden = Raster::Cover::TwoThirds};
  if (mark.points.size() == 1) return raster.drawDot(map.placeOf(mark.points.front()), pen);
  for (std::size_t i = 1; i < mark.points.size(); ++i)
    raster.drawLine(map.placeOf(mark.points[i - 1]), map.placeOf(mark.points[i]), pen);
}

}  // namespace

PictureView viewFrom(PictureSide side) noexcept {
  switch (side) {
    case PictureSide::Isometric:
      break;
    case PictureSide::Front:
      return viewAlong({0.0, 1.0, 0.0});
    case PictureSide::Right:
      return viewAlong({-1.0, 0.0, 0.0});
    case PictureSide::Top:
      return viewAlong({0.0, 0.0, -1.0});
  }
  return viewAlong({-1.0, 1.0, -1.0});
}

PictureView viewAlong(const glm::dvec3& away) noexcept {
  // Nearer to the vertical than this, z is no up.
  constexpr double kVertical = 1e-6;
  PictureView view;
  const glm::dvec3 direction = glm::normalize(away);
  const glm::dvec3 across(direction.y, -direction.x, 0.0);
  const double length = glm::length(across);
  view.right = length > kVertical ? across / length : glm::dvec3(1.0, 0.0, 0.0);
  view.up = glm::normalize(glm::cross(view.right, direction));
  view.right = glm::normalize(glm::cross(direction, view.up));
  return view;
}

PictureView fitted(const PictureView& view, std::span<const glm::dvec3> points, int width, int height,
                   double minExtent) noexcept {
  if (points.empty()) return view;
  const glm::dvec3 away = view.away();
  const auto inView = [&](const glm::dvec3& p) {
    return glm::dvec3(glm::dot(p, view.right), glm::dot(p, view.up), glm::dot(p, away));
  };
  Aabb box;
  for (const glm::dvec3& point : points)
    box.add(inView(point));
  const glm::dvec3 middle = box.centre(), size = box.upper - box.lower;
  PictureView result = view;
  result.centre = middle.x * view.right + middle.y * view.up + middle.z * away;
  const double needed = std::max(size.x, size.y * width / height) / (1.0 - 2.0 * kRim);
  result.extent = std::max(needed, minExtent);
  if (!(result.extent > 0.0)) result.extent = view.extent;
  return result;
}

std::array<glm::dvec3, 8> boxCorners(const TriangleMesh& mesh, const RigidTransform& worldFromPart) noexcept {
  std::array<glm::dvec3, 8> corners = mesh.bounds().corners();
  for (glm::dvec3& corner : corners)
    corner = worldFromPart.applyToPoint(corner);
  return corners;
}

DrawnShapes::DrawnShapes(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress) {
  std::vector<Shape*> shapes;
  double total = 1.0;
  for (const PartGeometryPtr& geometry : geometries) {
    const auto [known, isNew] = shapes_.try_emplace(geometry.get());
    if (!isNew) continue;
    known->second = std::make_unique<Shape>(Shape{geometry, {}});
    shapes.push_back(known->second.get());
    total += static_cast<double>(geometry->mesh.triangles().size());
  }
  SharedProgress done(progress, total);
  parallelFor(shapes.size(), [&](std::size_t i) {
    const PartGeometry& geometry = *shapes[i]->geometry;
    done.add(0.0);
    const double tolerance = flatTolerance(geometry.mesh, geometry.report.coordinateRounding);
    shapes[i]->shaded = shadedMesh(geometry.mesh, kSharpAngle, tolerance);
    done.add(static_cast<double>(geometry.mesh.triangles().size()));
  });
}

Picture drawn(const ScenePicture& scene, const DrawnShapes& shapes, int width, int height) {
  Raster raster(width, height, kPaper);
  const PictureMap map(scene.view, width, height);
  for (const BoxedPart& part : partsFromTheFront(scene, map, raster))
    drawPart(part, shapes, map, raster);
  for (const DrawnMark& mark : scene.marks)
    drawMark(mark, map, raster);
  return raster.picture();
}

glm::dvec3 pictureLight() noexcept {
  return glm::normalize(glm::dvec3(-0.4, 0.5, 0.8));
}

}  // namespace nearfit
