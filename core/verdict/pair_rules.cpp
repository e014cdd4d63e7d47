#include "core/verdict/pair_rules.h"

#include <algorithm>

namespace nearfit {

PairRules::PairRules(const std::vector<PairRule>& rules, std::span<const RuledPart> parts) : rules_(rules) {
  checkPairRules(rules);
  for (const PairRule& rule : rules) {
    Matches& matches = matches_.emplace_back();
    for (const RuledPart& part : parts) {
      matches.part.push_back(matchesPattern(rule.part, part.name));
      matches.other.push_back(matchesPattern(rule.other, part.name));
    }
  }
  for (const RuledPart& part : parts)
    groups_.push_back(part.group);
}

bool PairRules::isFor(std::size_t rule, std::size_t a, std::size_t b) const {
  if (rules_[rule].kind == PairRuleKind::SameGroup) return groups_[a] && groups_[a] == groups_[b];
  const Matches& m = matches_[rule];
  return (m.part[a] && m.other[b]) || (m.part[b] && m.other[a]);
}

std::optional<std::size_t> PairRules::leavingOut(std::size_t a, std::size_t b) const {
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    const PairRuleKind kind = rules_[i].kind;
    if ((kind == PairRuleKind::LeaveOut || kind == PairRuleKind::SameGroup) && isFor(i, a, b)) return i;
  }
  return std::nullopt;
}

double PairRules::allowedInterference(std::size_t a, std::size_t b) const {
  double most = 0.0;
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    if (rules_[i].kind == PairRuleKind::PressFit && isFor(i, a, b))
      most = std::max(most, rules_[i].interference);
  }
  return most;
}

std::optional<std::size_t> PairRules::allowing(std::size_t a, std::size_t b, PairVerdict verdict,
                                               double depth) const {
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    const PairRule& rule = rules_[i];
    const bool isFit = rule.kind == PairRuleKind::PressFit;
    const bool mayTouch = isFit || rule.kind == PairRuleKind::Touching;
    const bool isAllowed = (verdict == PairVerdict::Touching && mayTouch) ||
                           (verdict == PairVerdict::Clash && isFit && depth <= rule.interference);
    if (isAllowed && isFor(i, a, b)) return i;
  }
  return std::nullopt;
}

}  // namespace nearfit
