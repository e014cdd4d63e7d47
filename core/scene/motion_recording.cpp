#include "core/scene/motion_recording.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"

namespace nearfit {
namespace {

void appendPose(std::string& line, const RigidTransform& pose) {
  const glm::dvec3& t = pose.translation;
  const glm::dquat& q = pose.rotation;
  fmt::format_to(std::back_inserter(line), ",{},{},{},{},{},{},{}", t.x, t.y, t.z, q.w, q.x, q.y, q.z);
}

}  // namespace

MotionRow motionRow(const ServoSnapshot& s) noexcept {
  return {s.time,      s.handle,   s.proxy,       s.wrench,    s.lmdCount, s.distance,
          s.queryTime, s.tickTime, s.isTruncated, s.isClamped, s.fault};
}

std::string_view motionHeader() noexcept {
  return "t_s,"
         "handle_tx,handle_ty,handle_tz,handle_qw,handle_qx,handle_qy,handle_qz,"
         "proxy_tx,proxy_ty,proxy_tz,proxy_qw,proxy_qx,proxy_qy,proxy_qz,"
         "force_x,force_y,force_z,torque_x,torque_y,torque_z,"
         "lmds,distance,query_us,tick_us";
}

std::string formatMotionRow(const MotionRow& row) {
  std::string line = fmt::format("{}", row.time);
  appendPose(line, row.handle);
  appendPose(line, row.proxy);
  const glm::dvec3& f = row.wrench.force;
  const glm::dvec3& t = row.wrench.torque;
  fmt::format_to(std::back_inserter(line), ",{},{},{},{},{},{},{},{},{:.3f},{:.3f}", f.x, f.y, f.z, t.x, t.y,
                 t.z, row.lmds, row.distance, row.queryTime * 1e6, row.tickTime * 1e6);
  return line;
}

MotionWriter::MotionWriter(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code ignored;
  if (file_.filename().empty() || std::filesystem::is_directory(file_, ignored)) {
    throw FileError(file_.string(), "this is a directory, not a file to record to", "give a file name");
  }
  // In the same directory, since a rename is atomic only within one file system.
  temporary_ = (file_.parent_path() / fmt::format(".{}.XXXXXX", file_.filename().string())).string();
  const int descriptor = ::mkostemp(temporary_.data(), O_CLOEXEC);
  if (descriptor < 0) {
    const int error = errno;
    temporary_.clear();
    fail("cannot be created", error);
  }
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor, 0666 & ~mask);
  stream_ = ::fdopen(descriptor, "w");
  if (stream_ == nullptr) {
    const int error = errno;
    ::close(descriptor);
    discard();
    fail("cannot be created", error);
  }
  try {
    writeLine(motionHeader());
  } catch (...) {
    discard();
    throw;
  }
}

MotionWriter::~MotionWriter() {
  discard();
}

void MotionWriter::write(const MotionRow& row) {
  writeLine(formatMotionRow(row));
}

void MotionWriter::finish() {
  if (std::fflush(stream_) != 0 || ::fsync(::fileno(stream_)) != 0) fail("cannot be written", errno);
  const int closed = std::fclose(std::exchange(stream_, nullptr));
  if (closed != 0) fail("cannot be written", errno);
  if (std::rename(temporary_.c_str(), file_.c_str()) != 0) fail("cannot be put in place", errno);
  temporary_.clear();
}

void MotionWriter::writeLine(std::string_view line) {
  if (std::fwrite(line.data(), 1, line.size(), stream_) != line.size() || std::fputc('\n', stream_) == EOF) {
    fail("cannot be written", errno);
  }
}

void MotionWriter::fail(const std::string& problem, int error) {
  throw FileError(file_.string(), fmt::format("the recording {} ({})", problem, std::strerror(error)),
                  "choose a directory that exists, can be written and has room");
}

void MotionWriter::discard() noexcept {
  if (stream_ != nullptr) std::fclose(std::exchange(stream_, nullptr));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

}  // namespace nearfit
