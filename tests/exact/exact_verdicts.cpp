#include "tests/exact/exact_verdicts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/math/aabb.h"
#include "core/math/rotation_vector.h"
#include "core/parallel/parallel_for.h"
#include "core/proximity/query/broad_phase.h"
#include "core/scene/part_geometry.h"
#include "tests/exact/box_tree.h"
#include "tests/exact/exact_meeting.h"
#include "tests/exact/triangle_separation.h"
#include "tests/support/portable_random.h"

namespace nearfit::test {
namespace {

/// What a gap of triangles may be rounded, of the largest coordinate: some ten roundings.
constexpr double kGapRounding = 1e-14;
/// How far distances of the check may be off, of the largest coordinate: it computes in double precision.
constexpr double kDistanceRounding = 1e-11;
/// A triangle whose height is less than that of its longest edge has no area to speak of: its plane is rounding.
constexpr double kSliverHeight = 1e-14;
/// As documented of the verdict "touching": of the smaller diagonal, and at most [m].
constexpr double kTouchFraction = 1e-6, kMostTouch = 1e-6;
/// Meeting triangles whose normals are tried.
constexpr std::size_t kTriedMeetings = 16;
/// Of the scene's diagonal, and in radians.
constexpr double kSpreadShift = 0.01, kSpreadTurn = 0.05;

double largestCoordinate(const Box& box) {
  double most = 0.0;
  for (glm::length_t i = 0; i < 3; ++i)
    most = std::max({most, std::abs(box.lower[i]), std::abs(box.upper[i])});
  return most;
}

glm::dvec3 crossOf(const Corners& t) {
  return glm::cross(t[1] - t[0], t[2] - t[0]);
}

bool isSliver(const Corners& t) {
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, glm::distance(t[k], t[(k + 1) % 3]));
  return glm::length(crossOf(t)) <= kSliverHeight * longest * longest;
}

double distanceOfTriangles(const Corners& a, const Corners& b) {
  if (!isSliver(a) && !isSliver(b)) return exactDistance(a, b);
  return doMeetExactly(a, b) ? 0.0 : separation(a, b, std::numeric_limits<double>::infinity());
}

/// Index of the piece of each vertex; pieces are numbered by their first triangles, and vertices without one have none.
struct VertexPieces {
  explicit VertexPieces(const TriangleMesh& mesh) : parent(mesh.vertices().size()) {
    std::iota(parent.begin(), parent.end(), 0U);
    for (const Triangle& t : mesh.triangles())
      parent[root(t[0])] = parent[root(t[1])] = root(t[2]);
    for (const Triangle& t : mesh.triangles()) {
      if (numbers.emplace(root(t[0]), numbers.size()).second) firstVertex.push_back(t[0]);
    }
  }

  std::uint32_t root(std::uint32_t v) {
    while (parent[v] != v)
      v = parent[v] = parent[parent[v]];
    return v;
  }
  std::size_t pieceOf(std::uint32_t vertex) { return numbers.at(root(vertex)); }

