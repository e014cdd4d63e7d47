#include "core/verdict/clash_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/axes_across.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/query/triangle_distance.h"
#include "core/proximity/surface/near_faces.h"
#include "core/proximity/surface/straight_sweep.h"

namespace nearfit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A way out ends this far beyond where the last triangles part, as a fraction of the lengths involved, and where the exact
/// predicate still finds them touching, by each of the next. Some thousand roundings, and still nothing that anyone could
/// measure.
constexpr std::array<double, 3> kPaddings{1e-12, 1e-10, 1e-8};

/// Max number of places on one way at which the exact predicate is asked: bodies that are nested have many gaps.
constexpr int kMaxPlaces = 12;

/// Pairs of nodes between two questions if the search goes on: some milliseconds.
constexpr std::uint64_t kBetweenLooks = 8192;

/// Pairs of triangles that meet whose normals are looked at; and max number of directions kept of them. Normals within
/// some 5 degrees are one.
constexpr std::size_t kMaxMeetings = 4096, kMaxNormals = 24;
constexpr double kOneNormal = 0.996;

/// A way along a face that blocks it by touching is tried at this tilt off the face: half a millionth longer.
constexpr double kTilt = 1e-3;
/// A face within this angle of a way may be one along which it slides [rad].
constexpr double kSliding = 1e-2;

/// Angles by which the best direction is varied, from coarse to fine [rad]; neighbours at each; and rounds at each angle.
constexpr std::array<double, 3> kTurns{0.4, 0.2, 0.1};
constexpr int kNeighbours = 6, kRounds = 3;

/// Planes found on ways within this cosine of the best direction are taken to block it too. Max number of them, of which
/// each three are combined; and max number of combined directions that are tried.
constexpr double kSameSide = 0.5;
constexpr std::size_t kMaxPlanes = 12;
constexpr int kMaxCombined = 16;

/// A shorter way must be shorter by this share to count: less is rounding.
constexpr double kShorter = 1e-9;

/// Returns the direction; zero if the vector has none.
glm::dvec3 unitOrZero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > std::numeric_limits<double>::min() ? v / length : glm::dvec3(0.0);
}

glm::dvec3 normalOf(const TriangleCorners& t) {
  return unitOrZero(glm::cross(t[1] - t[0], t[2] - t[0]));
}

/// End of a way, or where it is blocked.
struct WayEnd {
  bool isFree = false;
  double travel = 0.0;     ///< If free: length of the way, padding included [m].
  double blockedTo = 0.0;  ///< The last pair of triangles blocks it up to here [m].
  glm::dvec3 normal{0.0};  ///< Plane in which that pair parts; zero if no pair was seen.
  /// Normals of the pair's triangles that lead the part away from the scene, and how far along each parts the pair [m].
  std::array<glm::dvec3, 2> faceNormals{};
  std::array<double, 2> faceHeights{};
};

/// Finds the way out along a direction.
class WayOut {
 public:
  WayOut(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
         const DepthLimits& limits)
      : scene_(scene),
        part_(part),
        sceneFromPart_(sceneFromPart),
        sweep_(scene, part, sceneFromPart),
        limits_(limits) {
    extent_ = scene.size() + part.size() + glm::length(scene.centre()) + glm::length(part.centre()) +
              glm::length(sceneFromPart.translation);
    gap_ = 2.0 * kPaddings[0] * extent_ + sweep_.placed().rounding();
  }

  /// @param direction  Unit.
  /// @param within     Only a shorter way is of interest [m].
  WayEnd along(const glm::dvec3& direction, double within) {
    direction_ = direction;
    within_ = within;
    reach_ = 0.0;
    end_ = {};
    blocking_ = {};
    waiting_ = {};
    normals_.clear();
    for (const SweptEntry& s : sweep_.sceneChildren(0)) {
      for (const SweptEntry& p : sweep_.partChildren(0))
        add(s, p);
    }
    for (int places = 0;;) {
      extend();
      if (isSpent() || !(reach_ < within_)) return end_;
      if (takeWaiting()) continue;
      if (++places > kMaxPlaces || proveFree()) return end_;
      if (waiting_.empty()) return end_;
      reach_ = waiting_.top().stretch.from;
    }
  }

