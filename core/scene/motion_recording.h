#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/atomic_write.h"
#include "core/haptics/servo_tick.h"
#include "core/realtime/spsc_queue.h"

namespace nearfit {

/// What is kept of one tick; trivially copyable. World frame.
struct MotionRow {
  double time = 0.0;      ///< Since the servo started [s].
  RigidTransform handle;  ///< worldFromHandle
  RigidTransform proxy;   ///< worldFromPart
  Wrench wrench;          ///< As sent, about the part's centre of mass.
  std::uint32_t lmds = 0;
  double distance = 0.0;  ///< Least distance [m]; infinity when nothing is within the cutoff.
  double queryTime = 0.0, tickTime = 0.0;  ///< [s]
  std::uint32_t lateBodies = 0;            ///< Searched anew in this tick.
  bool isTruncated = false, isClamped = false;
  ServoFault fault = ServoFault::None;
  double energyToHand = 0.0;  ///< Since the start, less what came back [J].
  double proxyTime = 0.0;     ///< Of the tick, for the proxy without its queries [s].
  std::uint32_t subSteps = 0, shortenedSteps = 0, refusedSteps = 0;  ///< Of the proxy in this tick.
  std::uint32_t constraints = 0, contacts = 0;                       ///< In its last step.
  std::uint32_t released = 0;  ///< Parts that are overlapped and not felt.
  double lateness = 0.0;       ///< Of the tick behind its deadline, or behind the report that it follows [s].
};

/// Real-time safe.
/// @param lateness  Of the tick; what else is kept the snapshot tells [s].
MotionRow motionRow(const ServoSnapshot& snapshot, double lateness = 0.0) noexcept;

/// From the servo thread to the thread that writes: sixteen seconds at 1 kHz.
using MotionQueue = SpscQueue<MotionRow, 16384>;

/// First line of a recording: t_s, handle_tx ... handle_qz, proxy_tx ... proxy_qz, force_x ... torque_z,
/// lmds, distance, query_us, tick_us, late_bodies, energy, sub_steps, shortened, refused, constraints,
/// contacts, released, proxy_us, clamped, fault, truncated, late_us. Poses are tx ty tz qw qx qy qz.
std::string_view motionHeader() noexcept;

/// One line without its end, in the columns of motionHeader. Numbers are the shortest that read back the
/// same, but for durations in microseconds, which are rounded to whole nanoseconds;
/// `distance` is `inf` when nothing is within the cutoff, `clamped` and `truncated` (not all minima
/// that there are within the cutoff were looked for) 0 or 1, `fault` the number of the ServoFault.
std::string formatMotionRow(const MotionRow& row);

/// Writes a recording as CSV, row by row, to a file beside the target that takes its name only when it is
/// whole; a program that is killed leaves that, called "felt.unfinished.csv" where it was to be "felt.csv",
/// with all but the last tenths of a second. Not for the servo thread. Throws FileError.
class MotionWriter {
 public:
  explicit MotionWriter(const std::filesystem::path& file);

  void write(const MotionRow& row);
  /// Flushes to disk and puts the recording in place; without it nothing is left of what was written.
  void finish();
  /// After a failure: puts the whole rows before it in place, and says when the last of them was [s], as it
  /// was given. Nothing when there is none; then none is kept.
  std::optional<double> keepWritten();

 private:
  /// A row in the buffer.
  struct Waiting {
    std::size_t end;  ///< Behind its line.
    double time;
  };
  void writeLine(std::string_view line);
  void flush();

  AtomicFile file_;
  std::string buffer_;  ///< Lines that are not in the file yet.
  std::vector<Waiting> waiting_;
  std::uint64_t flushed_ = 0;       ///< Bytes of the file that are whole lines.
  std::optional<double> lastTime_;  ///< Of what is flushed.
};

}  // namespace nearfit
