#include "core/servo/start_apart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/proximity/overlap/containment.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/query/broad_phase.h"
#include "core/proximity/surface/surface_distance.h"

namespace nearfit {
namespace {

/// Clearance that a start is given [m], and at most as a fraction of the part's size: the proxy then has room to step,
/// and the eye sees no shift.
constexpr double kStartGap = 1e-6, kStartGapOfSize = 1e-5;
/// Depth to which bodies that touch may meet, as a fraction of the lengths involved. Rounding of typed poses and of fitted
/// planes stays far below; anything felt as an overlap is far above.
constexpr double kTouchDepth = 1e-10;
/// Shifts that are tried, as multiples of the clearance that they must add. The first is enough along the normal, the
/// second up to 70 degrees off it.
constexpr std::array<double, 2> kShifts = {1.2, 4.0};
/// Share of its clearance that the shift must leave to a body that the part was clear of.
constexpr double kClearLeft = 0.5;
/// Max steps to prove the way back. At 70 degrees each leaves two thirds of the way.
constexpr int kMaxWaySteps = 120;
/// Max work of one distance, some ten thousand times the usual; beyond, a shift counts as not proved.
constexpr std::uint64_t kMaxDistanceWork = std::uint64_t{1} << 24;

/// A body that the part may touch at its start or after the shift.
struct StartNeighbour {
  const ServoScene::Body* body = nullptr;
  double deviation = 0.0;
  double touchDepth = 0.0;  ///< [m]
  double clearance = 0.0;   ///< At the start [m]; no more than rounding if it is touched or overlapped.
  bool isDisjoint = false;
  glm::dvec3 away{0.0};  ///< World direction off it at the start; zero if unknown.
  ComponentsOnDemand components;

  bool isClear() const noexcept { return isDisjoint && clearance > touchDepth; }
};

class StartSearch {
 public:
  explicit StartSearch(const ServoScene& scene)
      : scene_(scene), part_(scene.moving.geometry->tree()), start_(scene.moving.worldFromPart) {
    const double size = scene.moving.geometry->mesh.bounds().diagonal();
    gap_ = std::min(kStartGap, kStartGapOfSize * size);
    for (const ServoScene::Body& body : scene.bodies)
      most_ = std::max(most_, scene.deviation(body));
    need_ = gap_ + most_;
    within_ = (1.0 + kShifts.back()) * need_ + most_;
    findNeighbours();
  }

  /// A shift that leaves every touched body that can be left at all; std::nullopt if none does. Between two flush walls
  /// each can be left, but only into the other.
  std::optional<glm::dvec3> find() {
    const auto touched = std::ranges::count_if(neighbours_, [](const auto& n) { return !n->isClear(); });
    if (touched == 0) return std::nullopt;
    const std::vector<glm::dvec3> directions = directionsToTry();
    std::vector<Attempt> attempts;
    for (const double factor : kShifts) {
      for (const glm::dvec3& direction : directions) {
        Attempt attempt = attemptOf(factor * need_ * direction);
        const auto left = std::ranges::count(attempt.isLeft, true);
        if (left == touched) return attempt.shift;
        if (left > 0) attempts.push_back(std::move(attempt));
      }
    }
    std::vector<bool> canBeLeft(neighbours_.size(), false);
    for (const Attempt& attempt : attempts)
      for (std::size_t i = 0; i < canBeLeft.size(); ++i)
        canBeLeft[i] = canBeLeft[i] || attempt.isLeft[i];
    const auto best = std::ranges::find(attempts, canBeLeft, &Attempt::isLeft);
    return best == attempts.end() ? std::nullopt : std::optional(best->shift);
  }

 private:
  RigidTransform bodyFromPart(const StartNeighbour& near, const glm::dvec3& shift) const {
    RigidTransform moved = start_;
    moved.translation += shift;
    return (near.body->worldFromPart.inverse() * moved).normalized();
  }

  SurfaceDistance distance(const StartNeighbour& near, const glm::dvec3& shift, double within) {
    return leastSurfaceDistance(near.body->geometry->tree(), part_, bodyFromPart(near, shift), within,
                                scratch_, kMaxDistanceWork);
  }

  bool isDisjoint(StartNeighbour& near, const glm::dvec3& shift) {
    return findInterference({near.body->geometry->tree(), near.components}, {part_, components_},
                            bodyFromPart(near, shift))
               .kind == InterferenceKind::Disjoint;
  }

