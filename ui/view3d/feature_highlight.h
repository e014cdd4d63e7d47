#pragma once

#include <QColor>

#include <vtkRenderer.h>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"
#include "core/placing/feature.h"
#include "ui/view3d/mark_actors.h"

namespace nearfit::ui {

/// Highlights a feature in the view: its face, edge, axis or point.
class FeatureHighlight {
 public:
  /// @param colour  In the light theme.
  FeatureHighlight(vtkRenderer& renderer, const QColor& colour);

  /// Shows a feature of a mesh.
  /// @param picked  In the part's frame.
  void show(const TriangleMesh& mesh, const PickedFeature& picked, const RigidTransform& worldFromPart);
  void setPose(const RigidTransform& worldFromPart) { actors_.setPose(worldFromPart); }
  void clear() { actors_.clear(); }
  bool isShown() const { return actors_.isShown(); }

 private:
  MarkActors actors_;
  const QColor colour_;
};

}  // namespace nearfit::ui