  bool proveFreeAt(const glm::dvec3& direction, double travel, FreeingTranslation& proven) const {
    for (const double padding : kPaddings) {
      const double padded = travel + padding * extent_;
      RigidTransform moved = sceneFromPart_;
      moved.translation += padded * direction;
      const InterferenceKind kind = findInterference(scene_, part_, moved).kind;
      if (kind == InterferenceKind::Disjoint) {
        proven = {padded, direction};
        return true;
      }
      if (kind != InterferenceKind::SurfacesMeet) return false;
    }
    return false;
  }

  bool isSpent() const noexcept { return isStopped_ || nodePairs_ >= limits_.maxNodePairs; }
  const StraightSweep& sweep() const noexcept { return sweep_; }

 private:
  /// A pair of entries, or of triangles, with the range of the way that it may block, or blocks.
  struct Blocker {
    SweepStretch stretch;
    const SweptEntry *scene, *part;  ///< Kept by the sweep.
    /// Index of the normal, if the entries are triangles and the range is theirs.
    std::uint32_t exact = kNotExact;
  };
  static constexpr std::uint32_t kNotExact = std::numeric_limits<std::uint32_t>::max();
  struct EndsLast {
    bool operator()(const Blocker& a, const Blocker& b) const noexcept { return a.stretch.to < b.stretch.to; }
  };
  struct BeginsFirst {
    bool operator()(const Blocker& a, const Blocker& b) const noexcept {
      return a.stretch.from > b.stretch.from;
    }
  };

  void add(const SweptEntry& s, const SweptEntry& p) {
    const std::optional<SweepStretch> stretch = sweep_.meeting(s.box, p.box, direction_, within_);
    if (stretch) add({*stretch, &s, &p});
  }
  void add(const Blocker& blocker) {
    if (!(blocker.stretch.to > reach_)) return;
    blocker.stretch.from <= reach_ + gap_ ? blocking_.push(blocker) : waiting_.push(blocker);
  }

  /// Moves the reach to where nothing that has been seen to begin before it blocks any more. What may block farthest is
  /// opened first: it makes most of the others needless.
  void extend() {
    while (!blocking_.empty() && !isSpent() && reach_ < within_) {
      const Blocker top = blocking_.top();
      if (!(top.stretch.to > reach_)) {
        blocking_ = {};
        return;
      }
      blocking_.pop();
      if (top.exact != kNotExact) {
        block(top);
      } else {
        open(top);
      }
    }
  }

  void block(const Blocker& pair) {
    reach_ = pair.stretch.to;
    end_.blockedTo = reach_;
    end_.normal = normals_[pair.exact];
    const TriangleCorners fixed = sceneCorners(*pair.scene), moving = partCorners(*pair.part);
    end_.faceNormals = {normalOf(fixed), -normalOf(moving)};
    for (std::size_t i = 0; i < 2; ++i) {
      const glm::dvec3& n = end_.faceNormals[i];
      const auto highest = [&](const TriangleCorners& t, double sign) {
        return std::max({sign * glm::dot(n, t[0]), sign * glm::dot(n, t[1]), sign * glm::dot(n, t[2])});
      };
      end_.faceHeights[i] = highest(fixed, 1.0) + highest(moving, -1.0);
    }
  }

  void open(const Blocker& pair) {
    if (++nodePairs_ % kBetweenLooks == 0 && limits_.goOn && !limits_.goOn()) isStopped_ = true;
    if (!NormalConeTree::isLeaf(pair.scene->child) || !NormalConeTree::isLeaf(pair.part->child)) {
      openLarger(sweep_, *pair.scene, *pair.part,
                 [this](const SweptEntry& s, const SweptEntry& p) { add(s, p); });
      return;
    }
    const TriangleSweep found =
        sweepTriangles(sceneCorners(*pair.scene), partCorners(*pair.part), direction_, within_);
    if (found.stretch.isEmpty() || !(found.stretch.to > reach_)) return;
    normals_.push_back(found.lastNormal);
    add({found.stretch, pair.scene, pair.part, static_cast<std::uint32_t>(normals_.size() - 1)});
  }

