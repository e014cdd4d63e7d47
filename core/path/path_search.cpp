#include "core/path/path_search.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/math/symmetric_eigen.h"
#include "core/mesh/oriented_box.h"
#include "core/parallel/lower_to.h"
#include "core/parallel/parallel_for.h"
#include "core/path/path_bodies.h"
#include "core/path/path_shortening.h"
#include "core/path/sliding_motions.h"
#include "core/planning/pose_planner.h"
#include "core/planning/pose_sampler.h"

namespace nearfit {
namespace {

/// Share of the progress that building hierarchies takes.
constexpr double kPrepared = 0.05;
/// Most of the search's time that shortening takes, as a share, where a path was found early enough to leave it.
constexpr double kShorteningTime = 0.5;
/// Gap of the boxes at which what moves is out, in radii: enough to see.
constexpr double kOutGap = 0.05;
/// Surfaces within this many radii at the start tell where the moving parts can go.
constexpr double kFeltAround = 0.05;
/// Directions nearer to each other than this cosine count once.
constexpr double kSameDirection = 0.9999;
/// Max calls of SlidingMotions::advance() along a direction: 30 radii.
constexpr int kAdvancesAlong = 24;
/// Poses out of the assembly that planners may choose from.
constexpr std::size_t kOutPoses = 24;
/// Bound on the distances that prove a straight motion: through a fit of a few ten thousandths of the length.
constexpr std::uint64_t kMaxStraightDistances = 20'000;
/// Displacement that counts as being there already, in radii.
constexpr double kThere = 1e-9;
/// Time between two reports of the progress [s].
constexpr double kReportEvery = 0.05;

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Time of a search, its progress, and whether the user has cancelled it. Thread-safe.
class SearchClock {
 public:
  SearchClock(double seconds, const std::function<double()>& now, const ProgressCallback& progress)
      : seconds_(seconds), now_(now ? now : std::function<double()>(steadySeconds)), progress_(progress) {}

  double elapsed() const { return now_() - begin_; }
  /// True if the time is over, or the search is cancelled.
  bool isOver() {
    if (!isOver_ && isOverAfter(seconds_)) isOver_ = true;
    return isOver_;
  }
  bool isOverAfter(double seconds) {
    report();
    return isCancelled_ || elapsed() >= seconds;
  }
  void throwIfCancelled() const {
    if (isCancelled_) throw Cancelled();
  }

 private:
  void report() {
    if (!progress_) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || elapsed() < reported_ + kReportEvery) return;
    reported_ = elapsed();
    if (!progress_(kPrepared + (1.0 - kPrepared) * std::min(1.0, reported_ / seconds_))) isCancelled_ = true;
  }

  const double seconds_;
  const std::function<double()> now_;
  const ProgressCallback& progress_;
  const double begin_ = now_();
  std::mutex mutex_;
  double reported_ = 0.0;  ///< Guarded by the mutex.
  std::atomic<bool> isCancelled_{false}, isOver_{false};
};

Aabb boxOfOthers(const PathBodies& bodies) {
  Aabb box;
  for (const Scene::PartPtr& other : bodies.others) {
    for (const glm::dvec3& corner : other->geometry->mesh.bounds().corners())
      box.add(other->worldFromPart.applyToPoint(corner));
  }
  return box;
}

Aabb boxOfMoving(const PathBodies& bodies, const RigidTransform& worldFromCentre) {
  Aabb box;
  for (const PathPart& part : bodies.moving) {
    for (const glm::dvec3& corner : part.corners)
      box.add(worldFromCentre.applyToPoint(corner));
  }
  return box;
}

/// True if two boxes are a gap apart along an axis.
bool isClear(const Aabb& a, const Aabb& b, double gap) {
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] > b.upper[axis] + gap || b.lower[axis] > a.upper[axis] + gap) return true;
  }
  return false;
}

/// Shift along a direction after which a box is a gap clear of another [m].
double shiftToClear(const Aabb& moving, const Aabb& others, const glm::dvec3& direction, double gap) {
  double least = std::numeric_limits<double>::infinity();
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    if (direction[axis] > 0.0)
      least = std::min(least, (others.upper[axis] + gap - moving.lower[axis]) / direction[axis]);
    if (direction[axis] < 0.0)
      least = std::min(least, (others.lower[axis] - gap - moving.upper[axis]) / direction[axis]);
  }
  // A little more than rounding, so that it counts as clear.
  return std::max(0.0, least) * (1.0 + 1e-9) + 1e-9 * gap;
}

