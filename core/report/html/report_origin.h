#pragma once

#include <string>

namespace nearfit {

/// When, by whom and by what a report was made; the rest of it depends on its inputs alone.
struct ReportOrigin {
  std::string date;       ///< UTC, ISO 8601.
  std::string author;     ///< May be empty.
  std::string program;    ///< "Nearfit 0.1.0".
  std::string libraries;  ///< Libraries that results depend on, with versions.
  std::string system;     ///< Operating system, its release, machine.
};

/// The origin of a report that this program makes now.
/// @param author  Empty: the user's name on this system.
ReportOrigin reportOrigin(const std::string& author = {});

}  // namespace nearfit
