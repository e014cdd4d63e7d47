// Commands about checks of the scene.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/session/session.h"

namespace nearfit {

void Session::setPairRules(const std::vector<PairRule>& rules) {
  if (rules == scene().pairRules()) return;
  Scene next = scene();
  next.setPairRules(rules);
  commit(std::move(next), "Change the rules of the check");
}

void Session::setPairRecords(const std::vector<PairRecord>& records) {
  Scene next = scene();
  next.setPairRecords(records);
  if (next.pairRecords() == scene().pairRecords()) return;
  // Undo takes back what the user did, and a check that follows a move must not stand in its way.
  current_.scene = std::move(next);
  current_.serial = nextSerial_++;
  events_.notify();
}

void Session::setFindingState(const std::vector<PartPair>& pairs, FindingState state,
                              const std::string& reason) {
  std::vector<PairRecord> records = scene().pairRecords();
  for (const PartPair& pair : pairs) {
    const auto it = std::ranges::lower_bound(records, pair, {}, &PairRecord::pair);
    if (it == records.end() || it->pair != pair)
      throw UsageError("finding", "the last check found nothing for these parts", "check the scene again");
    it->state = state;
    it->reason = reason;
  }
  if (records == scene().pairRecords()) return;
  Scene next = scene();
  next.setPairRecords(std::move(records));
  const char* verb = state == FindingState::Accepted ? "Accept"
                     : state == FindingState::Fixed  ? "Mark as fixed"
                                                     : "Reopen";
  commit(std::move(next), pairs.size() == 1 ? fmt::format("{} a finding", verb)
                                            : fmt::format("{} {} findings", verb, pairs.size()));
}

}  // namespace nearfit
