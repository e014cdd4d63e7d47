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

/// The mouse as a hand: with Shift held over a view, a left drag moves a point with the pointer, a right drag
/// turns about it, the wheel moves it to and fro. Without a point, or without Shift, the mouse is the view's.
class HandDrag : public QObject {
  Q_OBJECT

 public:
  /// @param view, camera  Outlive this.
  HandDrag(QWidget& view, vtkCamera& camera);

  /// In the world [m]; nothing: there is no hand to drag.
  void setPoint(const std::optional<glm::dvec3>& point) { point_ = point; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  /// @param shift  In the world [m].
  /// @param turn   About the point, in the world.
  void dragged(const glm::dvec3& shift, const glm::dquat& turn);

 private:
  struct Frame {
    glm::dvec3 right, up, away;  ///< Unit, in the world.
    double metresPerPixel;       ///< At the point.
  };
  Frame frame() const;
  bool press(const QMouseEvent& event);
  bool move(const QMouseEvent& event);
  bool wheel(const QWheelEvent& event);

  QWidget& view_;
  vtkCamera& camera_;
  std::optional<glm::dvec3> point_;
  Qt::MouseButton button_ = Qt::NoButton;  ///< That drags.
  QPoint last_;
};

}  // namespace nearfit::ui
