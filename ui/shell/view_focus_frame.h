#pragma once

#include <QObject>
#include <array>

class QWidget;

namespace nearfit::ui {

/// A thin frame over a view while it has the focus, and with it the arrow and page keys. Four narrow strips: a
/// frame of the view's size would have to be blended with each of its pictures.
class ViewFocusFrame : public QObject {
  Q_OBJECT

 public:
  /// @param view  Becomes the parent.
  explicit ViewFocusFrame(QWidget* view);

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void place();
  void setShown(bool isShown);

  QWidget* view_;
  std::array<QWidget*, 4> edges_{};
};

}  // namespace nearfit::ui
