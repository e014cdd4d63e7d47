#pragma once

#include <cstddef>
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

/// Patterns for the names of two parts.
struct NamePair {
  std::string part, other;
};

/// Position of the first separator at or after `from` without a backslash before it; npos if there is none.
std::size_t findUnescaped(const std::string& text, char separator, std::size_t from = 0);

/// Parses "A:B". Throws UsageError, which names the option.
NamePair parseNamePair(const std::string& option, const std::string& text);

}  // namespace nearfit::cli
