#pragma once

#include "core/realtime/latency_histogram.h"
#include "tests/makers/maker_bench.h"

namespace nearfit::test {

/// What a hand did and felt that pressed a peg on a floor for some time, through the servo and a maker's plug-in.
struct ContactOutcome {
  bool wasReady = false, wasFelt = false, wasLetGo = false;
  bool cameToRest = false;      ///< Where the floor's force and the hand's pull balance.
  double force = 0.0;           ///< Upward, at rest in contact, or as it was last [N].
  double handPull = 0.0;        ///< Of the hand's spring then, downward [N].
  double deepest = 0.0;         ///< The handle's lowest z [m]; the floor is met at -kContactGap.
  double maxEnergyGiven = 0.0;  ///< The most that the motors ever gave the hand [J].
  LatencyHistogram roundTrip;
  std::string note;  ///< HapticDevice::stateNote() at the end.
};

/// From where it begins the handle goes down so far before the peg meets the floor, and the hand wants it so far down [m].
inline constexpr double kContactGap = 0.01, kContactTarget = 0.018;
/// Stiffness of the hand (StandinDevice) [N/m].
inline constexpr double kContactHand = 300.0;

/// @param seconds  How long the hand presses, and moves sideways as it does; 0: until it is at rest.
/// @param safety   SafetyLimits{} where the machine does nothing else: else patientSafety().
ContactOutcome pressOnFloor(MakerBench& bench, double seconds, const SafetyLimits& safety);

}  // namespace nearfit::test
