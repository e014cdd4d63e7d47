#include "app/cli/scene_check_run.h"

#include <filesystem>
#include <optional>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "app/cli/progress_line.h"
#include "app/cli/scene_part.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/report/scene_check_export.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

constexpr const char* kStdout = "-";

/// Position of the first separator without a backslash before it; npos if there is none.
std::size_t findUnescaped(const std::string& text, char separator) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == separator) {
      return i;
    }
  }
  return text.npos;
}

/// Parses "A:B".
PairRule parsePairRule(const std::string& option, const std::string& text, PairRuleKind kind) {
  const std::size_t colon = findUnescaped(text, ':');
  if (colon == text.npos)
    throw UsageError(
        option, fmt::format("\"{}\" does not name two parts", text),
        "give A:B, names or patterns with * and ?; a backslash takes the next character as it is");
  PairRule rule{kind, text.substr(0, colon), text.substr(colon + 1)};
  try {
    checkPattern(rule.part);
    checkPattern(rule.other);
  } catch (const UsageError& e) {
    throw UsageError(option, fmt::format("\"{}\": {}", text, e.problem()), e.remedy());
  }
  return rule;
}

/// Parses "A:B=0.02mm".
PairRule parsePressFit(const std::string& text) {
  constexpr const char* kOption = "--press-fit";
  const std::size_t equals = text.rfind('=');
  if (equals == text.npos)
    throw UsageError(kOption, fmt::format("\"{}\" has no interference", text),
                     "give A:B=LENGTH, such as A:B=0.02mm");
  PairRule rule = parsePairRule(kOption, text.substr(0, equals), PairRuleKind::PressFit);
  rule.interference = parseLength(kOption, text.substr(equals + 1));
  try {
    checkPairRule(rule);
  } catch (const UsageError& e) {
    throw UsageError(kOption, e.problem(), e.remedy());
  }
  return rule;
}

/// Rules of the command line come first: they are what is asked for now.
std::vector<PairRule> rulesFor(const Scene& scene, const SceneCheckOptions& options) {
  std::vector<PairRule> rules;
  for (const std::string& text : options.leaveOut)
    rules.push_back(parsePairRule("--leave-out", text, PairRuleKind::LeaveOut));
  if (options.leaveOutGroups) rules.push_back({PairRuleKind::SameGroup});
  for (const std::string& text : options.touching)
    rules.push_back(parsePairRule("--touching", text, PairRuleKind::Touching));
  for (const std::string& text : options.pressFit)
    rules.push_back(parsePressFit(text));
  rules.insert(rules.end(), scene.pairRules().begin(), scene.pairRules().end());
  return rules;
}

/// Throws UsageError if an output would replace an input or the other output.
void checkCheckOutputs(const std::filesystem::path& sceneFile, const Scene& scene,
                       const SceneCheckOptions& options) {
  const bool areBoth = !options.json.empty() && !options.csv.empty();
  const bool isOne = areBoth && (options.json == kStdout || options.csv == kStdout
                                     ? options.json == options.csv
                                     : isSameTarget(options.json, options.csv));
  if (isOne) throw UsageError("--csv", "it is where the JSON goes", "name another file");
  for (const std::string& target : {options.json, options.csv}) {
    if (target.empty() || target == kStdout) continue;
    checkTarget(target, std::span(&sceneFile, 1));
    checkTarget(target, partFiles(scene));
  }
}

void writeTo(const std::string& target, const std::string& text) {
  if (target == kStdout) {
    print(text);
  } else {
    atomicWrite(target, text);
  }
}

}  // namespace

void addSceneCheckOptions(CLI::App& command, CLI::Option& all,
                          const std::shared_ptr<SceneCheckOptions>& options) {
  const auto addRules = [&](const char* name, std::vector<std::string>& rules, const char* form,
                            const char* help) {
    command.add_option(name, rules, help)->allow_extra_args(false)->type_name(form)->needs(&all);
  };
  command
      .add_option("--threshold", options->threshold,
                  "With --all: find pairs no farther apart [m, or with a unit]; default: the scene's cutoff")
      ->type_name("D")
      ->needs(&all);
  command.add_option("--json", options->json, "With --all: write all findings as JSON; - for stdout")
      ->type_name("FILE")
      ->needs(&all);
  command.add_option("--csv", options->csv, "With --all: write the findings as CSV; - for stdout")
      ->type_name("FILE")
      ->needs(&all);
  addRules("--leave-out", options->leaveOut, "A:B", "With --all: do not check parts A with parts B");
  command
      .add_flag("--leave-out-groups", options->leaveOutGroups,
                "With --all: do not check parts directly in one group with each other")
      ->needs(&all);
  addRules("--touching", options->touching, "A:B", "With --all: A and B are meant to touch");
  addRules("--press-fit", options->pressFit, "A:B=D", "With --all: A and B may overlap up to this depth");
}

void runSceneCheck(const std::string& sceneFile, const SceneCheckOptions& options) {
  const InterruptGuard interrupt;
  std::optional<SceneCheck> check;
  Scene scene;
  {
    ProgressLine line("checking");
    const ProgressCallback reading = [](double) { return !InterruptGuard::isInterrupted(); };
    const ProgressCallback checking = [&line](double fraction) {
      line.show(fraction);
      return !InterruptGuard::isInterrupted();
    };
    scene = readSceneFile(sceneFile, reading);
    checkCheckOutputs(sceneFile, scene, options);
    SceneCheckRequest request = sceneCheckRequest(scene, scene.haptics().springs.cutoff);
    if (!options.threshold.empty()) request.threshold = parseLength("--threshold", options.threshold);
    checkPositive("--threshold", request.threshold, true);
    request.rules = rulesFor(scene, options);
    check = checkScene(request, checking);
  }
  const std::vector<ComparedFinding> compared = compareFindings(*check, scene.pairRecords());
  const bool isStdoutTaken = options.json == kStdout || options.csv == kStdout;
  if (!options.json.empty()) writeTo(options.json, sceneCheckJson(scene, *check, compared));
  if (!options.csv.empty()) writeTo(options.csv, sceneCheckCsv(scene, *check, compared));
  if (!isStdoutTaken)
    print(sceneCheckTable(scene, *check, compared) + sceneCheckSummary(*check) + sceneCheckChanges(compared));
  printCacheWarnings();
  if (check->forbidden() == 0) return;
  flushOutput();
  throw NegativeVerdict();
}

}  // namespace nearfit::cli
