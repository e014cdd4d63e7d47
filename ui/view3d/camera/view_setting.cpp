#include "ui/view3d/camera/view_setting.h"

#include <vtkLightKit.h>
#include <vtkNew.h>

#include "ui/widgets/theme.h"

namespace nearfit::ui {

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
