#pragma once

#include <QWidget>

#include "core/haptics/wrench.h"

namespace nearfit::ui {

/// A card over the 3-D view that explains its glyphs: the colours of distances from contact to the cutoff,
/// and the two arrows with their values.
class ColourLegend : public QWidget {
  Q_OBJECT

 public:
  explicit ColourLegend(QWidget* parent = nullptr);

  /// @param cutoff  Distance of the last colour [m].
  void setCutoff(double cutoff);
  /// Magnitudes beside the arrows' colours.
  void setWrench(const Wrench& wrench);

  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintScale(QPainter& painter);
  void paintArrowRow(QPainter& painter, int y, const QColor& colour, const QString& name,
                     const QString& value);

  double cutoff_ = 0.01;
  QString force_, torque_;
};

}  // namespace nearfit::ui
