#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/realtime/latency_histogram.h"
#include "core/servo/motion_recording.h"
#include "core/servo/servo_tick.h"
#include "device/interface/haptic_device.h"

namespace nearfit::cli {

/// A part to move along a path, one pose per tick, or by a device.
struct PlaceJob {
  std::unique_ptr<const ServoScene> scene;
  ServoParameters parameters;
  std::vector<RigidTransform> path;  ///< worldFromPart; not empty unless a device leads.
  MotionWriter* writer = nullptr;    ///< Receives a row of every tick; may be null.
  std::unique_ptr<HapticDevice> device;
  std::optional<double> seconds;  ///< With a device: duration [s].
  bool isCalibrating = false;     ///< See HapticDevice::calibrate().
  bool isArming = false;          ///< Forces go out as soon as the device is ready.
};

/// Report on the device in a run.
struct DeviceReport {
  std::string name;
  DeviceLimits limits;
  ReportCounters counters;
  /// From a report's arrival to the wrench that answers it; empty if the device has no report rate.
  LatencyHistogram roundTrip;
  double seconds = 0.0;  ///< Duration of the run [s].
  bool wasArmed = false;
  std::string trouble;  ///< Why it ended before the user wanted it to; empty if it did not.
};

/// Largest length of a vector so far, and when.
struct Peak {
  double value = 0.0;
  double time = 0.0;  ///< [s]
};

/// Result of a run.
struct PlaceResult {
  std::uint64_t ticks = 0;
  std::uint64_t clampedTicks = 0, truncatedTicks = 0, behindTicks = 0;
  std::uint64_t lateTicks = 0;  ///< Searched for themselves because the lists were not ready.
  std::uint64_t lostRows = 0;   ///< Missing in the record, and in the figures taken from rows.
  std::uint32_t maxLmds = 0;
  std::uint32_t maxAreas = 0;         ///< Minima that hold a spring at once; springs modes only.
  std::uint64_t heldTicks = 0;        ///< Springs held back to what the device bears.
  SpringShares leastShares;           ///< Smallest of each part of the springs that was rendered.
  double leastDistance = 0.0;         ///< [m]; infinity if nothing came within the cutoff.
  bool isLeastDistanceBound = false;  ///< `leastDistance` is a lower bound.
  double leastDistanceTime = 0.0;     ///< [s]
  Peak force, torque;                 ///< Peaks of what was sent [N], [N m].
  double maxEnergyToHand = 0.0;       ///< Highest energy given to the hand at any time [J].
  std::uint32_t maxSubSteps = 0;
  std::uint64_t shortenedSteps = 0, refusedSteps = 0;
  std::uint64_t overlappingTicks = 0;  ///< With parts that overlap and so are not felt.
  CouplingState coupling;              ///< In force in the last tick.
  double period = 0.0;                 ///< Measured period that it is based on [s].
  ServoFault fault = ServoFault::None;
  RigidTransform end;                              ///< worldFromPart after the last tick.
  LatencyHistogram lateness, queryTime, tickTime;  ///< `lateness` is empty unless run in real time.
  LatencyHistogram proxyTime;                      ///< The proxy without its queries.
  LatencyHistogram wrenchTime;                     ///< Until the wrench was known.
  LatencyHistogram refreshTime;                    ///< Searches ahead, on the search thread.
  std::uint64_t overruns = 0;
  std::string schedulingNote;  ///< Empty unless run in real time.
  bool isInterrupted = false;  ///< Stopped by the user before the path's end.
  std::optional<DeviceReport> device;
};

/// Runs the servo with a simulated device as fast as possible, on this thread. All but the times is the same
/// in each run. Interrupts (SIGINT, SIGTERM) end it early. Throws FileError from the writer.
PlaceResult placeFast(PlaceJob job);

/// Does the same at 1 kHz on the servo thread, while this thread writes the rows.
PlaceResult placeInRealTime(PlaceJob job);

/// Lets the job's device lead until the user interrupts, time is up, or the device is lost or stopped. Throws
/// Error if it cannot be opened.
PlaceResult placeWithDevice(PlaceJob job);

}  // namespace nearfit::cli
