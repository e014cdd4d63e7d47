#pragma once

#include <QColor>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"
#include "core/placing/feature.h"

namespace nearfit::ui {

/// Highlights a feature in the view: its face, edge, axis or point.
class FeatureHighlight {
 public:
  /// @param colour  In the light theme.
  FeatureHighlight(vtkRenderer& renderer, const QColor& colour);
  ~FeatureHighlight();
  FeatureHighlight(const FeatureHighlight&) = delete;
  FeatureHighlight& operator=(const FeatureHighlight&) = delete;

  /// Shows a feature of a mesh.
  /// @param picked  In the part's frame.
  void show(const TriangleMesh& mesh, const PickedFeature& picked, const RigidTransform& worldFromPart);
  void setPose(const RigidTransform& worldFromPart);
  void clear();
  bool isShown() const;

 private:
  void setUp(vtkActor& actor, vtkPolyData& data) const;
  void applyColours();

  vtkSmartPointer<vtkRenderer> renderer_;  ///< Owned: the view may be destroyed before its tools.
  vtkNew<vtkPolyData> faces_, lines_, points_;
  vtkNew<vtkActor> face_, line_, point_;
  vtkNew<vtkMatrix4x4> pose_;
  const QColor colour_;
};

}  // namespace nearfit::ui
