#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/session/session.h"
#include "core/session/session_script.h"

namespace nearfit {

/// Records the commands of a session as a script. It keeps the commands that undo keeps: a step that is undone leaves the
/// script, and comes back when it is redone. If steps from before the recording are undone, it starts from there instead.
/// Single-threaded.
class ScriptRecorder {
 public:
  /// @param session  Outlives this.
  explicit ScriptRecorder(const Session& session, const ScriptLimits& limits = {})
      : session_(session), limits_(limits) {}

  /// Starts to record to a file, from the present scene; a recording that runs is dropped. Throws FileError if the file
  /// cannot be written, UsageError if it, or the file for the start, is the session's own, or if a file for the start is
  /// there although the script is not.
  void start(const std::filesystem::path& file);
  /// Takes in what has changed since the last call. To be called after each change of the session, from a listener.
  /// Another scene in the session is not followed: endsHere() is true from then on. Throws as commandJson(), if a mesh
  /// has a path that is not UTF-8; may be called again.
  void follow();
  /// Writes the script, and beside it the scene that it starts from if that is not empty, and ends the recording. Throws
  /// FileError, or UsageError if the scene was saved to the file for the start, or the script would exceed a limit; the
  /// recording then goes on, and nothing is written.
  void stop();
  /// Ends the recording; the file keeps what start() wrote, a script without commands.
  void drop() noexcept { isRecording_ = false; }

  bool isRecording() const noexcept { return isRecording_; }
  /// True if the session has another scene than the recording began with.
  bool endsHere() const noexcept { return isRecording_ && session_.sceneSerial() != sceneSerial_; }
  const std::filesystem::path& file() const noexcept { return file_; }
  /// Number of steps in the script so far.
  std::size_t steps() const noexcept { return isRecording_ ? entries_.size() - 1 : 0; }

  /// The file for the scene that a script starts from: "vise.start.nearfit" beside "vise.jsonl".
  static std::filesystem::path startFileOf(const std::filesystem::path& script);

 private:
  /// A state on the way from the start to the present one.
  struct Entry {
    std::uint64_t step, state;  ///< As in Session::Reached.
    std::string command;        ///< Line for the step; empty for the start.
    std::string
        records;  ///< Line for records that the step did not leave; empty if no later line reads them.
    bool hasRecords = false;  ///< The step did not leave the records of the state.
    bool isFinding = false;   ///< The command is one on findings, which reads the records.
  };
  void beginAt(std::size_t index);
  std::string recordsOf(const Session::Reached& reached) const;
  /// Gives the last entry its line for records.
  void setRecords(std::string line);
  /// True if the line for the records of the last entry's state was left out.
  bool lacksRecords() const;
  /// The whole script. Throws UsageError if it would exceed a limit.
  std::string textFrom(const std::optional<std::filesystem::path>& startFile) const;

  const Session& session_;
  ScriptLimits limits_;
  bool isRecording_ = false;
  std::filesystem::path file_;
  std::uint64_t sceneSerial_ = 0;
  Scene start_;
  std::vector<Entry> entries_;  ///< The start first.
};

}  // namespace nearfit
