#include "ui/view/view_depths.h"

#include <vtkCamera.h>

namespace nearfit::ui {

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
  // From within the scene VTK begins at a part of the farthest depth, which room around it makes no nearer.
  const bool beginsAtTheEye = kept[0] <= 1.01 * renderer.GetNearClippingPlaneTolerance() * kept[1];
  if ((needed[0] < kept[0] && !beginsAtTheEye) || needed[1] > kept[1]) return false;
  camera.SetClippingRange(kept);
  return true;
}

}  // namespace nearfit::ui
