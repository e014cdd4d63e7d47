#pragma once

#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/scene/part_geometry.h"

namespace nearfit::cli {

/// Writes to stdout. Throws Error when it takes no more (disk full, reader gone).
void print(std::string_view text);

/// Throws Error when something that was printed did not arrive.
void flushOutput();

/// Writes one line to stderr: the program's name and the message.
void printError(std::string_view message) noexcept;

/// Writes a line to stderr for each warning that loading the mesh gave.
void printWarnings(const PartGeometry& geometry);

/// Throws UsageError when a file that is to be written is one of those that the command reads, by whatever
/// path or link.
void checkTarget(const std::filesystem::path& target, std::span<const std::filesystem::path> inputs);

/// Thrown by a command that has failed and has said so on stderr already: exit code 1, no further line.
class ReportedFailure : public std::exception {
 public:
  const char* what() const noexcept override { return "the command failed"; }
};

/// Text on one line: each run of line breaks a space, other control characters and bytes that are not UTF-8 as
/// `\xNN`, so that no file name can play with the terminal.
std::string oneLine(std::string_view text);

}  // namespace nearfit::cli
