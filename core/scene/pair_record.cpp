#include "core/scene/pair_record.h"

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr std::array<const char*, 5> kVerdictWords{"clear", "near", "touching", "clash", "contained"};
constexpr std::array<const char*, 3> kStateWords{"new", "accepted", "fixed"};

/// The enumerator of a word, by its place among all words.
template <class Enum, std::size_t Count>
std::optional<Enum> enumeratorOf(std::string_view word,
                                 const std::array<const char*, Count>& words) noexcept {
  for (std::size_t i = 0; i < Count; ++i) {
    if (word == words[i]) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace

const char* wordOf(PairVerdict verdict) noexcept {
  return kVerdictWords[static_cast<std::size_t>(verdict)];
}

std::optional<PairVerdict> pairVerdictNamed(std::string_view word) noexcept {
  return enumeratorOf<PairVerdict>(word, kVerdictWords);
}

const char* wordOf(FindingState state) noexcept {
  return kStateWords[static_cast<std::size_t>(state)];
}

std::optional<FindingState> findingStateNamed(std::string_view word) noexcept {
  return enumeratorOf<FindingState>(word, kStateWords);
}

void checkPairRecord(const PairRecord& record) {
  if (!(record.pair.part < record.pair.other))
    throw UsageError("finding", "its two parts are one, or not in the scene's order",
                     "name the older one first");
  const auto isLength = [](double length) { return std::isfinite(length) && length >= 0.0; };
  if (!isLength(record.distance) || !isLength(record.depth.value_or(0.0)))
    throw UsageError("finding", "a length is negative or not finite", "give a length of at least 0");
  if (record.reason.size() > kMaxReasonBytes || !isPrintableUtf8(record.reason))
    throw UsageError("reason of a finding", "it is too long, or not printable UTF-8",
                     "give one line of text, not too long");
  if (record.state == FindingState::Accepted && record.reason.empty())
    throw UsageError("finding", "it is accepted without a reason", "say why it may stay");
}

}  // namespace nearfit
