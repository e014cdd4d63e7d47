#pragma once

#include <QString>
#include <QWidget>

namespace nearfit::ui {

/// A bar of a round length with its label, in the lower right corner of a view: how large is what is seen.
/// Stays clear of the legend. Ignores the mouse. Off at first.
class ScaleBar : public QWidget {
  Q_OBJECT

 public:
  /// @param view  The parent.
  explicit ScaleBar(QWidget& view);

  /// Turns the bar on or off.
  void setWanted(bool isWanted);
  /// Sets the scale of the view, in its device-independent pixels; 0 hides the bar. Call after each picture.
  void showScale(double metresPerPixel);

  /// Length of the bar [m]: round in the unit of length shown. 0 if it has none.
  double length() const;
  /// Width of the bar without its frame [pixels].
  double pixels() const;
  /// The label: "20 mm".
  QString text() const;

  bool eventFilter(QObject* watched, QEvent* event) override;

 protected:
  void changeEvent(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  /// Max width of the bar [pixels].
  int room() const;
  /// Shows or hides the bar, and moves it into its corner.
  void place();

  bool isWanted_ = false;
  double metresPerPixel_ = 0.0;
};

}  // namespace nearfit::ui
