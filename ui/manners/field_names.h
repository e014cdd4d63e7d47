#pragma once

class QWidget;

namespace nearfit::ui {

/// Gives every widget below `root` that takes the keyboard, and that nobody has named, an accessible name:
/// that of the label beside it, or else its tooltip. What says itself, as a button with a text, is left.
void nameFields(QWidget& root);

/// Whether a screen reader has something to say of the widget but its kind.
bool hasAccessibleName(const QWidget& widget);

}  // namespace nearfit::ui
