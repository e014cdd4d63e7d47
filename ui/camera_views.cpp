#include "ui/camera_views.h"

#include <array>

#include <vtkCamera.h>

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
  renderer.ResetCamera(bounds);
  // VTK leaves room for the bounding sphere; most assemblies are slimmer than it.
  constexpr double kFill = 1.15;
  renderer.GetActiveCamera()->Dolly(kFill);
}

}  // namespace nearfit::ui
