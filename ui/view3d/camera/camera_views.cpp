#include "ui/view3d/camera/camera_views.h"

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace

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
  const double tanY = std::tan(glm::radians(0.5 * camera->GetViewAngle()));
  const double tanX = tanY * renderer.GetTiledAspectRatio();
  // Move back until every corner is inside the view frustum.
  double distance = 0.0;
  for (const vtkBoundingBox& box : boxes) {
    for (int corner = 0; corner < 8; ++corner) {
      glm::dvec3 p;
      box.GetCorner(corner, &p.x);
      p -= centre;
      const double across = std::max(std::abs(glm::dot(p, right)) / tanX, std::abs(glm::dot(p, up)) / tanY);
      distance = std::max(distance, glm::dot(p, toEye) + kMargin * across);
    }
  }
  // A single point has no size to fit.
  if (!(distance > 0.0)) distance = 1.0;
  const glm::dvec3 eye = centre + distance * toEye;
  camera->SetFocalPoint(centre.x, centre.y, centre.z);
  camera->SetPosition(eye.x, eye.y, eye.z);
  camera->OrthogonalizeViewUp();
  double bounds[6];
  whole.GetBounds(bounds);
  renderer.ResetCameraClippingRange(bounds);
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
  double bounds[6];
  box.GetBounds(bounds);
  renderer.ResetCameraClippingRange(bounds);
}

bool keepDepths(vtkRenderer& renderer, const vtkBoundingBox& box) {
  vtkCamera& camera = *renderer.GetActiveCamera();
  double kept[2];
  camera.GetClippingRange(kept);
  fitDepths(renderer, box);
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
  renderer.GradientBackgroundOn();
  if (isThemeDark()) {
    renderer.SetBackground(0.27, 0.31, 0.36);
    renderer.SetBackground2(0.13, 0.15, 0.18);
  } else {
    renderer.SetBackground(0.72, 0.78, 0.85);
    renderer.SetBackground2(0.955, 0.968, 0.98);
  }
}

}  // namespace nearfit::ui
