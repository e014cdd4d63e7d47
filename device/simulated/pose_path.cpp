#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/pose_csv.h"
#include "device/simulated/simulated_device.h"

namespace nearfit {
namespace {

constexpr std::size_t kColumns = 7;
constexpr const char* kRowRemedy = "write each pose as tx,ty,tz,qw,qx,qy,qz (metres, unit quaternion)";

std::string_view withoutQuotes(std::string_view text) {
  const char* const around = "\" \t";
  const std::size_t begin = text.find_first_not_of(around);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(around) - begin + 1);
}

/// True for a header: every column begins like a name, and none is a number by name (nan, inf). Names may be in
/// quotes; numbers in quotes are a row that cannot be read.
bool isHeader(std::string_view row) {
  const std::vector<std::string_view> columns = csv::columnsOf(row);
  return std::all_of(columns.begin(), columns.end(), [](std::string_view column) {
    const std::string_view name = withoutQuotes(column);
    return !name.empty() && name.find_first_of("0123456789+-.") != 0 && !csv::parseNumber(name);
  });
}

RigidTransform parseRow(std::string_view row, const csv::Place& place) {
  const std::vector<std::string_view> columns = csv::columnsOf(row);
  if (columns.size() != kColumns)
    place.fail(fmt::format("{} values instead of 7", columns.size()), kRowRemedy);
  std::array<double, kColumns> v{};
  for (std::size_t i = 0; i < kColumns; ++i)
    v[i] = csv::finiteNumber(columns[i], i, place, kRowRemedy);
  return csv::poseOf(v, 0, place);
}

}  // namespace

std::vector<RigidTransform> readPosePath(const std::filesystem::path& file) {
  std::vector<RigidTransform> path;
  csv::Rows rows(file);
  bool isFirstRow = true;
  while (const std::optional<std::string_view> row = rows.next()) {
    if (std::exchange(isFirstRow, false) && isHeader(*row)) continue;
    path.push_back(parseRow(*row, rows.place()));
  }
  if (path.empty()) throw FileError(file.string(), "it has no poses", kRowRemedy);
  return path;
}

}  // namespace nearfit
