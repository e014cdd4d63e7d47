#include "core/path/assembly_path.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

/// Rotations are unit to within this, of the squared length: a dozen roundings. Others are normalised.
constexpr double kUnitRounding = 3e-15;

void checkPathPose(const PathPose& pose, std::size_t index, const std::string& where) {
  const auto fail = [&](const std::string& problem) {
    throw UsageError(where, fmt::format("pose {}: {}", index, problem), "correct it, or make the path anew");
  };
  if (!(std::abs(pose.time) <= kMaxPathTime)) fail(fmt::format("{} s is not a valid time", pose.time));
  try {
    static_cast<void>(checkedPose(pose.worldFromLead));
  } catch (const UsageError& e) {
    fail(e.problem());
  }
  if (!(std::abs(glm::dot(pose.worldFromLead.rotation, pose.worldFromLead.rotation) - 1.0) <= kUnitRounding))
    fail("its quaternion is not of unit length");
}

/// Box of the parts in the frame of the one that leads.
Aabb boxInLead(const Scene& scene, const std::vector<PartId>& parts, const RigidTransform& leadFromWorld) {
  Aabb box;
  for (const PartId id : parts) {
    const Part& part = scene.get(id);
    if (!part.geometry || part.geometry->mesh.bounds().isEmpty()) continue;
    const RigidTransform leadFromPart = leadFromWorld * part.worldFromPart;
    for (const glm::dvec3& corner : part.geometry->mesh.bounds().corners())
      box.add(leadFromPart.applyToPoint(corner));
  }
  return box;
}

/// Place on a path, clamped and split into the pose before it and the share of the way to the next.
struct SplitPlace {
  std::size_t pose = 0;
  double share = 0.0;
};

SplitPlace split(const AssemblyPath& path, double place) noexcept {
  const double last = path.end();
  const double within = place > 0.0 ? std::min(place, last) : 0.0;
  const double whole = std::min(std::floor(within), std::max(last - 1.0, 0.0));
  return {static_cast<std::size_t>(whole), within - whole};
}

}  // namespace

double turnBetween(const RigidTransform& a, const RigidTransform& b) noexcept {
  return glm::length(rotationVector(glm::conjugate(a.rotation) * b.rotation));
}

void checkPath(const AssemblyPath& path, const std::string& where) {
  if (path.poses.size() < 2)
    throw UsageError(where, "it has less than two poses", "record or choose a longer motion");
  if (path.poses.size() > kMaxPathPoses)
    throw UsageError(where, fmt::format("it has more than {} poses", kMaxPathPoses), "trim or thin it");
  if (path.parts.empty()) throw UsageError(where, "it names no part", "name the part that moves");
  std::set<std::string> names;
  for (const std::string& name : path.parts) {
    checkPartName(name);
    if (!names.insert(name).second)
      throw UsageError(where, fmt::format("it names \"{}\" twice", name), "name each part once");
  }
  try {
    checkPosition(path.centre);
  } catch (const UsageError& e) {
    throw UsageError(where, "its centre: " + e.problem(), e.remedy());
  }
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    checkPathPose(path.poses[i], i, where);
    if (i == 0) continue;
    if (!(path.poses[i].time > path.poses[i - 1].time)) {
      throw UsageError(where, fmt::format("pose {} is no later than the one before", i),
                       "give poses in order of time");
    }
    if (!(turnBetween(path.poses[i - 1].worldFromLead, path.poses[i].worldFromLead) <= kMaxPathTurn)) {
      throw UsageError(where,
                       fmt::format("pose {} is turned by more than 170 degrees from the one before", i),
                       "add a pose between them");
    }
  }
}

bool isSamePath(const AssemblyPath& a, const AssemblyPath& b) noexcept {
  const auto isSamePose = [](const PathPose& x, const PathPose& y) {
    return x.time == y.time && x.worldFromLead == y.worldFromLead;
  };
  return a.parts == b.parts && a.centre == b.centre && std::ranges::equal(a.poses, b.poses, isSamePose);
}

RigidTransform poseBetween(const RigidTransform& from, const RigidTransform& to, const glm::dvec3& centre,
                           double share) noexcept {
  if (share <= 0.0) return from;
  if (share >= 1.0) return to;
  const glm::dvec3 turn = rotationVector(glm::conjugate(from.rotation) * to.rotation);
  const glm::dquat rotation = glm::normalize(from.rotation * rotationOf(share * turn));
  const glm::dvec3 before = from.applyToPoint(centre), after = to.applyToPoint(centre);
  return {rotation, before + share * (after - before) - rotation * centre};
}

RigidTransform poseAt(const AssemblyPath& path, double place) noexcept {
  const SplitPlace at = split(path, place);
  const RigidTransform& from = path.poses[at.pose].worldFromLead;
  if (at.share <= 0.0) return from;
  return poseBetween(from, path.poses[at.pose + 1].worldFromLead, path.centre, at.share);
}

