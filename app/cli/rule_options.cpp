#include "app/cli/rule_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "core/base/error.h"

namespace nearfit::cli {
namespace {

PairRule parsePairRule(const std::string& option, const std::string& text, PairRuleKind kind) {
  const NamePair names = parseNamePair(option, text);
  return {kind, names.part, names.other};
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

}  // namespace

void addRuleOptions(CLI::App& command, RuleOptions& options, CLI::Option* needed, const std::string& begin) {
  const auto add = [&](const char* name, std::vector<std::string>& rules, const char* form,
                       const char* help) {
    CLI::Option* option =
        command.add_option(name, rules, begin + help)->allow_extra_args(false)->type_name(form);
    if (needed != nullptr) option->needs(needed);
  };
  add("--leave-out", options.leaveOut, "A:B", "do not check parts A with parts B");
  CLI::Option* groups = command.add_flag("--leave-out-groups", options.leaveOutGroups,
                                         begin + "do not check parts directly in one group with each other");
  if (needed != nullptr) groups->needs(needed);
  add("--touching", options.touching, "A:B", "A and B are meant to touch");
  add("--press-fit", options.pressFit, "A:B=D", "A and B may overlap up to this depth");
}

std::vector<PairRule> rulesOf(const RuleOptions& options) {
  std::vector<PairRule> rules;
  for (const std::string& text : options.leaveOut)
    rules.push_back(parsePairRule("--leave-out", text, PairRuleKind::LeaveOut));
  if (options.leaveOutGroups) rules.push_back({PairRuleKind::SameGroup});
  for (const std::string& text : options.touching)
    rules.push_back(parsePairRule("--touching", text, PairRuleKind::Touching));
  for (const std::string& text : options.pressFit)
    rules.push_back(parsePressFit(text));
  return rules;
}

std::size_t findUnescaped(const std::string& text, char separator, std::size_t from) {
  for (std::size_t i = from; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == separator) {
      return i;
    }
  }
  return text.npos;
}

NamePair parseNamePair(const std::string& option, const std::string& text) {
  const std::size_t colon = findUnescaped(text, ':');
  if (colon == text.npos)
    throw UsageError(
        option, fmt::format("\"{}\" does not name two parts", text),
        "give A:B, names or patterns with * and ?; a backslash takes the next character as it is");
  NamePair names{text.substr(0, colon), text.substr(colon + 1)};
  try {
    checkPattern(names.part);
    checkPattern(names.other);
  } catch (const UsageError& e) {
    throw UsageError(option, fmt::format("\"{}\": {}", text, e.problem()), e.remedy());
  }
  return names;
}

}  // namespace nearfit::cli
