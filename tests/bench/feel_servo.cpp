#include "tests/bench/feel_servo.h"

#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/base/error.h"
#include "tests/bench/arrival_delay.h"

namespace nearfit::bench {
namespace {

long preemptions() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

}  // namespace

FeelServo::FeelServo(std::shared_ptr<const ServoScene> scene, const ServoParameters& parameters,
                     ListArrival arrival, BenchClock clock)
    : parameters_(parameters), reach_(searchReach(parameters.haptics)), arrival_(arrival), clock_(clock) {
  tracker_.setScene(std::move(scene));
  tracker_.refresh(reach_, tracked_[front_]);
}

const ServoSnapshot& FeelServo::tick(const RigidTransform& hand, double period) {
  ++ticks_;
  if (isUnderWay_ && ticks_ >= readyAt_) {
    front_ = 1 - front_;
    isUnderWay_ = false;
  }
  const long before = preemptions();
  const double start = secondsBy(clock_);
  tick_.run(tracked_[front_], parameters_, {.pose = hand}, period, *snapshot_);
  tickTime_ = secondsBy(clock_) - start;
  wasPreempted_ = preemptions() != before;
  if (snapshot_->fault != ServoFault::None)
    throw Error(fmt::format("tick {}", ticks_), faultReason(snapshot_->fault), "find out how it came about");
  if (snapshot_->overlappingCount > 0)
    throw Error(fmt::format("tick {}", ticks_), "the part overlaps a body", "start where it is free");
  workBeside();
  return *snapshot_;
}

void FeelServo::workBeside() {
  tracker_.update(observationOf(*snapshot_), 1.0);
  if (isUnderWay_ || !tracker_.isDue(reach_)) return;
  const double start = secondsBy(clock_);
  tracker_.refresh(reach_, tracked_[1 - front_]);
  const double time = secondsBy(clock_) - start;
  refreshTimes_.push_back(time);
  isUnderWay_ = true;
  readyAt_ = ticks_ + 1;
  if (arrival_ == ListArrival::AtOnce) return;
  const double delay = arrivalDelay(time);
  readyAt_ += static_cast<std::uint64_t>(delay);
  tracker_.setLead(delay);
}

}  // namespace nearfit::bench
