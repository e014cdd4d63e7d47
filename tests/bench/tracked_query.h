#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/proximity/tracking/candidate_list.h"
#include "core/proximity/tracking/lmd_tracker.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {

/// The full set at each pose as the servo finds it: from a list that another thread renews.
///
/// That thread is played by the time between two queries. A list whose search took so many milliseconds
/// arrives so many ticks of a 1 kHz servo later, and half a one for the thread to wake up; until then the old
/// one must do, and where it does not, the tick searches for itself and is counted as late.
class TrackedQuery : public QueryMethod {
 public:
  explicit TrackedQuery(const PreparedScene& scene);

  Answer query(const RigidTransform& sceneFromPart) override;
  /// Of the last query: as many as it counted.
  std::span<const Lmd> minima() const { return lmds_; }
  void workAside(const RigidTransform& sceneFromPart) override;
  std::string remark() const override;

 private:
  const PreparedScene& scene_;
  LmdTracker tracker_;
  LmdScratch scratch_, refreshScratch_;
  std::vector<Lmd> lmds_;
  std::array<CandidateList, 2> lists_;
  std::size_t front_ = 0;
  bool isUnderWay_ = false;
  std::uint64_t tick_ = 0, readyAt_ = 0;

  std::vector<double> refreshTimes_;
  std::vector<double> sizes_;  ///< Of the lists made.
  std::uint64_t late_ = 0;
};

}  // namespace nearfit::bench
