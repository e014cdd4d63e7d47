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

void ElidedLabel::setWholeStart(int letters) {
  wholeStart_ = letters;
  update();
}

QString ElidedLabel::shownText() const {
  // Share of the width that a start may take, so that something is left of the rest.
  constexpr double kMaxShare = 0.7;
  const QFontMetrics letters = fontMetrics();
  const int room = contentsRect().width();
  if (letters.horizontalAdvance(text()) <= room) return text();
  const QString start = text().left(wholeStart_);
  const int taken = letters.horizontalAdvance(start);
  if (taken > kMaxShare * room) return letters.elidedText(text(), Qt::ElideMiddle, room);
  return start + letters.elidedText(text().mid(wholeStart_), Qt::ElideMiddle, room - taken);
}

void ElidedLabel::paintEvent(QPaintEvent* event) {
  const QString cut = shownText();
  if (cut == text()) return QLabel::paintEvent(event);
  QStylePainter painter(this);
  QStyleOption option;
  option.initFrom(this);
  painter.drawPrimitive(QStyle::PE_Widget, option);
  painter.drawItemText(contentsRect(), static_cast<int>(alignment()), palette(), isEnabled(), cut,
                       foregroundRole());
}

}  // namespace nearfit::ui
