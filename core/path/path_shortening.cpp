#include "core/path/path_shortening.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/path/path_thinning.h"
#include "core/planning/pose_sampler.h"

namespace nearfit {
namespace {

/// Poses nearer than this share of the radius are taken for one.
constexpr double kSamePose = 1e-9;
/// Larger turns between two poses are halved [rad]; a path may have kMaxPathTurn.
constexpr double kMaxTimedTurn = 2.5;
/// Rounds of random shortcuts, and candidates of each, which are proven at once.
constexpr int kShortcutRounds = 32;
constexpr int kShortcutsAtOnce = 16;
/// Bound on the distances that prove a shortcut: one that takes more grazes.
constexpr std::uint64_t kMaxShortcutDistances = 4000;
/// Least gain of a shortcut, in radii: less does not show.
constexpr double kLeastShortcut = 1e-3;
/// Deviation that thinning allows before shortcuts, in radii: any, as long as it is free. And after them: what does
/// not show.
constexpr double kAnyDeviation = 1e6, kUnseenDeviation = 1e-4;

double motionLength(const RigidTransform& from, const RigidTransform& to, const glm::dvec3& centre,
                    double radius) {
  return glm::distance(from.applyToPoint(centre), to.applyToPoint(centre)) + radius * turnBetween(from, to);
}

/// Lengths of a path up to each pose.
std::vector<double> lengthsOf(const AssemblyPath& path, double radius) {
  std::vector<double> lengths{0.0};
  for (std::size_t i = 1; i < path.poses.size(); ++i)
    lengths.push_back(lengths.back() + motionLength(path.poses[i - 1].worldFromLead,
                                                    path.poses[i].worldFromLead, path.centre, radius));
  return lengths;
}

/// A stretch of a path that a single motion may replace.
struct Shortcut {
  double from = 0.0, to = 0.0;  ///< Places.
  double gain = 0.0;            ///< [m]
};

Shortcut randomShortcut(const AssemblyPath& path, const std::vector<double>& lengths, double radius,
                        PoseSampler& sampler) {
  Shortcut out{sampler.between(0.0, path.end()), sampler.between(0.0, path.end()), 0.0};
  if (out.from > out.to) std::swap(out.from, out.to);
  const auto lengthAt = [&](double place) {
    const auto i = std::min(static_cast<std::size_t>(place), lengths.size() - 2);
    return lengths[i] + (place - static_cast<double>(i)) * (lengths[i + 1] - lengths[i]);
  };
  const RigidTransform from = poseAt(path, out.from), to = poseAt(path, out.to);
  if (turnBetween(from, to) > kMaxTimedTurn) return out;
  out.gain = lengthAt(out.to) - lengthAt(out.from) - motionLength(from, to, path.centre, radius);
  return out;
}

std::vector<RigidTransform> posesWith(const AssemblyPath& path, const Shortcut& shortcut) {
  std::vector<RigidTransform> poses;
  for (std::size_t i = 0; static_cast<double>(i) < shortcut.from; ++i)
    poses.push_back(path.poses[i].worldFromLead);
  poses.push_back(poseAt(path, shortcut.from));
  poses.push_back(poseAt(path, shortcut.to));
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    if (static_cast<double>(i) > shortcut.to) poses.push_back(path.poses[i].worldFromLead);
  }
  return poses;
}

/// The best of some random shortcuts that are proven free; no gain if none is. Throws Cancelled.
Shortcut bestShortcut(const AssemblyPath& path, const PathCertifier& certifier, PoseSampler& sampler,
                      const ProgressCallback& goOn) {
  const double radius = certifier.radius();
  const std::vector<double> lengths = lengthsOf(path, radius);
  std::vector<Shortcut> shortcuts;
  std::vector<PathSegment> segments;
  for (int i = 0; i < kShortcutsAtOnce; ++i) {
    const Shortcut shortcut = randomShortcut(path, lengths, radius, sampler);
    if (!(shortcut.gain > kLeastShortcut * radius)) continue;
    shortcuts.push_back(shortcut);
    segments.push_back({poseAt(path, shortcut.from), poseAt(path, shortcut.to)});
  }
  const std::vector<char> isFree = certifier.freeSegments(segments, goOn, kMaxShortcutDistances);
  Shortcut best;
  for (std::size_t i = 0; i < shortcuts.size(); ++i) {
    if (isFree[i] != 0 && shortcuts[i].gain > best.gain) best = shortcuts[i];
  }
  return best;
}

}  // namespace

AssemblyPath timedPath(const AssemblyPath& frame, const std::vector<RigidTransform>& poses, double radius) {
  AssemblyPath path{frame.parts, frame.centre, {}};
  const auto add = [&](const RigidTransform& pose, double length) {
    const double time = path.poses.empty() ? 0.0 : path.poses.back().time + length / radius;
    path.poses.push_back({time, pose.normalized()});
  };
  for (const RigidTransform& pose : poses) {
    if (path.poses.empty()) {
      add(pose, 0.0);
      continue;
    }
    const RigidTransform before = path.poses.back().worldFromLead;
    const double length = motionLength(before, pose, frame.centre, radius);
    if (length <= kSamePose * radius && &pose != &poses.back()) continue;
    const bool isHalved = turnBetween(before, pose) > kMaxTimedTurn;
    if (isHalved) add(poseBetween(before, pose, frame.centre, 0.5), 0.5 * length);
    // The last pose is the goal's, to the bit.
    add(pose, std::max(isHalved ? 0.5 * length : length, kSamePose * radius));
  }
  return path;
}

AssemblyPath shortenedPath(const AssemblyPath& path, const PathCertifier& certifier, std::uint64_t seed,
                           const std::function<bool()>& isOver) {
  if (path.poses.size() <= 2) return path;
  const double radius = certifier.radius();
  const auto posesOf = [](const AssemblyPath& of) {
    std::vector<RigidTransform> poses;
    for (const PathPose& pose : of.poses)
      poses.push_back(pose.worldFromLead);
    return poses;
  };
  const ProgressCallback goOn = [&isOver](double) { return !isOver(); };
  AssemblyPath best = path;
  try {
    best = thinned(path, certifier, kAnyDeviation * radius, goOn).path;
    PoseSampler sampler(seed);
    for (int round = 0; round < kShortcutRounds && best.poses.size() > 2 && !isOver(); ++round) {
      best = timedPath(best, posesOf(best), radius);
      const Shortcut shortcut = bestShortcut(best, certifier, sampler, goOn);
      if (shortcut.gain > 0.0) best = timedPath(best, posesWith(best, shortcut), radius);
    }
    best = timedPath(best, posesOf(best), radius);
    if (best.poses.size() > 2) best = thinned(best, certifier, kUnseenDeviation * radius, goOn).path;
  } catch (const Cancelled&) {
    return best;
  }
  return best;
}

}  // namespace nearfit
