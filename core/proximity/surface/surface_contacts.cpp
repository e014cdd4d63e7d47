#include "core/proximity/surface/surface_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/proximity/query/triangle_distance.h"
#include "core/proximity/surface/near_faces.h"

namespace nearfit {
namespace {

using FaceLeaf = NormalConeTree::FaceLeaf;

/// Contacts whose points are this close, as a fraction of the bodies' sizes, and whose directions differ this
/// little are one: neighbouring features find it at their common boundary.
constexpr double kSamePlace = 1e-9, kSameDirection = 1e-3;

/// How far beyond a side a foot still counts as inside, as a fraction of the side: rounding must not lose it
/// between two faces in one plane, whose edge is no feature.
constexpr double kSide = 1e-9;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

const double kSineOfTilt = std::sin(kContactTilt);

/// One body's features, in the scene's centred frame.
struct Side {
  const UnsidedSurface& surface;
  RigidTransform frameFromTree;

  glm::dvec3 position(std::uint32_t v) const noexcept {
    return frameFromTree.applyToPoint(surface.tree().positions()[v]);
  }
  glm::dvec3 direction(std::uint32_t from, std::uint32_t to) const noexcept {
    const glm::dvec3 d = surface.tree().positions()[to] - surface.tree().positions()[from];
    const double length = glm::length(d);
    return length > 0.0 ? frameFromTree.applyToVector(d / length) : glm::dvec3(0.0);
  }

  /// True if no edge at the vertex leads nearer along d, a unit vector away from it, except within the tilt.
  bool allowsAtVertex(std::uint32_t v, const glm::dvec3& d) const noexcept {
    for (const std::uint32_t e : surface.mesh().edgesOfVertex(v)) {
      const MeshEdge& edge = surface.mesh().edges()[e];
      if (glm::dot(d, direction(v, edge.v0 == v ? edge.v1 : edge.v0)) > kSineOfTilt) return false;
    }
    return true;
  }
  /// True if no face at the edge leads nearer along d, perpendicular to the edge, except within the tilt.
  bool allowsAtEdge(std::uint32_t e, const glm::dvec3& d) const noexcept {
    const MeshEdge& edge = surface.mesh().edges()[e];
    const glm::dvec3 along = direction(edge.v0, edge.v1);
    for (const std::uint32_t f : surface.mesh().facesOfEdge(e)) {
      const Triangle& t = surface.mesh().triangles()[f];
      const glm::dvec3 third = direction(edge.v0, t[0] + t[1] + t[2] - edge.v0 - edge.v1);
      const glm::dvec3 inward = third - glm::dot(third, along) * along;
      if (glm::dot(d, inward) > kSineOfTilt * glm::length(inward)) return false;
    }
    return true;
  }
};

/// Keeps the nearest contacts in order of distance, one per place and direction.
class ContactList {
 public:
  /// @param count, isFull  Of `out`, before and after.
  ContactList(std::span<SurfaceContact> out, double samePlace, std::size_t& count, bool& isFull) noexcept
      : out_(out), samePlace_(samePlace), count_(count), isFull_(isFull) {}

  void add(const SurfaceContact& c) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      if (!isSame(out_[i], c)) continue;
      if (out_[i].distance <= c.distance) return;
      std::move(out_.begin() + at(i + 1), out_.begin() + at(count_), out_.begin() + at(i));
      --count_;
      break;
    }
    if (count_ == out_.size()) {
      isFull_ = true;
      if (count_ == 0 || out_[count_ - 1].distance <= c.distance) return;
      --count_;
    }
    std::size_t i = count_++;
    for (; i > 0 && out_[i - 1].distance > c.distance; --i)
      out_[i] = out_[i - 1];
    out_[i] = c;
  }

