#pragma once

#include <QPoint>
#include <QPointF>
#include <QStringList>
#include <QWidget>
#include <optional>

#include "core/servo/servo_snapshot.h"

namespace nearfit::ui {

/// A card over the 3-D view that explains its glyphs: the colour scale of distances, and force, torque, contacts and
/// hand with their current values. Can be dragged; its place is kept between runs. Ignores the mouse otherwise.
class ColourLegend : public QWidget {
  Q_OBJECT

 public:
  /// @param parent  Whatever it lies over; not null.
  explicit ColourLegend(QWidget* parent);

  /// Puts the legend where the user left it in its parent: at first in the lower left corner.
  void place();

  /// @param range  Distance at the end of the colour scale [m].
  void setColourRange(double range);
  /// Shows the snapshot's values and resizes to fit. Contacts and hand appear in proxy mode only.
  void showSnapshot(const ServoSnapshot& snapshot);
  /// Returns the values that it shows: force, torque, contacts and hand offset.
  QStringList values() const { return {force_, torque_, contacts_, lead_}; }
  /// Paints the values paler: they are past.
  void setPast(bool isPast);

  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;

 private:
  /// Factor from the layout's constants to the widget's font; at least 1.
  double scale() const;
  /// The widget's font at the size that the constants assume; the painter scales it.
  QFont letters() const;
  void paintScale(QPainter& painter);
  void paintRow(QPainter& painter, int y, const QString& name, const QString& value);

  /// Returns how far it can be from the upper left corner of its parent [pixels].
  QPoint room() const;

  QPointF share_;                  ///< Its place, as shares of room().
  std::optional<QPoint> grabbed_;  ///< Where it is held while it is dragged [pixels].
  double range_ = 0.01;
  QString force_, torque_, contacts_, lead_;
  bool hasProxy_ = true, isPast_ = false;
};

}  // namespace nearfit::ui
