#include "app/cli/scene_rule_command.h"

#include <algorithm>
#include <functional>
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

namespace nearfit::cli {
namespace {

struct SceneRuleOptions {
  std::string scene;
  RuleOptions added;
  std::vector<std::size_t> removed;
  bool isJson = false;
};

/// Removes rules by their numbers, from 1.
void removeRules(std::vector<PairRule>& rules, std::vector<std::size_t> numbers) {
  std::ranges::sort(numbers, std::greater{});
  const auto repeated = std::ranges::unique(numbers);
  numbers.erase(repeated.begin(), repeated.end());
  for (const std::size_t number : numbers) {
    if (number == 0 || number > rules.size())
      throw UsageError(
          "--remove", fmt::format("there is no rule {}", number),
          rules.empty() ? "the scene has no rules" : fmt::format("give numbers from 1 to {}", rules.size()));
    rules.erase(rules.begin() + static_cast<std::ptrdiff_t>(number - 1));
  }
}

/// True if parts of the scene have both names of the rule; a pattern may be meant for parts that are yet to come.
bool isForPartsOf(const Scene& scene, const PairRule& rule) {
  return isNameOfPart(scene, rule.part) && isNameOfPart(scene, rule.other);
}

void printRules(const Scene& scene, bool isJson) {
  if (isJson) {
    nlohmann::ordered_json rules = nlohmann::ordered_json::array();
    for (const PairRule& rule : scene.pairRules())
      rules.push_back({{"kind", wordOf(rule.kind)},
                       {"part", rule.part},
                       {"other", rule.other},
                       {"interference", rule.interference}});
    return print(rules.dump() + "\n");
  }
  if (scene.pairRules().empty()) print("no rules\n");
  std::size_t number = 0;
  for (const PairRule& rule : scene.pairRules())
    print(oneLine(fmt::format("{}: {}", ++number, textOf(rule))) + "\n");
}

void runSceneRule(const SceneRuleOptions& options) {
  Scene scene = readSceneFile(options.scene);
  const std::vector<PairRule> added = rulesOf(options.added);
  if (!added.empty() || !options.removed.empty()) {
    std::vector<PairRule> rules = scene.pairRules();
    removeRules(rules, options.removed);
    for (const PairRule& rule : added) {
      // Said again it would say no more.
      if (std::ranges::find(rules, rule) == rules.end()) rules.push_back(rule);
    }
    scene.setPairRules(rules);
    writeSceneFile(scene, options.scene);
  }
  printRules(scene, options.isJson);
  for (const PairRule& rule : added) {
    if (!isForPartsOf(scene, rule))
      printError(oneLine(fmt::format("warning: no parts of the scene have these names: {}", textOf(rule))));
  }
}

constexpr const char* kRuleFooter =
    "Lists the rules for checks of the scene, after those that are named are removed and others added; the "
    "scene\n"
    "file is replaced only then. Checks in the window, clearance --all and report follow them.\n"
    "A and B are names of parts in either order, or patterns: * stands for any characters, ? for one, a "
    "backslash\n"
    "takes the next one as it is. D is a length, in metres or with a unit.\n"
    "Example: nearfit-cli scene rule fit.nearfit --touching Peg:Hole --press-fit 'Bush*:Housing=0.02mm'\n"
    "         nearfit-cli scene rule fit.nearfit --remove 2";

}  // namespace

void addSceneRule(CLI::App& scene) {
  const auto options = std::make_shared<SceneRuleOptions>();
  CLI::App* command = scene.add_subcommand(
      "rule", "Lists, adds and removes rules that leave pairs of parts out of checks, or allow them.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  addRuleOptions(*command, options->added);
  command
      ->add_option("--remove", options->removed, "Number of a rule to remove, as listed; repeat it for more")
      ->allow_extra_args(false)
      ->type_name("NUMBER");
  command->add_flag("--json", options->isJson, "List the rules as JSON");
  command->footer(kRuleFooter);
  command->callback([options] { runSceneRule(*options); });
}

}  // namespace nearfit::cli
