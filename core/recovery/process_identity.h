#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace nearfit {

/// Identifies a process across boots; process IDs alone are reused.
struct ProcessIdentity {
  std::string boot;  ///< First digits of the kernel's boot ID, hexadecimal.
  int pid = 0;
  std::uint64_t start = 0;  ///< Start time, in clock ticks since boot.
  bool operator==(const ProcessIdentity&) const = default;
};

/// Identity of the calling process.
ProcessIdentity thisProcess();
/// True if the process still runs. A zombie counts as ended. A process that cannot be inspected counts as
/// running, to be safe.
bool isRunning(const ProcessIdentity& process);

/// Formats an identity for use in a file name: "0f3a9c12-4711-88123".
std::string textOf(const ProcessIdentity& process);
/// Parses textOf(); std::nullopt if the text is invalid.
std::optional<ProcessIdentity> processFromText(std::string_view text);

}  // namespace nearfit
