#include "core/scene/pose_csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace nearfit::csv {
namespace {

/// Ten times what seven numbers need, four times a row of a recording, without the line's end. Keeps a binary
/// file without line ends from filling memory.
constexpr std::size_t kMaxLineBytes = 4095;
/// Read at once; more than a line.
constexpr std::size_t kBufferBytes = std::size_t{1} << 16;

}  // namespace

void Place::fail(const std::string& problem, const std::string& remedy) const {
  throw FileError(fmt::format("{}:{}", file.string(), line), problem, remedy);
}

std::string_view trimmed(std::string_view text) noexcept {
  const char* const blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

Rows::Rows(const std::filesystem::path& file) : in_(file), place_{file, 0}, buffer_(kBufferBytes) {}

void Rows::refill() {
  std::copy(unread_.begin(), unread_.end(), buffer_.begin());
  const std::size_t count = in_.read(std::span(buffer_).subspan(unread_.size()));
  unread_ = {buffer_.data(), unread_.size() + count};
}

std::optional<std::string_view> Rows::nextLine() {
  if (unread_.size() <= kMaxLineBytes) refill();
  if (unread_.empty()) return std::nullopt;
  ++place_.line;
  const std::size_t end = unread_.substr(0, kMaxLineBytes + 1).find('\n');
  hasEnd_ = end != std::string_view::npos;
  if (!hasEnd_ && unread_.size() > kMaxLineBytes) {
    place_.fail(fmt::format("the line is longer than {} characters", kMaxLineBytes),
                "check that this is a CSV file of poses");
  }
  const std::string_view line = unread_.substr(0, end);
  const std::size_t count = line.size() + (hasEnd_ ? 1 : 0);
  unread_.remove_prefix(count);
  taken_ += count;
  return line;
}

std::optional<std::string_view> Rows::next() {
  while (std::optional<std::string_view> row = nextLine()) {
    if (place_.line == 1 && row->starts_with("\xEF\xBB\xBF")) row->remove_prefix(3);
    row = trimmed(*row);
    if (!row->empty() && row->front() != '#') return row;
  }
  return std::nullopt;
}

std::vector<std::string_view> columnsOf(std::string_view row) {
  std::vector<std::string_view> columns;
  while (true) {
    const std::size_t comma = row.find(',');
    columns.push_back(trimmed(row.substr(0, comma)));
    if (comma == std::string_view::npos) return columns;
    row.remove_prefix(comma + 1);
  }
}

std::optional<double> parseNumber(std::string_view text) noexcept {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // Underflow counts as zero.
  if (error == std::errc::result_out_of_range && end == text.data() + text.size() &&
      text.find("e-") != text.npos) {
    return 0.0;
  }
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

double finiteNumber(std::string_view text, std::size_t column, const Place& place, const char* remedy) {
  const std::optional<double> value = parseNumber(text);
  if (!value)
    place.fail(fmt::format("column {}: \"{}\" is not a number", column + 1, text.substr(0, 40)), remedy);
  if (!std::isfinite(*value))
    place.fail(fmt::format("column {}: \"{}\" is not finite", column + 1, text), remedy);
  return *value;
}

RigidTransform poseOf(std::span<const double, 7> v, std::size_t firstColumn, const Place& place) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(v[i]) > kMaxPosition) {
      place.fail(fmt::format("column {}: {} m is too far from the origin", firstColumn + i + 1, v[i]),
                 fmt::format("give metres, within {} of the origin", kMaxPosition));
    }
  }
  const RigidTransform pose{glm::dquat(v[3], v[4], v[5], v[6]), glm::dvec3(v[0], v[1], v[2])};
  const double length = std::hypot(std::hypot(v[3], v[4]), std::hypot(v[5], v[6]));
  if (!(std::abs(length - 1.0) <= kQuaternionSlack)) {
    place.fail(fmt::format("the quaternion has length {:.6g}, not 1", length),
               "normalise it; its order is qw,qx,qy,qz");
  }
  return pose.normalized();
}

}  // namespace nearfit::csv
