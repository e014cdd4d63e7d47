#include "ui/view3d/camera/view_depths.h"

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
  // From inside the scene, VTK puts the near plane at a fraction of the far one; room around the
  // box moves it no nearer.
  const bool beginsAtTheEye = kept[0] <= 1.01 * renderer.GetNearClippingPlaneTolerance() * kept[1];
  if ((needed[0] < kept[0] && !beginsAtTheEye) || needed[1] > kept[1]) return false;
  camera.SetClippingRange(kept);
  return true;
}

}  // namespace nearfit::ui
