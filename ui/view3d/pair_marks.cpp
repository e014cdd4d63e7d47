#include "ui/view3d/pair_marks.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/math/axes_across.h"
#include "ui/view3d/spot_label.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr MarkActors::Look kPairLook{.lineWidth = 3.5F, .pointSize = 8.0F};
/// Length and radius of the arrow's head, as shares of the arrow.
constexpr double kArrowLength = 0.25, kArrowRadius = 0.08;
constexpr int kHeadSides = 12;

const std::vector<std::vector<glm::dvec3>>& curvesOf(const PairFinding& finding) {
  static const std::vector<std::vector<glm::dvec3>> kNone;
  return finding.clash ? finding.clash->curves : kNone;
}

Aabb curvesBox(const PairFinding& finding) {
  Aabb box;
  for (const std::vector<glm::dvec3>& curve : curvesOf(finding)) {
    for (const glm::dvec3& point : curve)
      box.add(point);
  }
  return box;
}

void addHead(const FreeingArrow& arrow, MarkCells& faces) {
  const glm::dvec3 way = arrow.to - arrow.from;
  const double length = glm::length(way);
  if (!(length > 0.0)) return;
  const auto [first, second] = axesAcross(way / length);
  const glm::dvec3 base = arrow.to - kArrowLength * way;
  const auto rim = [&, u = first, v = second](int side) {
    const double angle = 2.0 * std::numbers::pi * side / kHeadSides;
    return base + kArrowRadius * length * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int side = 0; side < kHeadSides; ++side) {
    faces.add({arrow.to, rim(side), rim(side + 1)});
    faces.add({base, rim(side + 1), rim(side)});
  }
}

}  // namespace

FreeingArrow freeingArrow(const PairFinding& finding) {
  const Aabb met = curvesBox(finding);
  const glm::dvec3 from = met.isEmpty() ? finding.partPoint : met.centre();
  return {from, from + finding.clash->freeing->length * finding.clash->freeing->direction};
}

Aabb markedBox(const PairFinding& finding) {
  Aabb box = curvesBox(finding);
  if (finding.depth()) {
    const FreeingArrow arrow = freeingArrow(finding);
    box.add(arrow.from);
    box.add(arrow.to);
  } else if (box.isEmpty()) {
    box.add(finding.partPoint);
    box.add(finding.otherPoint);
  }
  return box;
}

PairMarks::PairMarks(Viewport& view)
    : curves_(view.overlay(), kPairLook),
      arrow_(view.overlay(), kPairLook),
      segment_(view.overlay(), colours::kAccent),
      label_(new SpotLabel(view, QStringLiteral("pairLabel"))) {}

void PairMarks::show(const PairFinding& finding, const QString& label) {
  showCurves(finding);
  std::optional<glm::dvec3> middle;
  if (finding.depth()) {
    const FreeingArrow arrow = freeingArrow(finding);
    showArrow(arrow);
    segment_.clear();
    middle = 0.5 * (arrow.from + arrow.to);
  } else {
    arrow_.clear();
    finding.clash ? segment_.clear() : segment_.show(finding.partPoint, finding.otherPoint);
    const Aabb box = markedBox(finding);
    if (!box.isEmpty()) middle = box.centre();
  }
  label.isEmpty() || !middle ? label_->end() : label_->showAt(*middle, label);
}

void PairMarks::showCurves(const PairFinding& finding) {
  MarkCells faces, lines, points;
  for (const std::vector<glm::dvec3>& curve : curvesOf(finding))
    lines.add(curve);
  for (const FoundMinimum& minimum : finding.minima) {
    lines.add({minimum.partPoint, minimum.otherPoint});
    points.add({minimum.partPoint});
    points.add({minimum.otherPoint});
  }
  const QColor colour = themed(finding.clash ? colours::kOverlap : colours::kClearance);
  curves_.setColours(colour, colour);
  curves_.show(faces, lines, points);
}

void PairMarks::showArrow(const FreeingArrow& arrow) {
  MarkCells faces, lines, points;
  lines.add({arrow.from, arrow.to});
  points.add({arrow.from});
  addHead(arrow, faces);
  const QColor colour = themed(colours::kAccent);
  arrow_.setColours(colour, colour);
  arrow_.show(faces, lines, points);
}

void PairMarks::clear() {
  curves_.clear();
  arrow_.clear();
  segment_.clear();
  label_->end();
}

}  // namespace nearfit::ui
