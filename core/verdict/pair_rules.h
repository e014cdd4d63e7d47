#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/group.h"
#include "core/scene/pair_record.h"
#include "core/scene/pair_rule.h"

namespace nearfit {

/// Properties of a part that rules look at.
struct RuledPart {
  std::string name;
  std::optional<GroupId> group;  ///< std::nullopt: at the top level, in no group.
};

/// Rules applied to the parts of one check. Names are matched once, on construction: O(rules * parts).
class PairRules {
 public:
  /// @param rules  Kept by reference. Throws UsageError like checkPairRules().
  PairRules(const std::vector<PairRule>& rules, std::span<const RuledPart> parts);

  /// Index of the first rule that leaves two parts out; std::nullopt if they are to be checked.
  /// @param a, b  Indices of parts, in either order. O(rules), as for the others.
  std::optional<std::size_t> leavingOut(std::size_t a, std::size_t b) const;
  /// Max interference that press fits of two parts allow [m]; 0 if none is meant.
  double allowedInterference(std::size_t a, std::size_t b) const;
  /// Index of the first rule that allows a finding; std::nullopt if none does. Only touching and clashes are allowed:
  /// Near needs no leave, and a part inside another one is no fit.
  /// @param depth  Of a clash: max depth, of which it is known that it is no more [m].
  std::optional<std::size_t> allowing(std::size_t a, std::size_t b, PairVerdict verdict, double depth) const;

 private:
  bool isFor(std::size_t rule, std::size_t a, std::size_t b) const;

  struct Matches {
    std::vector<bool> part, other;  ///< By index of a part.
  };
  const std::vector<PairRule>& rules_;
  std::vector<Matches> matches_;
  std::vector<std::optional<GroupId>> groups_;
};

}  // namespace nearfit
