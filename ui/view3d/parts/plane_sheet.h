#pragma once

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkWeakPointer.h>

#include "core/section/cut_plane.h"

class QColor;

namespace nearfit::ui {

/// Shows a cutting plane by the outline of a rectangle in it.
class PlaneSheet {
 public:
  /// @param renderer  May be destroyed before this.
  explicit PlaneSheet(vtkRenderer& renderer);
  ~PlaneSheet();
  PlaneSheet(const PlaneSheet&) = delete;
  PlaneSheet& operator=(const PlaneSheet&) = delete;

  /// Shows the outline, as large as `box` seen along the normal; both in the world. `box` must not be empty.
  void show(const CutPlane& plane, const Aabb& box, const QColor& colour);
  void clear();

 private:
  vtkWeakPointer<vtkRenderer> renderer_;  ///< Weak: the view may be destroyed first.
  vtkNew<vtkPoints> corners_;
  vtkNew<vtkPolyData> outline_;
  vtkNew<vtkActor> actor_;
};

}  // namespace nearfit::ui
