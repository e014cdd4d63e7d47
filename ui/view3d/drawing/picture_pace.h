#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QWidget>

namespace nearfit::ui {

/// Decides when a view draws: only on request, and at most as often as the display refreshes.
class PicturePace : public QObject {
  Q_OBJECT

 public:
  /// @param view  Outlives this.
  explicit PicturePace(QWidget& view) : view_(view) {}

  /// Requests a picture. Requests until it is due are answered by one.
  void request();
  /// Notes that a picture was drawn, requested or not.
  void noteDrawn() { sincePicture_.start(); }

 signals:
  /// Emitted when the view is to draw; not while it is hidden.
  void pictureDue();

 private:
  QWidget& view_;
  QElapsedTimer sincePicture_;
  bool hasRequest_ = false;
};

}  // namespace nearfit::ui