  TriangleCorners sceneCorners(const SweptEntry& leaf) const {
    return sweep_.placed().sceneCorners(scene_.faces()[NormalConeTree::leafIndex(leaf.child)]);
  }
  TriangleCorners partCorners(const SweptEntry& leaf) const {
    return sweep_.placed().partCorners(part_.faces()[NormalConeTree::leafIndex(leaf.child)]);
  }

  /// Takes up what begins where the way has come to; false if there is a gap.
  bool takeWaiting() {
    bool isAny = false;
    while (!waiting_.empty()) {
      const Blocker& next = waiting_.top();
      const bool isPassed = !(next.stretch.to > reach_);
      if (!isPassed && next.stretch.from > reach_ + gap_) break;
      if (!isPassed) blocking_.push(next);
      isAny = isAny || !isPassed;
      waiting_.pop();
    }
    return isAny;
  }

  bool proveFree() {
    FreeingTranslation proven;
    if (!proveFreeAt(direction_, reach_, proven) || !(proven.length < within_)) return false;
    end_.isFree = true;
    end_.travel = proven.length;
    return true;
  }

  const NormalConeTree &scene_, &part_;
  RigidTransform sceneFromPart_;
  StraightSweep sweep_;
  const DepthLimits& limits_;
  double extent_ = 0.0;  ///< Lengths that rounding is relative to [m].
  double gap_ = 0.0;     ///< Shorter gaps between blocked ranges are rounding [m].
  std::uint64_t nodePairs_ = 0;
  bool isStopped_ = false;

  glm::dvec3 direction_{0.0};
  double within_ = 0.0, reach_ = 0.0;
  WayEnd end_;
  std::vector<glm::dvec3> normals_;  ///< Of the planes in which pairs of triangles part.
  std::priority_queue<Blocker, std::vector<Blocker>, EndsLast> blocking_;
  std::priority_queue<Blocker, std::vector<Blocker>, BeginsFirst> waiting_;
};

/// A plane that the translation must pass: its component along the normal must be at least `height`.
struct WayPlane {
  glm::dvec3 normal;
  double height;
  glm::dvec3 seenAlong;  ///< Direction of the way on which it was found.
};

/// Shortest vector in the intersection of up to three planes; std::nullopt if they have none in common to rounding.
std::optional<glm::dvec3> shortestOn(const WayPlane& a, const WayPlane* b, const WayPlane* c) {
  if (b == nullptr) return a.height * a.normal;
  const glm::dvec3 across = glm::cross(a.normal, b->normal);
  const double squared = glm::dot(across, across);
  constexpr double kIndependent = 1e-8;
  if (!(squared > kIndependent)) return std::nullopt;
  const glm::dvec3 onLine =
      (a.height * glm::cross(b->normal, across) + b->height * glm::cross(across, a.normal)) / squared;
  if (c == nullptr) return onLine;
  const double rise = glm::dot(c->normal, across);
  if (!(rise * rise > kIndependent * squared)) return std::nullopt;
  return onLine + (c->height - glm::dot(c->normal, onLine)) / rise * across;
}

/// Shortest vector beyond all planes: on one, two or three of them. std::nullopt if there is none.
std::optional<glm::dvec3> shortestBeyond(const std::vector<WayPlane>& planes) {
  std::optional<glm::dvec3> shortest;
  const auto offer = [&](const std::optional<glm::dvec3>& v) {
    if (!v || (shortest && glm::dot(*v, *v) >= glm::dot(*shortest, *shortest))) return;
    constexpr double kOnPlane = 1e-9;
    const bool isBeyond = std::ranges::all_of(planes, [&](const WayPlane& plane) {
      return glm::dot(plane.normal, *v) >= plane.height - kOnPlane * std::abs(plane.height);
    });
    if (isBeyond) shortest = v;
  };
  for (std::size_t i = 0; i < planes.size(); ++i) {
    offer(shortestOn(planes[i], nullptr, nullptr));
    for (std::size_t k = i + 1; k < planes.size(); ++k) {
      offer(shortestOn(planes[i], &planes[k], nullptr));
      for (std::size_t l = k + 1; l < planes.size(); ++l)
        offer(shortestOn(planes[i], &planes[k], &planes[l]));
    }
  }
  return shortest;
}

