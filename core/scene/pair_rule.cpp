#include "core/scene/pair_rule.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit {

const char* wordOf(PairRuleKind kind) noexcept {
  switch (kind) {
    case PairRuleKind::LeaveOut:
      return "leaveOut";
    case PairRuleKind::SameGroup:
      return "sameGroup";
    case PairRuleKind::Touching:
      return "touching";
    case PairRuleKind::PressFit:
      break;
  }
  return "pressFit";
}

std::optional<PairRuleKind> pairRuleNamed(std::string_view word) noexcept {
  for (const PairRuleKind kind :
       {PairRuleKind::LeaveOut, PairRuleKind::SameGroup, PairRuleKind::Touching, PairRuleKind::PressFit}) {
    if (word == wordOf(kind)) return kind;
  }
  return std::nullopt;
}

void checkPairRule(const PairRule& rule) {
  checkPattern(rule.part);
  checkPattern(rule.other);
  if (rule.kind == PairRuleKind::SameGroup && (rule.part != "*" || rule.other != "*"))
    throw UsageError("rule for parts of one group", "it takes no names", "leave them out, or give \"*\"");
  if (rule.kind != PairRuleKind::PressFit && rule.interference != 0.0)
    throw UsageError(textOf(rule), "only a press fit has an interference", "give 0");
  const bool isInRange = rule.interference >= 0.0 && rule.interference <= kMaxInterference;
  if (!isInRange || (rule.kind == PairRuleKind::PressFit && rule.interference == 0.0)) {
    throw UsageError("interference of a press fit", fmt::format("{} m is out of range", rule.interference),
                     fmt::format("give a length above 0, up to {} m", kMaxInterference));
  }
}

void checkPairRules(const std::vector<PairRule>& rules) {
  if (rules.size() > kMaxPairRules)
    throw UsageError("rules", fmt::format("there are more than {}", kMaxPairRules), "remove some");
  for (const PairRule& rule : rules)
    checkPairRule(rule);
}

std::string textOf(const PairRule& rule) {
  switch (rule.kind) {
    case PairRuleKind::LeaveOut:
      return fmt::format("leave out {} with {}", rule.part, rule.other);
    case PairRuleKind::SameGroup:
      return "leave out parts of one group";
    case PairRuleKind::Touching:
      return fmt::format("{} and {} are meant to touch", rule.part, rule.other);
    case PairRuleKind::PressFit:
      break;
  }
  return fmt::format("press fit of {} with {} up to {} m", rule.part, rule.other, rule.interference);
}

}  // namespace nearfit
