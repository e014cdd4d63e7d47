#include "tests/bench/pose_record.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit::bench {
namespace {

constexpr std::array<const char*, 7> kColumns{"tx", "ty", "tz", "qw", "qx", "qy", "qz"};
constexpr const char* kRemedy = "record the motion again";

std::vector<std::string_view> cellsOf(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string_view> cells;
  for (std::size_t comma = 0; comma != line.npos; line.remove_prefix(std::min(line.size(), comma + 1))) {
    comma = line.find(',');
    cells.push_back(line.substr(0, comma));
  }
  return cells;
}

/// Of the column that says how many parts were released; none where there is no such column.
std::optional<std::size_t> placeOfReleased(const std::string& header) {
  const std::vector<std::string_view> names = cellsOf(header);
  const auto found = std::ranges::find(names, std::string_view("released"));
  if (found == names.end()) return {};
  return static_cast<std::size_t>(found - names.begin());
}

std::array<std::size_t, 7> placesOf(const std::filesystem::path& file, const std::string& header,
                                    const std::string& name) {
  const std::vector<std::string_view> names = cellsOf(header);
  std::array<std::size_t, 7> places{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const std::string wanted = fmt::format("{}_{}", name, kColumns[i]);
    const auto found = std::ranges::find(names, wanted);
    if (found == names.end())
      throw FileError(file.string() + ":1", fmt::format("it has no column {}", wanted), kRemedy);
    places[i] = static_cast<std::size_t>(found - names.begin());
  }
  return places;
}

}  // namespace

std::vector<RecordedPose> readRecordedPoses(const std::filesystem::path& file, const std::string& name,
                                            std::size_t every) {
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) throw FileError(file.string(), "it cannot be read, or is empty", kRemedy);
  const std::array<std::size_t, 7> places = placesOf(file, line, name);
  const std::optional<std::size_t> released = placeOfReleased(line);
  std::vector<RecordedPose> poses;
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    if ((number - 2) % every != 0) continue;
    const std::vector<std::string_view> cells = cellsOf(line);
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const std::string_view cell = places[i] < cells.size() ? cells[places[i]] : "";
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), v[i]);
      if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(v[i])) {
        throw FileError(fmt::format("{}:{}", file.string(), number),
                        fmt::format("its {}_{} is no finite number", name, kColumns[i]), kRemedy);
      }
    }
    const bool isReleased = released && *released < cells.size() && cells[*released] != "0";
    poses.push_back({{{v[3], v[4], v[5], v[6]}, {v[0], v[1], v[2]}}, number, isReleased});
  }
  return poses;
}

}  // namespace nearfit::bench