class Directions {
 public:
  void add(const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0.0) || !std::isfinite(length)) return;
    const glm::dvec3 unit = direction / length;
    const bool isKnown = std::ranges::any_of(
        all_, [&](const glm::dvec3& other) { return glm::dot(other, unit) > kSameDirection; });
    if (!isKnown) all_.push_back(unit);
  }
  void addBoth(const glm::dvec3& direction) {
    add(direction);
    add(-direction);
  }
  const std::vector<glm::dvec3>& all() const { return all_; }

 private:
  std::vector<glm::dvec3> all_;
};

/// Result of drawing the moving parts along a direction.
struct Drawn {
  PoseWay way;
  bool isAtGoal = false;
};

class PathSearch {
 public:
  PathSearch(const Scene& scene, const PathGoal& goal, const PathSearchOptions& options,
             const ProgressCallback& progress)
      : options_(options),
        goal_(goal),
        frame_(framed(scene)),
        bodies_(pathBodies(scene, frame_)),
        separation_(options.separation > 0.0 ? options.separation : defaultSeparation(scene, frame_)),
        certifier_(scene, frame_, separation_, stageCallback(progress, 0.0, kPrepared)),
        space_{bodies_, certifier_, frame_.centre, separation_, options.mayTurn},
        clock_(options.seconds, options.now, progress),
        others_(boxOfOthers(bodies_)),
        gap_(std::max(kOutGap * certifier_.radius(), 2.0 * separation_)),
        start_(centrePose(bodies_.worldFromLead.normalized(), frame_.centre)) {
    if (goal.pose) end_ = centrePose(checkedPose(*goal.pose), frame_.centre);
    result_.separation = separation_;
  }

  PathSearchResult search() {
    checkGoal();
    if (!isPlaceFree(start_, PathSearchEnd::StartNotFree)) return finished();
    if (end_ && !isPlaceFree(*end_, PathSearchEnd::GoalNotFree)) return finished();
    note(start_);
    PoseWay way = straight();
    if (way.empty()) way = drawn();
    if (way.empty()) way = planned();
    clock_.throwIfCancelled();
    if (!way.empty()) finish(way);
    return finished();
  }

 private:
  static AssemblyPath framed(const Scene& scene) {
    AssemblyPath frame = pathFrame(scene);
    const RigidTransform pose = scene.get(*scene.movingPart()).worldFromPart.normalized();
    frame.poses = {{0.0, pose}, {1.0, pose}};
    return frame;
  }
  bool isGoal(const RigidTransform& pose) const {
    return !end_ && isClear(boxOfMoving(bodies_, pose), others_, gap_);
  }
  SlidingMotions motions() {
    return {space_, [this](const RigidTransform& pose) {
              note(pose);
              return isGoal(pose);
            }};
  }
  /// Keeps how far it came.
  void note(const RigidTransform& pose) {
    const double shift = glm::distance(pose.translation, start_.translation);
    const double left =
        end_ ? displacementBound(pose, *end_, glm::dvec3(0.0), certifier_.radius()) : result_.nearest;
    const std::scoped_lock lock(mutex_);
    result_.farthest = std::max(result_.farthest, shift);
    result_.nearest = std::min(result_.nearest, left);
  }

  void checkGoal() const {
    if (!end_ && others_.isEmpty())
      throw UsageError("goal", "no other part is visible, so there is nothing to come out of",
                       "show the assembly, or give a pose");
    const bool isThere = end_ ? displacementBound(start_, *end_, glm::dvec3(0.0), certifier_.radius()) <=
                                    kThere * certifier_.radius()
                              : isGoal(start_);
    if (isThere)
      throw UsageError("goal", end_ ? "what moves is there already" : "what moves is out already",
                       "move it, or choose another goal");
    if (end_ && !options_.mayTurn && std::abs(glm::dot(start_.rotation, end_->rotation)) < 1.0 - kThere)
      throw UsageError("goal", "it is turned against the start, but the search may not turn",
                       "allow turns, or choose another goal");
  }

  /// Proves that a pose is free; if not, keeps what is in the way.
  bool isPlaceFree(const RigidTransform& pose, PathSearchEnd otherwise) {
    AssemblyPath resting = frame_;
    resting.poses = {{0.0, leadPose(pose, frame_.centre)}, {1.0, leadPose(pose, frame_.centre)}};
    const PathProof proof = certifier_.prove(resting);
    if (proof.isFree()) return true;
    result_.end = otherwise;
    result_.blocked = proof.unproven;
    return false;
  }
  bool isStraightFree(const RigidTransform& from, const RigidTransform& to) const {
    const PathSegment segment{leadPose(from, frame_.centre), leadPose(to, frame_.centre)};
    return certifier_.freeSegments(std::span(&segment, 1), {}, kMaxStraightDistances).front() != 0;
  }

