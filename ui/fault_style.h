#pragma once

namespace nearfit::ui {

/// Style sheet of a line that holds what could not be taken over.
inline constexpr char kFaultyStyle[] = "background: #fde8e6; color: #7a1109;";

/// How long the message below it stays [ms].
inline constexpr int kFaultTime = 20000;

}  // namespace nearfit::ui
