#pragma once

#include <QColor>

#include <glm/vec3.hpp>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkWeakPointer.h>

namespace nearfit::ui {

/// Draws a segment between two parts, with a dot at each end.
class PairSegment {
 public:
  /// @param overlay  Renderer that parts do not hide. May be destroyed before this.
  PairSegment(vtkRenderer& overlay, const QColor& colour);
  ~PairSegment();

  /// Shows the segment between two world points [m].
  void show(const glm::dvec3& from, const glm::dvec3& to);
  void clear();
  bool isShown() const { return isShown_; }

 private:
  void applyVisibility();

  vtkWeakPointer<vtkRenderer> overlay_;  ///< Weak: the view may be destroyed first.
  vtkNew<vtkPoints> ends_;
  vtkNew<vtkPolyData> segment_, dots_;
  vtkNew<vtkActor> halo_, line_, rims_, points_;
  bool isShown_ = false;
};

}  // namespace nearfit::ui