/// Search for the shortest way out over directions.
class DirectionSearch {
 public:
  DirectionSearch(const DepthBody& scene, const DepthBody& part, const RigidTransform& sceneFromPart,
                  LmdScratch& scratch, const DepthLimits& limits)
      : scene_(scene.tree),
        part_(part.tree),
        sceneFromPart_(sceneFromPart),
        scratch_(scratch),
        way_(scene.tree, part.tree, sceneFromPart, limits) {}

  std::optional<ClashDepth> run() {
    for (const glm::dvec3& direction : firstDirections())
      follow(direction);
    vary();
    combine();
    if (!(best_.length < kInfinity)) return std::nullopt;
    return ClashDepth{best_, false};
  }

 private:
  /// Normals where the surfaces meet, away from the scene, the most frequent first.
  std::vector<glm::dvec3> meetingNormals() {
    std::vector<glm::dvec3> found;
    found.reserve(2 * kMaxMeetings);
    const double touch = way_.sweep().placed().rounding();
    constexpr auto kAboveZero = static_cast<double>(std::numeric_limits<float>::min());
    NearFaces near(scene_, part_, sceneFromPart_, std::max(touch, kAboveZero), scratch_.data());
    const auto visit = [&](std::uint32_t s, std::uint32_t p) noexcept {
      const TriangleCorners a = near.placed().sceneCorners(scene_.faces()[s]),
                            b = near.placed().partCorners(part_.faces()[p]);
      if (areSurelyBeyond(a, b, touch) || closestOfTriangles(a, b).distanceSquared > touch * touch) return;
      if (found.size() == found.capacity()) return near.stop();
      found.push_back(normalOf(a));
      found.push_back(-normalOf(b));
    };
    near.run(visit, kMaxMeetings * 64);
    return distinct(found);
  }

