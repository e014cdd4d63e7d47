#include "core/servo/motion_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/pose_csv.h"

namespace nearfit {
namespace {

constexpr const char* kRemedy = "give a recording written by nearfit or by nearfit-cli place --record";
/// Rows between two progress reports.
constexpr std::size_t kRowsPerReport = 1000;
/// Max time in a recording: eleven days [s].
constexpr double kLongest = 1e6;
/// Max magnitude of forces, energies and times. Larger values are errors, and would overflow in plots.
constexpr double kLargest = 1e12;

enum class Kind : std::uint8_t { Time, Number, Distance, Duration, Count, Grip, Pose };

struct Column {
  std::string_view name;
  Kind kind;
  bool isRequired;
};

/// In the order of motionHeader(), so that an index identifies a column.
constexpr std::array kColumns = {Column{"t_s", Kind::Time, true},
                                 Column{"handle_tx", Kind::Pose, true},
                                 Column{"handle_ty", Kind::Pose, true},
                                 Column{"handle_tz", Kind::Pose, true},
                                 Column{"handle_qw", Kind::Pose, true},
                                 Column{"handle_qx", Kind::Pose, true},
                                 Column{"handle_qy", Kind::Pose, true},
                                 Column{"handle_qz", Kind::Pose, true},
                                 Column{"proxy_tx", Kind::Pose, true},
                                 Column{"proxy_ty", Kind::Pose, true},
                                 Column{"proxy_tz", Kind::Pose, true},
                                 Column{"proxy_qw", Kind::Pose, true},
                                 Column{"proxy_qx", Kind::Pose, true},
                                 Column{"proxy_qy", Kind::Pose, true},
                                 Column{"proxy_qz", Kind::Pose, true},
                                 Column{"force_x", Kind::Number, true},
                                 Column{"force_y", Kind::Number, true},
                                 Column{"force_z", Kind::Number, true},
                                 Column{"torque_x", Kind::Number, true},
                                 Column{"torque_y", Kind::Number, true},
                                 Column{"torque_z", Kind::Number, true},
                                 Column{"lmds", Kind::Count, false},
                                 Column{"distance", Kind::Distance, false},
                                 Column{"query_us", Kind::Duration, false},
                                 Column{"tick_us", Kind::Duration, false},
                                 Column{"late_bodies", Kind::Count, false},
                                 Column{"energy", Kind::Number, false},
                                 Column{"sub_steps", Kind::Count, false},
                                 Column{"shortened", Kind::Count, false},
                                 Column{"refused", Kind::Count, false},
                                 Column{"constraints", Kind::Count, false},
                                 Column{"contacts", Kind::Count, false},
                                 Column{"released", Kind::Count, false},
                                 Column{"proxy_us", Kind::Duration, false},
                                 Column{"clamped", Kind::Count, false},
                                 Column{"fault", Kind::Count, false},
                                 Column{"truncated", Kind::Count, false},
                                 Column{"late_us", Kind::Duration, false},
                                 Column{"wrench_us", Kind::Duration, false},
                                 Column{"behind", Kind::Count, false},
                                 Column{"grip", Kind::Grip, false},
                                 Column{"distance_bound", Kind::Count, false}};
constexpr std::size_t kFirstHandle = 1, kFirstProxy = 8, kFirstForce = 15, kAfterWrench = 21;
constexpr std::size_t kGrip = kAfterWrench + 19;
static_assert(kColumns[kGrip].kind == Kind::Grip);

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();
using Places = std::array<std::size_t, kColumns.size()>;
using Values = std::array<double, kColumns.size()>;

Places placesIn(std::string_view header, const csv::Place& place) {
  const std::vector<std::string_view> names = csv::columnsOf(header);
  Places places{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), kColumns[i].name);
    if (found == names.end() && kColumns[i].isRequired)
      place.fail(fmt::format("there is no column {}", kColumns[i].name), kRemedy);
    places[i] = found == names.end() ? kAbsent : static_cast<std::size_t>(found - names.begin());
  }
  return places;
}

bool isAllowed(Kind kind, double value) {
  switch (kind) {
    case Kind::Time:
      return std::abs(value) <= kLongest;
    case Kind::Number:
      return std::abs(value) <= kLargest;
    case Kind::Distance:
      return value >= 0.0;
    case Kind::Duration:
      return value >= 0.0 && value <= kLargest;
    case Kind::Count:
      return value >= 0.0 && value <= std::numeric_limits<std::uint32_t>::max() && value == std::floor(value);
    case Kind::Grip:
      // A device without a gripper has none: NaN.
      return std::isnan(value) || std::abs(value) <= kLargest;
    case Kind::Pose:
      break;
  }
  return true;  // Checked by poseOf(), with a better message.
}

