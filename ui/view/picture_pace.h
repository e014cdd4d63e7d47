#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QWidget>

namespace nearfit::ui {

/// When a view draws: at most as often as the display shows pictures, and only after it was asked to.
class PicturePace : public QObject {
  Q_OBJECT

 public:
  /// @param view  Outlives this.
  explicit PicturePace(QWidget& view) : view_(view) {}

  /// A picture is wanted; one answers all requests until it is due.
  void request();
  /// A picture has been drawn, asked for or not.
  void noteDrawn() { sincePicture_.start(); }

 signals:
  void pictureDue();

 private:
  QWidget& view_;
  QElapsedTimer sincePicture_;
  bool hasRequest_ = false;
};

}  // namespace nearfit::ui
