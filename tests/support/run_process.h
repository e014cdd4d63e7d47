#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nearfit::test {

struct ProcessResult {
  int exitCode = 0;  ///< Minus the signal when one ended it.
  std::string out, err;
};

struct ProcessOptions {
  std::filesystem::path stdoutPath;     ///< Where stdout goes; empty: into ProcessResult::out.
  bool isStdoutClosed = false;          ///< stdout is a pipe whose reader has gone.
  std::filesystem::path workingFolder;  ///< Empty: the test's own.
};

/// Runs a program to its end, without a shell; stdin is empty. Throws std::runtime_error when it cannot be
/// started.
ProcessResult runProcess(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

/// Runs nearfit-cli with these arguments.
ProcessResult runCli(std::vector<std::string> arguments, const ProcessOptions& options = {});

/// Lines of a text, without their ends.
std::vector<std::string> linesOf(const std::string& text);

}  // namespace nearfit::test
