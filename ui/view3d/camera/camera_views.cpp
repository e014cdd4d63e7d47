#include "ui/view3d/camera/camera_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/trigonometric.hpp>
#include <vtkLightKit.h>
#include <vtkNew.h>

#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

struct Direction {
  std::array<double, 3> toEye, up;
};

Direction directionOf(StandardView view) {
  switch (view) {
    case StandardView::Front:
      return {{0, -1, 0}, {0, 0, 1}};
    case StandardView::Right:
      return {{1, 0, 0}, {0, 0, 1}};
    case StandardView::Top:
      return {{0, 0, 1}, {0, 1, 0}};
    case StandardView::Isometric:
      break;
  }
  return {{0.62, -0.62, 0.48}, {0, 0, 1}};
}

/// Half the height that a perspective camera sees at depth 1.
double slopeOf(vtkCamera& camera) {
  return std::tan(glm::radians(0.5 * camera.GetViewAngle()));
}

/// Moves the eye along the direction of sight to this distance from the focal point [m].
void standAt(vtkCamera& camera, double distance) {
  const glm::dvec3 focus = glm::make_vec3(camera.GetFocalPoint());
  const glm::dvec3 eye = focus - distance * glm::make_vec3(camera.GetDirectionOfProjection());
  camera.SetPosition(eye.x, eye.y, eye.z);
}

/// Depth of the nearest corner of a box in front of the eye [m]; negative behind it.
double nearestDepth(vtkCamera& camera, const vtkBoundingBox& box) {
  const glm::dvec3 eye = glm::make_vec3(camera.GetPosition());
  const glm::dvec3 away = glm::make_vec3(camera.GetDirectionOfProjection());
  double nearest = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 p;
    box.GetCorner(corner, &p.x);
    nearest = std::min(nearest, glm::dot(p - eye, away));
  }
  return nearest;
}

/// Moves the eye back until a box is well in front of it, as VTK clips what is near the eye or behind it.
void standBack(vtkCamera& camera, const vtkBoundingBox& box) {
  // Min depth of the box, and its depth after moving, as fractions of its diagonal: with room, so that moving
  // parts rarely move the eye.
  constexpr double kClear = 0.1, kRoom = 1.0;
  const double size = box.GetDiagonalLength(), nearest = nearestDepth(camera, box);
  if (nearest < kClear * size) standAt(camera, camera.GetDistance() + kRoom * size - nearest);
}

}  // namespace

void setOrthographic(vtkCamera& camera, bool isOrthographic) {
  if ((camera.GetParallelProjection() != 0) == isOrthographic) return;
  if (isOrthographic) {
    camera.SetParallelScale(camera.GetDistance() * slopeOf(camera));
  } else {
    standAt(camera, camera.GetParallelScale() / slopeOf(camera));
  }
  camera.SetParallelProjection(isOrthographic ? 1 : 0);
}

void setStandardView(vtkRenderer& renderer, StandardView view, const double bounds[6]) {
  const Direction direction = directionOf(view);
  vtkCamera* camera = renderer.GetActiveCamera();
  camera->SetFocalPoint(0, 0, 0);
  camera->SetPosition(direction.toEye.data());
  camera->SetViewUp(direction.up.data());
  fitView(renderer, bounds);
}

void fitView(vtkRenderer& renderer, const double bounds[6]) {
  const vtkBoundingBox box(bounds);
  fitView(renderer, std::span(&box, 1));
}

