#pragma once

namespace nearfit::ui {

/// Style sheet of a tool button with a menu arrow: keeps the icon clear of the arrow.
inline constexpr const char* kSplitButton =
    "QToolButton { padding-right: 18px; } QToolButton::menu-button { border: none; width: 16px; }";

}  // namespace nearfit::ui
