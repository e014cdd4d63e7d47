#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"

namespace nearfit {

/// The importer: nearfit-import in the folder of the running program, else in `libexec/nearfit` beside that folder (where it is
/// installed), or the file that the environment variable NEARFIT_IMPORT names, which has to be the user's or the system's and
/// writable by nobody else. Throws FileError.
std::filesystem::path importProgram();

/// The exporter: nearfit-export in the same places, or the file that the environment variable NEARFIT_EXPORT names, as for
/// importProgram(). Throws FileError.
std::filesystem::path exportProgram();

/// Asks the importer for its version and that of OpenCASCADE: "nearfit-import 0.1.0, OpenCASCADE 7.6.3". Takes as long as its
/// libraries take to load. Throws FileError if it is missing, is not to be trusted or does not answer.
std::string importerVersion();

/// Limits of a run of either program.
struct ImportLimits {
  double silence = 20.0;  ///< Max time without a sign of progress [s].
};

/// Runs the importer on a file and returns what it wrote as its result. Kills it, and whatever it started, when
/// `progress` returns false and when it makes no progress for too long.
/// @param arguments  Besides the file.
/// Throws FileError, also with the importer's own message, and Cancelled.
std::vector<std::byte> runImporter(const std::filesystem::path& program, const std::filesystem::path& file,
                                   const std::vector<std::string>& arguments, const ImportLimits& limits,
                                   const ProgressCallback& progress);

/// Runs the exporter on a request and returns what it wrote as its result; otherwise as runImporter().
/// @param file  To be written by the caller; named in messages.
std::vector<std::byte> runExporter(const std::filesystem::path& program, const std::filesystem::path& file,
                                   std::span<const std::byte> request, const ImportLimits& limits,
                                   const ProgressCallback& progress);

}  // namespace nearfit
