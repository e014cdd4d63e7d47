#pragma once

#include <QWidget>
#include <vector>

#include "core/report/clearance_histogram.h"

namespace nearfit::ui {

/// Draws the area of a surface by its clearance, as bars in the colours of the map, with a line at the threshold. A tool
/// tip says the area of the bar under the pointer.
class HistogramView : public QWidget {
  Q_OBJECT

 public:
  explicit HistogramView(QWidget* parent = nullptr);

  /// @param bins   Ascending; empty: nothing is drawn.
  /// @param total  Area of the surface [m^2].
  void showBins(std::vector<ClearanceBin> bins, double range, double total);
  /// @param threshold  [m]
  void setThreshold(double threshold);
  /// Draws the bars pale: they are of a former pose.
  void setStale(bool isStale);

  const std::vector<ClearanceBin>& bins() const noexcept { return bins_; }
  QSize sizeHint() const override { return {320, 130}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

 private:
  QRect chart() const;
  double pixelOf(double distance) const;

  std::vector<ClearanceBin> bins_;
  double range_ = 0.0, total_ = 0.0, threshold_ = 0.0;
  bool isStale_ = false;
};

/// Formats an area [m^2] in the square of the unit that the user chose: "12.3 cm²" with millimetres.
QString formatArea(double squareMetres);
/// Formats a share: "4 %", "0.3 %".
QString formatShare(double share);

}  // namespace nearfit::ui
