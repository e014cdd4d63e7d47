#include "core/report/html/finding_views.h"

#include <algorithm>
#include <ranges>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

constexpr Colour kNearestColour{0.85F, 0.05F, 0.05F}, kMinimumColour{0.90F, 0.45F, 0.0F},
    kCurveColour{0.85F, 0.0F, 0.35F}, kFreeingColour{0.0F, 0.45F, 0.10F}, kFrameColour{0.15F, 0.15F, 0.15F},
    kPathColour{0.0F, 0.25F, 0.75F};
/// Widths of lines and dots [pixels].
constexpr double kLine = 2.5, kThinLine = 1.0, kDot = 7.0;
/// A close view is this much wider than what it is about, and no narrower than this share of the smaller part.
constexpr double kAround = 1.6, kShareOfPart = 0.25;
/// The same where parts touch: a point says nothing without what is around it.
constexpr double kShareOfTouching = 1.0;
/// A close view that shows nearly all is not needed.
constexpr double kCloseShare = 0.8;
/// A direction of sight turned away from the gap by a projection that leaves less than this is not of the corner that
/// was wanted.
constexpr double kShortened = 0.4;

Raster::Cover coverOf(double opacity) noexcept {
  constexpr double kHalf = 0.5, kNearlyFull = 5.0 / 6.0;
  if (opacity >= kNearlyFull) return Raster::Cover::Full;
  return opacity >= kHalf ? Raster::Cover::TwoThirds : Raster::Cover::OneThird;
}

DrawnPart drawnPart(const Part& part, Raster::Cover cover) {
  return {part.geometry, part.worldFromPart, part.colour, cover};
}

void addPoints(std::vector<glm::dvec3>& to, std::span<const glm::dvec3> points) {
  to.insert(to.end(), points.begin(), points.end());
}

void addSegment(std::vector<DrawnMark>& marks, const glm::dvec3& a, const glm::dvec3& b,
                const Colour& colour) {
  marks.push_back({{a, b}, colour, kLine});
  marks.push_back({{a}, colour, kDot});
  marks.push_back({{b}, colour, kDot});
}

std::vector<DrawnMark> marksOf(const PairFinding& finding) {
  std::vector<DrawnMark> marks;
  if (finding.clash) {
    for (const std::vector<glm::dvec3>& curve : finding.clash->curves)
      marks.push_back({curve, kCurveColour, kLine});
  }
  // The nearest comes last, over the others; a clash with curves has no nearest points of its own.
  for (const auto& minimum : std::views::reverse(finding.minima))
    addSegment(marks, minimum.partPoint, minimum.otherPoint, kMinimumColour);
  if (marks.empty() || !finding.clash)
    addSegment(marks, finding.partPoint, finding.otherPoint, kNearestColour);
  return marks;
}

/// Points of what a finding is about.
std::vector<glm::dvec3> placesOf(const PairFinding& finding) {
  std::vector<glm::dvec3> places;
  if (finding.clash) {
    for (const std::vector<glm::dvec3>& curve : finding.clash->curves)
      addPoints(places, curve);
  }
  if (places.empty()) places = {finding.partPoint, finding.otherPoint};
  return places;
}

/// The isometric direction of sight, or another one, turned across a direction.
glm::dvec3 sightAcross(const glm::dvec3& direction) {
  const double length = glm::length(direction);
  const glm::dvec3 corner = viewFrom(PictureSide::Isometric).away();
  if (!(length > 0.0)) return corner;
  const glm::dvec3 unit = direction / length;
  const auto across = [&unit](const glm::dvec3& v) { return v - glm::dot(v, unit) * unit; };
  const glm::dvec3 turned = across(corner);
  return glm::length(turned) >= kShortened ? turned : across(glm::normalize(glm::dvec3(0.8, 1.0, -0.3)));
}

glm::dvec3 directionOf(const PairFinding& finding) {
  return finding.clash && finding.clash->freeing ? finding.clash->freeing->direction
                                                 : finding.otherPoint - finding.partPoint;
}

/// The translation that frees the first part, from the middle of the place.
void addFreeing(const PairFinding& finding, std::span<const glm::dvec3> places,
                std::vector<DrawnMark>& marks) {
  if (!finding.clash || !finding.clash->freeing) return;
  Aabb box;
  for (const glm::dvec3& place : places)
    box.add(place);
  const glm::dvec3 from = box.centre();
  const glm::dvec3 to = from + finding.clash->freeing->length * finding.clash->freeing->direction;
  marks.push_back({{from, to}, kFreeingColour, kLine});
  marks.push_back({{to}, kFreeingColour, kDot});
}

DrawnMark frameOf(const PictureView& view, int width, int height) {
  const glm::dvec3 right = 0.5 * view.extent * view.right,
                   up = 0.5 * view.extent * static_cast<double>(height) / width * view.up;
  const glm::dvec3& c = view.centre;
  return {{c - right - up, c + right - up, c + right + up, c - right + up, c - right - up},
          kFrameColour,
          kThinLine};
}

}  // namespace

ScenePicture sceneView(const Scene& scene, PictureSide side, const AssemblyPath* path, int width,
                       int height) {
  ScenePicture picture;
  std::vector<glm::dvec3> points;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (!part->isVisible || !hasTriangles(*part)) continue;
    picture.parts.push_back(drawnPart(*part, coverOf(part->opacity)));
    addPoints(points, boxCorners(part->geometry->mesh, part->worldFromPart));
  }
  if (path != nullptr && !path->poses.empty()) {
    DrawnMark way{{}, kPathColour, kLine};
    for (const PathPose& pose : path->poses)
      way.points.push_back(pose.worldFromLead.applyToPoint(path->centre));
    addPoints(points, way.points);
    picture.marks.push_back({{way.points.front()}, kPathColour, kDot});
    picture.marks.push_back(std::move(way));
  }
  picture.view = fitted(viewFrom(side), points, width, height);
  return picture;
}

FindingViews findingViews(const Scene& scene, const PairFinding& finding, int width, int height) {
  const Part &part = scene.get(finding.pair.part), &other = scene.get(finding.pair.other);
  const double size = part.geometry->mesh.bounds().diagonal(),
               otherSize = other.geometry->mesh.bounds().diagonal();
  const auto partsWith = [&](Raster::Cover ofLarger) {
    const bool isLarger = size > otherSize;
    return std::vector{drawnPart(part, isLarger ? ofLarger : Raster::Cover::Full),
                       drawnPart(other, isLarger ? Raster::Cover::Full : ofLarger)};
  };
  const std::vector<glm::dvec3> places = placesOf(finding);
  std::vector<DrawnMark> marks = marksOf(finding);
  addFreeing(finding, places, marks);

  std::vector<glm::dvec3> all = places;
  addPoints(all, boxCorners(part.geometry->mesh, part.worldFromPart));
  addPoints(all, boxCorners(other.geometry->mesh, other.worldFromPart));
  const PictureView view = viewAlong(sightAcross(directionOf(finding)));
  FindingViews views;
  views.whole = {fitted(view, all, width, height), partsWith(Raster::Cover::TwoThirds), marks};
  const double share = finding.verdict == PairVerdict::Touching ? kShareOfTouching : kShareOfPart;
  PictureView close = fitted(view, places, width, height, share * std::min(size, otherSize) / kAround);
  close.extent *= kAround;
  if (close.extent < kCloseShare * views.whole.view.extent) {
    views.whole.marks.push_back(frameOf(close, width, height));
    views.close = {close, partsWith(Raster::Cover::OneThird), std::move(marks)};
  }
  return views;
}

}  // namespace nearfit
