#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/pair_record.h"
#include "core/verdict/scene_check.h"

namespace nearfit {

/// How a finding differs from what the last check found of the same parts.
enum class FindingChange : std::uint8_t { New, Worse, Same, Better, Gone };

/// "new", "worse", "same", "better" or "gone".
const char* wordOf(FindingChange change) noexcept;

/// A finding of this check, of the last one, or of both.
struct ComparedFinding {
  PartPair pair;
  const PairFinding* now =
      nullptr;  ///< In the check; null if it is gone, or its parts were not checked this time.
  std::optional<PairRecord> before;  ///< No value if the last check did not find it.
  FindingChange change = FindingChange::New;
  /// The user's word, carried over. An accepted finding that became worse, or has another verdict, is New again, with its
  /// reason; one that is gone is Fixed, and New again if it comes back.
  FindingState state = FindingState::New;
  std::string reason;
};

/// Compares a check with the records of the last one: all findings of both, in ascending order of pairs. A finding is
/// worse if its verdict is, or by the same verdict if the parts are nearer, or in each other deeper, by more than a
/// thousandth and a nanometre, or if no translation is found any more that frees them. Clashes without one both times are
/// the same. Records of pairs that were not checked this time, because a part is hidden or a rule leaves
/// them out, stay as they are, as Same; so do those that were gone before, with the verdict Clear.
/// @param check   Kept by pointer in the result.
/// @param before  In ascending order of pairs, as Scene::pairRecords().
std::vector<ComparedFinding> compareFindings(const SceneCheck& check, const std::vector<PairRecord>& before);

/// True for a finding that was accepted once and became another since, so that it has to be judged again: it is New, and
/// has a reason.
constexpr bool wasAccepted(FindingState state, std::string_view reason) noexcept {
  return state == FindingState::New && !reason.empty();
}
/// "new", "accepted" or "fixed"; "changed" where wasAccepted().
const char* stateWord(FindingState state, std::string_view reason) noexcept;

/// Number of findings that no rule allows, and that the user has accepted as they are.
std::size_t acceptedIn(const std::vector<ComparedFinding>& findings) noexcept;

/// Number of findings by how they differ from the last check. Those that are the same, or were not checked, are not counted.
struct FindingChanges {
  std::size_t added = 0, worse = 0, better = 0, gone = 0;
};
FindingChanges changesIn(const std::vector<ComparedFinding>& findings) noexcept;

/// The records to keep with the scene, up to kMaxPairRecords in all: first those that the user said something about and
/// that are still there (accepted, with a reason, or marked as fixed), then clashes and contained parts, then what is gone,
/// and of the rest those that touch or are nearest. In ascending order of pairs. An accepted finding keeps the measures
/// that it was accepted with as long as it stays the same, so that it cannot creep away from them by steps too small to
/// count.
std::vector<PairRecord> recordsOf(const std::vector<ComparedFinding>& findings);

/// Number of findings that recordsOf() leaves out.
std::size_t findingsNotKept(const std::vector<ComparedFinding>& findings) noexcept;
/// The same in words for the user, without a full stop; "" if all are kept.
std::string notKeptText(const std::vector<ComparedFinding>& findings);

}  // namespace nearfit
