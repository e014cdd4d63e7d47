#include "tests/stress/stress_servo.h"

#include <utility>

namespace nearfit::stress {
namespace {

constexpr std::uint64_t kUsualDelays = 4, kLongestDelay = 400, kOneInStalls = 8;

}  // namespace

StressServo::StressServo(std::shared_ptr<const ServoScene> scene, const ServoParameters& parameters,
                         std::uint64_t seed)
    : parameters_(parameters), random_(seed) {
  tracker_.setScene(std::move(scene));
  tracker_.refresh(searchReach(parameters_.haptics), tracked_[front_]);
}

const ServoSnapshot& StressServo::tick(const HandleInput& input, double period) {
  ++ticks_;
  if (isUnderWay_ && ticks_ >= readyAt_) {
    front_ = 1 - front_;
    // Its lists go back to the tracker, as from the servo's triple buffer.
    tracked_[1 - front_] = TrackedScene{};
    isUnderWay_ = false;
  }
  tick_.run(tracked_[front_], parameters_, input, period, *snapshot_);
  snapshot_->tick = ticks_;
  workBeside();
  return *snapshot_;
}

void StressServo::workBeside() {
  tracker_.update(observationOf(*snapshot_), 1.0);
  if (isUnderWay_) return;
  const SearchReach reach = searchReach(parameters_.haptics);
  if (!tracker_.isDue(reach)) return;
  tracker_.refresh(reach, tracked_[1 - front_]);
  isUnderWay_ = true;
  const std::uint64_t late = delay();
  readyAt_ = ticks_ + 1 + late;
  tracker_.setLead(static_cast<double>(late));
}

std::uint64_t StressServo::delay() {
  switch (arrival_) {
    case Arrival::AtOnce:
      return 0;
    case Arrival::Usual:
      return random_() % kUsualDelays;
    case Arrival::Stalled:
      return random_() % kOneInStalls == 0 ? random_() % kLongestDelay : random_() % kUsualDelays;
  }
  return 0;
}

}  // namespace nearfit::stress
