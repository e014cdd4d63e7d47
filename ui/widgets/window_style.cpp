#include "ui/widgets/window_style.h"

#include <QHash>
#include <QPair>
#include <QStyleFactory>
#include <QStyleOption>

#include "ui/widgets/row_table.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Colours that Fusion derives frames from in the dark theme: of check boxes and radio
/// buttons, and of fields.
constexpr QRgb kFrameInDark = 0xffb4c0cc, kFieldFrameInDark = 0xff7d8995;
/// Colours of a button that is checked, in the light and the dark theme.
constexpr QRgb kChecked = 0xffbcd8f4, kCheckedInDark = 0xff2b5a8c;

/// Returns a palette with another colour for frames. Equal arguments give the same palette, as Fusion
/// caches pixmaps by its key.
QPalette framed(const QPalette& own, QRgb frame) {
  constexpr int kMax = 64;
  static QHash<QPair<qint64, QRgb>, QPalette> known;
  if (known.size() >= kMax) known.clear();
  QPalette& palette = known[{own.cacheKey(), frame}];
  if (palette.color(QPalette::Window) != QColor(frame)) {
    palette = own;
    palette.setColor(QPalette::Window, QColor(frame));
  }
  return palette;
}

template <class Option>
bool takesFrom(const QStyleOption* option, Option& out, QRgb frame = kFrameInDark) {
  const Option* own = qstyleoption_cast<const Option*>(option);
  if (own == nullptr) return false;
  out = *own;
  out.palette = framed(own->palette, frame);
  return true;
}

}  // namespace

WindowStyle::WindowStyle() : QProxyStyle(QStyleFactory::create(QStringLiteral("Fusion"))) {}

void WindowStyle::drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                                const QWidget* widget) const {
  QStyleOptionButton button;
  QStyleOptionViewItem item;
  QStyleOptionFrame field;
  const bool isButton = element == PE_IndicatorCheckBox || element == PE_IndicatorRadioButton;
  if (isThemeDark() && isButton && takesFrom(option, button)) {
    QProxyStyle::drawPrimitive(element, &button, painter, widget);
  } else if (isThemeDark() && element == PE_IndicatorItemViewItemCheck && takesFrom(option, item)) {
    QProxyStyle::drawPrimitive(element, &item, painter, widget);
  } else if (isThemeDark() && element == PE_FrameLineEdit && takesFrom(option, field, kFieldFrameInDark)) {
    QProxyStyle::drawPrimitive(element, &field, painter, widget);
  } else {
    QProxyStyle::drawPrimitive(element, option, painter, widget);
  }
}

void WindowStyle::drawComplexControl(ComplexControl control, const QStyleOptionComplex* option,
                                     QPainter* painter, const QWidget* widget) const {
  QStyleOptionSpinBox field;
  const bool isField = isThemeDark() && control == CC_SpinBox && takesFrom(option, field, kFieldFrameInDark);
  QProxyStyle::drawComplexControl(control, isField ? &field : option, painter, widget);
}

void WindowStyle::drawControl(ControlElement element, const QStyleOption* option, QPainter* painter,
                              const QWidget* widget) const {
  const auto* button = qstyleoption_cast<const QStyleOptionButton*>(option);
  if (element == CE_PushButtonBevel && button != nullptr && button->state.testFlag(State_On)) {
    QStyleOptionButton checked = *button;
    checked.palette.setColor(QPalette::Button, isThemeDark() ? kCheckedInDark : kChecked);
    return QProxyStyle::drawControl(element, &checked, painter, widget);
  }
  const auto* box = qstyleoption_cast<const QStyleOptionComboBox*>(option);
  if (element != CE_ComboBoxLabel || box == nullptr || box->editable)
    return QProxyStyle::drawControl(element, option, painter, widget);
  // Fusion clips long text without an ellipsis.
  QStyleOptionComboBox elided = *box;
  const QRect room = subControlRect(CC_ComboBox, box, SC_ComboBoxEditField, widget);
  const int icon = box->currentIcon.isNull() ? 0 : box->iconSize.width() + 4;
  elided.currentText =
      box->fontMetrics.elidedText(box->currentText, Qt::ElideMiddle, room.width() - icon - 2);
  QProxyStyle::drawControl(element, &elided, painter, widget);
}

QIcon WindowStyle::standardIcon(StandardPixmap which, const QStyleOption* option,
                                const QWidget* widget) const {
  // Fusion's is black in both themes.
  return which == SP_ToolBarHorizontalExtensionButton ? icon(QStringLiteral("more"))
                                                      : QProxyStyle::standardIcon(which, option, widget);
}

int WindowStyle::styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                           QStyleHintReturn* result) const {
  return hint == SH_EtchDisabledText ? 0 : QProxyStyle::styleHint(hint, option, widget, result);
}

QRect WindowStyle::subElementRect(SubElement element, const QStyleOption* option,
                                  const QWidget* widget) const {
  const QRect rect = QProxyStyle::subElementRect(element, option, widget);
  const int gap = element == SE_HeaderLabel ? columnGapOf(widget) : 0;
  return rect.adjusted(gap, 0, -gap, 0);
}

QSize WindowStyle::sizeFromContents(ContentsType type, const QStyleOption* option, const QSize& contents,
                                    const QWidget* widget) const {
  const QSize size = QProxyStyle::sizeFromContents(type, option, contents, widget);
  return type == CT_HeaderSection ? size + QSize(2 * columnGapOf(widget), 0) : size;
}

int WindowStyle::pixelMetric(PixelMetric metric, const QStyleOption* option, const QWidget* widget) const {
  constexpr int kMoreTools = 26;
  if (metric == PM_ToolBarExtensionExtent) return kMoreTools;
  const int usual = QProxyStyle::pixelMetric(metric, option, widget);
  // The margins of cells.
  return metric == PM_FocusFrameHMargin ? usual + columnGapOf(widget) : usual;
}

}  // namespace nearfit::ui
