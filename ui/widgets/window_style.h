#pragma once

#include <QProxyStyle>

namespace nearfit::ui {

/// Fusion with some details improved. In the dark theme the frames of check boxes, radio buttons and fields
/// stand out; Fusion draws them a little darker than their surroundings, hardly visible on a dark ground.
/// Combo boxes elide long text, which Fusion clips. Disabled items of lists have no second text behind their own, and
/// checked buttons have the colour of checked tools. A toolbar's extension button is as wide as a tool; Fusion makes it a
/// few pixels wide. Tables can have more room between their columns (keepColumnsApart()).
class WindowStyle : public QProxyStyle {
 public:
  WindowStyle();

  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override;
  void drawComplexControl(ComplexControl control, const QStyleOptionComplex* option, QPainter* painter,
                          const QWidget* widget) const override;
  void drawControl(ControlElement element, const QStyleOption* option, QPainter* painter,
                   const QWidget* widget) const override;
  QIcon standardIcon(StandardPixmap which, const QStyleOption* option, const QWidget* widget) const override;
  int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                QStyleHintReturn* result) const override;
  QRect subElementRect(SubElement element, const QStyleOption* option, const QWidget* widget) const override;
  QSize sizeFromContents(ContentsType type, const QStyleOption* option, const QSize& contents,
                         const QWidget* widget) const override;
  int pixelMetric(PixelMetric metric, const QStyleOption* option, const QWidget* widget) const override;
};

}  // namespace nearfit::ui
