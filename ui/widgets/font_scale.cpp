#include "ui/widgets/font_scale.h"

#include <QWidget>
#include <algorithm>

namespace nearfit::ui {

double fontScale(const QWidget& widget) {
  constexpr double kUsualLetters = 17.0;  // [pixels]
  return std::max(1.0, widget.fontMetrics().height() / kUsualLetters);
}

int forFont(const QWidget& widget, int usual) {
  return qRound(usual * fontScale(widget));
}

}  // namespace nearfit::ui
