#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/haptics/servo_tick.h"
#include "core/realtime/latency_histogram.h"
#include "core/scene/motion_recording.h"
#include "device/haptic_device.h"

namespace nearfit::cli {

/// A part to be led along a path, one pose a tick, or by a device.
struct PlaceJob {
  std::unique_ptr<const ServoScene> scene;
  ServoParameters parameters;
  std::vector<RigidTransform> path;  ///< worldFromPart; not empty, unless a device leads.
  MotionWriter* writer = nullptr;    ///< Gets a row of every tick; may be null.
  std::unique_ptr<HapticDevice> device;
  std::optional<double> seconds;  ///< With a device: ends after so long.
  bool isCalibrating = false;     ///< See HapticDevice::calibrate.
  bool isArming = false;          ///< Forces go out as soon as the device is ready.
};

/// What a device did.
struct DeviceReport {
  std::string name;
  DeviceLimits limits;
  ReportCounters counters;
  LatencyHistogram
      roundTrip;  ///< From a report's arrival to its wrench handed over; empty: it sends at no rate.
  double seconds = 0.0;
  bool wasArmed = false;
  std::string trouble;  ///< Why it ended before the user wanted it to; empty: it did not.
};

/// Largest length of a vector so far, and when.
struct Peak {
  double value = 0.0;
  double time = 0.0;  ///< [s]
};

struct PlaceResult {
  std::uint64_t ticks = 0;
  std::uint64_t clampedTicks = 0, truncatedTicks = 0;
  std::uint64_t lateTicks = 0;  ///< That searched for themselves, as the lists were not ready.
  std::uint64_t lostRows = 0;   ///< Ticks that are missing in the record and in everything below but `end`.
  std::uint32_t maxLmds = 0;
  double leastDistance = 0.0;  ///< [m]; infinity when nothing ever came within the cutoff.
  double leastDistanceTime = 0.0;
  Peak force, torque;            ///< As sent [N], [N m].
  double maxEnergyToHand = 0.0;  ///< Most that the hand had been given at any time [J].
  std::uint32_t maxSubSteps = 0;
  std::uint64_t shortenedSteps = 0, refusedSteps = 0;
  std::uint64_t releasedTicks = 0;  ///< With parts that were overlapped and so not felt.
  CouplingState coupling;           ///< In force in the last tick.
  double period = 0.0;              ///< Measured, that it was reckoned with [s].
  ServoFault fault = ServoFault::None;
  RigidTransform end;                              ///< worldFromPart after the last tick.
  LatencyHistogram lateness, queryTime, tickTime;  ///< `lateness` is empty when it did not run in real time.
  LatencyHistogram proxyTime;                      ///< Of the proxy without its queries.
  LatencyHistogram refreshTime;                    ///< Of the searches ahead, in the thread beside.
  std::uint64_t overruns = 0;
  std::string schedulingNote;  ///< Empty when it did not run in real time.
  bool isInterrupted = false;  ///< The user stopped it before the path's end.
  std::optional<DeviceReport> device;
};

/// The servo with the simulated device as fast as it goes, in this thread. Everything but the times taken is
/// the same each time. Interrupts (SIGINT, SIGTERM) end it early. Throws FileError from the writer.
PlaceResult placeFast(PlaceJob job);

/// The same at 1 kHz in the servo thread; this thread writes the rows.
PlaceResult placeInRealTime(PlaceJob job);

/// The job's device leads, until the user interrupts, time is up, or the device is lost or stopped. Throws
/// Error when it cannot be opened.
PlaceResult placeWithDevice(PlaceJob job);

}  // namespace nearfit::cli
