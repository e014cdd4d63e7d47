#include "core/recovery/recovery_folder.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/user_folders.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

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

const char* const kJournalEnding = ".nearfit";
const char* const kAsideEndings[] = {".damaged", ".older", ".discarded"};

/// Parses "<process>.nearfit", or "<process>.<number>.nearfit" for a journal taken over.
std::optional<ProcessIdentity> ownerOf(const fs::path& journal) {
  if (journal.extension() != kJournalEnding) return std::nullopt;
  const std::string name = journal.stem().string();
  return processFromText(std::string_view(name).substr(0, name.find('.')));
}

void putAside(const fs::path& journal, const char* ending) noexcept {
  try {
    std::error_code failure;
    fs::rename(journal, fs::path(journal) += ending, failure);
  } catch (...) {
  }
}

/// True if no journal has this name, nor one that was put aside under it.
bool isFree(const fs::path& journal) {
  const auto isTaken = [&journal](const char* ending) {
    std::error_code failure;
    return fs::exists(fs::symlink_status(fs::path(journal) += ending, failure));
  };
  return !isTaken("") && std::ranges::none_of(kAsideEndings, isTaken);
}

std::vector<fs::path> filesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (fs::directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure)) {
    std::error_code ignored;
    if (it->is_regular_file(ignored)) files.push_back(it->path());
  }
  return files;
}

bool isSavedAfter(const fs::path& sceneFile, fs::file_time_type journal) {
  std::error_code failure;
  const fs::file_time_type saved = fs::last_write_time(sceneFile, failure);
  return !failure && saved > journal;
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

RecoveryFolder::RecoveryFolder(fs::path folder, ProcessIdentity self)
    : folder_(std::move(folder)), self_(std::move(self)) {}

fs::path RecoveryFolder::ownJournal() const {
  return folder_ / (textOf(self_) + kJournalEnding);
}

void RecoveryFolder::write(const Scene& scene, const JournalHead& head) {
  const std::string text = journalText(scene, head);
  std::error_code failure;
  fs::create_directories(folder_.parent_path(), failure);
  // Private from the start.
  if (::mkdir(folder_.c_str(), S_IRWXU) == 0 || fs::is_directory(folder_, failure))
    fs::permissions(folder_, fs::perms::owner_all, failure);
  atomicWrite(ownJournal(), text, FileAccess::Private);
}

void RecoveryFolder::clear() noexcept {
  try {
    std::error_code failure;
    fs::remove(ownJournal(), failure);
  } catch (...) {
  }
}

bool RecoveryFolder::claim(fs::path& journal, int& number) {
  // Renames are atomic: if two processes try, one of them fails.
  for (;; ++number) {
    const fs::path mine = folder_ / fmt::format("{}.{}{}", textOf(self_), number, kJournalEnding);
    if (!isFree(mine)) continue;
    std::error_code failure;
    fs::rename(journal, mine, failure);
    if (failure) return false;
    journal = mine;
    return true;
  }
}

void RecoveryFolder::examine(const fs::path& journal, FoundWork& found) {
  LostWork work{journal, {}, {}};
  std::error_code failure;
  const fs::file_time_type written = fs::last_write_time(journal, failure);
  try {
    work.head = readJournalHead(journal);
  } catch (const Error&) {
    putAside(journal, ".damaged");
    found.damaged.push_back(fs::path(journal) += ".damaged");
    return;
  }
  if (isSaved(journal, work.head)) return forget(work);
  if (isSavedAfter(work.head.scene, written)) return putAside(journal, ".older");
  work.time = std::chrono::file_clock::to_sys(written);
  found.lost.push_back(std::move(work));
}

FoundWork RecoveryFolder::takeLost() {
  FoundWork found;
  try {
    sweep();
    int number = 1;
    for (fs::path journal : filesIn(folder_)) {
      const std::optional<ProcessIdentity> owner = ownerOf(journal);
      if (!owner || *owner == self_) continue;
      if (isRunning(*owner))
        found.areOthersRunning = true;
      else if (claim(journal, number))
        examine(journal, found);
    }
  } catch (...) {
    // Return what was found so far; the rest stays for the next time.
  }
  std::ranges::sort(found.lost, std::greater<>(), &LostWork::time);
  return found;
}

void RecoveryFolder::forget(const LostWork& work) noexcept {
  std::error_code failure;
  fs::remove(work.journal, failure);
}

void RecoveryFolder::discard(const LostWork& work) noexcept {
  putAside(work.journal, ".discarded");
}

void RecoveryFolder::sweep() noexcept {
  // Half of a journal, of which the process that died has an earlier one, whole.
  removeAbandoned(folder_);
  try {
    const fs::file_time_type limit = fs::file_time_type::clock::now() - kKeptAside;
    for (const fs::path& file : filesIn(folder_)) {
      std::error_code failure;
      const bool isAside = std::ranges::find(kAsideEndings, file.extension()) != std::end(kAsideEndings);
      if (isAside && fs::last_write_time(file, failure) < limit && !failure) fs::remove(file, failure);
    }
  } catch (...) {
  }
}

fs::path userRecoveryFolder() {
  const fs::path folder = userFolder(UserFiles::State);
  return folder.empty() ? folder : folder / "recovery";
}

}  // namespace nearfit
