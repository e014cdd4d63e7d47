#include "ui/view3d/joint_marks.h"

#include <array>

#include <glm/geometric.hpp>

#include "core/math/axes_across.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Periods of a dash-dotted line, and where in each the dash and the dot begin and end.
constexpr int kPeriods = 14;
constexpr double kDashBegin = 0.0, kDashEnd = 0.6, kDotBegin = 0.75, kDotEnd = 0.85;
constexpr MarkActors::Look kLook{.faceOpacity = 0.2, .lineWidth = 2.0F, .pointSize = 9.0F};

void addDashDotted(MarkCells& lines, const glm::dvec3& from, const glm::dvec3& to) {
  // The last period ends with its dash, so that the line looks the same from both ends.
  const double whole = kPeriods - 1 + kDashEnd;
  const auto at = [&](double period) { return from + (period / whole) * (to - from); };
  for (int i = 0; i < kPeriods; ++i) {
    lines.add({at(i + kDashBegin), at(i + kDashEnd)});
    if (i + 1 < kPeriods) lines.add({at(i + kDotBegin), at(i + kDotEnd)});
  }
}

void addSquare(MarkCells& faces, MarkCells& lines, const JointMark& mark) {
  const std::array<glm::dvec3, 2> across = axesAcross(mark.direction);
  const glm::dvec3 u = mark.reach * across[0], v = mark.reach * across[1];
  const glm::dvec3 a = mark.middle - u - v, b = mark.middle + u - v, c = mark.middle + u + v,
                   d = mark.middle - u + v;
  faces.add({a, b, c, d});
  lines.add({a, b, c, d, a});
}

void addCross(MarkCells& lines, const JointMark& mark) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 reach(0.0);
    reach[axis] = mark.reach;
    lines.add({mark.middle - reach, mark.middle + reach});
  }
}

void addMark(MarkCells& faces, MarkCells& lines, MarkCells& points, const JointMark& mark) {
  const glm::dvec3 reach = mark.reach * mark.direction;
  switch (mark.kind) {
    case JointKind::OnAxis:
      addDashDotted(lines, mark.middle - reach, mark.middle + reach);
      break;
    case JointKind::InPlane:
      addSquare(faces, lines, mark);
      break;
    case JointKind::ToPoint:
      addCross(lines, mark);
      points.add({mark.middle});
      break;
  }
  if (!mark.strayed) return;
  lines.add({mark.middle, *mark.strayed});
  points.add({*mark.strayed});
}

}  // namespace

JointMarks::JointMarks(vtkRenderer& renderer) : kept_(renderer, kLook), strayed_(renderer, kLook) {}

void JointMarks::show(const std::vector<JointMark>& marks) {
  std::vector<const JointMark*> kept, strayed;
  for (const JointMark& mark : marks)
    (mark.strayed ? strayed : kept).push_back(&mark);
  fill(kept_, kept, themed(colours::kJoint));
  fill(strayed_, strayed, themed(colours::kWarning));
}

void JointMarks::fill(MarkActors& actors, const std::vector<const JointMark*>& marks, const QColor& colour) {
  MarkCells faces, lines, points;
  for (const JointMark* mark : marks)
    addMark(faces, lines, points, *mark);
  actors.setColours(colour, colour);
  actors.show(faces, lines, points);
}

}  // namespace nearfit::ui
