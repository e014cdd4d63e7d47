#pragma once

#include <QAbstractButton>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QImage>
#include <QToolButton>

#include "tests/app/desktop/view_pointer.h"
#include "ui/model/selection.h"

namespace nearfit::test {

/// The two cubes from the front, fixed red and moving blue, and the section as the test wants it.
struct SectionDriver {
  explicit SectionDriver(const char* look = "viewFront") : pointer(d) {
    d.addCubes();
    d.session().setColour(d.partId("fixed"), {1.0F, 0.0F, 0.0F});
    d.session().setColour(d.partId("moving"), {0.0F, 0.0F, 1.0F});
    d.action("seeThrough")->setChecked(false);
    d.window().selection().select({});
    d.choose(look);
  }
  void begin(const char* axis) {
    pressShortcut(d, Qt::Key_C);
    QVERIFY(d.action("section")->isChecked());
    QVERIFY(d.widget<QWidget>("sectionBar")->isVisible());
    press(axis);
    QVERIFY(isDown(axis));
  }
  void press(const char* button) {
    auto* widget = d.widget<QAbstractButton>(button);
    // Where a check box has its box.
    QTest::mouseClick(widget, Qt::LeftButton, {}, QPoint(8, widget->height() / 2));
  }
  bool isDown(const char* button) { return d.widget<QToolButton>(button)->isChecked(); }
  void goTo(const char* position) { d.type<QDoubleSpinBox>("sectionPosition", position); }
  double position() { return d.widget<QDoubleSpinBox>("sectionPosition")->value(); }

  /// What is seen around a point of the world: the middle of some pixels, so that stripes count as a ground.
  QColor seenAt(const glm::dvec3& point) {
    constexpr int kReach = 4;
    const QImage picture = d.picture();
    const QPoint middle = pointer.seen(point) * view().devicePixelRatioF();
    int r = 0, g = 0, b = 0, count = 0;
    for (int y = -kReach; y <= kReach; ++y) {
      for (int x = -kReach; x <= kReach; ++x) {
        const QColor pixel = picture.pixelColor(middle + QPoint(x, y));
        r += pixel.red();
        g += pixel.green();
        b += pixel.blue();
        ++count;
      }
    }
    return {r / count, g / count, b / count};
  }
  bool isRedAt(const glm::dvec3& point) {
    const QColor seen = seenAt(point);
    return seen.red() > seen.blue() + 60 && seen.red() > seen.green() + 60;
  }
  bool isBlueAt(const glm::dvec3& point) {
    const QColor seen = seenAt(point);
    return seen.blue() > seen.red() + 60 && seen.blue() > seen.green() + 60;
  }
  /// What is nearest to the viewer there; nothing over the background.
  std::optional<ui::PickedPoint> picked(const glm::dvec3& point) {
    return view().pointAt(pointer.seen(point));
  }
  bool isCapAt(const glm::dvec3& point, const char* part) {
    const auto found = picked(point);
    return found && found->cut != nullptr && found->part == d.partId(part);
  }

  ui::Viewport& view() { return pointer.view(); }
  ui::GizmoOverlay& handle() { return *d.widget<ui::GizmoOverlay>("sectionHandle"); }
  /// Where the section's handle can be grabbed.
  QPoint handleAt(GizmoGrip which) {
    for (const GizmoFigure& figure : handle().picture().value().layout.figures()) {
      if (figure.handle != which || figure.isFarSide || figure.isArea != isArrow(which)) continue;
      glm::dvec2 place = figure.points[figure.points.size() / 3];
      if (figure.isArea) {
        place = glm::dvec2(0.0);
        for (const glm::dvec2& p : figure.points)
          place += p / static_cast<double>(figure.points.size());
      }
      return {qRound(place.x), qRound(place.y)};
    }
    return {};
  }

  DesktopDriver d;
  ViewPointer pointer;
};

}  // namespace nearfit::test