 private:
  static std::ptrdiff_t at(std::size_t i) noexcept { return static_cast<std::ptrdiff_t>(i); }
  bool isSame(const SurfaceContact& a, const SurfaceContact& b) const noexcept {
    const glm::dvec3 turn = a.direction - b.direction, p = a.partPoint - b.partPoint,
                     s = a.scenePoint - b.scenePoint;
    return glm::dot(p, p) <= samePlace_ * samePlace_ && glm::dot(s, s) <= samePlace_ * samePlace_ &&
           glm::dot(turn, turn) <= kSameDirection * kSameDirection;
  }

  std::span<SurfaceContact> out_;
  double samePlace_;
  std::size_t& count_;
  bool& isFull_;
};

/// Tests the pairs of features that belong to a pair of triangles.
class PairContacts {
 public:
  PairContacts(const Side& scene, const Side& part, double within, ContactList& list) noexcept
      : scene_(scene), part_(part), within_(within), list_(list) {}

  /// Returns the direction of the nearest contact, or zero.
  glm::dvec3 test(const FaceLeaf& s, const TriangleCorners& a, const FaceLeaf& p,
                  const TriangleCorners& b) noexcept {
    nearest_ = kUnbounded;
    direction_ = glm::dvec3(0.0);
    testFeatures(s, a, p, b);
    return direction_;
  }

