#include "core/recovery/process_identity.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

namespace nearfit {
namespace {

constexpr std::size_t kBootDigits = 8;

std::string wholeText(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string thisBoot() {
  std::string id = wholeText("/proc/sys/kernel/random/boot_id");
  std::erase_if(id, [](unsigned char c) { return std::isxdigit(c) == 0; });
  id.resize(kBootDigits, '0');
  return id;
}

/// Field 22 of proc(5)'s stat; the name before it stands in parentheses and may hold anything.
std::optional<std::uint64_t> startOf(int pid) {
  const std::string stat = wholeText(fmt::format("/proc/{}/stat", pid));
  const std::size_t name = stat.rfind(')');
  if (name == std::string::npos) return std::nullopt;
  std::istringstream fields(stat.substr(name + 1));
  constexpr int kFieldsBefore = 19;
  std::string skipped;
  for (int i = 0; i < kFieldsBefore; ++i)
    fields >> skipped;
  std::uint64_t start = 0;
  if (!(fields >> start)) return std::nullopt;
  return start;
}

template <typename Number>
bool parse(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

ProcessIdentity thisProcess() {
  const int pid = ::getpid();
  return {thisBoot(), pid, startOf(pid).value_or(0)};
}

bool isRunning(const ProcessIdentity& process) {
  if (process.boot != thisBoot() || process.pid <= 0) return false;
  if (::kill(process.pid, 0) != 0 && errno == ESRCH) return false;
  const std::optional<std::uint64_t> start = startOf(process.pid);
  return !start || *start == process.start;
}

std::string textOf(const ProcessIdentity& process) {
  return fmt::format("{}-{}-{}", process.boot, process.pid, process.start);
}

std::optional<ProcessIdentity> processFromText(std::string_view text) {
  const std::size_t first = text.find('-'), second = text.find('-', first + 1);
  if (first != kBootDigits || second == std::string_view::npos) return std::nullopt;
  ProcessIdentity process;
  process.boot = text.substr(0, first);
  const bool isHex = std::ranges::all_of(process.boot, [](unsigned char c) { return std::isxdigit(c) != 0; });
  if (!isHex || !parse(text.substr(first + 1, second - first - 1), process.pid) ||
      !parse(text.substr(second + 1), process.start) || process.pid <= 0)
    return std::nullopt;
  return process;
}

}  // namespace nearfit
