#include "core/servo/motion_recording.h"

#include <iterator>
#include <limits>

#include <fmt/format.h>

namespace nearfit {
namespace {

void appendPose(std::string& line, const RigidTransform& pose) {
  const glm::dvec3& t = pose.translation;
  const glm::dquat& q = pose.rotation;
  fmt::format_to(std::back_inserter(line), ",{},{},{},{},{},{},{}", t.x, t.y, t.z, q.w, q.x, q.y, q.z);
}

}  // namespace

MotionRow motionRow(const ServoSnapshot& s, double lateness) noexcept {
  MotionRow row;
  row.time = s.time;
  row.handle = s.handle;
  row.proxy = s.proxy;
  row.wrench = s.wrench;
  row.lmds = s.lmdCount;
  row.distance = s.distance;
  row.isDistanceBound = s.isDistanceBound;
  row.queryTime = s.queryTime;
  row.tickTime = s.tickTime;
  row.lateBodies = s.lateBodies;
  row.isTruncated = s.isTruncated;
  row.isClamped = s.isClamped;
  row.fault = s.fault;
  row.energyToHand = s.energyToHand;
  row.proxyTime = s.proxyTime;
  row.subSteps = s.subSteps;
  row.shortenedSteps = s.shortenedSteps;
  row.refusedSteps = s.refusedSteps;
  row.constraints = s.constraintCount;
  row.contacts = s.contactCount;
  row.overlapping = s.overlappingCount;
  row.wrenchTime = s.wrenchTime;
  row.isBehind = s.isBehind;
  row.grip = s.grip;
  row.areas = s.areaCount;
  row.springShares = s.springShares;
  row.lateness = lateness;
  return row;
}

std::string_view motionHeader() noexcept {
  return "t_s,"
         "handle_tx,handle_ty,handle_tz,handle_qw,handle_qx,handle_qy,handle_qz,"
         "proxy_tx,proxy_ty,proxy_tz,proxy_qw,proxy_qx,proxy_qy,proxy_qz,"
         "force_x,force_y,force_z,torque_x,torque_y,torque_z,"
         "lmds,distance,query_us,tick_us,late_bodies,"
         "energy,sub_steps,shortened,refused,constraints,contacts,released,proxy_us,clamped,fault,"
         "truncated,late_us,wrench_us,behind,grip,distance_bound";
}

std::string formatMotionRow(const MotionRow& row) {
  std::string line = fmt::format("{}", row.time);
  appendPose(line, row.handle);
  appendPose(line, row.proxy);
  const glm::dvec3& f = row.wrench.force;
  const glm::dvec3& t = row.wrench.torque;
  fmt::format_to(std::back_inserter(line), ",{},{},{},{},{},{},{},{},{:.3f},{:.3f},{}", f.x, f.y, f.z, t.x,
                 t.y, t.z, row.lmds, row.distance, row.queryTime * 1e6, row.tickTime * 1e6, row.lateBodies);
  fmt::format_to(std::back_inserter(line),
                 ",{},{},{},{},{},{},{},{:.3f},{:d},{:d},{:d},{:.3f},{:.3f},{:d},{},{:d}", row.energyToHand,
                 row.subSteps, row.shortenedSteps, row.refusedSteps, row.constraints, row.contacts,
                 row.overlapping, row.proxyTime * 1e6, row.isClamped, static_cast<int>(row.fault),
                 row.isTruncated, row.lateness * 1e6, row.wrenchTime * 1e6, row.isBehind,
                 row.grip.value_or(std::numeric_limits<double>::quiet_NaN()), row.isDistanceBound);
  return line;
}

MotionWriter::MotionWriter(const std::filesystem::path& file)
    : file_(file, FileAccess::Usual, Unfinished::Visible) {
  writeLine(motionHeader());
}

void MotionWriter::write(const MotionRow& row) {
  const std::string line = formatMotionRow(row);
  waiting_.push_back({buffer_.size() + line.size() + 1, row.time});
  writeLine(line);
}

void MotionWriter::finish() {
  flush();
  file_.commit();
}

void MotionWriter::flush() {
  file_.write(buffer_);
  flushed_ = file_.size();
  if (!waiting_.empty()) lastTime_ = waiting_.back().time;
  buffer_.clear();
  waiting_.clear();
}

std::optional<double> MotionWriter::keepWritten() {
  std::uint64_t whole = flushed_;
  for (const Waiting& row : waiting_) {
    if (flushed_ + row.end > file_.size()) break;
    whole = flushed_ + row.end;
    lastTime_ = row.time;
  }
  if (!lastTime_) return std::nullopt;
  file_.cut(whole);
  // A failed disk may refuse to flush.
  file_.commit(AtomicFile::Flush::Later);
  return lastTime_;
}

void MotionWriter::writeLine(std::string_view line) {
  // A few hundred rows per system call.
  constexpr std::size_t kBlock = 1 << 16;
  buffer_ += line;
  buffer_ += '\n';
  if (buffer_.size() >= kBlock) flush();
}

}  // namespace nearfit