 private:
  void testFeatures(const FaceLeaf& s, const TriangleCorners& a, const FaceLeaf& p,
                    const TriangleCorners& b) noexcept {
    sceneTriangle_ = s.face;
    partTriangle_ = p.face;
    const bool hasSceneVertex = scene_.surface.hasAnyVertex(s.face),
               hasPartVertex = part_.surface.hasAnyVertex(p.face);
    if (hasSceneVertex) verticesOverFace(scene_, s, a, TriangleFrame(b), 1.0);
    if (hasPartVertex) verticesOverFace(part_, p, b, TriangleFrame(a), -1.0);
    if (!hasSceneVertex && !scene_.surface.hasAnyEdge(s.face)) return;
    if (!hasPartVertex && !part_.surface.hasAnyEdge(p.face)) return;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        edgeEdge(s, a, i, p, b, j);
        vertexEdge(s, a, i, p, b, j);
        edgeVertex(s, a, i, p, b, j);
        vertexVertex(s, a, i, p, b, j);
      }
    }
  }
  /// @param sign  1 if the vertices are the scene's, else -1.
  void verticesOverFace(const Side& side, const FaceLeaf& owner, const TriangleCorners& corners,
                        const TriangleFrame& face, double sign) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      if (side.surface.hasVertex(owner.face, i)) vertexFace(side, owner.corners[i], corners[i], face, sign);
    }
  }

  void vertexFace(const Side& side, std::uint32_t v, const glm::dvec3& point, const TriangleFrame& face,
                  double sign) noexcept {
    const TriangleFrame::Coordinates c = face.of(point);
    if (std::abs(c.z) > within_ || !(std::abs(c.z) > 0.0) || !face.holds(c.x, c.y, kSide)) return;
    const glm::dvec3 away = c.z > 0.0 ? -face.normal() : face.normal();
    if (!side.allowsAtVertex(v, away)) return;
    const glm::dvec3 foot = point - c.z * face.normal();
    sign > 0.0 ? add(point, foot, away, std::abs(c.z)) : add(foot, point, -away, std::abs(c.z));
  }

  void edgeEdge(const FaceLeaf& s, const TriangleCorners& a, std::size_t i, const FaceLeaf& p,
                const TriangleCorners& b, std::size_t j) noexcept {
    if (!scene_.surface.hasEdge(s.face, i) || !part_.surface.hasEdge(p.face, j)) return;
    const glm::dvec3 u = a[(i + 1) % 3] - a[i], v = b[(j + 1) % 3] - b[j], w = b[j] - a[i];
    const glm::dvec3 n = glm::cross(u, v);
    const double nn = glm::dot(n, n);
    // Parallel edges touch in a region, whose ends have contacts of their own.
    constexpr double kParallel = 1e-12;
    if (!(nn > kParallel * glm::dot(u, u) * glm::dot(v, v))) return;
    const double height = glm::dot(w, n);
    if (height * height > within_ * within_ * nn) return;
    const double x = glm::dot(glm::cross(w, v), n) / nn, y = glm::dot(glm::cross(w, u), n) / nn;
    if (!isOnSide(x) || !isOnSide(y)) return;
    const glm::dvec3 d = n * (height / nn);
    const double distance = glm::length(d);
    if (!(distance > 0.0) || distance > within_) return;
    const glm::dvec3 direction = d / distance;
    if (!scene_.allowsAtEdge(scene_.surface.mesh().edgesOfTriangle(s.face)[i], direction) ||
        !part_.allowsAtEdge(part_.surface.mesh().edgesOfTriangle(p.face)[j], -direction))
      return;
    const glm::dvec3 point = a[i] + x * u;
    add(point, point + d, direction, distance);
  }

  /// Foot of a vertex on a side; the distance is negative if there is none.
  struct Foot {
    glm::dvec3 point, direction;  ///< The direction is from the vertex.
    double distance = -1.0;
  };
  Foot footOn(const glm::dvec3& vertex, const glm::dvec3& start, const glm::dvec3& end) const noexcept {
    const glm::dvec3 u = end - start;
    const double share = glm::dot(vertex - start, u) / glm::dot(u, u);
    Foot foot;
    if (!isOnSide(share)) return foot;
    foot.point = start + share * u;
    const glm::dvec3 d = foot.point - vertex;
    const double distance = glm::length(d);
    if (!(distance > 0.0) || distance > within_) return foot;
    foot.direction = d / distance;
    foot.distance = distance;
    return foot;
  }

  void vertexEdge(const FaceLeaf& s, const TriangleCorners& a, std::size_t i, const FaceLeaf& p,
                  const TriangleCorners& b, std::size_t j) noexcept {
    if (!scene_.surface.hasVertex(s.face, i) || !part_.surface.hasEdge(p.face, j)) return;
    const Foot foot = footOn(a[i], b[j], b[(j + 1) % 3]);
    if (foot.distance < 0.0 || !scene_.allowsAtVertex(s.corners[i], foot.direction) ||
        !part_.allowsAtEdge(part_.surface.mesh().edgesOfTriangle(p.face)[j], -foot.direction))
      return;
    add(a[i], foot.point, foot.direction, foot.distance);
  }

  void edgeVertex(const FaceLeaf& s, const TriangleCorners& a, std::size_t i, const FaceLeaf& p,
                  const TriangleCorners& b, std::size_t j) noexcept {
    if (!scene_.surface.hasEdge(s.face, i) || !part_.surface.hasVertex(p.face, j)) return;
    const Foot foot = footOn(b[j], a[i], a[(i + 1) % 3]);
    if (foot.distance < 0.0 || !part_.allowsAtVertex(p.corners[j], foot.direction) ||
        !scene_.allowsAtEdge(scene_.surface.mesh().edgesOfTriangle(s.face)[i], -foot.direction))
      return;
    add(foot.point, b[j], -foot.direction, foot.distance);
  }

  void vertexVertex(const FaceLeaf& s, const TriangleCorners& a, std::size_t i, const FaceLeaf& p,
                    const TriangleCorners& b, std::size_t j) noexcept {
    if (!scene_.surface.hasVertex(s.face, i) || !part_.surface.hasVertex(p.face, j)) return;
    const glm::dvec3 d = b[j] - a[i];
    const double distance = glm::length(d);
    if (!(distance > 0.0) || distance > within_) return;
    if (!scene_.allowsAtVertex(s.corners[i], d / distance) ||
        !part_.allowsAtVertex(p.corners[j], -d / distance))
      return;
    add(a[i], b[j], d / distance, distance);
  }

  static bool isOnSide(double share) noexcept { return share >= -kSide && share <= 1.0 + kSide; }

  void add(const glm::dvec3& scenePoint, const glm::dvec3& partPoint, const glm::dvec3& direction,
           double distance) noexcept {
    const glm::dvec3& centre = scene_.surface.tree().centre();
    list_.add({centre + scenePoint, centre + partPoint, direction, distance, sceneTriangle_, partTriangle_});
    if (distance >= nearest_) return;
    nearest_ = distance;
    direction_ = direction;
  }

  const Side &scene_, &part_;
  double within_;
  ContactList& list_;
  std::uint32_t sceneTriangle_ = 0, partTriangle_ = 0;
  double nearest_ = kUnbounded;  ///< Of the contacts of this pair, and its direction.
  glm::dvec3 direction_{0.0};
};

