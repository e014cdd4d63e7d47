#pragma once

#include <QProxyStyle>

namespace nearfit::ui {

/// Fusion, with boxes and circles to tick that stand out in the dark theme too: Fusion draws their frames a
/// little darker than what lies around them, which is hardly seen where that is dark; so are the frames of
/// fields. A list that drops down shortens what is chosen where Fusion would cut it. The button for tools
/// that a toolbar has no room for is as wide as a tool; Fusion's is a few pixels.
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
  int pixelMetric(PixelMetric metric, const QStyleOption* option, const QWidget* widget) const override;
};

}  // namespace nearfit::ui
