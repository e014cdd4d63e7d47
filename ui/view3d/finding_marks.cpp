#include "ui/view3d/finding_marks.h"

#include <span>

#include "ui/widgets/theme.h"

namespace nearfit::ui {

FindingMarks::FindingMarks(vtkRenderer& overlay)
    : actors_(overlay, {.faceOpacity = 0.5, .lineWidth = 3.5F, .pointSize = 11.0F}) {}

void FindingMarks::show(const MeshFinding& finding, const RigidTransform& worldFromPart) {
  MarkCells faces, lines, points;
  for (const TriangleCorners& t : finding.triangles)
    faces.add(t);
  for (const auto& edge : finding.edges)
    lines.add(edge);
  if (finding.hasPlace) points.add(std::span(&finding.point, 1));
  const QColor colour = themed(colours::kOverlap);
  actors_.setColours(colour, colour);
  actors_.setPose(worldFromPart);
  actors_.show(faces, lines, points);
}

}  // namespace nearfit::ui
