#pragma once

#include <string>
#include <vector>

#include "core/scene/pair_rule.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace nearfit::cli {

/// Options that state rules for pairs of parts, as they were written.
struct RuleOptions {
  std::vector<std::string> leaveOut, touching, pressFit;
  bool leaveOutGroups = false;
};

/// Adds --leave-out, --leave-out-groups, --touching and --press-fit.
/// @param options  Outlives the command.
/// @param needed   An option that each of them needs; null: none.
/// @param begin    Begin of each help text, such as "With --all: ".
void addRuleOptions(CLI::App& command, RuleOptions& options, CLI::Option* needed = nullptr,
                    const std::string& begin = "");

/// The rules, by kind in the order above, and as written within a kind. Throws UsageError, which names the option.
std::vector<PairRule> rulesOf(const RuleOptions& options);

}  // namespace nearfit::cli
