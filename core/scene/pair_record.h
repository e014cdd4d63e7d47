#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/part.h"

namespace nearfit {

/// Two parts of a scene, the older one first.
struct PartPair {
  PartId part{}, other{};
  auto operator<=>(const PartPair&) const = default;
};

/// How two parts are to each other, from harmless to bad.
enum class PairVerdict : std::uint8_t {
  Clear,      ///< Farther apart than the threshold of the check.
  Near,       ///< Apart, but nearer than the threshold.
  Touching,   ///< Apart, or overlapping, by no more than rounding in files and poses comes to.
  Clash,      ///< The surfaces pass through each other.
  Contained,  ///< The surfaces are apart, but one part, or a component of it, is inside the other.
};

/// "clear", "near", "touching", "clash" or "contained".
const char* wordOf(PairVerdict verdict) noexcept;
std::optional<PairVerdict> pairVerdictNamed(std::string_view word) noexcept;

/// The user's word on a finding.
enum class FindingState : std::uint8_t {
  New,       ///< Nothing yet.
  Accepted,  ///< It may stay as it is, for a reason.
  Fixed,     ///< It was there, and is gone.
};

/// "new", "accepted" or "fixed".
const char* wordOf(FindingState state) noexcept;
std::optional<FindingState> findingStateNamed(std::string_view word) noexcept;

/// Result of the last check for two parts, and the user's word on it; kept with the scene.
struct PairRecord {
  PartPair pair;
  PairVerdict verdict = PairVerdict::Clear;
  double distance = 0.0;  ///< Min distance of the surfaces [m]; 0 if they meet.
  /// Length of the least translation known to free them [m]; no value unless they clash or one contains the other.
  std::optional<double> depth;
  FindingState state = FindingState::New;
  std::string reason;  ///< Why it is accepted; UTF-8 without control characters.
  bool operator==(const PairRecord&) const = default;
};

/// Max records of a scene, so that a scene file stays within its limits; and max length of a reason [bytes of UTF-8].
constexpr std::size_t kMaxPairRecords = 20'000, kMaxReasonBytes = 200;

/// Throws UsageError if the pair is not in order, a number is not finite or negative, a reason is invalid, or a
/// finding is accepted without one.
void checkPairRecord(const PairRecord& record);

}  // namespace nearfit
