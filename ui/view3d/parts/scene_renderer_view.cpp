#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vtkCamera.h>

#include "ui/model/shown_poses.h"
#include "ui/view3d/parts/scene_renderer.h"

// SceneRenderer: levels of detail, picking and what is seen, which depend on the camera.
namespace nearfit::ui {
namespace {

struct Ray {
  glm::dvec3 begin, end;
  double from = 0.0, to = 1.0;  ///< Range within the whole ray, as fractions.

  glm::dvec3 at(double fraction) const { return begin + fraction * (end - begin); }
};

/// Returns the fraction at which a whole ray crosses a plane; nullopt if it does not.
std::optional<double> throughPlane(const Ray& ray, const CutPlane& plane) {
  const double first = plane.heightOf(ray.begin), last = plane.heightOf(ray.end);
  return (first > 0.0) != (last > 0.0) ? std::optional(first / (first - last)) : std::nullopt;
}

/// Returns the piece of a whole ray that is not cut away; nullopt if none is left.
std::optional<Ray> behind(const Ray& ray, const CutPlane& plane) {
  const bool isAway = plane.heightOf(ray.begin) > 0.0;
  const std::optional<double> through = throughPlane(ray, plane);
  if (!through) return isAway ? std::nullopt : std::optional(ray);
  return isAway ? Ray{ray.at(*through), ray.end, *through, 1.0}
                : Ray{ray.begin, ray.at(*through), 0.0, *through};
}

/// Returns the plane that clips surfaces as drawn: a hair beyond the cut plane, to keep faces that lie in it.
CutPlane planeOf(vtkPlane& drawn) {
  glm::dvec3 stays, origin;
  drawn.GetNormal(&stays.x);
  drawn.GetOrigin(&origin.x);
  return {-stays, -glm::dot(stays, origin)};
}

glm::dvec3 worldOf(vtkRenderer& renderer, double x, double y, double depth) {
  renderer.SetDisplayPoint(x, y, depth);
  renderer.DisplayToWorld();
  const double* p = renderer.GetWorldPoint();
  return glm::dvec3(p[0], p[1], p[2]) / p[3];
}

struct Hit {
  double fraction = 2.0;  ///< Along the ray; above 1: no hit yet.
  std::uint32_t triangle = 0;
  glm::dvec3 point{0.0};  ///< In the part's frame [m].
};

/// The nearest surface on a ray.
struct Nearest {
  Hit hit;
  std::optional<PickedPoint> picked;
};

/// A ray that passes a surface goes on this far behind it, as a share of its length: beyond the slack of RayTree.
constexpr double kBehindSurface = 1e-6;
/// Max number of surfaces that a ray passes.
constexpr int kMaxPassed = 100;

/// Finds the first triangle on a ray in the part's frame that `accepts(triangle, point)`. True, with `hit` updated, if
/// it is nearer than `hit`.
template <class Accepts>
bool hitFirst(const PartShape& shape, const Ray& ray, Hit& hit, Accepts&& accepts) {
  double start = 0.0;
  for (int passed = 0; passed < kMaxPassed && start < 1.0; ++passed) {
    const std::optional<RayHit> found = shape.rays.firstHit(ray.at(start), ray.end);
    if (!found) return false;
    const double along = start + found->fraction * (1.0 - start);
    const double fraction = ray.from + along * (ray.to - ray.from);
    if (fraction >= hit.fraction) return false;
    if (accepts(found->triangle, found->point)) {
      hit = {fraction, found->triangle, found->point};
      return true;
    }
    start = along + kBehindSurface;
  }
  return false;
}

}  // namespace

/// The camera's position, scale and frustum.
struct SceneRenderer::View {
  glm::dvec3 eye;
  bool isParallel = false;
  double pixelsAtOne = 1.0;  ///< Pixels per metre, at 1 m from the eye in perspective.
  double planes[24];         ///< Frustum planes; negative outside.

