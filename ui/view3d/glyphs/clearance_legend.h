#pragma once

#include <QColor>
#include <QWidget>

namespace nearfit::ui {

/// A card over the 3-D view that explains the colours of clearances: the scale with lengths, overlaps, and what is beyond
/// the range. At the view's upper left; below or beside the legend of glyphs where that lies there. Ignores the mouse.
class ClearanceLegend : public QWidget {
  Q_OBJECT

 public:
  /// @param view  Whatever it lies over; not null.
  explicit ClearanceLegend(QWidget* view);

  /// Contents of the card.
  struct Scale {
    double range = 0.0;  ///< [m]
    QColor beyond;       ///< Colour of the part.
    bool hasOverlap = false;
    bool isStale = false;  ///< Colours are of a former pose.
  };
  void showScale(const Scale& scale);

  QSize sizeHint() const override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void place();
  /// Returns a corner clear of the legends of glyphs, if there is room for one.
  QPoint clearCorner() const;
  /// Names of the swatches below and above the scale, and the title, in the order in which they are painted.
  QStringList texts() const;
  void paintSwatch(QPainter& painter, const QRect& at, const QColor& colour, const QString& text) const;

  Scale scale_;
};

}  // namespace nearfit::ui
