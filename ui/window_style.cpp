#include "ui/window_style.h"

#include <QStyleFactory>
#include <QStyleOption>

#include "ui/theme.h"

namespace nearfit::ui {
namespace {

/// What Fusion's frames are made from in the dark theme.
constexpr QRgb kFrameInDark = 0xffb4c0cc;

template <class Option>
bool takesFrom(const QStyleOption* option, Option& out) {
  const Option* own = qstyleoption_cast<const Option*>(option);
  if (own == nullptr) return false;
  out = *own;
  out.palette.setColor(QPalette::Window, QColor(kFrameInDark));
  return true;
}

}  // namespace

WindowStyle::WindowStyle() : QProxyStyle(QStyleFactory::create(QStringLiteral("Fusion"))) {}

void WindowStyle::drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                                const QWidget* widget) const {
  QStyleOptionButton button;
  QStyleOptionViewItem item;
  const bool isButton = element == PE_IndicatorCheckBox || element == PE_IndicatorRadioButton;
  if (isThemeDark() && isButton && takesFrom(option, button)) {
    QProxyStyle::drawPrimitive(element, &button, painter, widget);
  } else if (isThemeDark() && element == PE_IndicatorItemViewItemCheck && takesFrom(option, item)) {
    QProxyStyle::drawPrimitive(element, &item, painter, widget);
  } else {
    QProxyStyle::drawPrimitive(element, option, painter, widget);
  }
}

QIcon WindowStyle::standardIcon(StandardPixmap which, const QStyleOption* option,
                                const QWidget* widget) const {
  // Fusion's is black on any ground.
  return which == SP_ToolBarHorizontalExtensionButton ? icon(QStringLiteral("more"))
                                                      : QProxyStyle::standardIcon(which, option, widget);
}

int WindowStyle::pixelMetric(PixelMetric metric, const QStyleOption* option, const QWidget* widget) const {
  constexpr int kMoreTools = 26;
  return metric == PM_ToolBarExtensionExtent ? kMoreTools : QProxyStyle::pixelMetric(metric, option, widget);
}

}  // namespace nearfit::ui