/// How far apart two triangles are along a direction, unit, from the first to the second [m].
double apartAlong(const glm::dvec3& direction, const TriangleCorners& a, const TriangleCorners& b) noexcept {
  const auto at = [&](const glm::dvec3& corner) { return glm::dot(direction, corner - a[0]); };
  return std::min(at(b[0]), std::min(at(b[1]), at(b[2]))) - std::max(0.0, std::max(at(a[1]), at(a[2])));
}

/// Tests listed pairs at one pose.
class ListedPairs {
 public:
  ListedPairs(const UnsidedSurface& scene, const UnsidedSurface& part, const RigidTransform& sceneFromPart,
              double within, ContactList& list) noexcept
      : scene_(scene),
        part_(part),
        placed_(scene.tree(), part.tree(), sceneFromPart),
        sceneSide_{scene, {}},
        partSide_{part, placed_.pose()},
        contacts_(sceneSide_, partSide_, within, list),
        within_(within) {}

  double rounding() const noexcept { return placed_.rounding(); }

  void test(TrianglePair& pair) noexcept {
    const FaceLeaf &s = leafOf(scene_, pair.scene), &p = leafOf(part_, pair.part);
    const double reach = within_ + rounding();
    const DirectedTriangle& a = sceneTriangle_.of(pair.scene, [&] { return placed_.sceneCorners(s); });
    const DirectedTriangle& b = partTriangle_.of(pair.part, [&] { return placed_.partCorners(p); });
    pair.gap = triangleGapLowerBound(a, b, reach, pair.isByPart);
    pair.direction = glm::dvec3(0.0);
    if (pair.gap <= reach) pair.direction = contacts_.test(s, a.corners, p, b.corners);
    if (pair.direction != glm::dvec3(0.0) || !(pair.gap > 0.0)) return;
    pair.direction = directionOfGap(a, b, pair.isByPart);
  }
  /// Finds a direction along which a pair is apart, if there is one among those of its faces.
  void separate(TrianglePair& pair) noexcept {
    const DirectedTriangle& a =
        sceneTriangle_.of(pair.scene, [&] { return placed_.sceneCorners(leafOf(scene_, pair.scene)); });
    const DirectedTriangle& b =
        partTriangle_.of(pair.part, [&] { return placed_.partCorners(leafOf(part_, pair.part)); });
    const double gap = triangleGapLowerBound(a, b, kUnbounded, pair.isByPart);
    pair.known = std::max(pair.known, gap - rounding());
    pair.direction = directionOfGap(a, b, pair.isByPart);
  }
  /// How far a pair is apart along its direction [m]; less than 0 if it has none.
  double apart(const TrianglePair& pair) const noexcept {
    return pair.direction == glm::dvec3(0.0) ? -kUnbounded : apartAlong(pair.direction, pair);
  }
  double apartAlong(const glm::dvec3& direction, const TrianglePair& pair) const noexcept {
    return nearfit::apartAlong(direction, placed_.sceneCorners(leafOf(scene_, pair.scene)),
                               placed_.partCorners(leafOf(part_, pair.part)));
  }
  ClosestPoints closest(const TrianglePair& pair) const noexcept {
    return closestOfTriangles(placed_.sceneCorners(leafOf(scene_, pair.scene)),
                              placed_.partCorners(leafOf(part_, pair.part)));
  }