  static std::vector<glm::dvec3> distinct(const std::vector<glm::dvec3>& all) {
    struct Counted {
      glm::dvec3 normal;
      std::size_t count;
    };
    std::vector<Counted> kinds;
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& n : all) {
      sum += n;
      const auto same = std::ranges::find_if(
          kinds, [&](const Counted& kind) { return glm::dot(kind.normal, n) > kOneNormal; });
      if (same != kinds.end()) {
        ++same->count;
      } else if (kinds.size() < 8 * kMaxNormals) {
        kinds.push_back({n, 1});
      }
    }
    std::ranges::stable_sort(kinds, std::greater{}, &Counted::count);
    std::vector<glm::dvec3> normals{unitOrZero(sum)};
    for (std::size_t i = 0; i < std::min(kinds.size(), kMaxNormals); ++i)
      normals.push_back(kinds[i].normal);
    return normals;
  }

  std::vector<glm::dvec3> firstDirections() {
    std::vector<glm::dvec3> directions = meetingNormals();
    directions.push_back(unitOrZero(sceneFromPart_.applyToPoint(part_.centre()) - scene_.centre()));
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const glm::dvec3 d = unitOrZero(glm::dvec3(x, y, z));
          directions.push_back(d);
          if (std::abs(x) + std::abs(y) + std::abs(z) == 1)
            directions.push_back(sceneFromPart_.applyToVector(d));
        }
      }
    }
    return directions;
  }

  /// Tries a direction; true if its way is the shortest so far.
  bool attempt(const glm::dvec3& direction) {
    if (direction == glm::dvec3(0.0) || way_.isSpent()) return false;
    const WayEnd end = way_.along(direction, best_.length);
    note(end, direction);
    if (take(end, direction)) return true;
    // It may slide along a face that it touches, of either body.
    bool isShorter = false;
    for (std::size_t i = 0; i < 2 && !way_.isSpent(); ++i) {
      const glm::dvec3& off = end.faceNormals[i];
      if (off == glm::dvec3(0.0) || std::abs(glm::dot(off, direction)) > kSliding) continue;
      planes_.push_back({off, end.faceHeights[i], direction});
      const glm::dvec3 tilted = unitOrZero(direction + kTilt * off);
      const WayEnd next = way_.along(tilted, best_.length);
      note(next, tilted);
      isShorter = take(next, tilted) || isShorter;
    }
    return isShorter;
  }

  bool take(const WayEnd& end, const glm::dvec3& direction) {
    if (!end.isFree || !(end.travel < best_.length * (1.0 - kShorter))) return false;
    best_ = {end.travel, direction};
    bestNormal_ = end.normal;
    return true;
  }

  void note(const WayEnd& end, const glm::dvec3& direction) {
    const double along = glm::dot(end.normal, direction);
    if (along > 0.0) planes_.push_back({end.normal, along * end.blockedTo, direction});
  }

  /// Tries a direction, and from its end the normal of what blocked it last, as long as that is shorter.
  void follow(const glm::dvec3& direction) {
    constexpr int kMaxTurns = 12;
    glm::dvec3 next = direction;
    for (int i = 0; i < kMaxTurns && attempt(next); ++i)
      next = bestNormal_;
  }

  void vary() {
    for (const double turn : kTurns) {
      bool isShorter = true;
      for (int round = 0; round < kRounds && isShorter; ++round) {
        isShorter = false;
        const glm::dvec3 middle = best_.direction;
        if (middle == glm::dvec3(0.0)) return;
        const auto [u, v] = axesAcross(middle);
        for (int i = 0; i < kNeighbours; ++i) {
          const double angle = 2.0 * std::numbers::pi * i / kNeighbours;
          const glm::dvec3 side = std::cos(angle) * u + std::sin(angle) * v;
          isShorter = attempt(std::cos(turn) * middle + std::sin(turn) * side) || isShorter;
        }
      }
    }
  }

  /// Tries the shortest translation beyond the planes that blocked ways near the best one. Each attempt finds the plane
  /// that blocks it.
  void combine() {
    glm::dvec3 last(0.0);
    for (int i = 0; i < kMaxCombined && !way_.isSpent(); ++i) {
      const std::optional<glm::dvec3> shortest = shortestBeyond(nearPlanes());
      const bool isShorter = shortest && glm::length(*shortest) < best_.length * (1.0 - kShorter);
      if (!isShorter || *shortest == last) return;
      last = *shortest;
      attempt(unitOrZero(last));
    }
  }

  /// The planes found last on ways to the side of the best direction that are no farther than its way, each once.
  std::vector<WayPlane> nearPlanes() const {
    std::vector<WayPlane> near;
    for (std::size_t i = planes_.size(); i > 0 && near.size() < kMaxPlanes; --i) {
      const WayPlane& plane = planes_[i - 1];
      const bool isNear = glm::dot(plane.seenAlong, best_.direction) > kSameSide &&
                          plane.height < best_.length && plane.height > 0.0;
      if (!isNear) continue;
      constexpr double kOneWayPlane = 1.0 - 1e-9;
      const auto same = std::ranges::find_if(
          near, [&](const WayPlane& other) { return glm::dot(other.normal, plane.normal) > kOneWayPlane; });
      if (same == near.end()) {
        near.push_back(plane);
      } else {
        same->height = std::max(same->height, plane.height);
      }
    }
    return near;
  }

  const NormalConeTree &scene_, &part_;
  RigidTransform sceneFromPart_;
  LmdScratch& scratch_;
  WayOut way_;
  FreeingTranslation best_{kInfinity, glm::dvec3(0.0)};
  glm::dvec3 bestNormal_{0.0};
  std::vector<WayPlane> planes_;
};

}  // namespace

std::optional<ClashDepth> findClashDepth(const DepthBody& scene, const DepthBody& part,
                                         const RigidTransform& sceneFromPart, LmdScratch& scratch,
                                         const DepthLimits& limits) {
  if (scene.tree.isEmpty() || part.tree.isEmpty() || !sceneFromPart.isFinite()) return std::nullopt;
  if (scene.convex != nullptr && part.convex != nullptr) {
    const std::optional<FreeingTranslation> shortest =
        convexDepth(*scene.convex, *part.convex, sceneFromPart);
    FreeingTranslation proven;
    if (shortest && WayOut(scene.tree, part.tree, sceneFromPart, limits)
                        .proveFreeAt(shortest->direction, shortest->length, proven))
      return ClashDepth{*shortest, true};
  }
  return DirectionSearch(scene, part, sceneFromPart, scratch, limits).run();
}

}  // namespace nearfit
