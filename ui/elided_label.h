#pragma once

#include <QLabel>

namespace nearfit::ui {

/// A line of plain text that asks for no room: what has none is cut in the middle. text() is whole; so that a
/// reader can see it, tell it in the tool tip.
class ElidedLabel : public QLabel {
  Q_OBJECT

 public:
  explicit ElidedLabel(QWidget* parent = nullptr);

  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
};

}  // namespace nearfit::ui
