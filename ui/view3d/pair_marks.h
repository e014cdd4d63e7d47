#pragma once

#include <QString>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/verdict/scene_check.h"
#include "ui/view3d/glyphs/pair_segment.h"
#include "ui/view3d/mark_actors.h"

namespace nearfit::ui {

class SpotLabel;
class Viewport;

/// Place of the arrow that frees the first part of a clash, in the world [m].
struct FreeingArrow {
  glm::dvec3 from{0.0}, to{0.0};
};

/// The arrow begins in the middle of the curves in which the surfaces meet, else at the nearest point of the
/// first part.
/// @param finding  Has a translation that frees it.
FreeingArrow freeingArrow(const PairFinding& finding);

/// Box of the marks of a finding in the world [m]; empty if there is nothing to mark.
Aabb markedBox(const PairFinding& finding);

/// Draws what a check of the scene found of two parts over all parts: of a clash the curves in which they
/// meet, and the way that frees the first one as an arrow; of others the segment between their nearest
/// points, and the other minima as thin lines. A label says how long the arrow or the segment is.
class PairMarks {
 public:
  /// @param view  May be destroyed first; after that only the destructor may be called.
  explicit PairMarks(Viewport& view);

  /// Shows a finding in the colours of the present theme.
  /// @param label  Empty: none.
  void show(const PairFinding& finding, const QString& label);
  void clear();
  bool isShown() const { return curves_.isShown() || arrow_.isShown() || segment_.isShown(); }

 private:
  void showCurves(const PairFinding& finding);
  void showArrow(const FreeingArrow& arrow);

  MarkActors curves_, arrow_;
  PairSegment segment_;
  SpotLabel* label_;
};

}  // namespace nearfit::ui
