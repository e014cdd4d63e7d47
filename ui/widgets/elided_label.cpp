#include "ui/widgets/elided_label.h"

#include <QStyle>
#include <QStyleOption>
#include <QStylePainter>

namespace nearfit::ui {

ElidedLabel::ElidedLabel(QWidget* parent) : QLabel(parent) {
  setTextFormat(Qt::PlainText);
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
}

QSize ElidedLabel::minimumSizeHint() const {
  return {0, QLabel::minimumSizeHint().height()};
}

void ElidedLabel::paintEvent(QPaintEvent* event) {
  const QString cut = fontMetrics().elidedText(text(), Qt::ElideMiddle, contentsRect().width());
  if (cut == text()) return QLabel::paintEvent(event);
  QStylePainter painter(this);
  QStyleOption option;
  option.initFrom(this);
  painter.drawPrimitive(QStyle::PE_Widget, option);
  painter.drawItemText(contentsRect(), static_cast<int>(alignment()), palette(), isEnabled(), cut,
                       foregroundRole());
}

}  // namespace nearfit::ui