 private:
  static const FaceLeaf& leafOf(const UnsidedSurface& surface, std::uint32_t i) noexcept {
    return surface.tree().faces()[i];
  }

  /// The triangle of the last call: pairs that were found together often share one.
  struct Latest {
    std::uint32_t index = std::numeric_limits<std::uint32_t>::max();
    DirectedTriangle triangle;

    template <class Corners>
    const DirectedTriangle& of(std::uint32_t wanted, Corners&& corners) noexcept {
      if (wanted != index) {
        index = wanted;
        triangle.corners = corners();
        triangle.directions = SeparatingDirections(triangle.corners);
      }
      return triangle;
    }
  };

  const UnsidedSurface &scene_, &part_;
  PlacedFaces placed_;
  Latest sceneTriangle_, partTriangle_;
  Side sceneSide_, partSide_;
  PairContacts contacts_;
  double within_;
};

/// Max work of listing one batch of a traversal's pairs.
constexpr std::uint64_t kMaxOfBatch = kWorkOfListing * TraversalWork::kMaxLeaves;

bool isPoseValid(const RigidTransform& sceneFromPart, double within) noexcept {
  return sceneFromPart.isFinite() && within > 0.0 && std::isfinite(within);
}

}  // namespace

NearbyTriangles findNearbyTriangles(const UnsidedSurface& scene, const UnsidedSurface& part,
                                    const RigidTransform& sceneFromPart, double within, LmdScratch& scratch,
                                    std::span<TrianglePair> out, std::uint64_t maxWork) noexcept {
  NearbyTriangles result;
  if (!isPoseValid(sceneFromPart, within)) return result;
  result.within = within;
  if (scene.tree().isEmpty() || part.tree().isEmpty()) return result;
  NearFaces faces(scene.tree(), part.tree(), sceneFromPart, within, scratch.data());
  const PlacedFaces& placed = faces.placed();
  const double rounding = placed.rounding(), reach = within + rounding;
  const auto visit = [&](std::uint32_t s, std::uint32_t p) {
    faces.spend(kWorkOfListing);
    bool isByPart = false;
    const TriangleCorners a = placed.sceneCorners(scene.tree().faces()[s]),
                          b = placed.partCorners(part.tree().faces()[p]);
    const double gap = triangleGapLowerBound(a, b, reach, isByPart);
    if (gap > reach) return;
    const double atLeast = std::max(0.0, gap - rounding);
    if (result.count < out.size()) {
      TrianglePair& pair = out[result.count++];
      pair = {s, p, atLeast, isByPart, atLeast};
      if (gap > 0.0) pair.direction = directionOfGap(a, b, isByPart);
    } else {
      result.within = std::min(result.within, atLeast);
      faces.stop();
    }
  };
  // A batch is always listed to its end.
  if (!faces.run(visit, maxWork - std::min(maxWork, kMaxOfBatch)))
    result.within = std::min(result.within, faces.leastNotVisited());
  result.work = faces.work();
  return result;
}

void TriangleTests::begin(const Asked& asked, std::span<SurfaceContact> out) noexcept {
  asked_ = asked;
  out_ = out;
  count_ = at_ = 0;
  isFull_ = false;
  result_ = {};
  stage_ = isPoseValid(asked.sceneFromPart, asked.within) ? Stage::Contacts : Stage::Done;
  result_.leastOnWay = asked.way && stage_ != Stage::Done ? asked.enough : 0.0;
}

void TriangleTests::settle() noexcept {
  const HeldTriangles& held = asked_.held;
  if (stage_ != Stage::Contacts) return;
  for (TrianglePair& pair : held.pairs.subspan(at_))
    pair.known = std::max(pair.known - held.travelSinceTest, pair.atLeast - held.travel);
  stage_ = Stage::Done;
}

