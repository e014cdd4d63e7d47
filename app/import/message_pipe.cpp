#include "app/import/message_pipe.h"

#include <algorithm>
#include <cerrno>

#include <fmt/format.h>
#include <unistd.h>

#include "core/import/import_protocol.h"

namespace nearfit::importer {
namespace {

namespace protocol = import_protocol;

/// Steps of progress worth a line.
constexpr double kProgressStep = 0.002;

std::string field(std::string text) {
  text.resize(std::min(text.size(), protocol::kMaxFieldBytes));
  std::ranges::replace_if(text, [](char c) { return c == '\t' || c == '\n'; }, ' ');
  return text;
}

}  // namespace

void MessagePipe::progress(double fraction) {
  if (fraction < written_ + kProgressStep) return;
  written_ = fraction;
  writeLine(fmt::format("{}\t{:.4f}\n", protocol::kProgress, fraction));
}

void MessagePipe::failure(const std::string& where, const std::string& problem,
                          const std::string& remedy) const {
  writeLine(fmt::format("{}\t{}\t{}\t{}\n", protocol::kFailure, field(where), field(problem), field(remedy)));
}

void MessagePipe::writeLine(std::string line) const {
  if (descriptor_ < 0) return;
  // Lines are shorter than a pipe writes at once. A reader who has gone does not want them.
  while (::write(descriptor_, line.data(), line.size()) < 0 && errno == EINTR) {
  }
}

}  // namespace nearfit::importer
