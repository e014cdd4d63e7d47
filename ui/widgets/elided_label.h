#pragma once

#include <QLabel>

namespace nearfit::ui {

/// A line of plain text that claims no width and is elided in the middle to fit. text() returns the whole
/// text; set it as the tool tip too, so that users can read it.
class ElidedLabel : public QLabel {
  Q_OBJECT

 public:
  explicit ElidedLabel(QWidget* parent = nullptr);

  /// Keeps the first letters of the text whole where there is room for more than these: what follows is elided in its
  /// own middle.
  void setWholeStart(int letters);
  /// Returns the text as it is shown in its width.
  QString shownText() const;

  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  int wholeStart_ = 0;
};

}  // namespace nearfit::ui
