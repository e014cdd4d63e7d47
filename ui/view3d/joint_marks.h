#pragma once

#include <QColor>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <vtkRenderer.h>

#include "core/scene/joint.h"
#include "ui/view3d/mark_actors.h"

namespace nearfit::ui {

/// How a joint is drawn. All in the world.
struct JointMark {
  JointKind kind = JointKind::OnAxis;
  glm::dvec3 middle{0.0};               ///< Of the line, the square or the cross [m].
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< Of the axis, or normal of the plane; unit.
  double reach = 0.0;  ///< Half the length of the line, the cross or a side of the square [m].
  /// Feature of the part, if the part is off the joint [m]: a line leads there, in the colour of warnings.
  std::optional<glm::dvec3> strayed;
};

/// Draws joints over all parts: an axis as a dash-dotted line, a plane as a translucent square, a point as a cross with
/// a dot.
class JointMarks {
 public:
  explicit JointMarks(vtkRenderer& renderer);

  /// Shows these joints, in the colours of the present theme; empty: none.
  void show(const std::vector<JointMark>& marks);

 private:
  static void fill(MarkActors& actors, const std::vector<const JointMark*>& marks, const QColor& colour);

  MarkActors kept_, strayed_;
};

}  // namespace nearfit::ui
