#include "app/cli/output.h"

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <new>
#include <system_error>

#include "core/base/error.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/text/utf8.h"

namespace nearfit::cli {
namespace {

[[noreturn]] void failOutput(int error) {
  throw Error("standard output", "it cannot be written: " + std::system_category().message(error));
}

}  // namespace

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) failOutput(errno);
}

void flushOutput() {
  errno = 0;
  // Help goes through std::cout.
  const bool hasArrived = std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (!hasArrived) failOutput(errno != 0 ? errno : EIO);
}

void printError(std::string_view message) noexcept {
  try {
    const std::string line = "nearfit-cli: " + oneLine(message) + "\n";
    std::fwrite(line.data(), 1, line.size(), stderr);
  } catch (const std::bad_alloc&) {
    std::fputs("nearfit-cli: out of memory\n", stderr);
  }
}

void printWarnings(const PartGeometry& geometry) {
  for (const std::string& warning : geometry.report.warnings) {
    printError("warning: " + geometry.file.string() + ": " + warning);
  }
}

void printCacheWarnings() {
  for (const std::string& warning : treeCacheWarnings())
    printError("warning: " + warning);
}

void reportEach(std::span<const std::string> files,
                const std::function<void(const std::string& file)>& report) {
  bool hasFailed = false;
  for (const std::string& file : files) {
    try {
      report(file);
    } catch (const FileError& e) {
      flushOutput();
      printError(e.what());
      hasFailed = true;
    }
  }
  if (hasFailed) throw ReportedFailure();
}

std::string oneLine(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool isBreak = c == '\n' || c == '\r';
    if (!isBreak) line += c;
    if (isBreak && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ')
    line.pop_back();
  return printableText(line);
}

}  // namespace nearfit::cli
