#pragma once

#include <QColor>
#include <initializer_list>
#include <span>

#include <glm/vec3.hpp>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/math/rigid_transform.h"

namespace nearfit::ui {

/// Collects cells of a mark with points of their own.
class MarkCells {
 public:
  MarkCells() { points_->SetDataTypeToDouble(); }

  void add(std::span<const glm::dvec3> corners);
  void add(std::initializer_list<glm::dvec3> corners) { add(std::span(corners.begin(), corners.size())); }
  vtkPoints* points() { return points_; }
  vtkCellArray* cells() { return cells_; }

 private:
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> cells_;
};

/// Faces, lines and points of a mark in one pose, each drawn by an actor of its own: unlit, never picked, hidden at first.
class MarkActors {
 public:
  struct Look {
    double faceOpacity = 1.0;
    float lineWidth = 1.0F, pointSize = 1.0F;  ///< In device-independent pixels.
  };

  MarkActors(vtkRenderer& renderer, const Look& look);
  ~MarkActors();
  MarkActors(const MarkActors&) = delete;
  MarkActors& operator=(const MarkActors&) = delete;

  /// The cells; showFilled() shows them once they are set.
  vtkPolyData& faces() { return *faces_.Get(); }
  vtkPolyData& lines() { return *lines_.Get(); }
  vtkPolyData& points() { return *points_.Get(); }
  vtkActor& face() { return *face_.Get(); }
  /// Shows each of the three that has cells, hides the others.
  void showFilled();
  /// Shows these cells.
  void show(MarkCells& faces, MarkCells& lines, MarkCells& points);
  void setColours(const QColor& face, const QColor& linesAndPoints);
  void setPose(const RigidTransform& worldFromMark);
  void clear();
  bool isShown() const;

 private:
  void setUp(vtkActor& actor, vtkPolyData& data);

  vtkSmartPointer<vtkRenderer> renderer_;  ///< Owned: the view may be destroyed before those who mark in it.
  vtkNew<vtkPolyData> faces_, lines_, points_;
  vtkNew<vtkActor> face_, line_, point_;
  vtkNew<vtkMatrix4x4> pose_;
};

}  // namespace nearfit::ui
