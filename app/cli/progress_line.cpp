#include "app/cli/progress_line.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace nearfit::cli {

ProgressLine::ProgressLine(const char* what) : what_(what), isShown_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (percent_ >= 0) std::fputs("\r\x1B[K", stderr);
}

void ProgressLine::show(double fraction) {
  const int percent = static_cast<int>(100.0 * fraction);
  if (!isShown_ || percent == percent_) return;
  percent_ = percent;
  std::fputs(fmt::format("\r{} {} %", what_, percent).c_str(), stderr);
}

}  // namespace nearfit::cli
