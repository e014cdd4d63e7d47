#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/atomic_write.h"
#include "core/realtime/spsc_queue.h"
#include "core/servo/servo_tick.h"

namespace nearfit {

/// What a recording keeps of one tick, and a little more; trivially copyable. World frame.
struct MotionRow {
  double time = 0.0;      ///< Since the servo started [s].
  RigidTransform handle;  ///< worldFromHandle
  RigidTransform proxy;   ///< worldFromPart
  Wrench wrench;          ///< As sent to the device, about the part's centre of mass.
  std::uint32_t lmds = 0;
  double distance = 0.0;                   ///< Min distance [m]; infinity if nothing is within the cutoff.
  bool isDistanceBound = false;            ///< See ServoSnapshot::isDistanceBound.
  double queryTime = 0.0, tickTime = 0.0;  ///< [s]
  std::uint32_t lateBodies = 0;            ///< Bodies searched anew in this tick.
  /// Truncated: the search may have missed minima. Clamped: a limit cut the wrench.
  bool isTruncated = false, isClamped = false;
  ServoFault fault = ServoFault::None;
  double energyToHand = 0.0;  ///< Given to the hand since the start, less what came back [J].
  double proxyTime = 0.0;     ///< Time of the tick spent in the proxy, without its queries [s].
  std::uint32_t subSteps = 0, shortenedSteps = 0, refusedSteps = 0;  ///< Steps of the proxy in this tick.
  std::uint32_t constraints = 0, contacts = 0;                       ///< In the proxy's last step.
  std::uint32_t overlapping = 0;                                     ///< Parts that the moving part overlaps.
  double wrenchTime = 0.0;                                           ///< Time until the wrench was known [s].
  bool isBehind = false;         ///< The tick's work ended before the proxy's way.
  std::optional<double> grip{};  ///< Opening angle of the device's gripper [rad]; none if it has no gripper.
  /// As in the snapshot; not in the recording.
  std::uint32_t areas = 0;
  SpringShares springShares;
  double lateness = 0.0;  ///< Delay of the tick after its deadline, or after the report that triggers it [s].
};

/// Converts a snapshot to a row. Real-time safe.
/// @param lateness  See MotionRow::lateness [s].
MotionRow motionRow(const ServoSnapshot& snapshot, double lateness = 0.0) noexcept;

/// Carries rows from the servo thread to the writing thread: sixteen seconds at 1 kHz.
using MotionQueue = SpscQueue<MotionRow, 16384>;

/// Header line of a recording: t_s, handle_tx ... handle_qz, proxy_tx ... proxy_qz, force_x ... torque_z,
/// lmds, distance, query_us, tick_us, late_bodies, energy, sub_steps, shortened, refused, constraints,
/// contacts, released, proxy_us, clamped, fault, truncated, late_us, wrench_us, behind, grip, distance_bound.
/// Poses are tx ty tz qw qx qy qz.
std::string_view motionHeader() noexcept;

/// Formats a row in the columns of motionHeader(), without line end. Numbers have the fewest digits that read
/// back to the same double, except durations in microseconds, which are rounded to nanoseconds. `distance` is
/// `inf` if nothing is within the cutoff; `grip` is `nan` if the device has none; `clamped`, `truncated` (the
/// search may have missed minima within the cutoff), `behind` and `distance_bound` are 0 or 1;
/// `fault` is the number of the ServoFault.
std::string formatMotionRow(const MotionRow& row);

/// Writes a recording as CSV, row by row, to a temporary file beside the target: "felt.unfinished.csv" for
/// "felt.csv". finish() renames it. If the program is killed, the temporary file remains and lacks only the
/// last tenths of a second. Not for the servo thread. Throws FileError.
class MotionWriter {
 public:
  /// Creates the temporary file and writes the header.
  explicit MotionWriter(const std::filesystem::path& file);

  /// Appends a row. Buffered: it reaches the file in blocks of 64 KiB.
  void write(const MotionRow& row);
  /// Flushes to disk and moves the recording to its name. Without this call, nothing is kept.
  void finish();
  /// After a failure, keeps the rows written completely and returns the time of the last one [s]. Returns
  /// std::nullopt, and keeps no file, if there is none.
  std::optional<double> keepWritten();

 private:
  /// A row in the buffer.
  struct Waiting {
    std::size_t end;  ///< Offset just past its line in `buffer_`.
    double time;
  };
  void writeLine(std::string_view line);
  void flush();

  AtomicFile file_;
  std::string buffer_;  ///< Lines not written to the file yet.
  std::vector<Waiting> waiting_;
  std::uint64_t flushed_ = 0;       ///< Size of the file's complete lines [bytes].
  std::optional<double> lastTime_;  ///< Time of the last row flushed [s].
};

}  // namespace nearfit
