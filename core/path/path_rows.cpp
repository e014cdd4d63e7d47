#include "core/path/path_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nearfit {

AssemblyPath sampledPath(const AssemblyPath& path, double step, std::size_t maxAdded) {
  const std::size_t room = kMaxPathPoses - std::min(kMaxPathPoses, path.poses.size());
  maxAdded = std::min(maxAdded, room);
  if (path.poses.size() < 2 || maxAdded == 0) return path;
  const double duration = path.poses.back().time - path.poses.front().time;
  const double longest = std::max(step, duration / static_cast<double>(maxAdded));
  AssemblyPath sampled = path;
  sampled.poses.clear();
  for (std::size_t i = 0; i + 1 < path.poses.size(); ++i) {
    const PathPose &from = path.poses[i], &to = path.poses[i + 1];
    sampled.poses.push_back(from);
    const auto parts = static_cast<std::size_t>(std::ceil((to.time - from.time) / longest));
    for (std::size_t k = 1; k < parts; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(parts);
      sampled.poses.push_back({from.time + share * (to.time - from.time),
                               poseBetween(from.worldFromLead, to.worldFromLead, path.centre, share)});
    }
  }
  sampled.poses.push_back(path.poses.back());
  return sampled;
}

std::vector<MotionRow> rowsOfPath(const AssemblyPath& path) {
  std::vector<MotionRow> rows;
  rows.reserve(path.poses.size());
  for (const PathPose& pose : path.poses) {
    MotionRow& row = rows.emplace_back();
    row.time = pose.time - path.poses.front().time;
    row.handle = row.proxy = pose.worldFromLead;
    row.distance = std::numeric_limits<double>::infinity();
  }
  return rows;
}

void setDistances(std::span<MotionRow> rows, const std::vector<PathClearance>& clearances) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].distance = std::numeric_limits<double>::infinity();
    for (const PathClearance& clearance : clearances) {
      if (i < clearance.distances.size())
        rows[i].distance = std::min(rows[i].distance, clearance.distances[i]);
    }
  }
}

}  // namespace nearfit
