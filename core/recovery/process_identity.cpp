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

/// From /proc/<pid>/stat (proc(5)).
struct ProcessState {
  bool hasEnded = false;  ///< A zombie, waiting for its parent, or dead.
  std::uint64_t start = 0;
};

/// Reads fields 3 and 22. The name before them is in parentheses and may contain anything.
std::optional<ProcessState> stateOf(int pid) {
  const std::string stat = wholeText(fmt::format("/proc/{}/stat", pid));
  const std::size_t name = stat.rfind(')');
  if (name == std::string::npos) return std::nullopt;
  std::istringstream fields(stat.substr(name + 1));
  char state = 0;
  fields >> state;
  constexpr int kFieldsBetween = 18;
  std::string skipped;
  for (int i = 0; i < kFieldsBetween; ++i)
    fields >> skipped;
  ProcessState result;
  result.hasEnded = state == 'Z' || state == 'X';
  if (!(fields >> result.start)) return std::nullopt;
  return result;
}

template <typename Number>
bool parse(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

ProcessIdentity thisProcess() {
  const int pid = ::getpid();
  const std::optional<ProcessState> state = stateOf(pid);
  return {thisBoot(), pid, state ? state->start : 0};
}

bool isRunning(const ProcessIdentity& process) {
  if (process.boot != thisBoot() || process.pid <= 0) return false;
  if (::kill(process.pid, 0) != 0 && errno == ESRCH) return false;
  const std::optional<ProcessState> state = stateOf(process.pid);
  return !state || (!state->hasEnded && state->start == process.start);
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