  /// Directions in which what moves probably comes free of what it touches at a pose.
  std::vector<glm::dvec3> directionsAt(const RigidTransform& pose) {
    Directions directions;
    SlidingMotions around = motions();
    const std::vector<glm::dvec3> normals = around.normalsAt(pose, kFeltAround * certifier_.radius());
    glm::dmat3 spread(0.0);
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& n : normals) {
      spread += glm::outerProduct(n, n);
      sum += n;
    }
    // A peg goes along what is across all that it touches, a lid off what it lies on.
    if (!normals.empty()) {
      const SymmetricEigen axes = symmetricEigen(spread);
      directions.addBoth(axes.vectors[0]);
      directions.add(sum);
      directions.addBoth(axes.vectors[1]);
      directions.addBoth(axes.vectors[2]);
    }
    const PathPart& largest = *std::ranges::max_element(bodies_.moving, {}, &PathPart::radius);
    const OrientedBox box = orientedBox(largest.part->geometry->mesh);
    const glm::dquat worldFromPart = pose.rotation * largest.leadFromPart.rotation;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      directions.addBoth(worldFromPart * box.axes[axis]);
      glm::dvec3 ofWorld(0.0);
      ofWorld[axis] = 1.0;
      directions.addBoth(ofWorld);
    }
    return directions.all();
  }

  /// A single straight motion to the goal; empty if none is free.
  PoseWay straight() {
    startDirections_ = directionsAt(start_);
    if (end_) {
      if (!isStraightFree(start_, *end_)) return {};
      return {start_, *end_};
    }
    const Aabb moving = boxOfMoving(bodies_, start_);
    PoseWay best;
    double least = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& direction : startDirections_) {
      if (clock_.isOver()) break;
      const double shift = shiftToClear(moving, others_, direction, gap_);
      const RigidTransform to{start_.rotation, start_.translation + shift * direction};
      if (!(shift < least) || !isStraightFree(start_, to)) continue;
      least = shift;
      best = {start_, to};
    }
    return best;
  }

  /// Draws what moves along a direction, or toward the goal, as far as it goes.
  Drawn drawnFrom(const RigidTransform& from, const RigidTransform& toward, bool isTowed, bool isFromStart) {
    SlidingMotions slider = motions();
    Drawn out{{from}, false};
    for (int i = 0; i < kAdvancesAlong && !clock_.isOver(); ++i) {
      PoseWay more;
      const bool isThere = slider.advance(out.way.back(), toward, isTowed, more);
      if (more.empty()) break;
      for (const RigidTransform& pose : more) {
        out.way.push_back(pose);
        if (isFromStart && slider.reach(pose)) {
          out.isAtGoal = true;
          return out;
        }
      }
      if (isThere) {
        out.isAtGoal = isFromStart;
        return out;
      }
    }
    return out;
  }

  /// Draws what moves in many directions; the way that reaches the goal, or empty.
  PoseWay drawn() {
    result_.method = PathSearchMethod::Sliding;
    if (end_) goalDirections_ = directionsAt(*end_);
    const double length = 2.0 * (certifier_.radius() + worldSize());
    struct Task {
      RigidTransform from, toward;
      bool isTowed, isFromStart;
    };
    std::vector<Task> tasks;
    if (end_) tasks.push_back({start_, *end_, false, true});
    const auto addTasks = [&](const RigidTransform& from, const std::vector<glm::dvec3>& all, bool isStart) {
      for (const glm::dvec3& direction : all)
        tasks.push_back({from, {from.rotation, from.translation + length * direction}, true, isStart});
    };
    addTasks(start_, startDirections_, true);
    if (end_) addTasks(*end_, goalDirections_, false);
    std::vector<Drawn> all(tasks.size());
    std::atomic<std::size_t> first{tasks.size()};
    parallelFor(tasks.size(), [&](std::size_t i) {
      // The first in order wins, whichever is done first.
      if (i > first.load()) return;
      const Task& task = tasks[i];
      all[i] = drawnFrom(task.from, task.toward, task.isTowed, task.isFromStart);
      if (all[i].isAtGoal) lowerTo(first, i);
    });
    result_.directions = tasks.size();
    if (first < tasks.size()) return all[first].way;
    for (std::size_t i = 0; i < tasks.size(); ++i)
      (tasks[i].isFromStart ? startWays_ : goalWays_).push_back(std::move(all[i].way));
    return {};
  }

  double worldSize() const {
    Aabb all = others_;
    const Aabb moving = boxOfMoving(bodies_, start_);
    all.add(moving.lower);
    all.add(moving.upper);
    if (end_) {
      const Aabb there = boxOfMoving(bodies_, *end_);
      all.add(there.lower);
      all.add(there.upper);
    }
    return all.diagonal();
  }

  PoseQuery query() const {
    PoseQuery query;
    const double radius = certifier_.radius(), around = 2.0 * radius + 2.0 * gap_;
    Aabb box = others_;
    box.add(start_.translation);
    if (end_) box.add(end_->translation);
    query.bounds = {box.lower - around, box.upper + around, radius, options_.mayTurn};
    query.start = start_;
    query.goals = end_ ? std::vector<RigidTransform>{*end_} : outPoses();
    query.startWays = startWays_;
    query.goalWays = goalWays_;
    Directions directions;
    for (const glm::dvec3& direction : startDirections_)
      directions.add(direction);
    for (const glm::dvec3& direction : goalDirections_)
      directions.add(direction);
    query.directions = directions.all();
    return query;
  }

  /// Random poses clear of the assembly.
  std::vector<RigidTransform> outPoses() const {
    PoseSampler sampler(options_.seed);
    const double away = certifier_.radius() + 1.5 * gap_;
    std::vector<RigidTransform> poses;
    for (std::size_t i = 0; i < kOutPoses; ++i) {
      glm::dvec3 centre = sampler.pointIn(others_.lower - away, others_.upper + away);
      const auto axis = static_cast<glm::length_t>(i / 2 % 3);
      centre[axis] = i % 2 == 0 ? others_.upper[axis] + away : others_.lower[axis] - away;
      const bool isTurned = options_.mayTurn && i % 4 >= 2;
      poses.push_back({isTurned ? sampler.rotation() : start_.rotation, centre});
    }
    return poses;
  }

  /// Both planners, each in a thread. The one that took less work wins, so that the result does not depend on the time
  /// that they take; the other one goes on until it is known.
  PoseWay planned() {
    constexpr std::array<PathSearchMethod, 2> kMethods{PathSearchMethod::SlidingTrees,
                                                       PathSearchMethod::ConnectedTrees};
    struct Plan {
      PosePlan plan;
      std::uint64_t work = 0;
    };
    std::array<Plan, kMethods.size()> plans;
    std::atomic<std::uint64_t> least{options_.maxMotions};
    parallelFor(kMethods.size(), [&](std::size_t i) {
      PoseQuery query = this->query();
      query.seed = kMethods.size() * options_.seed + i;
      SlidingMotions mine = motions();
      const PlanLimit isOver = [&] { return clock_.isOver() || mine.work() >= least.load(); };
      try {
        plans[i].plan = kMethods[i] == PathSearchMethod::SlidingTrees ? planBySliding(query, mine, isOver)
                                                                      : planByConnecting(query, mine, isOver);
      } catch (const Error&) {
        throw;
      } catch (const std::exception& e) {
        throw Error("path", fmt::format("the planner failed: {}", e.what()), "search with another seed");
      }
      plans[i].work = mine.work();
      if (plans[i].plan.way.empty()) return;
      lowerTo(least, plans[i].work);
    });
    std::size_t best = kMethods.size();
    for (std::size_t i = 0; i < plans.size(); ++i) {
      result_.poses += plans[i].plan.poses;
      result_.motions += plans[i].work;
      if (plans[i].plan.way.empty()) continue;
      if (best == kMethods.size() || plans[i].work < plans[best].work) best = i;
    }
    if (best == kMethods.size()) return {};
    result_.method = kMethods[best];
    return plans[best].plan.way;
  }

  /// Makes a path of a way, proves it, and shortens it in the time that is left.
  void finish(const PoseWay& way) {
    std::vector<RigidTransform> poses;
    for (const RigidTransform& pose : way)
      poses.push_back(leadPose(pose, frame_.centre));
    // Ends are those given, without rounding.
    poses.front() = bodies_.worldFromLead.normalized();
    if (end_) poses.back() = checkedPose(*goal_.pose);
    const AssemblyPath found = timedPath(frame_, poses, certifier_.radius());
    const double begin = clock_.elapsed();
    keepIfFree(found, certifier_.prove(found));
    if (found.poses.size() > 2) shorten(found, clock_.elapsed() - begin);
  }

  /// @param proving  Time that the proof of the path took: that of a shorter one takes no longer [s].
  void shorten(const AssemblyPath& found, double proving) {
    const double now = clock_.elapsed();
    const double until = std::min(now + kShorteningTime * options_.seconds, options_.seconds - proving);
    if (now >= until) return;
    const AssemblyPath shorter =
        shortenedPath(found, certifier_, options_.seed, [&] { return clock_.isOverAfter(until); });
    clock_.throwIfCancelled();
    try {
      keepIfFree(shorter, certifier_.prove(shorter, [this](double) { return !clock_.isOver(); }));
    } catch (const Cancelled&) {
      // Either by the user, or the time is over and the path stays as it was found.
      clock_.throwIfCancelled();
    }
  }

  void keepIfFree(const AssemblyPath& path, PathProof proof) {
    if (!proof.isFree()) return;
    result_.end = PathSearchEnd::Found;
    result_.path = path;
    result_.proof = std::move(proof);
  }

  PathSearchResult finished() {
    result_.seconds = clock_.elapsed();
    return std::move(result_);
  }

  const PathSearchOptions& options_;
  const PathGoal& goal_;
  AssemblyPath frame_;  ///< Two poses at the start.
  PathBodies bodies_;
  double separation_;
  PathCertifier certifier_;
  SlidingSpace space_;
  SearchClock clock_;
  Aabb others_;
  double gap_;
  RigidTransform start_;               ///< Pose of the centre at the start.
  std::optional<RigidTransform> end_;  ///< And at the goal.
  std::vector<glm::dvec3> startDirections_, goalDirections_;
  std::vector<PoseWay> startWays_, goalWays_;
  std::mutex mutex_;
  PathSearchResult result_;  ///< Distances are guarded by the mutex while threads search.
};

