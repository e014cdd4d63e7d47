#include "app/cli/scene_finding_command.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/output.h"
#include "app/cli/rule_options.h"
#include "app/cli/scene_part.h"
#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "core/text/utf8.h"
#include "core/verdict/finding_states.h"

namespace nearfit::cli {
namespace {

struct SceneFindingOptions {
  std::string scene;
  std::vector<std::string> accepted, fixed, reopened;
  bool isJson = false;
};

/// A state that the user gives findings.
struct GivenState {
  std::vector<PartPair> pairs;
  FindingState state = FindingState::New;
  std::string reason;
};

/// The findings of parts with these names, in either order. Throws UsageError if there is none.
std::vector<PartPair> findingsOf(const Scene& scene, const std::string& option, const NamePair& names) {
  for (const std::string& pattern : {names.part, names.other}) {
    if (!isNameOfPart(scene, pattern))
      throw UsageError(option, fmt::format("there is no part \"{}\"", pattern), "name parts of the scene");
  }
  std::vector<PartPair> pairs;
  for (const PairRecord& record : scene.pairRecords()) {
    const std::string &part = scene.get(record.pair.part).name, &other = scene.get(record.pair.other).name;
    const bool isIt = (matchesPattern(names.part, part) && matchesPattern(names.other, other)) ||
                      (matchesPattern(names.part, other) && matchesPattern(names.other, part));
    if (isIt) pairs.push_back(record.pair);
  }
  if (pairs.empty())
    throw UsageError(option,
                     fmt::format("the scene keeps no finding of \"{}\" and \"{}\"", names.part, names.other),
                     "name a pair that is listed without options, or check the scene again (clearance SCENE "
                     "--all --save)");
  return pairs;
}

std::string trimmedReason(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == text.npos ? std::string() : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Throws UsageError if a reason would not be kept.
void checkReason(const std::string& option, const std::string& names, const std::string& reason) {
  if (reason.empty())
    throw UsageError(option, fmt::format("no reason is given for \"{}\"", names),
                     "give A:B=WHY, such as A:B='glued'");
  if (reason.size() > kMaxReasonBytes)
    throw UsageError(option, fmt::format("the reason for \"{}\" is {} bytes long", names, reason.size()),
                     fmt::format("give at most {} bytes, in which letters beyond ASCII take more than one",
                                 kMaxReasonBytes));
  if (!isPrintableUtf8(reason))
    throw UsageError(option, fmt::format("the reason for \"{}\" is not printable UTF-8", names),
                     "give one line of text");
}

/// Parses "A:B=WHY". The name of B may contain a '=': WHY follows the first one behind the name of a part.
GivenState parseAccepted(const Scene& scene, const std::string& text) {
  const std::string option = "--accept";
  const std::size_t colon = findUnescaped(text, ':');
  const std::size_t first = colon == text.npos ? text.npos : findUnescaped(text, '=', colon + 1);
  if (first == text.npos)
    throw UsageError(option, fmt::format("\"{}\" has no reason", text), "give A:B=WHY, such as A:B='glued'");
  std::size_t split = first;
  while (split != text.npos && !isNameOfPart(scene, text.substr(colon + 1, split - colon - 1)))
    split = findUnescaped(text, '=', split + 1);
  if (split == text.npos) split = first;
  const std::string names = text.substr(0, split);
  GivenState given{{}, FindingState::Accepted, trimmedReason(text.substr(split + 1))};
  given.pairs = findingsOf(scene, option, parseNamePair(option, names));
  checkReason(option, names, given.reason);
  return given;
}

std::vector<GivenState> givenStates(const Scene& scene, const SceneFindingOptions& options) {
  std::vector<GivenState> given;
  for (const std::string& text : options.accepted)
    given.push_back(parseAccepted(scene, text));
  const auto add = [&](const char* option, const std::vector<std::string>& texts, FindingState state) {
    for (const std::string& text : texts)
      given.push_back({findingsOf(scene, option, parseNamePair(option, text)), state, {}});
  };
  add("--fixed", options.fixed, FindingState::Fixed);
  add("--reopen", options.reopened, FindingState::New);
  return given;
}

/// Throws UsageError if a finding is given two states: none of them would be sure to stay.
void checkNoneTwice(const Scene& scene, const std::vector<GivenState>& given) {
  std::vector<PartPair> pairs;
  for (const GivenState& each : given)
    pairs.insert(pairs.end(), each.pairs.begin(), each.pairs.end());
  std::ranges::sort(pairs);
  const auto twice = std::ranges::adjacent_find(pairs);
  if (twice == pairs.end()) return;
  throw UsageError("scene finding",
                   fmt::format("two options name the finding of \"{}\" and \"{}\"",
                               scene.get(twice->part).name, scene.get(twice->other).name),
                   "give it one state");
}

std::string findingLine(const Scene& scene, const PairRecord& record) {
  std::string line = fmt::format("{} and {}: {}", scene.get(record.pair.part).name,
                                 scene.get(record.pair.other).name, wordOf(record.verdict));
  if (record.depth) {
    line += fmt::format(", depth {:.4g} m", *record.depth);
  } else if (record.verdict == PairVerdict::Near) {
    line += fmt::format(", distance {:.4g} m", record.distance);
  }
  line += fmt::format("; {}", stateWord(record.state, record.reason));
  return record.reason.empty() ? line : line + ": " + record.reason;
}

void printFindings(const Scene& scene, bool isJson) {
  if (isJson) {
    nlohmann::ordered_json findings = nlohmann::ordered_json::array();
    for (const PairRecord& record : scene.pairRecords())
      findings.push_back(
          {{"part", scene.get(record.pair.part).name},
           {"other", scene.get(record.pair.other).name},
           {"verdict", wordOf(record.verdict)},
           {"distance", record.distance},
           {"depth", record.depth ? nlohmann::ordered_json(*record.depth) : nlohmann::ordered_json()},
           {"state", stateWord(record.state, record.reason)},
           {"reason", record.reason}});
    return print(findings.dump() + "\n");
  }
  if (scene.pairRecords().empty()) print("no findings\n");
  for (const PairRecord& record : scene.pairRecords())
    print(oneLine(findingLine(scene, record)) + "\n");
}

void runSceneFinding(const SceneFindingOptions& options) {
  Scene scene = readSceneFile(options.scene);
  const std::vector<PairRecord> before = scene.pairRecords();
  const std::vector<GivenState> given = givenStates(scene, options);
  checkNoneTwice(scene, given);
  for (const GivenState& each : given)
    scene.setFindingState(each.pairs, each.state, each.reason);
  // Certificates name the file's hash, so that it stays as it is where nothing changes.
  if (scene.pairRecords() != before) writeSceneFile(scene, options.scene);
  printFindings(scene, options.isJson);
}

constexpr const char* kFindingFooter =
    "Lists the findings that the scene keeps of its last check (clearance --all --save, or Check scene in "
    "the\n"
    "window) with their states, after those that are named get others; the scene file is replaced only if "
    "one\n"
    "changes. Certificates that name the hash of the scene file are refused from then on.\n"
    "A and B are names of parts in either order, or patterns: * stands for any characters, ? for one, a "
    "backslash\n"
    "takes the next one as it is, such as : in a name. WHY, at most 200 bytes of text, follows the first = "
    "behind\n"
    "the name of a part. A finding that is accepted stays so until it becomes worse, or has another "
    "verdict.\n"
    "Example: nearfit-cli scene finding pump.nearfit --accept 'Bush:Housing=pressed in' --reopen Lid:Housing";

}  // namespace

void addSceneFinding(CLI::App& scene) {
  const auto options = std::make_shared<SceneFindingOptions>();
  CLI::App* command =
      scene.add_subcommand("finding", "Lists the findings of the last check, and sets their states.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  const auto add = [&](const char* name, std::vector<std::string>& texts, const char* form,
                       const char* help) {
    command->add_option(name, texts, help)->allow_extra_args(false)->type_name(form);
  };
  add("--accept", options->accepted, "A:B=WHY", "The finding may stay, for this reason; repeat it for more");
  add("--fixed", options->fixed, "A:B", "Mark the finding as fixed; repeat it for more");
  add("--reopen", options->reopened, "A:B", "Mark the finding as new again; repeat it for more");
  command->add_flag("--json", options->isJson, "List the findings as JSON");
  command->footer(kFindingFooter);
  command->callback([options] { runSceneFinding(*options); });
}

}  // namespace nearfit::cli
