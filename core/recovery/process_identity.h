#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace nearfit {

/// Which process of which boot: a process id alone is given again.
struct ProcessIdentity {
  std::string boot;  ///< First digits of the kernel's id of this boot, hexadecimal.
  int pid = 0;
  std::uint64_t start = 0;  ///< When it began, in clock ticks since the boot.
  bool operator==(const ProcessIdentity&) const = default;
};

ProcessIdentity thisProcess();
/// Whether the process still runs; one that has ended and whose parent has not asked how yet does not. One
/// that cannot be looked at is taken for running: better too careful.
bool isRunning(const ProcessIdentity& process);

/// As a piece of a file name: "0f3a9c12-4711-88123".
std::string textOf(const ProcessIdentity& process);
std::optional<ProcessIdentity> processFromText(std::string_view text);

}  // namespace nearfit
