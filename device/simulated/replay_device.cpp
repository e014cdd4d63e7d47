#include "device/simulated/replay_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/pose_csv.h"
#include "device/interface/device_supervisor.h"

namespace nearfit {
namespace {

constexpr const char* kRemedy =
    "give a recording written by nearfit-cli place --record; for a file of poses alone, use --path";
constexpr std::array kNames = {"t_s",       "handle_tx", "handle_ty", "handle_tz",
                               "handle_qw", "handle_qx", "handle_qy", "handle_qz"};
/// Rows between two calls of `progress`.
constexpr std::size_t kRowsPerReport = 1000;
/// Eleven days: longer than any recording, and well within the range of nanoseconds [s].
constexpr double kLongest = 1e6;
/// Nothing sends at a shorter period; such rows belong to one tick [s].
constexpr double kMinReplayPeriod = 1e-4;

using Columns = std::array<std::size_t, kNames.size()>;

Columns columnsNamed(std::string_view header, const csv::Place& place) {
  const std::vector<std::string_view> names = csv::columnsOf(header);
  Columns columns{};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), kNames[i]);
    if (found == names.end()) place.fail(fmt::format("there is no column {}", kNames[i]), kRemedy);
    columns[i] = static_cast<std::size_t>(found - names.begin());
  }
  return columns;
}

TimedPose parseRow(std::string_view row, const Columns& columns, const csv::Place& place) {
  const std::vector<std::string_view> texts = csv::columnsOf(row);
  std::array<double, kNames.size()> values{};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (columns[i] >= texts.size()) place.fail(fmt::format("it ends before column {}", kNames[i]), kRemedy);
    values[i] = csv::finiteNumber(texts[columns[i]], columns[i], place, kRemedy);
  }
  if (std::abs(values[0]) > kLongest) place.fail(fmt::format("{} s is not a valid time", values[0]), kRemedy);
  return {values[0], csv::poseOf(std::span(values).last<7>(), columns[1], place)};
}

}  // namespace

std::vector<TimedPose> readHandMotion(const std::filesystem::path& file, const ProgressCallback& progress) {
  csv::Rows rows(file);
  const std::optional<std::string_view> header = rows.next();
  if (!header) throw FileError(file.string(), "it is empty", kRemedy);
  const Columns columns = columnsNamed(*header, rows.place());
  std::vector<TimedPose> motion;
  while (const std::optional<std::string_view> row = rows.next()) {
    const auto pose = rows.parsed(!motion.empty(), [&] { return parseRow(*row, columns, rows.place()); });
    if (!pose) break;
    motion.push_back(*pose);
    if (motion.size() > 1 && motion.back().time < motion[motion.size() - 2].time)
      rows.place().fail("its time is earlier than that of the row before", kRemedy);
    if (!progress || motion.size() % kRowsPerReport != 0 || rows.size() == 0) continue;
    const double share = static_cast<double>(rows.taken()) / static_cast<double>(rows.size());
    if (!progress(std::min(share, 1.0))) throw Cancelled();
  }
  if (motion.empty()) throw FileError(file.string(), "it has no poses", kRemedy);
  const double begin = motion.front().time;
  for (TimedPose& each : motion)
    each.time -= begin;
  return motion;
}

ReplayDevice::ReplayDevice(std::filesystem::path file) : file_(std::move(file)) {}

double ReplayDevice::reportPeriod() const noexcept {
  if (motion_.size() < 2) return 0.0;
  const double period = motion_.back().time / static_cast<double>(motion_.size() - 1);
  return period < kMinReplayPeriod ? 0.0 : period;
}

DeviceInfo ReplayDevice::info() const {
  // Recorded poses have already been through the workspace mapping.
  return {"Recording " + file_.filename().string(), 0, DeviceLimits{}, reportPeriod(), false};
}

void ReplayDevice::start(const RigidTransform& worldFromPart, const ProgressCallback& progress) {
  state_.store(DeviceState::Opening, std::memory_order_release);
  try {
    motion_ = readHandMotion(file_, progress);
  } catch (...) {
    state_.store(DeviceState::Present, std::memory_order_release);
    throw;
  }
  const RigidTransform first = motion_.front().worldFromHandle;
  const RigidTransform moved = worldFromPart.normalized() * first.inverse();
  for (TimedPose& each : motion_)
    each.worldFromHandle = (moved * each.worldFromHandle).normalized();
  SafetyLimits limits;
  limits.keepPace(reportPeriod());
  patience_ = limits.patience;
  next_ = 0;
  begin_ = 0;
  state_.store(DeviceState::Armed, std::memory_order_release);
}

void ReplayDevice::stop() noexcept {
  state_.store(DeviceState::Present, std::memory_order_release);
}

Nanoseconds ReplayDevice::dueTime(std::size_t pose) const noexcept {
  return begin_ + static_cast<Nanoseconds>(motion_[pose].time * 1e9);
}

bool ReplayDevice::waitForHandle(Nanoseconds deadline) noexcept {
  if (begin_ == 0) begin_ = monotonicNow();
  // After the end there is nothing to wait for: readHandle() says so.
  const bool isDue = next_ == motion_.size() || dueTime(next_) <= deadline;
  waitUntil(next_ == motion_.size() ? deadline : std::min(dueTime(next_), deadline));
  return isDue && next_ < motion_.size();
}

bool ReplayDevice::readHandle(HandleInput& handle) noexcept {
  if (state() != DeviceState::Armed) return false;
  const Nanoseconds now = monotonicNow();
  if (begin_ == 0) begin_ = now;
  if (next_ == motion_.size()) {
    state_.store(DeviceState::Present, std::memory_order_release);
    return false;
  }
  // The newest pose wins, as with reports that come during a tick; the first one is due at once.
  const std::size_t before = next_;
  while (next_ < motion_.size() && dueTime(next_) <= now)
    ++next_;
  poses_.fetch_add(next_ - before, std::memory_order_relaxed);
  handle = {.pose = motion_[next_ - 1].worldFromHandle};
  handle.age = toSeconds(std::max<Nanoseconds>(now - dueTime(next_ - 1), 0));
  handle.patience = patience_;
  return true;
}

}  // namespace nearfit
