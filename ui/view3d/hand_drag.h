#pragma once

#include <QObject>
#include <QPoint>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

class QMouseEvent;
class QWheelEvent;
class QWidget;
class vtkCamera;

namespace nearfit::ui {

/// The mouse as a hand. While Shift is held over a view, a left drag moves a point with the pointer, a right
/// drag turns about it, and the wheel moves it along the line of sight. Without Shift, or without a point,
/// events pass on to the view.
class HandDrag : public QObject {
  Q_OBJECT

 public:
  /// @param view, camera  Outlive this.
  HandDrag(QWidget& view, vtkCamera& camera);

  /// Sets the point that drags move, in the world [m]; nullopt turns dragging off.
  void setPoint(const std::optional<glm::dvec3>& point) { point_ = point; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  /// Emitted for each step of a drag or of the wheel.
  /// @param shift  World [m].
  /// @param turn   About the point, in the world frame.
  void dragged(const glm::dvec3& shift, const glm::dquat& turn);

 private:
  struct Frame {
    glm::dvec3 right, up, away;  ///< Unit vectors in the world.
    double metresPerPixel;       ///< At the point's depth.
  };
  Frame frame() const;
  bool press(const QMouseEvent& event);
  bool move(const QMouseEvent& event);
  bool wheel(const QWheelEvent& event);

  QWidget& view_;
  vtkCamera& camera_;
  std::optional<glm::dvec3> point_;
  Qt::MouseButton button_ = Qt::NoButton;  ///< The button that drags.
  QPoint last_;
};

}  // namespace nearfit::ui
