#include "core/path/path_thinning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

/// Rounds of smoothing: what moves a pose by less afterwards does not show.
constexpr std::size_t kSmoothingRounds = 8;
/// Poses that would move by less than this share of the tolerance stay: nobody sees it, and proving it takes time.
constexpr double kLeastStep = 1e-3;

void checkTolerance(const char* where, double tolerance) {
  if (tolerance > 0.0 && std::isfinite(tolerance)) return;
  throw UsageError(where, fmt::format("{} m is not a valid distance", tolerance),
                   "give a length greater than 0");
}

/// Poses that a segment of the thinned path spans, by their numbers.
struct Span {
  std::size_t from, to;
};

/// Chooses which poses stay.
class PathThinner {
 public:
  PathThinner(const AssemblyPath& path, double radius, double tolerance)
      : path_(path), radius_(radius), tolerance_(tolerance) {}

  /// Splits a span until each part of it is within the tolerance; appends these in order.
  void split(Span whole, std::vector<Span>& out) const {
    std::vector<Span> open{whole};
    while (!open.empty()) {
      const Span span = open.back();
      open.pop_back();
      const Worst worst = worstIn(span);
      if (worst.deviation <= tolerance_) {
        out.push_back(span);
        continue;
      }
      open.push_back({worst.pose, span.to});
      open.push_back({span.from, worst.pose});
    }
  }

  /// Splits a span of several segments where it deviates most.
  void halve(Span span, std::vector<Span>& out) const {
    const std::size_t at = worstIn(span).pose;
    out.push_back({span.from, at});
    out.push_back({at, span.to});
  }

 private:
  struct Worst {
    std::size_t pose = 0;
    double deviation = 0.0;  ///< [m]
  };

  /// The pose within a span that is farthest from the way between its ends; its middle if all are on that.
  Worst worstIn(const Span& span) const {
    const PathPose &from = path_.poses[span.from], &to = path_.poses[span.to];
    Worst worst{span.from + (span.to - span.from) / 2, 0.0};
    if (span.to - span.from < 2) return worst;
    if (turnBetween(from.worldFromLead, to.worldFromLead) > kMaxPathTurn)
      return {worst.pose, std::numeric_limits<double>::infinity()};
    for (std::size_t i = span.from + 1; i < span.to; ++i) {
      const PathPose& pose = path_.poses[i];
      const double share = (pose.time - from.time) / (to.time - from.time);
      const RigidTransform there = poseBetween(from.worldFromLead, to.worldFromLead, path_.centre, share);
      const double deviation = displacementBound(there, pose.worldFromLead, path_.centre, radius_);
      if (deviation > worst.deviation) worst = {i, deviation};
    }
    return worst;
  }

  const AssemblyPath& path_;
  double radius_, tolerance_;
};

/// Half the way from a pose to the middle between its neighbours in time.
RigidTransform smoothedPose(const PathPose& before, const PathPose& pose, const PathPose& after,
                            const glm::dvec3& centre) {
  const double share = (pose.time - before.time) / (after.time - before.time);
  const RigidTransform middle = poseBetween(before.worldFromLead, after.worldFromLead, centre, share);
  return poseBetween(pose.worldFromLead, middle, centre, 0.5);
}

}  // namespace

ChangedPath thinned(const AssemblyPath& path, const PathCertifier& certifier, double tolerance,
                    const ProgressCallback& progress) {
  checkTolerance("thin", tolerance);
  checkPath(path, "path");
  const PathThinner thinner(path, certifier.radius(), tolerance);
  std::vector<Span> waiting, accepted;
  ChangedPath result;
  thinner.split({0, path.poses.size() - 1}, waiting);
  while (!waiting.empty()) {
    std::vector<Span> asked;
    for (const Span& span : waiting)
      (span.to - span.from < 2 ? accepted : asked).push_back(span);
    waiting.clear();
    std::vector<PathSegment> segments;
    for (const Span& span : asked)
      segments.push_back({path.poses[span.from].worldFromLead, path.poses[span.to].worldFromLead});
    // Rounds halve what is left; nobody knows how many come.
    const std::vector<char> isFree =
        certifier.freeSegments(segments, [&](double) { return !progress || progress(0.0); });
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (isFree[i]) {
        accepted.push_back(asked[i]);
        continue;
      }
      ++result.refused;
      thinner.halve(asked[i], waiting);
    }
  }
  std::ranges::sort(accepted, {}, &Span::from);
  result.path = {path.parts, path.centre, {path.poses.front()}};
  for (const Span& span : accepted)
    result.path.poses.push_back(path.poses[span.to]);
  result.changed = path.poses.size() - result.path.poses.size();
  if (progress && !progress(1.0)) throw Cancelled();
  return result;
}

ChangedPath smoothed(const AssemblyPath& path, const PathCertifier& certifier, double tolerance,
                     const ProgressCallback& progress) {
  checkTolerance("smooth", tolerance);
  checkPath(path, "path");
  ChangedPath result{path, 0, 0};
  std::vector<PathPose>& poses = result.path.poses;
  std::vector<char> isMoved(poses.size(), 0);
  for (std::size_t round = 0; round < 2 * kSmoothingRounds; ++round) {
    // Every other pose, so that each has neighbours that stay.
    std::vector<std::size_t> asked;
    std::vector<RigidTransform> wanted;
    std::vector<PathSegment> segments;
    for (std::size_t i = 1 + round % 2; i + 1 < poses.size(); i += 2) {
      const RigidTransform pose = smoothedPose(poses[i - 1], poses[i], poses[i + 1], path.centre);
      const double moved =
          displacementBound(path.poses[i].worldFromLead, pose, path.centre, certifier.radius());
      const double step = displacementBound(poses[i].worldFromLead, pose, path.centre, certifier.radius());
      if (moved > tolerance || step < kLeastStep * tolerance) continue;
      asked.push_back(i);
      wanted.push_back(pose);
      segments.push_back({poses[i - 1].worldFromLead, pose});
      segments.push_back({pose, poses[i + 1].worldFromLead});
    }
    const auto share = [&](double fraction) {
      return (static_cast<double>(round) + fraction) / static_cast<double>(2 * kSmoothingRounds);
    };
    const std::vector<char> isFree = certifier.freeSegments(
        segments, [&](double fraction) { return !progress || progress(share(fraction)); });
    for (std::size_t k = 0; k < asked.size(); ++k) {
      const bool isProven = isFree[2 * k] != 0 && isFree[2 * k + 1] != 0;
      if (isProven) poses[asked[k]].worldFromLead = wanted[k];
      if (isProven) isMoved[asked[k]] = 1;
      if (!isProven) ++result.refused;
    }
  }
  result.changed = static_cast<std::size_t>(std::ranges::count(isMoved, 1));
  checkPath(result.path, "path");
  return result;
}

}  // namespace nearfit
