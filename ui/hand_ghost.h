#pragma once

#include <memory>

#include <vtkActor.h>
#include <vtkLineSource.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/haptics/servo_snapshot.h"
#include "ui/part_shape.h"

namespace nearfit::ui {

/// Draws where the hand wants the moving part while the part stays behind: a translucent copy, and a line
/// from its centre to the part's.
class HandGhost {
 public:
  /// @param parts    For the copy.   @param overlay  For the line, which parts would hide. Both outlive this.
  HandGhost(vtkRenderer& parts, vtkRenderer& overlay);

  /// Of the moving part; null when there is none.
  void setShape(std::shared_ptr<const PartShape> shape);
  /// @param size  The part's diagonal [m].
  void show(const ServoSnapshot& snapshot, double size);
  void clear();
  void setVisible(bool isVisible);
  /// Cuts the copy open, as the part is: what the plane's normal points to stays. Null: it is whole.
  void setCut(vtkPlane* cut);

  /// In the world, as VTK has them; false while it is not drawn.
  bool visibleBounds(double bounds[6]) const;

 private:
  void applyVisibility();
  void applyCut();

  std::shared_ptr<const PartShape> shape_;
  vtkNew<vtkActor> surface_, edges_, line_;
  vtkNew<vtkMatrix4x4> pose_;
  vtkNew<vtkLineSource> lead_;
  vtkSmartPointer<vtkPlane> cut_;
  bool isVisible_ = true, isAhead_ = false;
};

}  // namespace nearfit::ui
