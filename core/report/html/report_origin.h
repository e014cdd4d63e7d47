#pragma once

#include <string>

namespace nearfit {

/// When, by whom and by what a report was made; the rest of it depends on its inputs alone.
struct ReportOrigin {
  std::string date;           ///< UTC, ISO 8601.
  std::string author;         ///< May be empty.
  std::string program;        ///< "Nearfit 0.1.0".
  std::string libraries;      ///< Libraries that results depend on, with versions.
  std::string system;         ///< Operating system, its release, machine.
  std::string revision = {};  ///< Of the sources of the program; empty if it does not know.
  std::string importer =
      {};  ///< The program that reads CAD documents, with OpenCASCADE's version; empty if not asked.
};

/// The origin of a report that the user of this system makes now; without the importer.
ReportOrigin reportOrigin();

/// Asks the importer for ReportOrigin::importer; says why where it does not answer.
std::string importerOfReport();

}  // namespace nearfit
