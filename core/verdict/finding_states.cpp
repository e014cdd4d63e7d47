#include "core/verdict/finding_states.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

namespace nearfit {
namespace {

/// Lengths that differ by no more are the same, as a share and in metres: what another tessellation or pose rounded anew
/// comes to.
constexpr double kSameShare = 1e-3, kSameLength = 1e-9;

bool isClearlyMore(double a, double b) noexcept {
  return a - b > kSameLength + kSameShare * std::abs(b);
}

PairRecord recordOf(const PairFinding& finding) {
  PairRecord record;
  record.pair = finding.pair;
  record.verdict = finding.verdict;
  record.distance = finding.distance;
  record.depth = finding.depth();
  return record;
}

FindingChange changeOf(const PairFinding& now, const PairRecord& before) {
  if (before.verdict == PairVerdict::Clear) return FindingChange::New;
  if (now.verdict != before.verdict)
    return now.verdict > before.verdict ? FindingChange::Worse : FindingChange::Better;
  const std::optional<double> depth = now.depth();
  if (depth && before.depth) {
    if (isClearlyMore(*depth, *before.depth)) return FindingChange::Worse;
    return isClearlyMore(*before.depth, *depth) ? FindingChange::Better : FindingChange::Same;
  }
  // Distances of both are 0: a way out that is no longer found is all that tells a deeper clash.
  if (now.verdict >= PairVerdict::Clash && depth.has_value() != before.depth.has_value())
    return depth ? FindingChange::Better : FindingChange::Worse;
  if (isClearlyMore(before.distance, now.distance)) return FindingChange::Worse;
  return isClearlyMore(now.distance, before.distance) ? FindingChange::Better : FindingChange::Same;
}

ComparedFinding compared(const PairFinding& now, const PairRecord* before) {
  ComparedFinding finding{now.pair, &now, {}, FindingChange::New, FindingState::New, {}};
  if (before == nullptr) return finding;
  finding.change = changeOf(now, *before);
  finding.reason = before->reason;
  if (before->verdict == PairVerdict::Clear) return finding;
  finding.before = *before;
  // Marked by hand, it is not fixed as long as it is there.
  const bool isAccepted = before->state == FindingState::Accepted && now.verdict == before->verdict &&
                          finding.change != FindingChange::Worse;
  finding.state = isAccepted ? FindingState::Accepted : FindingState::New;
  return finding;
}

/// Place of a record among those to keep, the lowest first. What is gone comes behind live clashes: after a check with a
/// smaller threshold it can fill all places.
int keepingTier(const PairRecord& record) noexcept {
  const bool isThere = record.verdict != PairVerdict::Clear;
  if (record.state == FindingState::Accepted || !record.reason.empty()) return 0;
  if (record.state == FindingState::Fixed) return isThere ? 0 : 2;
  return record.verdict >= PairVerdict::Clash ? 1 : 3;
}

bool wasChecked(const SceneCheck& check, const PartPair& pair) {
  const auto isThere = [&](PartId id) { return std::ranges::binary_search(check.parts, id); };
  return isThere(pair.part) && isThere(pair.other) &&
         !std::ranges::binary_search(check.leftOut, pair, {}, &LeftOutPair::pair);
}

}  // namespace

const char* wordOf(FindingChange change) noexcept {
  constexpr std::array<const char*, 5> kWords{"new", "worse", "same", "better", "gone"};
  return kWords[static_cast<std::size_t>(change)];
}

std::vector<ComparedFinding> compareFindings(const SceneCheck& check, const std::vector<PairRecord>& before) {
  std::vector<ComparedFinding> findings;
  findings.reserve(check.findings.size() + before.size());
  for (const PairFinding& now : check.findings) {
    const auto it = std::ranges::lower_bound(before, now.pair, {}, &PairRecord::pair);
    findings.push_back(compared(now, it != before.end() && it->pair == now.pair ? &*it : nullptr));
  }
  for (const PairRecord& record : before) {
    if (std::ranges::binary_search(check.findings, record.pair, {}, &PairFinding::pair)) continue;
    const bool isGone = wasChecked(check, record.pair) && record.verdict != PairVerdict::Clear;
    findings.push_back({record.pair, nullptr, record, isGone ? FindingChange::Gone : FindingChange::Same,
                        isGone ? FindingState::Fixed : record.state, record.reason});
  }
  std::ranges::sort(findings, {}, &ComparedFinding::pair);
  return findings;
}

const char* stateWord(FindingState state, std::string_view reason) noexcept {
  return wasAccepted(state, reason) ? "changed" : wordOf(state);
}

std::size_t acceptedIn(const std::vector<ComparedFinding>& findings) noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(findings, [](const ComparedFinding& finding) {
    return finding.now != nullptr && finding.now->isForbidden() && finding.state == FindingState::Accepted;
  }));
}

FindingChanges changesIn(const std::vector<ComparedFinding>& findings) noexcept {
  FindingChanges changes;
  for (const ComparedFinding& finding : findings) {
    if (finding.change == FindingChange::New) ++changes.added;
    if (finding.change == FindingChange::Worse) ++changes.worse;
    if (finding.change == FindingChange::Better) ++changes.better;
    if (finding.change == FindingChange::Gone) ++changes.gone;
  }
  return changes;
}

std::vector<PairRecord> recordsOf(const std::vector<ComparedFinding>& findings) {
  std::vector<PairRecord> records;
  for (const ComparedFinding& finding : findings) {
    const bool isAsAccepted =
        finding.state == FindingState::Accepted && finding.change == FindingChange::Same && finding.before;
    PairRecord record = finding.now != nullptr && !isAsAccepted ? recordOf(*finding.now) : *finding.before;
    if (finding.change == FindingChange::Gone) {
      record.verdict = PairVerdict::Clear;
      record.depth.reset();
    }
    record.state = finding.state;
    record.reason = finding.reason;
    records.push_back(std::move(record));
  }
  if (records.size() <= kMaxPairRecords) return records;
  const auto rank = [](const PairRecord& r) {
    return std::tuple(keepingTier(r), -static_cast<int>(r.verdict), -r.depth.value_or(0.0), r.distance,
                      r.pair);
  };
  std::ranges::nth_element(records, records.begin() + static_cast<std::ptrdiff_t>(kMaxPairRecords), {}, rank);
  records.resize(kMaxPairRecords);
  std::ranges::sort(records, {}, &PairRecord::pair);
  return records;
}

std::size_t findingsNotKept(const std::vector<ComparedFinding>& findings) noexcept {
  return findings.size() - std::min(findings.size(), kMaxPairRecords);
}

std::string notKeptText(const std::vector<ComparedFinding>& findings) {
  const std::size_t count = findingsNotKept(findings);
  if (count == 0) return "";
  return fmt::format(
      "a scene keeps {} findings: {} of the least {} not kept, and will be new in the next check",
      kMaxPairRecords, count, count == 1 ? "is" : "are");
}

}  // namespace nearfit
