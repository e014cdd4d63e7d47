#include "ui/model/min_distance.h"

#include <QCoreApplication>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "ui/widgets/format.h"

namespace nearfit::ui {

MinDistance minDistanceOf(const ServoSnapshot& snapshot) noexcept {
  // The part may be inside another: then the distance of its surface is none.
  if (snapshot.isOverlapUnknown) return {0.0, true, snapshot.overlappingCount > 0};
  if (snapshot.overlappingCount == 0) return {snapshot.distance, snapshot.isDistanceBound, false};
  if (snapshot.overlappingCount > ServoSnapshot::kMaxOverlapping)
    return {std::numeric_limits<double>::quiet_NaN(), false, true};
  const auto overlapping = std::span(snapshot.overlapping).first(snapshot.overlappingCount);
  double rest = std::numeric_limits<double>::infinity();
  for (const SnapshotLmd& shown : std::span(snapshot.lmds).first(snapshot.storedLmds)) {
    if (std::ranges::find(overlapping, shown.other) == overlapping.end())
      rest = std::min(rest, shown.lmd.distance);
  }
  // Without a minimum of others, the snapshot's bound is that of a part that is overlapped.
  if (std::isinf(rest)) return {rest, false, true};
  // A minimum that is missing is no nearer than the snapshot's distance.
  const bool isMissing =
      snapshot.isTruncated || snapshot.isDistanceBound || snapshot.storedLmds < snapshot.lmdCount;
  const bool isBound = isMissing && snapshot.distance < rest;
  return {isBound ? snapshot.distance : rest, isBound, true};
}

QString formatMinDistance(const MinDistance& shown) {
  if (shown.isOfRest && !std::isfinite(shown.distance))
    return QCoreApplication::translate("format", "– (overlapping)");
  const QString distance = formatDistance(shown.distance, shown.isBound);
  return shown.isOfRest ? QCoreApplication::translate("format", "%1 to others").arg(distance) : distance;
}

}  // namespace nearfit::ui
