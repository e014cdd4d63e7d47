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

/// Shows where a plane cuts: the outline of a rectangle in it.
class PlaneSheet {
 public:
  explicit PlaneSheet(vtkRenderer& renderer);
  ~PlaneSheet();
  PlaneSheet(const PlaneSheet&) = delete;
  PlaneSheet& operator=(const PlaneSheet&) = delete;

  /// As large as a box in the world is, seen against the normal.
  void show(const CutPlane& plane, const Aabb& box, const QColor& colour);
  void clear();

 private:
  vtkWeakPointer<vtkRenderer> renderer_;  ///< The view may go first.
  vtkNew<vtkPoints> corners_;
  vtkNew<vtkPolyData> outline_;
  vtkNew<vtkActor> actor_;
};

}  // namespace nearfit::ui
