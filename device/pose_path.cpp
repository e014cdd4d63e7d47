#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/scene/scene.h"
#include "device/simulated_device.h"

namespace nearfit {
namespace {

constexpr std::size_t kColumns = 7;

/// Seven numbers need a tenth of it. A binary file without line ends must not fill memory.
constexpr std::streamsize kMaxLineBytes = 4096;

std::string_view trimmed(std::string_view text) {
  const char* const blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::optional<double> parseNumber(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // Smaller than the smallest double is zero for a pose.
  if (error == std::errc::result_out_of_range && end == text.data() + text.size() &&
      text.find("e-") != text.npos) {
    return 0.0;
  }
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// A file being read, for messages.
struct Place {
  const std::filesystem::path& file;
  std::size_t line;

  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw FileError(fmt::format("{}:{}", file.string(), line), problem, remedy);
  }
};

constexpr const char* kRowRemedy = "write each pose as tx,ty,tz,qw,qx,qy,qz (metres, unit quaternion)";

/// Cuts a row into its columns; more than seven are counted, not kept.
std::size_t splitRow(std::string_view row, std::array<std::string_view, kColumns>& columns) {
  std::size_t count = 0;
  while (true) {
    const std::size_t comma = row.find(',');
    if (count < kColumns) columns[count] = trimmed(row.substr(0, comma));
    ++count;
    if (comma == std::string_view::npos) return count;
    row.remove_prefix(comma + 1);
  }
}

/// A first row is a header when every column begins as a name does, and none is a number by name (nan, inf).
bool isHeader(std::string_view row) {
  std::array<std::string_view, kColumns> columns;
  const std::size_t count = std::min(splitRow(row, columns), kColumns);
  return std::all_of(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(count),
                     [](std::string_view name) {
                       return !name.empty() && name.find_first_of("0123456789+-.") != 0 && !parseNumber(name);
                     });
}

RigidTransform parseRow(std::string_view row, const Place& place) {
  std::array<std::string_view, kColumns> columns;
  const std::size_t count = splitRow(row, columns);
  if (count != kColumns) place.fail(fmt::format("{} values where 7 belong", count), kRowRemedy);
  std::array<double, kColumns> v{};
  for (std::size_t i = 0; i < kColumns; ++i) {
    const std::optional<double> value = parseNumber(columns[i]);
    if (!value) {
      place.fail(fmt::format("column {}: \"{}\" is not a number", i + 1, columns[i].substr(0, 40)),
                 kRowRemedy);
    }
    if (!std::isfinite(*value)) {
      place.fail(fmt::format("column {}: \"{}\" is not finite", i + 1, columns[i]), kRowRemedy);
    }
    if (i < 3 && std::abs(*value) > kMaxPosition) {
      place.fail(fmt::format("column {}: {} m is too far away", i + 1, *value),
                 fmt::format("give metres, within {} of the origin", kMaxPosition));
    }
    v[i] = *value;
  }
  const RigidTransform pose{glm::dquat(v[3], v[4], v[5], v[6]), glm::dvec3(v[0], v[1], v[2])};
  const double length = std::hypot(std::hypot(v[3], v[4]), std::hypot(v[5], v[6]));
  if (!(std::abs(length - 1.0) <= kQuaternionSlack)) {
    place.fail(fmt::format("the quaternion has length {:.6g}, not 1", length),
               "normalise it; its order is qw,qx,qy,qz");
  }
  return pose.normalized();
}

}  // namespace

std::vector<RigidTransform> readPosePath(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(file, ignored)) {
    throw FileError(file.string(), fmt::format("cannot be read ({})", std::strerror(in ? EISDIR : errno)),
                    "check the name and the permissions");
  }
  std::vector<RigidTransform> path;
  std::array<char, kMaxLineBytes> buffer;
  bool isFirstRow = true;
  for (Place place{file, 1}; in.getline(buffer.data(), kMaxLineBytes) || in.gcount() > 0; ++place.line) {
    if (in.fail() && !in.eof()) {
      if (in.bad()) break;
      place.fail(fmt::format("the line is longer than {} characters", kMaxLineBytes - 1),
                 "check that this is a CSV file of poses");
    }
    // The count includes the line's end, where there is one.
    std::string_view row(buffer.data(), static_cast<std::size_t>(in.gcount()) - (in.eof() ? 0 : 1));
    if (place.line == 1 && row.starts_with("\xEF\xBB\xBF")) row.remove_prefix(3);
    row = trimmed(row);
    if (row.empty() || row.front() == '#') continue;
    if (std::exchange(isFirstRow, false) && isHeader(row)) continue;
    path.push_back(parseRow(row, place));
  }
  if (in.bad()) throw FileError(file.string(), "reading stopped before the end", "check the disk");
  if (path.empty()) throw FileError(file.string(), "there are no poses in it", kRowRemedy);
  return path;
}

}  // namespace nearfit