  void findNeighbours() {
    Aabb reached = boundsOf(scene_.moving.geometry->mesh.bounds(), start_);
    if (reached.isEmpty()) return;
    reached.lower -= within_;
    reached.upper += within_;
    const double radius = movingRadius();
    for (const ServoScene::Body& body : scene_.bodies) {
      // The tick reports invalid poses.
      if (!body.worldFromPart.isFinite()) continue;
      if (!doOverlap(boundsOf(body.geometry->mesh.bounds(), body.worldFromPart), reached)) continue;
      auto near = std::make_unique<StartNeighbour>();
      near->body = &body;
      near->deviation = scene_.deviation(body);
      near->touchDepth = kTouchDepth * (radius + glm::length(start_.translation) +
                                        glm::length(body.worldFromPart.translation));
      look(*near);
      neighbours_.push_back(std::move(near));
    }
  }

  double movingRadius() const noexcept { return 0.5 * scene_.moving.geometry->mesh.bounds().diagonal(); }

  void look(StartNeighbour& near) {
    near.isDisjoint = isDisjoint(near, glm::dvec3(0.0));
    if (!near.isDisjoint) return;
    const SurfaceDistance found = distance(near, glm::dvec3(0.0), within_);
    near.clearance = found.lowerBound - near.deviation;
    if (!found.isFound || !(found.distance > near.touchDepth)) return;
    near.away = near.body->worldFromPart.applyToVector((found.partPoint - found.scenePoint) / found.distance);
  }

  /// First straight off what is touched, where that is known. Then the axes of the frames in which parts are placed, and
  /// the directions between them: a part that lies flush lies along one of them, and no other direction is farther from
  /// the nearest of them than 28 degrees.
  std::vector<glm::dvec3> directionsToTry() const {
    std::vector<glm::dvec3> directions;
    std::vector<glm::dquat> frames = {{1, 0, 0, 0}, start_.rotation};
    for (const auto& near : neighbours_) {
      if (near->isClear()) continue;
      frames.push_back(near->body->worldFromPart.rotation);
      if (near->away != glm::dvec3(0.0)) directions.push_back(glm::normalize(near->away));
    }
    constexpr std::size_t kMaxFrames = 3;
    std::vector<glm::dquat> used;
    for (const glm::dquat& frame : frames) {
      if (used.size() == kMaxFrames || std::ranges::find(used, frame) != used.end()) continue;
      used.push_back(frame);
      for (int axes = 1; axes <= 3; ++axes)
        addDirections(frame, axes, directions);
    }
    return directions;
  }

  /// Adds those directions that are as far along each of so many axes.
  static void addDirections(const glm::dquat& frame, int axes, std::vector<glm::dvec3>& out) {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (std::abs(x) + std::abs(y) + std::abs(z) != axes) continue;
          out.push_back(glm::normalize(frame * glm::dvec3(x, y, z)));
        }
      }
    }
  }

  /// A shift, and which of the touched neighbours the part is clear of after it: none if it comes too near another.
  struct Attempt {
    glm::dvec3 shift{0.0};
    std::vector<bool> isLeft;
  };

  Attempt attemptOf(const glm::dvec3& shift) {
    Attempt attempt{shift, std::vector<bool>(neighbours_.size(), false)};
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      const bool isLeft = leaves(*neighbours_[i], shift);
      if (!neighbours_[i]->isClear()) {
        attempt.isLeft[i] = isLeft;
      } else if (!isLeft) {
        attempt.isLeft.assign(neighbours_.size(), false);
        break;
      }
    }
    return attempt;
  }

  bool leaves(StartNeighbour& near, const glm::dvec3& shift) {
    if (!isDisjoint(near, shift)) return false;
    const double least = near.isClear() ? std::min(gap_, kClearLeft * near.clearance) : gap_;
    const double clearance = distance(near, shift, within_).lowerBound - near.deviation;
    return clearance >= least && isWayBackFree(near, shift);
  }

  /// Goes from the shifted pose to the start as far as the distance allows, again and again. True if it comes as near to the
  /// start as touching surfaces may meet.
  bool isWayBackFree(const StartNeighbour& near, const glm::dvec3& shift) {
    const double length = glm::length(shift), enough = near.deviation + near.touchDepth;
    double left = length;
    for (int i = 0; i < kMaxWaySteps && left > enough; ++i) {
      const double free = distance(near, (left / length) * shift, left).lowerBound;
      if (!(free > 0.0)) return false;
      left -= free;
    }
    return left <= enough;
  }

  const ServoScene& scene_;
  const NormalConeTree& part_;
  const RigidTransform start_;
  double gap_ = 0.0, most_ = 0.0, need_ = 0.0, within_ = 0.0;  ///< [m]
  std::vector<std::unique_ptr<StartNeighbour>> neighbours_;
  ComponentsOnDemand components_;
  LmdScratch scratch_;
};

}  // namespace

bool startApart(ServoScene& scene) {
  if (!scene.moving.geometry || scene.bodies.empty() || !scene.moving.worldFromPart.isFinite()) return false;
  const std::optional<glm::dvec3> shift = StartSearch(scene).find();
  if (!shift) return false;
  scene.moving.worldFromPart.translation += *shift;
  return true;
}

}  // namespace nearfit
