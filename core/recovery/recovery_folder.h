#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/recovery/process_identity.h"
#include "core/recovery/recovery_journal.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Work that a process took with it when it died.
struct LostWork {
  std::filesystem::path journal;
  JournalHead head;
  std::chrono::system_clock::time_point time;  ///< Of the last change that was kept.
};

/// What a look at the folder found.
struct FoundWork {
  std::vector<LostWork> lost;                  ///< Newest first.
  std::vector<std::filesystem::path> damaged;  ///< Kept aside there.
  /// There are journals of other processes that run, of which one may be about to end.
  bool areOthersRunning = false;
};

/// The user's folder of recovery journals, one a process, its name saying whose it is: no process touches
/// that of another that runs. Folder and journals are the user's alone to read. Any thread, but one at a time
/// on one journal.
class RecoveryFolder {
 public:
  /// How long what was put aside is kept.
  static constexpr std::chrono::hours kKeptAside{24 * 30};

  /// @param folder  Made when it is first written to.
  /// @param self    Whose journal this writes; another only in tests.
  explicit RecoveryFolder(std::filesystem::path folder, ProcessIdentity self = thisProcess());

  /// Replaces this process's journal, as one step. Throws FileError and leaves the old one.
  void write(const Scene& scene, const JournalHead& head);
  /// Removes this process's journal: there is nothing to lose.
  void clear() noexcept;

  /// Takes over the journals of processes that have died, each by one process only, and says which hold what
  /// was lost. What its file holds too is removed; what its file was saved after, and what is damaged, is put
  /// aside. What was put aside long ago is removed. Never throws: a folder that cannot be read holds nothing.
  FoundWork takeLost();
  /// Removes a journal whose work is restored and kept otherwise.
  void forget(const LostWork& work) noexcept;
  /// Puts a journal aside that the user does not want; it can be had back for kKeptAside.
  void discard(const LostWork& work) noexcept;

  const std::filesystem::path& path() const noexcept { return folder_; }

 private:
  std::filesystem::path ownJournal() const;
  bool claim(std::filesystem::path& journal);
  void examine(const std::filesystem::path& journal, FoundWork& found);
  void sweep() noexcept;

  std::filesystem::path folder_;
  ProcessIdentity self_;
};

/// The folder of this user: below $XDG_STATE_HOME, else ~/.local/state. Empty when there is neither that nor
/// a home.
std::filesystem::path userRecoveryFolder();

}  // namespace nearfit
