#include "core/session/session_script.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/scene/scene_file.h"
#include "core/scene/scene_json.h"
#include "core/session/command_json.h"
#include "core/text/json_file.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr const char* kVersionKey = "nearfitScript";
constexpr const char* kLineRemedy = "correct this line, or take it out";

/// "FILE:LINE".
std::filesystem::path scriptPlace(const std::filesystem::path& script, std::size_t line) {
  return script.string() + ":" + std::to_string(line);
}

/// The error with the place of the line before whatever else says where it is, and with a remedy.
FileError atLine(const std::filesystem::path& place, const Error& e) {
  const std::string at = place.string();
  const std::string remedy = e.remedy().empty() ? kLineRemedy : e.remedy();
  std::string where = e.where();
  if (where.starts_with(at)) {
    // The JSON reader counts lines too, and sees one alone: "FILE:12:1:7" becomes "FILE:12:7".
    const std::string first = at + ":1:";
    if (where.starts_with(first)) where = at + ":" + where.substr(first.size());
    return {where, e.problem(), remedy};
  }
  return {at, where.empty() ? e.problem() : where + ": " + e.problem(), remedy};
}

JsonLimits lineLimits() {
  JsonLimits limits;
  limits.maxBytes = kMaxScriptLineBytes;
  return limits;
}

bool isBlank(std::string_view text) {
  return text.find_first_not_of(" \t\r") == std::string_view::npos;
}

void readHead(const std::string& text, const std::filesystem::path& place, SessionScript& script) {
  const nlohmann::json json = readJsonText(text, place, lineLimits());
  const JsonField head(json, place);
  if (!head.has(kVersionKey)) {
    head.fail(fmt::format("it is not a script of Nearfit: the key \"{}\" is missing", kVersionKey),
              fmt::format(R"(begin the file with {{"{}": {}}})", kVersionKey, kScriptVersion));
  }
  const double version = head.at(kVersionKey).number();
  if (version != kScriptVersion) {
    head.at(kVersionKey)
        .fail(fmt::format("this is version {} of the script format, but this program reads version {}",
                          version, kScriptVersion),
              "replay it with the Nearfit that made it, or record it again");
  }
  if (!head.has("scene") || head.at("scene").isNull()) return;
  const std::string scene = head.at("scene").text(kMaxPathBytes);
  if (scene.empty())
    head.at("scene").fail("it is empty", "name a scene file, or give null for an empty scene");
  script.scene = meshFolder(script.file) / scene;
}

/// Carries out one line.
/// @param progress  Fraction of the line.
void replayLine(const SessionScript& script, const SessionScript::Line& line, Session& session,
                const ProgressCallback& progress) {
  const std::filesystem::path place = scriptPlace(script.file, line.number);
  try {
    const nlohmann::json json = readJsonText(line.text, place, lineLimits());
    session.apply(readCommand(JsonField(json, place), session.scene(), meshFolder(script.file), progress));
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    throw atLine(place, e);
  }
}

}  // namespace

std::string scriptHead(const std::optional<std::filesystem::path>& scene) {
  nlohmann::ordered_json json;
  json[kVersionKey] = kScriptVersion;
  const std::string name = scene ? scene->filename().string() : std::string();
  if (!isUtf8(name)) {
    throw FileError(printableText(name), "the name of this scene file is not UTF-8",
                    "give the script another name");
  }
  json["scene"] = scene ? nlohmann::ordered_json(name) : nlohmann::ordered_json();
  return json.dump();
}

SessionScript readScript(const std::filesystem::path& file) {
  // Opened once: another file may take its place meanwhile.
  InputFile input(file);
  if (input.size() > kMaxScriptBytes) {
    throw FileError(file.string(), fmt::format("it is larger than {} bytes", kMaxScriptBytes),
                    "check that it is the right file");
  }
  const std::vector<char> bytes = input.readAll();
  SessionScript script{file, {}, {}};
  std::string_view rest(bytes.data(), bytes.size());
  bool hasHead = false;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string text(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::filesystem::path place = scriptPlace(file, number);
    if (number > kMaxScriptLines) {
      throw FileError(place.string(), fmt::format("there are more than {} lines", kMaxScriptLines),
                      "split the script");
    }
    if (isBlank(text)) continue;
    if (hasHead) {
      script.lines.push_back({number, text});
      continue;
    }
    try {
      readHead(text, place, script);
    } catch (const Error& e) {
      throw atLine(place, e);
    }
    hasHead = true;
  }
  if (!hasHead) {
    throw FileError(file.string(), "it is empty",
                    fmt::format(R"(begin the file with {{"{}": {}}})", kVersionKey, kScriptVersion));
  }
  return script;
}

Scene startOf(const SessionScript& script, const ProgressCallback& progress,
              std::vector<std::filesystem::path>* changedMeshes) {
  if (!script.scene) return {};
  std::vector<std::filesystem::path> changed;
  Scene scene = readSceneFile(*script.scene, progress, &changed);
  if (changedMeshes != nullptr) *changedMeshes = std::move(changed);
  return scene;
}

void replay(const SessionScript& script, Session& session, const ProgressCallback& progress) {
  const auto count = static_cast<double>(script.lines.size());
  for (std::size_t i = 0; i < script.lines.size(); ++i) {
    const ProgressCallback ofLine =
        stageCallback(progress, static_cast<double>(i) / count, static_cast<double>(i + 1) / count);
    if (!ofLine(0.0)) throw Cancelled();
    replayLine(script, script.lines[i], session, ofLine);
  }
}

}  // namespace nearfit