double timeAt(const AssemblyPath& path, double place) noexcept {
  const SplitPlace at = split(path, place);
  const double from = path.poses[at.pose].time;
  if (at.share <= 0.0) return from;
  const double to = path.poses[at.pose + 1].time;
  return at.share >= 1.0 ? to : from + at.share * (to - from);
}

double placeAt(const AssemblyPath& path, double time) noexcept {
  const auto after = std::ranges::upper_bound(path.poses, time, {}, &PathPose::time);
  if (after == path.poses.begin()) return 0.0;
  if (after == path.poses.end()) return path.end();
  const PathPose &from = *(after - 1), &to = *after;
  return static_cast<double>(after - path.poses.begin() - 1) + (time - from.time) / (to.time - from.time);
}

std::vector<GuidancePose> wayOf(const AssemblyPath& path, const glm::dvec3& point) {
  // The sagitta of an arc of this angle [rad] is a 3200th of its radius.
  constexpr double kMaxPieceTurn = 0.05;
  // Nearer places [m], and rotations by less [rad], differ by rounding alone.
  constexpr double kSamePoint = 1e-9, kSameTurn = 1e-7;
  std::vector<GuidancePose> way;
  const auto add = [&](const RigidTransform& pose) {
    const GuidancePose at{pose.applyToPoint(point), pose.rotation};
    const bool isAnother = way.empty() || glm::distance(way.back().place, at.place) > kSamePoint ||
                           turnBetween({way.back().rotation, {}}, {at.rotation, {}}) > kSameTurn;
    if (isAnother) way.push_back(at);
  };
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const RigidTransform& to = path.poses[i].worldFromLead;
    if (i > 0) {
      const RigidTransform& from = path.poses[i - 1].worldFromLead;
      const auto pieces = static_cast<int>(std::ceil(turnBetween(from, to) / kMaxPieceTurn));
      for (int k = 1; k < pieces; ++k)
        add(poseBetween(from, to, path.centre, static_cast<double>(k) / pieces));
    }
    add(to);
  }
  return way;
}

double displacementBound(const RigidTransform& a, const RigidTransform& b, const glm::dvec3& centre,
                         double radius) noexcept {
  const glm::dquat turn = glm::conjugate(a.rotation) * b.rotation;
  // The displacement of a point by a turn is a chord.
  const double sine = std::min(1.0, glm::length(glm::dvec3(turn.x, turn.y, turn.z)));
  return glm::distance(a.applyToPoint(centre), b.applyToPoint(centre)) + 2.0 * sine * radius;
}

AssemblyPath trimmed(const AssemblyPath& path, double from, double to) {
  const std::string where = "path";
  if (path.poses.empty() || !(from < to))
    throw UsageError(where, fmt::format("there is no motion from {} to {} s", from, to),
                     "choose a start before the end");
  const double first = placeAt(path, from), last = placeAt(path, to);
  AssemblyPath result{path.parts, path.centre, {}};
  const auto add = [&](const PathPose& pose) {
    if (result.poses.empty() || pose.time > result.poses.back().time) result.poses.push_back(pose);
  };
  add({timeAt(path, first), poseAt(path, first)});
  for (auto i = static_cast<std::size_t>(std::ceil(first)); i < path.poses.size(); ++i) {
    if (static_cast<double>(i) < last) add(path.poses[i]);
  }
  add({timeAt(path, last), poseAt(path, last)});
  if (result.poses.size() < 2)
    throw UsageError(
        where, fmt::format("there is no motion from {} to {} s", from, to),
        fmt::format("choose times from {} to {} s", path.poses.front().time, path.poses.back().time));
  return result;
}

AssemblyPath pathFrame(const Scene& scene) {
  const std::optional<PartId> lead = scene.movingPart();
  if (!lead) throw UsageError("path", "nothing is in hand", "choose the part that moves");
  std::vector<PartId> moving{*lead};
  for (const PartId id : scene.movingParts()) {
    if (id != *lead && scene.get(id).isVisible && scene.get(id).geometry) moving.push_back(id);
  }
  AssemblyPath path;
  for (const PartId id : moving)
    path.parts.push_back(scene.get(id).name);
  const Aabb box = boxInLead(scene, moving, scene.get(*lead).worldFromPart.inverse());
  if (!box.isEmpty()) path.centre = box.centre();
  return path;
}

AssemblyPath pathOfMotion(std::span<const MotionRow> rows, const Scene& scene, double from, double to) {
  AssemblyPath path = pathFrame(scene);
  for (const MotionRow& row : rows) {
    const PathPose pose{row.time, row.proxy.normalized()};
    if (!path.poses.empty() && row.time <= path.poses.back().time)
      path.poses.back() = {path.poses.back().time, pose.worldFromLead};
    else
      path.poses.push_back(pose);
  }
  path = trimmed(path, from, to);
  checkPath(path, "path");
  return path;
}

}  // namespace nearfit
