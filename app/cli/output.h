#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "core/scene/part_geometry.h"

namespace nearfit::cli {

/// Writes to stdout. Throws Error if it accepts no more (disk full, reader gone).
void print(std::string_view text);

/// Flushes stdout. Throws Error if something that was printed did not arrive.
void flushOutput();

/// Writes one line to stderr: the program's name and the message.
void printError(std::string_view message) noexcept;

/// Writes a line to stderr for each warning from loading the mesh.
void printWarnings(const PartGeometry& geometry);

/// Writes a line to stderr for each reason why the cache is not used as the environment says.
void printCacheWarnings();

/// Thrown by a command that failed and has already said so on stderr: exit code 1, no further line.
class ReportedFailure : public std::exception {
 public:
  const char* what() const noexcept override { return "the command failed"; }
};

/// Thrown by a command that has printed a verdict which is no, such as a path that is not proven free or a clash that no
/// rule allows: exit code 3, no further line.
class NegativeVerdict : public std::exception {
 public:
  const char* what() const noexcept override { return "the verdict is no"; }
};

/// Calls `report` for each file. One that cannot be read is told on stderr, and the others still follow. Throws
/// ReportedFailure at the end if there was one.
void reportEach(std::span<const std::string> files,
                const std::function<void(const std::string& file)>& report);

/// Returns text on one line: each run of line breaks becomes a space; other control characters and bytes that
/// are not UTF-8 become `\xNN`, so that no file name can control the terminal.
std::string oneLine(std::string_view text);

}  // namespace nearfit::cli