  std::vector<std::uint32_t> parent;
  std::map<std::uint32_t, std::size_t> numbers;
  std::vector<std::uint32_t> firstVertex;
};

std::vector<glm::dvec3> pointOfEachPiece(const TriangleMesh& mesh) {
  std::vector<glm::dvec3> points;
  for (const std::uint32_t v : VertexPieces(mesh).firstVertex)
    points.push_back(mesh.vertices()[v]);
  return points;
}

/// Whether as many triangles run one way along each edge as the other.
bool isBalanced(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const Triangle& t : mesh.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      runs[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
    }
  }
  return std::ranges::all_of(runs, [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

struct ExactBodies::Bodies {
  struct Nodes {
    std::uint32_t scene, part;
  };
  /// The part where it is placed.
  struct Placed {
    std::vector<glm::dvec3> vertices;
    std::vector<Box> boxes;
    double size;  ///< Largest coordinate of both bodies.
  };

  Bodies(const TriangleMesh& s, const TriangleMesh& p)
      : scene(s),
        part(p),
        scenePoints(pointOfEachPiece(s)),
        partPoints(pointOfEachPiece(p)),
        doesSceneEnclose(isBalanced(s)),
        doesPartEnclose(isBalanced(p)) {}

  Placed placed(const RigidTransform& pose) const {
    Placed out{{}, {}, 0.0};
    out.vertices.reserve(part.mesh().vertices().size());
    for (const glm::dvec3& p : part.mesh().vertices())
      out.vertices.push_back(pose.applyToPoint(p));
    out.boxes = part.boxesAround(out.vertices);
    out.size = std::max(largestCoordinate(scene.node(0).box), largestCoordinate(out.boxes[0]));
    return out;
  }

  std::array<Nodes, 2> opened(const Nodes& at, const Placed& p) const {
    const BoxTree::Node &a = scene.node(at.scene), &b = part.node(at.part);
    if (b.child == 0 || (a.child != 0 && a.box.size() >= p.boxes[at.part].size()))
      return {Nodes{a.child, at.part}, Nodes{a.child + 1, at.part}};
    return {Nodes{at.scene, b.child}, Nodes{at.scene, b.child + 1}};
  }

  double gapOf(const Nodes& at, const Placed& p) const {
    return scene.node(at.scene).box.distance(p.boxes[at.part]);
  }

  /// Calls visit(triangle of the scene, of the part) for pairs whose boxes are less than reach() apart, near ones first,
  /// until it says to stop.
  template <class Reach, class Visit>
  void visitNear(const Placed& p, Reach&& reach, Visit&& visit) const {
    if (scene.isEmpty() || part.isEmpty()) return;
    std::vector<Nodes> waiting{{0, 0}};
    while (!waiting.empty()) {
      const Nodes at = waiting.back();
      waiting.pop_back();
      if (gapOf(at, p) > reach()) continue;
      const BoxTree::Node &a = scene.node(at.scene), &b = part.node(at.part);
      if (a.child != 0 || b.child != 0) {
        std::array<Nodes, 2> next = opened(at, p);
        if (gapOf(next[0], p) < gapOf(next[1], p)) std::swap(next[0], next[1]);
        waiting.insert(waiting.end(), next.begin(), next.end());
        continue;
      }
      for (const std::uint32_t t : part.triangles(b)) {
        for (const std::uint32_t s : scene.triangles(a)) {
          if (!visit(scene.corners(s), part.corners(t, p.vertices))) return;
        }
      }
    }
  }

  /// Calls found(triangle of the scene, of the part) for pairs that meet, until it says to stop.
  template <class Found>
  void visitMeetings(const Placed& p, Found&& found) const {
    const double rounding = kGapRounding * p.size;
    visitNear(
        p, [] { return 0.0; },
        [&](const Corners& a, const Corners& b) {
          const bool isSurelyApart = separation(a, b, 2.0 * rounding) > rounding;
          return isSurelyApart || !doMeetExactly(a, b) || found(a, b);
        });
  }

  bool doSurfacesMeet(const RigidTransform& pose) const {
    if (scene.isEmpty() || part.isEmpty()) return false;
    bool doMeet = false;
    visitMeetings(placed(pose), [&](const Corners&, const Corners&) {
      doMeet = true;
      return false;
    });
    return doMeet;
  }

  double leastDistance(const RigidTransform& pose, double most) const {
    if (scene.isEmpty() || part.isEmpty()) return most;
    const Placed p = placed(pose);
    double least = most;
    visitNear(
        p, [&] { return least; },
        [&](const Corners& a, const Corners& b) {
          // What is not surely nearer changes nothing beyond rounding.
          if (separation(a, b, least) < least - kGapRounding * p.size)
            least = std::min(least, distanceOfTriangles(a, b));
          return least > 0.0;
        });
    return least;
  }

  bool isOneInside(const RigidTransform& pose) const {
    const auto isInside = [](const BoxTree& solid, const glm::dvec3& point) {
      constexpr double kHalfWinding = 0.5;
      return !solid.isEmpty() && solid.node(0).box.meets({point, point}) &&
             std::abs(windingNumber(solid.mesh(), point)) > kHalfWinding;
    };
    const RigidTransform partFromScene = pose.inverse();
    return (doesSceneEnclose &&
            std::ranges::any_of(
                partPoints, [&](const glm::dvec3& p) { return isInside(scene, pose.applyToPoint(p)); })) ||
           (doesPartEnclose && std::ranges::any_of(scenePoints, [&](const glm::dvec3& p) {
              return isInside(part, partFromScene.applyToPoint(p));
            }));
  }

  std::vector<glm::dvec3> triedDirections(const RigidTransform& pose) const {
    std::vector<glm::dvec3> directions{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::size_t meetings = 0;
    visitMeetings(placed(pose), [&](const Corners& a, const Corners& b) {
      for (const Corners& t : {a, b}) {
        if (!isSliver(t)) directions.push_back(glm::normalize(crossOf(t)));
      }
      return ++meetings < kTriedMeetings;
    });
    return directions;
  }

  BoxTree scene, part;
  std::vector<glm::dvec3> scenePoints, partPoints;  ///< One of each piece.
  bool doesSceneEnclose, doesPartEnclose;
};

ExactBodies::ExactBodies(const TriangleMesh& scene, const TriangleMesh& part)
    : bodies_(std::make_unique<const Bodies>(scene, part)) {}
ExactBodies::~ExactBodies() = default;
ExactBodies::ExactBodies(ExactBodies&&) noexcept = default;

bool ExactBodies::doSurfacesMeet(const RigidTransform& sceneFromPart) const {
  return bodies_->doSurfacesMeet(sceneFromPart);
}

double ExactBodies::leastDistance(const RigidTransform& sceneFromPart, double most) const {
  return bodies_->leastDistance(sceneFromPart, most);
}

bool ExactBodies::isOneInside(const RigidTransform& sceneFromPart) const {
  return bodies_->isOneInside(sceneFromPart);
}

bool ExactBodies::isFree(const RigidTransform& sceneFromPart) const {
  return !bodies_->doSurfacesMeet(sceneFromPart) && !bodies_->isOneInside(sceneFromPart);
}

bool ExactBodies::isFreedBy(double length, const RigidTransform& sceneFromPart) const {
  for (const glm::dvec3& direction : bodies_->triedDirections(sceneFromPart)) {
    for (const double way : {length, -length}) {
      RigidTransform moved = sceneFromPart;
      moved.translation += way * direction;
      if (isFree(moved)) return true;
    }
  }
  return false;
}

namespace {

/// What exact arithmetic says of a pair.
struct ExactVerdict {
  PairVerdict verdict = PairVerdict::Clear;
  double distance = 0.0;  ///< [m]
  double rounding = 0.0;  ///< By how much a distance of double precision may differ [m].
};

ExactVerdict exactVerdict(const CheckedPart& part, const CheckedPart& other, double threshold) {
  const TriangleMesh &a = other.geometry->tree().mesh(), &b = part.geometry->tree().mesh();
  const RigidTransform pose = (other.worldFromPart.inverse() * part.worldFromPart).normalized();
  const ExactBodies bodies(a, b);
  const double diagonal =
      std::min(other.geometry->mesh.bounds().diagonal(), part.geometry->mesh.bounds().diagonal());
  const double touch = std::min(kTouchFraction * diagonal, kMostTouch);
  const double size = a.bounds().diagonal() + b.bounds().diagonal() + glm::length(pose.translation);
  ExactVerdict exact{PairVerdict::Clear, 0.0, kDistanceRounding * size};
  if (bodies.doSurfacesMeet(pose)) {
    // Just less than the tolerance frees what it frees.
    constexpr double kWithin = 1.0 + 1e-6;
    exact.verdict = bodies.isFreedBy(kWithin * touch, pose) ? PairVerdict::Touching : PairVerdict::Clash;
    return exact;
  }
  if (bodies.isOneInside(pose)) {
    exact.verdict = PairVerdict::Contained;
    return exact;
  }
  constexpr double kBeyond = 1.01;
  exact.distance = bodies.leastDistance(pose, kBeyond * threshold + touch);
  exact.verdict = exact.distance <= touch       ? PairVerdict::Touching
                  : exact.distance <= threshold ? PairVerdict::Near
                                                : PairVerdict::Clear;
  return exact;
}

/// What a check says of a pair.
struct SaidVerdict {
  PairVerdict verdict = PairVerdict::Clear;
  double distance = 0.0;  ///< [m]
};

SaidVerdict saidOf(const SceneCheck& check, const PartPair& pair) {
  const auto found = std::ranges::find(check.findings, pair, &PairFinding::pair);
  return found == check.findings.end() ? SaidVerdict() : SaidVerdict{found->verdict, found->distance};
}

/// True if the two say the same, or rounding decides between them.
bool doAgree(const ExactVerdict& exact, const SaidVerdict& said, double threshold) {
  const bool isAtThreshold = exact.distance > 0.0 && std::abs(exact.distance - threshold) <= exact.rounding;
  if (isAtThreshold) return said.verdict == PairVerdict::Near || said.verdict == PairVerdict::Clear;
  if (exact.verdict != said.verdict) return false;
  return exact.verdict != PairVerdict::Near || std::abs(exact.distance - said.distance) <= exact.rounding;
}

void countExact(PairVerdict verdict, VerdictComparison& out) {
  switch (verdict) {
    case PairVerdict::Clear:
      ++out.clear;
      return;
    case PairVerdict::Near:
      ++out.near;
      return;
    case PairVerdict::Touching:
      ++out.touching;
      return;
    case PairVerdict::Clash:
      ++out.clashes;
      return;
    case PairVerdict::Contained:
      ++out.contained;
      return;
  }
}

}  // namespace

VerdictComparison compareVerdicts(const SceneCheckRequest& request, const SceneCheck& check) {
  const std::vector<CheckedPart>& parts = request.parts;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t k = i + 1; k < parts.size(); ++k)
      pairs.emplace_back(i, k);
  }
  std::vector<ExactVerdict> exact(pairs.size());
  parallelFor(pairs.size(), [&](std::size_t n) {
    exact[n] = exactVerdict(parts[pairs[n].first], parts[pairs[n].second], request.threshold);
  });
  VerdictComparison out;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const CheckedPart &part = parts[pairs[n].first], &other = parts[pairs[n].second];
    const SaidVerdict said = saidOf(check, {part.id, other.id});
    ++out.pairs;
    countExact(exact[n].verdict, out);
    if (exact[n].verdict == PairVerdict::Near && said.verdict == PairVerdict::Near)
      out.worstDistance = std::max(out.worstDistance, std::abs(exact[n].distance - said.distance));
    if (doAgree(exact[n], said, request.threshold)) {
      ++out.agree;
    } else {
      out.differences.push_back(
          fmt::format("\"{}\" and \"{}\" are {} ({:.17g} m) by the check, {} ({:.17g} m) by exact arithmetic",
                      part.ruled.name, other.ruled.name, wordOf(said.verdict), said.distance,
                      wordOf(exact[n].verdict), exact[n].distance));
    }
  }
  return out;
}

Scene spreadScene(const Scene& scene, double factor, std::uint64_t seed) {
  const auto middleOf = [](const Part& part) {
    return part.worldFromPart.applyToPoint(part.geometry->mesh.bounds().centre());
  };
  Aabb all;
  for (const Scene::PartPtr& part : scene.parts()) {
    const Aabb box = boundsOf(part->geometry->mesh.bounds(), part->worldFromPart);
    all.add(box.lower);
    all.add(box.upper);
  }
  std::mt19937_64 random(seed);
  const auto vector = [&random](double size) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return size * (2.0 * glm::dvec3(x, y, z) - 1.0);
  };
  Scene spread = scene;
  for (const Scene::PartPtr& drawn : scene.parts()) {
    Part part = *drawn;
    const glm::dvec3 middle = middleOf(part);
    const glm::dvec3 place =
        all.centre() + factor * (middle - all.centre()) + vector(kSpreadShift * all.diagonal());
    const glm::dquat turn = rotationOf(vector(kSpreadTurn));
    part.worldFromPart = RigidTransform{turn, place - turn * middle} * part.worldFromPart;
    part.worldFromPart = part.worldFromPart.normalized();
    spread.replace(part);
  }
  return spread;
}

std::vector<TriangleMesh> meshPieces(const TriangleMesh& mesh) {
  VertexPieces pieces(mesh);
  std::vector<std::vector<glm::dvec3>> vertices(pieces.firstVertex.size());
  std::vector<std::vector<Triangle>> triangles(pieces.firstVertex.size());
  std::vector<std::uint32_t> index(mesh.vertices().size(), std::numeric_limits<std::uint32_t>::max());
  for (const Triangle& t : mesh.triangles()) {
    const std::size_t piece = pieces.pieceOf(t[0]);
    Triangle moved = t;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& at = index[t[k]];
      if (at == std::numeric_limits<std::uint32_t>::max()) {
        at = static_cast<std::uint32_t>(vertices[piece].size());
        vertices[piece].push_back(mesh.vertices()[t[k]]);
      }
      moved[k] = at;
    }
    triangles[piece].push_back(moved);
  }
  std::vector<TriangleMesh> out;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    out.emplace_back(std::move(vertices[i]), std::move(triangles[i]));
  return out;
}

}  // namespace nearfit::test
