#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/name_pattern.h"

namespace nearfit {

/// Effect of a rule on pairs of parts in a check of the scene.
enum class PairRuleKind : std::uint8_t {
  LeaveOut,   ///< The pair is not checked.
  SameGroup,  ///< Parts that are directly in one group are not checked with each other.
  Touching,   ///< The parts are meant to touch: touching is allowed, a clash is not.
  PressFit,   ///< Touching, and a clash up to a depth, are allowed.
};

/// "leaveOut", "sameGroup", "touching" or "pressFit": the kind's word in scene files.
const char* wordOf(PairRuleKind kind) noexcept;
/// The kind of a word; std::nullopt if it is none of these.
std::optional<PairRuleKind> pairRuleNamed(std::string_view word) noexcept;

/// A rule for pairs of parts, in either order.
struct PairRule {
  PairRuleKind kind = PairRuleKind::LeaveOut;
  /// Patterns for the names of the two parts (name_pattern.h). Both "*" for SameGroup, which has none.
  std::string part = "*", other = "*";
  double interference = 0.0;  ///< Max depth of a clash that a press fit allows [m]; else 0.
  bool operator==(const PairRule&) const = default;
};

/// Max rules of a scene: more than anyone writes, and few enough to be tried on each pair.
constexpr std::size_t kMaxPairRules = 1000;
/// Max interference of a press fit [m]. A longer one is in the wrong unit.
constexpr double kMaxInterference = 1.0;

/// Throws UsageError if a pattern is invalid, or an interference is out of range or has no press fit.
void checkPairRule(const PairRule& rule);
/// The same for all of them, and if there are more than kMaxPairRules.
void checkPairRules(const std::vector<PairRule>& rules);

/// The rule in words: "leave out A* with B*", "press fit of A with B up to 2e-05 m".
std::string textOf(const PairRule& rule);

}  // namespace nearfit