  double pixelsPerMetre(const glm::dvec3& centre, double radius) const {
    if (isParallel) return pixelsAtOne;
    // A part around the eye counts as very near, not as infinitely large.
    return pixelsAtOne / std::max(glm::distance(eye, centre) - radius, 1e-3 * radius + 1e-12);
  }
  bool sees(const glm::dvec3& centre, double radius) const {
    for (std::size_t plane = 0; plane < 6; ++plane) {
      const double* p = planes + 4 * plane;
      if (p[0] * centre.x + p[1] * centre.y + p[2] * centre.z + p[3] < -radius) return false;
    }
    return true;
  }
};

SceneRenderer::View SceneRenderer::view() const {
  vtkCamera* camera = renderer_.GetActiveCamera();
  View view;
  camera->GetPosition(&view.eye.x);
  view.isParallel = camera->GetParallelProjection() != 0;
  const double height = std::max(1, renderer_.GetSize()[1]);
  view.pixelsAtOne = view.isParallel ? height / (2.0 * camera->GetParallelScale())
                                     : height / (2.0 * std::tan(0.5 * glm::radians(camera->GetViewAngle())));
  camera->GetFrustumPlanes(renderer_.GetTiledAspectRatio(), view.planes);
  return view;
}

struct SceneRenderer::Candidate {
  PartId part{};
  PartActor* actor = nullptr;
  bool isSeen = false;
  double pixels = 0.0;  ///< Size in the picture.
};

DetailChoice SceneRenderer::applyDetail(const DetailLimits& limits,
                                        const std::optional<NewPartLimits>& newLimits) {
  const View view = this->view();
  std::vector<DetailCandidate> candidates;
  std::vector<Candidate> drawn;
  for (const auto& [id, actor] : actors_) {
    if (!actor->isVisible() || actor->isKept()) continue;
    double b[6];
    actor->bounds(b);
    const glm::dvec3 lower(b[0], b[2], b[4]), upper(b[1], b[3], b[5]), centre = 0.5 * (lower + upper);
    const double radius = 0.5 * glm::distance(lower, upper);
    const double scale = view.pixelsPerMetre(centre, radius);
    actor->setScale(scale);
    candidates.push_back({actor->levels(), scale, view.sees(centre, radius)});
    drawn.push_back({id, actor.get(), candidates.back().isSeen, radius * scale});
  }
  DetailChoice choice = chooseDetail(candidates, limits);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    drawn[i].actor->setLevel(choice.levels[i]);
  limitNew(drawn, newLimits, choice);
  return choice;
}

void SceneRenderer::limitNew(std::span<const Candidate> drawn, const std::optional<NewPartLimits>& limits,
                             DetailChoice& choice) {
  heldBack_.clear();
  std::vector<Candidate> found;
  std::ranges::copy_if(drawn, std::back_inserter(found), [](const Candidate& c) { return c.actor->isNew(); });
  std::set<const ShapeMappers*> shapes;
  std::size_t triangles = 0;
  for (const Candidate& c : found) {
    if (!c.actor->isUploaded() && shapes.insert(&c.actor->mappers()).second)
      triangles += c.actor->levels()[c.actor->level()].triangles;
  }
  const bool isTooMuch =
      limits && shapes.size() > 1 && (shapes.size() > limits->shapes || triangles > limits->triangles);
  if (!isTooMuch) {
    for (const Candidate& c : found)
      c.actor->admit();
    return;
  }
  std::ranges::stable_sort(found, {}, [](const Candidate& c) { return std::pair(c.isSeen, c.pixels); });
  for (const Candidate& c : found) {
    c.actor->holdBack();
    heldBack_.push_back(c.part);
    if (c.isSeen) choice.triangles -= c.actor->levels()[c.actor->level()].triangles;
  }
}

std::vector<vtkProp*> SceneRenderer::admitNext() {
  std::vector<vtkProp*> props;
  while (!heldBack_.empty()) {
    const auto found = actors_.find(heldBack_.back());
    const bool isLeft = found != actors_.end() && found->second->isHeldBack() && found->second->isVisible();
    if (isLeft) {
      PartActor& actor = *found->second;
      const bool isUploaded = actor.isUploaded();
      // One that uploads something is the next turn's.
      if (!isUploaded && !props.empty()) break;
      actor.admit();
      if (!isUploaded) props = actor.drawnProps();
    }
    heldBack_.pop_back();
  }
  return props;
}

void SceneRenderer::admitAll() {
  heldBack_.clear();
  for (const auto& [id, actor] : actors_)
    actor->admit();
}

bool SceneRenderer::hasTranslucent() const {
  return std::ranges::any_of(
      actors_, [](const auto& entry) { return entry.second->isVisible() && !entry.second->isOpaque(); });
}

std::vector<vtkProp*> SceneRenderer::keep() {
  std::vector<vtkProp*> props;
  beingKept_.clear();
  for (const auto& [id, actor] : actors_) {
    if (!actor->isVisible() || !actor->isOpaque() || loose_.contains(id)) continue;
    actor->addTo(props);
    beingKept_.push_back(actor.get());
  }
  return props;
}

void SceneRenderer::prepareKept() {
  for (PartActor* actor : beingKept_)
    actor->setLevel(0);
}

void SceneRenderer::showKept() {
  for (PartActor* actor : beingKept_) {
    actor->admit();
    actor->setKept(true);
  }
}

void SceneRenderer::letGoOfKept() {
  for (PartActor* actor : beingKept_)
    actor->setKept(false);
  beingKept_.clear();
}

std::optional<PickedPoint> SceneRenderer::pickPoint(double x, double y, SeenThrough seenThrough,
                                                    const IsNearAt& isNearAt) {
  updateCut();
  const Ray whole{worldOf(renderer_, x, y, 0.0), worldOf(renderer_, x, y, 1.0)};
  // The nearest surface, and the nearest of those that count only where there is no other.
  Nearest first, last;
  // Returns null for a surface that is not to be picked.
  const auto nearestOf = [&](bool isSeenThrough) -> Nearest* {
    if (!isSeenThrough || seenThrough == SeenThrough::AsOthers) return &first;
    return seenThrough == SeenThrough::Last ? &last : nullptr;
  };
  if (const auto through = cut_.cut() ? throughPlane(whole, cut_.cut()->plane) : std::nullopt) {
    const std::optional<PickedPoint> cap = capAt(whole.at(*through));
    if (Nearest* nearest = cap ? nearestOf(isCapSeenThrough(cap->part)) : nullptr) {
      nearest->picked = cap;
      nearest->hit.fraction = *through;
    }
  }
  for (const auto& [id, actor] : actors_) {
    const Part* part = scene_.find(id);
    if (part == nullptr || !actor->isVisible()) continue;
    Nearest* nearest = nearestOf(!actor->isOpaque() && actor->colours() == nullptr);
    if (nearest == nullptr) continue;
    const auto seen = actor->mappers().isCut() ? behind(whole, planeOf(*cut_.plane())) : std::optional(whole);
    if (!seen) continue;
    const RigidTransform worldFromPart = poses_.shownPoseOf(*part), partFromWorld = worldFromPart.inverse();
    const Ray ray{partFromWorld.applyToPoint(seen->begin), partFromWorld.applyToPoint(seen->end), seen->from,
                  seen->to};
    const bool passesOthers = isNearAt && actor->showsOnlyNear();
    const auto isDrawn = [&, id = id](std::uint32_t triangle, const glm::dvec3& point) {
      return !passesOthers || isNearAt(id, triangle, point);
    };
    if (hitFirst(actor->shape(), ray, nearest->hit, isDrawn)) {
      const Hit& hit = nearest->hit;
      nearest->picked = PickedPoint{id, worldFromPart.applyToPoint(hit.point), hit.triangle, nullptr};
    }
  }
  return first.picked ? first.picked : last.picked;
}

bool SceneRenderer::isCapSeenThrough(PartId part) const {
  // A cut face is as translucent as the part is by itself, whatever else the part is seen through for.
  return scene_.get(part).opacity < 1.0 && find(part)->colours() == nullptr;
}

std::vector<PartId> SceneRenderer::seenIn(const ViewProjection& view, const PixelBox& pixels) const {
  std::vector<ShownPart> shown;
  for (const Scene::PartPtr& part : scene_.parts()) {
    const PartActor* actor = find(part->id);
    if (actor == nullptr || !actor->isVisible()) continue;
    const bool isCut = cut_.cuts(scene_.isMoving(part->id));
    shown.push_back({{part.get(), poses_.shownPoseOf(*part)}, !actor->isSeenThrough(), isCut});
  }
  return partsSeenIn(shown, view, pixels, cut_.cut() ? std::optional(cut_.cut()->plane) : std::nullopt);
}

std::optional<PickedPoint> SceneRenderer::capAt(const glm::dvec3& point) const {
  for (const auto& [id, cap] : cut_.caps()) {
    const RigidTransform partFromWorld = poses_.shownPoseOf(*scene_.find(id)).inverse();
    if (isOnCap(*cap->section(), partFromWorld.applyToVector(cut_.cut()->plane.normal),
                partFromWorld.applyToPoint(point)))
      return PickedPoint{id, point, 0, cap->section()};
  }
  return std::nullopt;
}

}  // namespace nearfit::ui
