#include "core/session/script_recorder.h"

#include <optional>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/scene/scene_file.h"
#include "core/session/command_json.h"
#include "core/session/session_script.h"

namespace nearfit {
namespace {

/// Place in the history, up to the present state, of the state that a step led to.
std::optional<std::size_t> indexOfStep(const Session& session, std::uint64_t step) {
  for (std::size_t i = session.historyIndex() + 1; i-- > 0;) {
    const std::uint64_t each = session.reached(i).step;
    if (each == step) return i;
    if (each < step) break;  // They ascend.
  }
  return std::nullopt;
}

}  // namespace

std::filesystem::path ScriptRecorder::startFileOf(const std::filesystem::path& script) {
  std::filesystem::path file = script;
  return file.replace_extension(".start.nearfit");
}

void ScriptRecorder::start(const std::filesystem::path& file) {
  const std::filesystem::path startFile = startFileOf(file);
  for (const std::filesystem::path& target : {file, startFile}) {
    checkReplaceable(target);
    if (!session_.file().empty() && isSameTarget(target, session_.file()))
      throw UsageError(target.string(), "this is the file of the open scene", "record to another file");
  }
  // Who agreed to replace a script agreed to replace its start scene, and no other.
  if (!std::filesystem::exists(file) && std::filesystem::exists(startFile))
    throw UsageError(startFile.string(), "the recording's start would replace this scene",
                     "record under another name");
  // A folder that nothing can be written to is better found now than at the end.
  atomicWrite(file, scriptHead({}) + "\n");
  file_ = file;
  sceneSerial_ = session_.sceneSerial();
  isRecording_ = true;
  beginAt(session_.historyIndex());
}

void ScriptRecorder::beginAt(std::size_t index) {
  const Session::Reached reached = session_.reached(index);
  start_ = reached.scene;
  entries_.clear();
  entries_.push_back({reached.step, reached.state, {}, {}});
}

std::string ScriptRecorder::recordsOf(const Session::Reached& reached) const {
  const steps::SetPairRecords records{reached.scene.pairRecords()};
  return commandJson(records, reached.scene, file_).dump();
}

void ScriptRecorder::follow() {
  if (!isRecording_ || endsHere()) return;
  std::optional<std::size_t> kept = indexOfStep(session_, entries_.back().step);
  while (!kept && entries_.size() > 1) {
    entries_.pop_back();
    kept = indexOfStep(session_, entries_.back().step);
  }
  if (!kept) return beginAt(session_.historyIndex());
  const Session::Reached last = session_.reached(*kept);
  if (last.state != entries_.back().state) {
    // At the start, a step is not known to have left other records.
    const bool isAsBefore = entries_.size() == 1 && last.scene.pairRecords() == start_.pairRecords();
    entries_.back().records = isAsBefore ? std::string() : recordsOf(last);
    entries_.back().state = last.state;
  }
  for (std::size_t i = *kept + 1; i <= session_.historyIndex(); ++i) {
    const Session::Reached reached = session_.reached(i);
    Entry entry{reached.step, reached.state, {}, {}};
    entry.command = commandJson(*reached.command, session_.reached(i - 1).scene, file_).dump();
    if (reached.restatesRecords) entry.records = recordsOf(reached);
    entries_.push_back(std::move(entry));
  }
}

void ScriptRecorder::stop() {
  if (!isRecording_) return;
  const std::filesystem::path startFile = startFileOf(file_);
  const bool isFromEmpty = sceneFileText(start_, startFile) == sceneFileText({}, startFile);
  if (!isFromEmpty && !session_.file().empty() && isSameTarget(startFile, session_.file()))
    throw UsageError(startFile.string(),
                     "the scene was saved to this file, which is for the start of the recording",
                     "save the scene to another file, which leaves this one to the recording");
  std::string text = scriptHead(isFromEmpty ? std::nullopt : std::optional(startFile)) + "\n";
  for (const Entry& entry : entries_) {
    for (const std::string* line : {&entry.command, &entry.records})
      if (!line->empty()) text += *line + "\n";
  }
  if (!isFromEmpty) writeSceneFile(start_, startFile);
  atomicWrite(file_, text);
  isRecording_ = false;
}

}  // namespace nearfit