bool TriangleTests::goOn(std::uint64_t& work) noexcept {
  if (stage_ == Stage::Done) return true;
  const UnsidedSurface &scene = *asked_.scene, &part = *asked_.part;
  const HeldTriangles& held = asked_.held;
  const double within = asked_.within;
  ContactList list(out_, kSamePlace * (scene.tree().size() + part.tree().size()), count_, isFull_);
  ListedPairs pairs(scene, part, asked_.sceneFromPart, within, list);
  const double rounding = pairs.rounding();
  // Work on pairs that are not tested is counted in fractions of a unit.
  std::size_t passed = 0;
  const auto spend = [&work](std::uint64_t done) { work -= std::min(work, done); };
  const auto pass = [&](std::size_t weight) {
    passed += weight;
    if (passed < kPassedOver) return;
    passed -= kPassedOver;
    spend(1);
  };
  constexpr std::size_t kWeightOfBound = kPassedOver / kBounded;
  if (stage_ == Stage::Contacts) {
    for (; at_ < held.pairs.size(); ++at_) {
      if (work == 0) return false;
      TrianglePair& pair = held.pairs[at_];
      pass(1);
      pair.gap = kUnbounded;
      pair.known = std::max(pair.known - held.travelSinceTest, pair.atLeast - held.travel);
      if (pair.known > within + rounding) continue;
      pass(kWeightOfBound);
      pair.known = std::max(pair.known, pairs.apart(pair) - rounding);
      if (pair.known > within + rounding) continue;
      spend(kWorkOfTest);
      pairs.test(pair);
      pair.known = std::max(pair.known, pair.gap - rounding);
    }
    const double notHeld = held.within - held.travel;
    result_.count = count_;
    result_.completeTo = std::clamp(notHeld, 0.0, within);
    if (isFull_) result_.completeTo = std::min(result_.completeTo, out_.empty() ? 0.0 : out_.back().distance);
    least_ = std::min(within, notHeld);
    if (count_ > 0) least_ = std::min(least_, out_[0].distance);
    stage_ = Stage::Distance;
    at_ = 0;
  }
  if (stage_ == Stage::Distance) {
    // Pairs without a contact count too, as where surfaces pass through each other.
    for (; at_ < held.pairs.size(); ++at_) {
      if (work == 0) return false;
      TrianglePair& pair = held.pairs[at_];
      pass(1);
      if (pair.gap >= least_ - rounding) continue;
      if (count_ > 0 && pairs.apartAlong(out_[0].direction, pair) >= least_ - rounding) {
        if (!(pair.gap > 0.0)) pair.direction = out_[0].direction;
        continue;
      }
      spend(kWorkOfDistance);
      const ClosestPoints closest = pairs.closest(pair);
      const double distance = std::sqrt(closest.distanceSquared);
      least_ = std::min(least_, distance);
      if (distance > 0.0) pair.direction = (closest.b - closest.a) / distance;
    }
    result_.lowerBound = std::max(0.0, least_ - 2.0 * rounding);
    stage_ = Stage::Way;
    at_ = 0;
  }
  if (asked_.way) {
    ListedPairs before(scene, part, asked_.way->from, within, list);
    const double lost = rounding + asked_.way->bend, clear = asked_.enough + asked_.way->travel;
    for (; at_ < held.pairs.size(); ++at_) {
      if (work == 0) return false;
      TrianglePair& pair = held.pairs[at_];
      pass(1);
      // What no point of the part travels as far as stays apart.
      if (pair.known > clear) continue;
      const auto least = [&] {
        pass(2 * kWeightOfBound);
        const double apart = std::min(pairs.apart(pair), before.apart(pair)) - lost;
        return std::max(apart, pair.known - asked_.way->travel);
      };
      double onWay = least();
      if (onWay < asked_.enough && pair.gap == kUnbounded) {
        spend(kWorkOfTest);
        pairs.separate(pair);
        onWay = std::max(onWay, least());
      }
      result_.leastOnWay = std::min(result_.leastOnWay, onWay);
    }
  }
  stage_ = Stage::Done;
  return true;
}

}  // namespace nearfit
