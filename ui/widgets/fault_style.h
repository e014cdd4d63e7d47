#pragma once

namespace nearfit::ui {

/// Style sheet of a field whose text cannot be accepted.
inline constexpr char kFaultyStyle[] = "background: #fde8e6; color: #7a1109;";

/// How long the message below such a field stays [ms].
inline constexpr int kFaultTime = 20000;

}  // namespace nearfit::ui
