#include "core/session/script_recorder.h"

#include <algorithm>
#include <ranges>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/scene/scene_file.h"
#include "core/session/command_json.h"

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
  entries_.push_back({reached.step, reached.state, {}, {}, false, false});
}

std::string ScriptRecorder::recordsOf(const Session::Reached& reached) const {
  const steps::SetPairRecords records{reached.scene.pairRecords()};
  return commandJson(records, reached.scene, file_).dump();
}

void ScriptRecorder::setRecords(std::string line) {
  entries_.back().records = std::move(line);
  entries_.back().hasRecords = true;
  // Each check restates all records, megabytes of them in a large scene. Only commands on findings read those before.
  for (std::size_t i = entries_.size() - 1; i > 0 && !entries_[i].isFinding; --i) {
    Entry& before = entries_[i - 1];
    if (!before.hasRecords) continue;
    before.records = std::string();
    return;
  }
}

bool ScriptRecorder::lacksRecords() const {
  const auto newestFirst = std::views::reverse(entries_);
  const auto last = std::ranges::find(newestFirst, true, &Entry::hasRecords);
  return last != newestFirst.end() && last->records.empty();
}

void ScriptRecorder::follow() {
  if (!isRecording_ || endsHere()) return;
  const std::size_t count = entries_.size();
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
    if (isAsBefore) {
      entries_.back().records.clear();
      entries_.back().hasRecords = false;
    } else {
      setRecords(recordsOf(last));
    }
    entries_.back().state = last.state;
  } else if (entries_.size() < count && lacksRecords()) {
    // The step that restated them was undone.
    setRecords(recordsOf(last));
  }
  for (std::size_t i = *kept + 1; i <= session_.historyIndex(); ++i) {
    const Session::Reached reached = session_.reached(i);
    Entry entry{reached.step, reached.state, {}, {}, false, false};
    entry.command = commandJson(*reached.command, session_.reached(i - 1).scene, file_).dump();
    entry.isFinding = std::holds_alternative<steps::SetFindingState>(*reached.command);
    std::string records = reached.restatesRecords ? recordsOf(reached) : std::string();
    entries_.push_back(std::move(entry));
    if (reached.restatesRecords) setRecords(std::move(records));
  }
}

std::string ScriptRecorder::textFrom(const std::optional<std::filesystem::path>& startFile) const {
  std::string text = scriptHead(startFile) + "\n";
  std::size_t count = 1;
  const auto add = [&](const std::string& line) {
    if (line.empty()) return;
    ++count;
    const bool isTooMuch = line.size() > limits_.maxLineBytes ||
                           text.size() + line.size() + 1 > limits_.maxBytes || count > limits_.maxLines;
    if (isTooMuch) {
      throw UsageError(
          file_.string(),
          fmt::format("the recorded commands exceed the limits of a script, which are {} bytes, {} bytes in "
                      "a line and {} lines",
                      limits_.maxBytes, limits_.maxLineBytes, limits_.maxLines),
          "undo the last ones and stop; then redo them and record them to another script");
    }
    text += line;
    text += '\n';
  };
  for (const Entry& entry : entries_) {
    add(entry.command);
    add(entry.records);
  }
  return text;
}

void ScriptRecorder::stop() {
  if (!isRecording_) return;
  const std::filesystem::path startFile = startFileOf(file_);
  const bool isFromEmpty = sceneFileText(start_, startFile) == sceneFileText({}, startFile);
  if (!isFromEmpty && !session_.file().empty() && isSameTarget(startFile, session_.file()))
    throw UsageError(startFile.string(),
                     "the scene was saved to this file, which is for the start of the recording",
                     "save the scene to another file, which leaves this one to the recording");
  const std::string text = textFrom(isFromEmpty ? std::nullopt : std::optional(startFile));
  if (!isFromEmpty) writeSceneFile(start_, startFile);
  atomicWrite(file_, text);
  isRecording_ = false;
}

}  // namespace nearfit
