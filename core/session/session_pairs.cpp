// Commands about checks of the scene.
#include <utility>

#include <fmt/format.h>

#include "core/session/session.h"

namespace nearfit {

void Session::setPairRules(const std::vector<PairRule>& rules) {
  if (rules == scene().pairRules()) return;
  Scene next = scene();
  next.setPairRules(rules);
  commit(std::move(next), "Change the rules of the check", steps::SetPairRules{rules});
}

void Session::setPairRecords(const std::vector<PairRecord>& records) {
  Scene next = scene();
  next.setPairRecords(records);
  if (next.pairRecords() == scene().pairRecords()) return;
  // Undo takes back what the user did, and a check that follows a move must not stand in its way.
  current_.scene = std::move(next);
  current_.serial = nextSerial_++;
  current_.restatesRecords = true;
  // The step that redo repeats was done before, and leaves the records that there were then.
  if (!future_.empty()) future_.back().restatesRecords = true;
  events_.notify();
}

void Session::setFindingState(const std::vector<PartPair>& pairs, FindingState state,
                              const std::string& reason) {
  Scene next = scene();
  next.setFindingState(pairs, state, reason);
  if (next.pairRecords() == scene().pairRecords()) return;
  const char* verb = state == FindingState::Accepted ? "Accept"
                     : state == FindingState::Fixed  ? "Mark as fixed"
                                                     : "Reopen";
  const std::string label = pairs.size() == 1 ? fmt::format("{} a finding", verb)
                                              : fmt::format("{} {} findings", verb, pairs.size());
  commit(std::move(next), label, steps::SetFindingState{pairs, state, reason});
}

}  // namespace nearfit