double numberIn(std::string_view text, std::size_t index, std::size_t at, const csv::Place& place) {
  const Column& column = kColumns[index];
  std::optional<double> number = csv::parseNumber(text);
  if (column.kind != Kind::Distance && column.kind != Kind::Grip)
    number = csv::finiteNumber(text, at, place, kRemedy);
  if (!number || !isAllowed(column.kind, *number))
    place.fail(fmt::format("column {}: \"{}\" is not a valid {}", at + 1, text.substr(0, 40), column.name),
               kRemedy);
  return *number;
}

Values valuesIn(std::string_view row, const Places& places, const csv::Place& place) {
  const std::vector<std::string_view> texts = csv::columnsOf(row);
  Values values{};
  values[kAfterWrench + 1] = std::numeric_limits<double>::infinity();
  values[kGrip] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    if (places[i] == kAbsent) continue;
    if (places[i] >= texts.size())
      place.fail(fmt::format("it ends before column {}", kColumns[i].name), kRemedy);
    values[i] = numberIn(texts[places[i]], i, places[i], place);
  }
  return values;
}

/// Reads the columns after the wrench, in order.
void takeRest(MotionRow& row, std::span<const double> v, const csv::Place& place) {
  constexpr double kMicro = 1e-6;
  const auto count = [&](std::size_t i) { return static_cast<std::uint32_t>(v[i]); };
  row.lmds = count(0);
  row.distance = v[1];
  row.queryTime = kMicro * v[2];
  row.tickTime = kMicro * v[3];
  row.lateBodies = count(4);
  row.energyToHand = v[5];
  row.subSteps = count(6);
  row.shortenedSteps = count(7);
  row.refusedSteps = count(8);
  row.constraints = count(9);
  row.contacts = count(10);
  row.overlapping = count(11);
  row.proxyTime = kMicro * v[12];
  row.isClamped = v[13] != 0.0;
  if (v[14] > static_cast<double>(ServoFault::ParametersInvalid))
    place.fail(fmt::format("no fault has the number {}", v[14]), kRemedy);
  row.fault = static_cast<ServoFault>(count(14));
  row.isTruncated = v[15] != 0.0;
  row.lateness = kMicro * v[16];
  row.wrenchTime = kMicro * v[17];
  row.isBehind = v[18] != 0.0;
  if (const double grip = v[kGrip - kAfterWrench]; !std::isnan(grip)) row.grip = grip;
  row.isDistanceBound = v[20] != 0.0;
}

MotionRow parseRow(std::string_view text, const Places& places, const csv::Place& place) {
  const Values v = valuesIn(text, places, place);
  MotionRow row;
  row.time = v[0];
  row.handle = csv::poseOf(std::span(v).subspan<kFirstHandle, 7>(), places[kFirstHandle], place);
  row.proxy = csv::poseOf(std::span(v).subspan<kFirstProxy, 7>(), places[kFirstProxy], place);
  row.wrench.force = {v[kFirstForce], v[kFirstForce + 1], v[kFirstForce + 2]};
  row.wrench.torque = {v[kFirstForce + 3], v[kFirstForce + 4], v[kFirstForce + 5]};
  takeRest(row, std::span(v).subspan<kAfterWrench>(), place);
  return row;
}

void reportProgress(const csv::Rows& rows, const ProgressCallback& progress) {
  if (!progress || rows.size() == 0) return;
  const double share = static_cast<double>(rows.taken()) / static_cast<double>(rows.size());
  if (!progress(std::min(share, 1.0))) throw Cancelled();
}

}  // namespace

Recording readRecording(const std::filesystem::path& file, const ProgressCallback& progress) {
  csv::Rows rows(file);
  const std::optional<std::string_view> header = rows.next();
  if (!header) throw FileError(file.string(), "it is empty", kRemedy);
  const Places places = placesIn(*header, rows.place());
  Recording read;
  std::vector<MotionRow>& motion = read.rows;
  while (const std::optional<std::string_view> text = rows.next()) {
    if (motion.size() == kMaxMotionRows)
      rows.place().fail(fmt::format("there are more than {} rows", kMaxMotionRows), "split the recording");
    const auto row = rows.parsed(!motion.empty(), [&] { return parseRow(*text, places, rows.place()); });
    if (!row) {
      read.isCut = true;
      break;
    }
    motion.push_back(*row);
    if (motion.size() > 1 && motion.back().time < motion[motion.size() - 2].time)
      rows.place().fail("its time is earlier than that of the row before", kRemedy);
    if (motion.size() % kRowsPerReport == 0) reportProgress(rows, progress);
  }
  if (motion.empty()) throw FileError(file.string(), "it has no rows", kRemedy);
  const double begin = motion.front().time;
  for (MotionRow& row : motion)
    row.time -= begin;
  return read;
}

std::vector<MotionRow> readMotion(const std::filesystem::path& file, const ProgressCallback& progress) {
  return readRecording(file, progress).rows;
}

}  // namespace nearfit
