#pragma once

#include <memory>

#include <vtkActor.h>
#include <vtkLineSource.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/servo/servo_snapshot.h"
#include "ui/view3d/parts/part_shape.h"

namespace nearfit::ui {

/// Draws the ghost: where the hand wants the moving part while the part stays behind. A translucent copy of
/// the part, and a line from the copy's centre of mass to the part's.
class HandGhost {
 public:
  /// @param parts    Draws the copy; outlives this.
  /// @param overlay  Draws the line, which parts would hide; outlives this.
  HandGhost(vtkRenderer& parts, vtkRenderer& overlay);

  /// Sets the moving part's shape; null if there is none.
  void setShape(std::shared_ptr<const PartShape> shape);
  /// Shows the ghost, unless the hand is too close to the part to tell them apart.
  /// @param size  Diagonal of the part [m].
  void show(const ServoSnapshot& snapshot, double size);
  void clear();
  void setVisible(bool isVisible);
  /// @param share  Of the usual opacity, for all that this draws; 0 to 1.
  void setOpacity(double share);
  /// Clips the copy, as the part is: keeps the side that the plane's normal points to. Null: whole. Holds a
  /// reference to `cut` and so follows it.
  void setCut(vtkPlane* cut);

  /// Gets the copy's bounds in the world, VTK's order [m]; false while it is not drawn.
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
