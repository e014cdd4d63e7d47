#include "core/recovery/recovery_folder.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/user_folders.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

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

bool RecoveryFolder::claim(fs::path& journal) {
  // Renames are atomic: if two processes try, one of them fails.
  for (int number = 1;; ++number) {
    const fs::path mine = folder_ / fmt::format("{}.{}{}", textOf(self_), number, kJournalEnding);
    std::error_code failure;
    if (fs::exists(fs::symlink_status(mine, failure))) continue;
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
    for (fs::path journal : filesIn(folder_)) {
      const std::optional<ProcessIdentity> owner = ownerOf(journal);
      if (!owner || *owner == self_) continue;
      if (isRunning(*owner))
        found.areOthersRunning = true;
      else if (claim(journal))
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
  try {
    const fs::file_time_type limit = fs::file_time_type::clock::now() - kKeptAside;
    for (const fs::path& file : filesIn(folder_)) {
      std::error_code failure;
      const bool isAside = std::ranges::find(kAsideEndings, file.extension()) != std::end(kAsideEndings);
      // Left by a process that died while writing.
      const bool isHalfWritten = file.filename().string().starts_with(".nearfit-");
      if ((isAside || isHalfWritten) && fs::last_write_time(file, failure) < limit && !failure)
        fs::remove(file, failure);
    }
  } catch (...) {
  }
}

fs::path userRecoveryFolder() {
  const fs::path folder = userFolder(UserFiles::State);
  return folder.empty() ? folder : folder / "recovery";
}

}  // namespace nearfit
