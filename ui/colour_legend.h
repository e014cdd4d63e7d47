#pragma once

#include <QWidget>

#include "core/haptics/servo_snapshot.h"

namespace nearfit::ui {

/// A card over the 3-D view that explains its glyphs: the colours of distances from contact to the cutoff,
/// and the other glyphs with what they stand for in numbers.
class ColourLegend : public QWidget {
  Q_OBJECT

 public:
  explicit ColourLegend(QWidget* parent = nullptr);

  /// @param cutoff  Distance of the last colour [m].
  void setCutoff(double cutoff);
  /// The numbers beside the glyphs; takes the size that they need.
  void showSnapshot(const ServoSnapshot& snapshot);

  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  /// Larger than 1 where letters are.
  double scale() const;
  QFont letters() const;
  void paintScale(QPainter& painter);
  void paintRow(QPainter& painter, int y, const QString& name, const QString& value);

  double cutoff_ = 0.01;
  QString force_, torque_, contacts_, lead_;
  bool hasProxy_ = true;
};

}  // namespace nearfit::ui
