#include "tests/bench/hand_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "tests/bench/portable_random.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;

/// What a hand does in one pose's time: unit direction of the part's centre, unit axis of its turn.
struct HandMotion {
  glm::dvec3 direction, axis;
};

/// Room that is kept for the next step, over what it needs.
constexpr double kSpare = 1.05;

class Hand {
 public:
  Hand(const PathBodies& bodies, const DistanceProbe& probe, const HandPathOptions& options)
      : bodies_(bodies), probe_(probe), options_(options), random_(options.seed) {
    stepLength_ = options.step * bodies.size;
    motion_ = {randomDirection(random_), randomDirection(random_)};
  }

  std::vector<RigidTransform> walk() {
    options_.start ? begin(*options_.start) : approach();
    home_ = centre();
    std::vector<RigidTransform> path{pose_};
    while (path.size() < options_.poses) {
      takeStep(path.size());
      path.push_back(pose_);
    }
    return path;
  }

 private:
  void begin(const RigidTransform& start) {
    pose_ = start.normalized();
    look(probe_(pose_));
    if (!(distance_ > 0.0)) throw Error("the path's start", "the bodies touch", "start with a gap");
  }

  /// Comes in from outside until the distance is half the cutoff, never by more than the distance.
  void approach() {
    pose_.rotation = glm::angleAxis(2.0 * pi * uniform(random_), randomDirection(random_));
    const double far = bodies_.sceneRadius + bodies_.partRadius + options_.reach;
    place(bodies_.sceneCentre + far * randomDirection(random_));
    for (double left = 2.0 * far; left > 0.0;) {
      const std::optional<Nearest> nearest = probe_(pose_);
      const double target = 0.5 * options_.cutoff;
      look(nearest);
      if (nearest && nearest->distance <= 1.1 * target) return;
      const double advance = nearest ? nearest->distance - target : 0.9 * options_.reach;
      place(centre() - advance * away_);
      left -= advance;
    }
    throw Error("the path's start", "the part passes the scene without coming near", "try another --seed");
  }

  void takeStep(std::size_t step) {
    const HandMotion wanted = steered(step);
    constexpr int kTries = 16, kMaxHalvings = 40;
    double scale = 1.0;
    for (int halving = 0; halving < kMaxHalvings; ++halving, scale *= 0.5) {
      const double bound = scale * (stepLength_ + options_.turn * bodies_.partRadius);
      for (int i = 0; i < kTries && bound < distance_; ++i) {
        if (tryMotion(candidate(wanted, i), scale, bound)) return;
      }
    }
    throw Error("the path", "the part is stuck", "try another --seed");
  }

  /// The hand's next intent: wanders smoothly, and seeks a distance that comes and goes.
  HandMotion steered(std::size_t step) {
    constexpr double kWander = 0.08;
    motion_.axis = glm::normalize(motion_.axis + kWander * randomDirection(random_));
    const glm::dvec3 wandering = glm::normalize(motion_.direction + kWander * randomDirection(random_));
    const double phase = 2.0 * pi * static_cast<double>(step) / 400.0;
    const double sought = options_.cutoff * (0.45 - 0.4 * std::sin(phase));
    const double rise = std::clamp((sought - distance_) / (10.0 * stepLength_), -0.95, 0.95);
    const glm::dvec3 along = wandering - glm::dot(wandering, away_) * away_;
    const double length = glm::length(along);
    if (!(length > 1e-6)) return {wandering, motion_.axis};
    return {std::sqrt(1.0 - rise * rise) / length * along + rise * away_, motion_.axis};
  }

  /// What to try: the intent, then turned back from what is in the way, then anything.
  HandMotion candidate(const HandMotion& wanted, int index) {
    const double inward = std::min(glm::dot(wanted.direction, away_), 0.0);
    const glm::dvec3 reflected = wanted.direction - 2.0 * inward * away_;
    switch (index) {
      case 0:
        return wanted;
      case 1:
        return {wanted.direction, -wanted.axis};
      case 2:
        return {reflected, wanted.axis};
      case 3:
        return {reflected, -wanted.axis};
      default:
        return {randomDirection(random_), randomDirection(random_)};
    }
  }

  bool tryMotion(const HandMotion& motion, double scale, double bound) {
    const RigidTransform before = pose_;
    const glm::dvec3 target = centre() + scale * stepLength_ * motion.direction;
    if (options_.range && glm::distance(target, home_) > *options_.range) return false;
    pose_.rotation = glm::normalize(glm::angleAxis(scale * options_.turn, motion.axis) * pose_.rotation);
    place(target);
    const std::optional<Nearest> nearest = probe_(pose_);
    if (nearest && !(nearest->distance > kSpare * bound)) {
      pose_ = before;
      return false;
    }
    look(nearest);
    motion_ = motion;
    return true;
  }

  void look(const std::optional<Nearest>& nearest) {
    distance_ = nearest ? nearest->distance : options_.reach;
    const glm::dvec3 outward = centre() - bodies_.sceneCentre;
    if (nearest) {
      away_ = nearest->direction;
    } else if (glm::length(outward) > 0.0) {
      away_ = glm::normalize(outward);
    }
  }

  glm::dvec3 centre() const { return pose_.applyToPoint(bodies_.partCentre); }
  void place(const glm::dvec3& centre) {
    pose_.translation = centre - pose_.applyToVector(bodies_.partCentre);
  }

  const PathBodies& bodies_;
  const DistanceProbe& probe_;
  const HandPathOptions& options_;
  std::mt19937_64 random_;
  double stepLength_ = 0.0;
  RigidTransform pose_;
  HandMotion motion_{};
  glm::dvec3 home_{0.0};
  double distance_ = 0.0;           ///< At the pose, or the reach when it is farther.
  glm::dvec3 away_{0.0, 0.0, 1.0};  ///< Unit, from what is nearest.
};

}  // namespace

std::vector<RigidTransform> handPath(const PathBodies& bodies, const DistanceProbe& probe,
                                     const HandPathOptions& options) {
  return Hand(bodies, probe, options).walk();
}

double motionBound(const PathBodies& bodies, const RigidTransform& from, const RigidTransform& to) {
  const glm::dvec3 moved = to.applyToPoint(bodies.partCentre) - from.applyToPoint(bodies.partCentre);
  const double cosHalf = std::min(std::abs(glm::dot(from.rotation, to.rotation)), 1.0);
  const glm::dquat turn = to.rotation * glm::conjugate(from.rotation);
  const double sinHalf = glm::length(glm::dvec3(turn.x, turn.y, turn.z));
  return glm::length(moved) + 2.0 * std::atan2(sinHalf, cosHalf) * bodies.partRadius;
}

}  // namespace nearfit::bench
