#pragma once

#include <QLabel>
#include <optional>

#include <glm/vec3.hpp>

namespace nearfit::ui {

class Viewport;

/// A small label over the view at a point of the world, where the point is seen. In exported pictures too.
class SpotLabel : public QLabel {
  Q_OBJECT

 public:
  /// @param view  The parent.
  /// @param name  Object name.
  SpotLabel(Viewport& view, const QString& name);

  /// Shows the label at a world point [m].
  void showAt(const glm::dvec3& point, const QString& text);
  /// Hides the label.
  void end();

 private:
  /// Follows the camera; called after each picture.
  void place();

  Viewport& view_;
  std::optional<glm::dvec3> point_;
};

}  // namespace nearfit::ui
