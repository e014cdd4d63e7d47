#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/recovery/recovery_journal.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Identifies a process across boots; process IDs alone are reused.
struct ProcessIdentity {
  std::string boot;  ///< First digits of the kernel's boot ID, hexadecimal.
  int pid = 0;
  std::uint64_t start = 0;  ///< Start time, in clock ticks since boot.
  bool operator==(const ProcessIdentity&) const = default;
};

/// Identity of the calling process.
ProcessIdentity thisProcess();
/// True if the process still runs. A zombie counts as ended. A process that cannot be inspected counts as
/// running, to be safe.
bool isRunning(const ProcessIdentity& process);

/// Formats an identity for use in a file name: "0f3a9c12-4711-88123".
std::string textOf(const ProcessIdentity& process);
/// Parses textOf(); std::nullopt if the text is invalid.
std::optional<ProcessIdentity> processFromText(std::string_view text);

/// Work lost when a process died.
struct LostWork {
  std::filesystem::path journal;
  JournalHead head;
  std::chrono::system_clock::time_point time;  ///< Of the last change kept.
};

/// Result of RecoveryFolder::takeLost().
struct FoundWork {
  std::vector<LostWork> lost;                  ///< Newest first.
  std::vector<std::filesystem::path> damaged;  ///< Moved to these names in the folder.
  /// True if other running processes have journals; one of them may be about to die.
  bool areOthersRunning = false;
};

/// The user's folder of recovery journals, one per process. A journal's name identifies its process; no
/// process touches the journal of another that runs. No journal replaces one that was taken over or put aside.
/// Only the user can read folder and journals. Thread-safe as long as no two threads use the same journal.
class RecoveryFolder {
 public:
  /// How long files are kept after being set aside.
  static constexpr std::chrono::hours kKeptAside{24 * 30};

  /// @param folder  Created by the first write().
  /// @param self    Owner of the journal written here; other values are for tests.
  explicit RecoveryFolder(std::filesystem::path folder, ProcessIdentity self = thisProcess());

  /// Replaces this process's journal atomically. Throws FileError and keeps the old one.
  void write(const Scene& scene, const JournalHead& head);
  /// Removes this process's journal: nothing can be lost.
  void clear() noexcept;

  /// Takes over the journals of dead processes and returns the lost work. Each journal goes to one process
  /// only. Removes journals whose content is in their scene file. Sets aside journals that are damaged or
  /// older than their scene file, and removes what was set aside before kKeptAside, and what dead processes
  /// left half written. Never throws: an unreadable folder counts as empty.
  FoundWork takeLost();
  /// Removes a journal whose work was restored and is safe elsewhere.
  void forget(const LostWork& work) noexcept;
  /// Sets aside a journal that the user does not want; it can be recovered for kKeptAside.
  void discard(const LostWork& work) noexcept;

  const std::filesystem::path& path() const noexcept { return folder_; }

 private:
  std::filesystem::path ownJournal() const;
  /// Gives a journal a name of this process, whose number is the first from `number` on under which none is
  /// kept, neither as a journal nor put aside. Updates both; false if another process was first.
  bool claim(std::filesystem::path& journal, int& number);
  void examine(const std::filesystem::path& journal, FoundWork& found);
  void sweep() noexcept;

  std::filesystem::path folder_;
  ProcessIdentity self_;
};

/// The user's recovery folder, below $XDG_STATE_HOME, else ~/.local/state. Empty if neither is known; see
/// userFolder().
std::filesystem::path userRecoveryFolder();

}  // namespace nearfit
