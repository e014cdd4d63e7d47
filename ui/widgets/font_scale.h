#pragma once

class QWidget;

namespace nearfit::ui {

/// Factor from sizes made for letters of the usual height to a widget's font; at least 1.
double fontScale(const QWidget& widget);

/// Returns a size for a widget's font: widths and heights fixed in pixels would cut off larger letters.
/// @param usual  For letters of the usual height [pixels].
int forFont(const QWidget& widget, int usual);

}  // namespace nearfit::ui
