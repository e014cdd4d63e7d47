#include "ui/tools/placing/align_rule.h"

#include <QtGlobal>

#include "core/placing/insert.h"

namespace nearfit::ui {
namespace {

AlignFeature wholeFeature(const TriangleMesh&, const PickedFeature& picked) {
  return picked.feature;
}

/// An axis may be anywhere along the other one, also that of a circle.
AlignFeature onlyAxis(const TriangleMesh&, const PickedFeature& picked) {
  AlignFeature feature = picked.feature;
  feature.shape = FeatureShape::Axis;
  return feature;
}

constexpr AlignRule kAlign{
    "align",
    QT_TRANSLATE_NOOP("AlignTool", "&Align…"),
    QT_TRANSLATE_NOOP("AlignTool", "Align a face, axis or point of a part with one of another"),
    "align",
    "A",
    "Align",
    QT_TRANSLATE_NOOP("AlignTool", "Click a face, axis or point of the part to move"),
    QT_TRANSLATE_NOOP("AlignTool", "Click the target"),
    std::nullopt,
    std::nullopt,
    wholeFeature,
    alignMotion,
    canBeOffset};

constexpr AlignRule kInsert{
    "insert",
    QT_TRANSLATE_NOOP("AlignTool", "&Insert…"),
    QT_TRANSLATE_NOOP("AlignTool",
                      "Insert a part into a bore by round edges: axes become one and faces meet"),
    "insert",
    "Shift+A",
    "Insert",
    QT_TRANSLATE_NOOP("AlignTool", "Click a round edge or cylinder of the part to insert"),
    QT_TRANSLATE_NOOP("AlignTool", "Click the round edge or bore that it goes into"),
    FeatureFilter::Rounds,
    std::nullopt,
    insertFeature,
    insertMotion,
    canBeSeated};

constexpr AlignRule kKeepOnAxis{
    "keepOnAxis",
    QT_TRANSLATE_NOOP("AlignTool", "&Keep on axis…"),
    QT_TRANSLATE_NOOP("AlignTool",
                      "Keep an axis of a part on one of another: it slides along it and turns about it"),
    "joint-axis",
    "K",
    "",
    QT_TRANSLATE_NOOP("AlignTool", "Click a cylinder, bore, circle or straight edge of the part to keep"),
    QT_TRANSLATE_NOOP("AlignTool", "Click the axis to keep it on"),
    FeatureFilter::Axes,
    JointKind::OnAxis,
    onlyAxis,
    alignMotion,
    canBeOffset};

constexpr AlignRule kKeepInPlane{
    "keepInPlane",
    QT_TRANSLATE_NOOP("AlignTool", "Keep in p&lane…"),
    QT_TRANSLATE_NOOP("AlignTool",
                      "Keep a flat face of a part in the plane of one of another: it slides in it"),
    "joint-plane",
    "Shift+K",
    "",
    QT_TRANSLATE_NOOP("AlignTool", "Click a flat face of the part to keep"),
    QT_TRANSLATE_NOOP("AlignTool", "Click the flat face to keep it on"),
    FeatureFilter::Faces,
    JointKind::InPlane,
    wholeFeature,
    alignMotion,
    canBeOffset};

constexpr AlignRule kKeepToPoint{
    "keepToPoint",
    QT_TRANSLATE_NOOP("AlignTool", "Keep to poin&t…"),
    QT_TRANSLATE_NOOP("AlignTool", "Keep a point of a part at a point of another: it only turns about it"),
    "joint-point",
    "Ctrl+K",
    "",
    QT_TRANSLATE_NOOP("AlignTool", "Click a corner, circle or point of the part to keep"),
    QT_TRANSLATE_NOOP("AlignTool", "Click the point to keep it at"),
    FeatureFilter::Points,
    JointKind::ToPoint,
    wholeFeature,
    alignMotion,
    canBeOffset};

}  // namespace

const std::array<AlignRule, 5>& alignRules() {
  static constexpr std::array<AlignRule, 5> kRules{kAlign, kInsert, kKeepOnAxis, kKeepInPlane, kKeepToPoint};
  return kRules;
}

}  // namespace nearfit::ui