void fitView(vtkRenderer& renderer, std::span<const vtkBoundingBox> boxes) {
  constexpr double kMargin = 1.04;
  vtkBoundingBox whole;
  for (const vtkBoundingBox& box : boxes)
    whole.AddBox(box);
  glm::dvec3 centre;
  whole.GetCenter(&centre.x);
  vtkCamera* camera = renderer.GetActiveCamera();
  const glm::dvec3 toEye = -glm::make_vec3(camera->GetDirectionOfProjection());
  const glm::dvec3 right = glm::normalize(glm::cross(glm::make_vec3(camera->GetViewUp()), toEye));
  const glm::dvec3 up = glm::cross(toEye, right);
  const double slope = slopeOf(*camera), aspect = renderer.GetTiledAspectRatio();
  // Grow and move back until every corner is inside the view.
  double halfHeight = 0.0, distance = 0.0;
  for (const vtkBoundingBox& box : boxes) {
    for (int corner = 0; corner < 8; ++corner) {
      glm::dvec3 p;
      box.GetCorner(corner, &p.x);
      p -= centre;
      const double across =
          kMargin * std::max(std::abs(glm::dot(p, right)) / aspect, std::abs(glm::dot(p, up)));
      halfHeight = std::max(halfHeight, across);
      distance = std::max(distance, glm::dot(p, toEye) + across / slope);
    }
  }
  // A single point has no size to fit.
  if (!(halfHeight > 0.0)) halfHeight = slope;
  if (!(distance > 0.0)) distance = 1.0;
  const bool isParallel = camera->GetParallelProjection() != 0;
  if (isParallel) camera->SetParallelScale(halfHeight);
  const glm::dvec3 eye = centre + (isParallel ? halfHeight / slope : distance) * toEye;
  camera->SetFocalPoint(centre.x, centre.y, centre.z);
  camera->SetPosition(eye.x, eye.y, eye.z);
  camera->OrthogonalizeViewUp();
  fitDepths(renderer, whole);
}

ViewProjection::Camera projectionCamera(vtkCamera& camera) {
  ViewProjection::Camera seen;
  seen.eye = glm::make_vec3(camera.GetPosition());
  seen.away = glm::make_vec3(camera.GetDirectionOfProjection());
  seen.up = glm::make_vec3(camera.GetViewUp());
  seen.isParallel = camera.GetParallelProjection() != 0;
  seen.viewAngle = glm::radians(camera.GetViewAngle());
  seen.halfHeight = camera.GetParallelScale();
  return seen;
}

void fitDepths(vtkRenderer& renderer, vtkBoundingBox box, double room) {
  if (box.IsValid() == 0) return;
  box.Inflate(room * box.GetMaxLength());
  vtkCamera& camera = *renderer.GetActiveCamera();
  if (camera.GetParallelProjection() != 0) standBack(camera, box);
  double bounds[6];
  box.GetBounds(bounds);
  renderer.ResetCameraClippingRange(bounds);
}

bool keepDepths(vtkRenderer& renderer, const vtkBoundingBox& box) {
  vtkCamera& camera = *renderer.GetActiveCamera();
  double kept[2];
  camera.GetClippingRange(kept);
  const double distance = camera.GetDistance();
  fitDepths(renderer, box);
  // Depths count from the eye.
  if (camera.GetDistance() != distance) return false;
  const double* needed = camera.GetClippingRange();
  // From inside the scene, VTK puts the near plane at a fraction of the far one; room around the
  // box moves it no nearer.
  const bool beginsAtTheEye = kept[0] <= 1.01 * renderer.GetNearClippingPlaneTolerance() * kept[1];
  if ((needed[0] < kept[0] && !beginsAtTheEye) || needed[1] > kept[1]) return false;
  camera.SetClippingRange(kept);
  return true;
}

void setUpLights(vtkRenderer& renderer) {
  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.92);
  lights->SetKeyToFillRatio(2.0);
  lights->SetKeyToHeadRatio(2.2);
  lights->AddLightsToRenderer(&renderer);
}

void setUpBackground(vtkRenderer& renderer) {
  const auto [lower, upper] = viewGround();
  renderer.GradientBackgroundOn();
  renderer.SetBackground(lower.redF(), lower.greenF(), lower.blueF());
  renderer.SetBackground2(upper.redF(), upper.greenF(), upper.blueF());
}

}  // namespace nearfit::ui