const char* describeMethod(PathSearchMethod method) {
  switch (method) {
    case PathSearchMethod::Straight:
      return "a straight motion";
    case PathSearchMethod::Sliding:
      return "sliding one way";
    case PathSearchMethod::SlidingTrees:
      return "a random search that slides along parts";
    case PathSearchMethod::ConnectedTrees:
      break;
  }
  return "a random search (RRT-Connect)";
}

}  // namespace

PathSearchResult searchPath(const Scene& scene, const PathGoal& goal, const PathSearchOptions& options,
                            const ProgressCallback& progress) {
  if (!(options.seconds > 0.0) || !(options.seconds <= kMaxSearchSeconds))
    throw UsageError("time", fmt::format("{} s is not a valid time", options.seconds),
                     "give seconds, more than 0 and at most a day");
  if (!(options.separation >= 0.0) || !std::isfinite(options.separation))
    throw UsageError("separation", fmt::format("{} m is not a valid separation", options.separation),
                     "give a length greater than 0");
  return PathSearch(scene, goal, options, progress).search();
}

std::string describePathSearch(const Scene& scene, const PathGoal& goal, const PathSearchResult& result,
                               const std::function<std::string(double)>& length) {
  switch (result.end) {
    case PathSearchEnd::Found:
      return fmt::format("Found in {:.1f} s by {}: {} poses. Proven to keep {} from all other visible parts.",
                         result.seconds, describeMethod(result.method), result.path.poses.size(),
                         length(result.separation));
    case PathSearchEnd::StartNotFree:
    case PathSearchEnd::GoalNotFree: {
      const bool isStart = result.end == PathSearchEnd::StartNotFree;
      const UnprovenPlace& at = *result.blocked;
      const std::string &part = scene.get(at.part).name, &other = scene.get(at.other).name;
      const std::string problem = at.isInside
                                      ? fmt::format("\"{}\" meets \"{}\"", part, other)
                                      : fmt::format("\"{}\" is not proven farther than {} from \"{}\"", part,
                                                    length(std::max(at.distance, 0.0)), other);
      return fmt::format("No path: at the {}, {}; the separation to keep is {}. {}",
                         isStart ? "start" : "goal", problem, length(result.separation),
                         isStart ? "Move it apart, or ask for a smaller separation."
                                 : "Choose another goal, or ask for a smaller separation.");
    }
    case PathSearchEnd::NotFound:
      break;
  }
  std::string text = fmt::format(
      "No path was found in {:.1f} s, which does not mean that there is none. Tried: straight motions, {} "
      "directions with sliding, {} random motions that reached {} poses. ",
      result.seconds, result.directions, result.motions, result.poses);
  text += goal.pose ? fmt::format("The part came to within {} of the goal.", length(result.nearest))
                    : fmt::format("The part came as far as {} from its place.", length(result.farthest));
  return text + " Give it more time, another seed, or a smaller separation.";
}

}  // namespace nearfit
