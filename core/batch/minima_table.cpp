#include "core/batch/minima_table.h"

#include <iterator>
#include <utility>

namespace nearfit {
namespace {

template <class T>
void appendColumn(std::vector<T>& column, const std::vector<T>& more) {
  column.insert(column.end(), more.begin(), more.end());
}

void appendTable(MinimaTable& table, const MinimaTable& more) {
  const std::int64_t before = table.offsets.back();
  for (auto offset = std::next(more.offsets.begin()); offset != more.offsets.end(); ++offset)
    table.offsets.push_back(before + *offset);
  appendColumn(table.isComplete, more.isComplete);
  appendColumn(table.distances, more.distances);
  appendColumn(table.movingPoints, more.movingPoints);
  appendColumn(table.fixedPoints, more.fixedPoints);
  appendColumn(table.directions, more.directions);
  appendColumn(table.others, more.others);
  appendColumn(table.features, more.features);
  appendColumn(table.isRegion, more.isRegion);
  appendColumn(table.isBlocked, more.isBlocked);
  appendColumn(table.isMarginal, more.isMarginal);
}

void reserveTable(MinimaTable& table, std::size_t poses, std::size_t rows) {
  table.offsets.reserve(poses + 1);
  table.isComplete.reserve(poses);
  table.distances.reserve(rows);
  table.movingPoints.reserve(rows);
  table.fixedPoints.reserve(rows);
  table.directions.reserve(rows);
  table.others.reserve(rows);
  table.features.reserve(rows);
  table.isRegion.reserve(rows);
  table.isBlocked.reserve(rows);
  table.isMarginal.reserve(rows);
}

}  // namespace

void MinimaTable::add(const Lmd& lmd, std::int32_t other) {
  distances.push_back(lmd.distance);
  movingPoints.push_back(lmd.partPoint);
  fixedPoints.push_back(lmd.scenePoint);
  directions.push_back(lmd.direction);
  others.push_back(other);
  features.push_back({lmd.sceneFeature, lmd.partFeature});
  isRegion.push_back(lmd.isRegion ? 1 : 0);
  isBlocked.push_back(lmd.isBlocked ? 1 : 0);
  isMarginal.push_back(lmd.isMarginal ? 1 : 0);
}

void MinimaTable::endPose(bool isWhole) {
  offsets.push_back(static_cast<std::int64_t>(distances.size()));
  isComplete.push_back(isWhole ? 1 : 0);
}

MinimaTable joined(std::span<MinimaTable> tables) {
  if (tables.size() == 1) return std::exchange(tables.front(), {});
  std::size_t poses = 0, rows = 0;
  for (const MinimaTable& table : tables) {
    poses += table.poses();
    rows += table.rows();
  }
  MinimaTable all;
  reserveTable(all, poses, rows);
  for (MinimaTable& table : tables)
    appendTable(all, std::exchange(table, {}));
  return all;
}

}  // namespace nearfit
