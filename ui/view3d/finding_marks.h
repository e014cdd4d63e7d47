#pragma once

#include <vtkRenderer.h>

#include "core/math/rigid_transform.h"
#include "core/mesh/check/mesh_check.h"
#include "ui/view3d/mark_actors.h"

namespace nearfit::ui {

/// Shows a finding over all parts: its triangles, its edges and a dot at its point.
class FindingMarks {
 public:
  explicit FindingMarks(vtkRenderer& overlay);

  /// Shows the place of a finding of a part, in the colours of the present theme; nothing if it has none.
  void show(const MeshFinding& finding, const RigidTransform& worldFromPart);
  void setPose(const RigidTransform& worldFromPart) { actors_.setPose(worldFromPart); }
  void clear() { actors_.clear(); }
  bool isShown() const { return actors_.isShown(); }

 private:
  MarkActors actors_;
};

}  // namespace nearfit::ui
