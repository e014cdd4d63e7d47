#pragma once

#include <vtkActor.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/math/rigid_transform.h"
#include "core/mesh/check/mesh_check.h"

namespace nearfit::ui {

/// Shows a finding over all parts: its triangles, its edges and a dot at its point.
class FindingMarks {
 public:
  explicit FindingMarks(vtkRenderer& overlay);
  ~FindingMarks();
  FindingMarks(const FindingMarks&) = delete;
  FindingMarks& operator=(const FindingMarks&) = delete;

  /// Shows the place of a finding of a part, in the colours of the present theme; nothing if it has none.
  void show(const MeshFinding& finding, const RigidTransform& worldFromPart);
  void setPose(const RigidTransform& worldFromPart);
  void clear();
  bool isShown() const;

 private:
  void setUp(vtkActor& actor, vtkPolyData& data);

  vtkSmartPointer<vtkRenderer> overlay_;  ///< Owned: the view may be destroyed before its panels.
  vtkNew<vtkPolyData> faces_, lines_, points_;
  vtkNew<vtkActor> face_, line_, point_;
  vtkNew<vtkMatrix4x4> pose_;
};

}  // namespace nearfit::ui
