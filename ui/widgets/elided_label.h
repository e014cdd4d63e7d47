#pragma once

#include <QLabel>

namespace nearfit::ui {

/// A line of plain text that claims no width and is elided in the middle to fit. text() returns the whole
/// text; set it as the tool tip too, so that users can read it.
class ElidedLabel : public QLabel {
  Q_OBJECT

 public:
  explicit ElidedLabel(QWidget* parent = nullptr);

  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
};

}  // namespace nearfit::ui
