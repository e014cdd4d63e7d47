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

/// Draws what lies between two parts: a segment with its two ends.
class PairSegment {
 public:
  /// @param overlay  Where parts do not hide it.
  PairSegment(vtkRenderer& overlay, const QColor& colour);
  ~PairSegment();

  /// In the world [m].
  void show(const glm::dvec3& from, const glm::dvec3& to);
  void clear();
  bool isShown() const { return isShown_; }

 private:
  void applyVisibility();

  vtkWeakPointer<vtkRenderer> overlay_;  ///< The view may go first.
  vtkNew<vtkPoints> ends_;
  vtkNew<vtkPolyData> segment_, dots_;
  vtkNew<vtkActor> halo_, line_, rims_, points_;
  bool isShown_ = false;
};

}  // namespace nearfit::ui
