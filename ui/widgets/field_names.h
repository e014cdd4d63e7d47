#pragma once

class QWidget;

namespace nearfit::ui {

/// Gives an accessible name to every widget below `root` that takes the keyboard and has none: the text of
/// the label beside it, else its tooltip. Skips widgets that name themselves, such as a button with a text.
void nameFields(QWidget& root);

/// True if a screen reader can say more about the widget than its kind.
bool hasAccessibleName(const QWidget& widget);

}  // namespace nearfit::ui
