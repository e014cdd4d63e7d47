#include "core/path/path_verifier.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/parallel/lower_to.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/path/triangle_boxes.h"

namespace nearfit {
namespace {

/// Travel is rounded up by this share, and poses by this of the lengths involved: far below the slack that certifiers
/// leave (path_certifier.cpp), far above rounding.
constexpr double kTravelShare = 1.0 + 1e-12, kPoseShare = 2e-14;
/// Stretches that one thread proves at once.
constexpr std::size_t kStretchesAtOnce = 16;
constexpr std::size_t kNoProblem = std::numeric_limits<std::size_t>::max();

double lengthOfLargest(const glm::dvec3& lower, const glm::dvec3& upper) {
  return glm::length(glm::max(glm::abs(lower), glm::abs(upper)));
}

/// A part of the certificate with the mesh that the scene has for it.
struct JudgedPart {
  const TriangleMesh* mesh = nullptr;
  RigidTransform pose;  ///< As CertifiedPart::pose.
  Aabb box;             ///< Of its triangles, in its own frame.
};

Aabb boxOfTriangles(const TriangleMesh& mesh) {
  Aabb box;
  for (const Triangle& triangle : mesh.triangles()) {
    for (const std::uint32_t v : triangle)
      box.add(mesh.vertices()[v]);
  }
  return box;
}

/// Farthest that any point of a moving part gets along the path, summed up by pose. Points turn about an axis through
/// the centre, so their way is at most that of the centre and the angle times the distance from the axis.
class WayLength {
 public:
  WayLength(const AssemblyPath& path, const JudgedPart& part) : sums_{0.0} {
    const glm::dvec3 centre = part.pose.inverse().applyToPoint(path.centre);
    double squaredRadius = 0.0;
    for (const Triangle& triangle : part.mesh->triangles()) {
      for (const std::uint32_t v : triangle) {
        const glm::dvec3 arm = part.mesh->vertices()[v] - centre;
        squaredRadius = std::max(squaredRadius, glm::dot(arm, arm));
      }
    }
    const double radius = std::sqrt(squaredRadius);
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      const RigidTransform &a = path.poses[i - 1].worldFromLead, &b = path.poses[i].worldFromLead;
      const bool isStill = a == b;
      sums_.push_back(sums_.back() +
                      (isStill ? 0.0 : lengthBetween(a, b, path.centre, part, centre, radius)));
    }
  }

  /// Length from the start of the path to a place [m].
  double to(double place) const {
    const auto last = sums_.size() - 1;
    const auto before = static_cast<std::size_t>(place);
    if (before >= last) return sums_[last];
    const double share = place - static_cast<double>(before);
    return (1.0 - share) * sums_[before] + share * sums_[before + 1];
  }

 private:
  static double lengthBetween(const RigidTransform& a, const RigidTransform& b, const glm::dvec3& centre,
                              const JudgedPart& part, const glm::dvec3& centreInPart, double radius) {
    const glm::dvec3 shift = (b.rotation * centre + b.translation) - (a.rotation * centre + a.translation);
    // The chord of two unit quaternions is twice the sine of a quarter of the angle.
    glm::dquat to = b.rotation;
    if (glm::dot(a.rotation, to) < 0.0) to = -to;
    const glm::dquat chord = to - a.rotation;
    const double angle = 4.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(glm::dot(chord, chord))));
    // The axis, in the frame of the part.
    const glm::dquat turn =
        glm::conjugate(part.pose.rotation) * (glm::conjugate(a.rotation) * to) * part.pose.rotation;
    const glm::dvec3 axis(turn.x, turn.y, turn.z);
    const double sine = glm::length(axis);
    double arm = radius;
    if (sine > 0.0) {
      double farthest = 0.0;
      for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1U ? part.box.upper : part.box.lower).x,
                           (corner & 2U ? part.box.upper : part.box.lower).y,
                           (corner & 4U ? part.box.upper : part.box.lower).z);
        farthest = std::max(farthest, glm::length(glm::cross(axis, p - centreInPart)) / sine);
      }
      arm = std::min(arm, farthest);
    }
    // Differences of nearly equal poses carry the rounding of both; so does the axis.
    const double rounding =
        1e-15 * (radius + glm::length(a.translation) + glm::length(b.translation) + glm::length(centre));
    return kTravelShare * (glm::length(shift) + angle * arm) + rounding;
  }

  std::vector<double> sums_;
};

/// A closed, or open, piece of a mesh: triangles that hang together by sides.
struct MeshPiece {
  std::uint32_t vertex = 0;  ///< One of its corners.
  /// As many triangles run one way along each side as the other, so that it winds around points a whole number of times.
  bool isClosed = true;
  Aabb box;
  std::vector<std::uint32_t> triangles;
};

std::vector<MeshPiece> hangingPieces(const TriangleMesh& mesh) {
  struct Side {
    std::uint32_t low, high, triangle;
    int sense;
  };
  const auto triangles = mesh.triangles();
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), t, from < to ? 1 : -1});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::pair(s.low, s.high); });
  std::vector<std::uint32_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto rootOf = [&](std::uint32_t t) {
    while (parent[t] != t)
      t = parent[t] = parent[parent[t]];
    return t;
  };
  std::vector<std::uint32_t> unbalanced;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    int sum = 0;
    for (; end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high; ++end) {
      sum += sides[end].sense;
      parent[rootOf(sides[end].triangle)] = rootOf(sides[i].triangle);
    }
    if (sum != 0) unbalanced.push_back(sides[i].triangle);
    i = end;
  }
  std::vector<std::size_t> pieceOf(triangles.size(), 0);
  std::vector<MeshPiece> pieces;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (rootOf(t) != t) continue;
    pieceOf[t] = pieces.size();
    pieces.push_back({triangles[t][0], true, {}, {}});
  }
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    MeshPiece& piece = pieces[pieceOf[rootOf(t)]];
    piece.triangles.push_back(t);
    for (const std::uint32_t v : triangles[t])
      piece.box.add(mesh.vertices()[v]);
  }
  for (const std::uint32_t t : unbalanced)
    pieces[pieceOf[rootOf(t)]].isClosed = false;
  return pieces;
}

/// Solid angle of a triangle from a point, by the sign of its sense [sr]. Source: Van Oosterom and Strackee 1983.
double solidAngle(const TriangleMesh& mesh, const Triangle& t, const glm::dvec3& from) {
  const glm::dvec3 a = mesh.vertices()[t[0]] - from, b = mesh.vertices()[t[1]] - from,
                   c = mesh.vertices()[t[2]] - from;
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double above = glm::dot(a, glm::cross(b, c));
  const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2.0 * std::atan2(above, below);
}

bool holdsPoint(const Aabb& box, const glm::dvec3& p) {
  return box.lower.x <= p.x && p.x <= box.upper.x && box.lower.y <= p.y && p.y <= box.upper.y &&
         box.lower.z <= p.z && p.z <= box.upper.z;
}

/// True if the closed pieces of a mesh wind around a point off them, or that is not certain.
bool isWoundAround(const TriangleMesh& mesh, const std::vector<MeshPiece>& pieces, const glm::dvec3& point) {
  double sum = 0.0;
  for (const MeshPiece& piece : pieces) {
    // None winds around what is outside its box.
    if (!piece.isClosed || !holdsPoint(piece.box, point)) continue;
    for (const std::uint32_t t : piece.triangles)
      sum += solidAngle(mesh, mesh.triangles()[t], point);
  }
  // The sum is a whole number of full angles but for rounding.
  return !(std::abs(sum) < 0.5 * 4.0 * std::numbers::pi);
}

/// Lower bound on the gap of two boxes along the axes of the first [m].
double gapInFrameOf(const Aabb& box, const Aabb& other, const RigidTransform& boxFromOther) {
  glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p = boxFromOther.applyToPoint({(corner & 1U ? other.upper : other.lower).x,
                                                    (corner & 2U ? other.upper : other.lower).y,
                                                    (corner & 4U ? other.upper : other.lower).z});
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  const glm::dvec3 gap = glm::max(glm::max(box.lower - upper, lower - box.upper), glm::dvec3(0.0));
  return glm::length(gap);
}

/// A stretch that is to be proven.
struct Claim {
  std::size_t pair = 0;
  ProvenStretch stretch;
};

/// Proves one certificate.
class CertificateCheck {
 public:
  CertificateCheck(const Certificate& certificate, const PathBodies& bodies) : certificate_(certificate) {
    const auto add = [&](const Part& part, const RigidTransform& pose) {
      parts_.push_back({&part.geometry->mesh, pose, boxOfTriangles(part.geometry->mesh)});
    };
    for (const PathPart& moving : bodies.moving)
      add(*moving.part, moving.leadFromPart);
    for (const Scene::PartPtr& other : bodies.others)
      add(*other, other->worldFromPart);
    moving_ = bodies.moving.size();
    parallelWays();
  }

  /// Says how the order of pairs or a stretch is wrong; empty if neither is.
  std::string formProblem() const {
    std::size_t next = 0;
    for (std::size_t part = 0; part < moving_; ++part) {
      for (std::size_t other = moving_; other < parts_.size(); ++other, ++next) {
        if (next >= certificate_.pairs.size() || certificate_.pairs[next].part != part ||
            certificate_.pairs[next].other != other) {
          return fmt::format("it has no proof for \"{}\" and \"{}\" where one belongs", nameOf(part),
                             nameOf(other));
        }
        const std::string problem = coverProblem(certificate_.pairs[next]);
        if (!problem.empty()) return problem;
      }
    }
    return next == certificate_.pairs.size() ? std::string()
                                             : "it has proofs for pairs of parts that it does not name";
  }

  /// Proves that nothing is inside something else at the start.
  std::string insideProblem() const {
    std::vector<char> isInside(certificate_.pairs.size(), 0);
    std::vector<std::vector<MeshPiece>> pieces(parts_.size());
    std::vector<char> isNeeded(parts_.size(), 0);
    for (const CertifiedPair& pair : certificate_.pairs) {
      if (!doBoxesMeet(pair)) continue;
      isNeeded[pair.part] = isNeeded[pair.other] = 1;
    }
    parallelFor(parts_.size(), [&](std::size_t i) {
      if (isNeeded[i] != 0) pieces[i] = hangingPieces(*parts_[i].mesh);
    });
    parallelFor(certificate_.pairs.size(), [&](std::size_t i) {
      const CertifiedPair& pair = certificate_.pairs[i];
      if (!doBoxesMeet(pair)) return;
      const RigidTransform otherFromPart = poseOf(pair, 0.0);
      isInside[i] = isAPieceInside(pair.part, pair.other, otherFromPart, pieces) ||
                            isAPieceInside(pair.other, pair.part, otherFromPart.inverse(), pieces)
                        ? 1
                        : 0;
    });
    const auto first = std::ranges::find(isInside, 1);
    if (first == isInside.end()) return {};
    const CertifiedPair& pair = certificate_.pairs[static_cast<std::size_t>(first - isInside.begin())];
    return fmt::format("\"{}\" and \"{}\" are not proven to be outside each other at the start of the path",
                       nameOf(pair.part), nameOf(pair.other));
  }

  /// Proves all stretches.
  std::string stretchProblem(const ProgressCallback& progress) {
    std::vector<Claim> claims = claimsBeyondBoxes();
    makeTrees(claims);
    const std::size_t blocks = (claims.size() + kStretchesAtOnce - 1) / kStretchesAtOnce;
    std::atomic<std::size_t> firstProblem{kNoProblem};
    SharedProgress done(progress, std::max(1.0, static_cast<double>(blocks)));
    parallelFor(blocks, [&](std::size_t block) {
      TriangleBoxes::Waiting waiting;
      const std::size_t end = std::min(claims.size(), (block + 1) * kStretchesAtOnce);
      // Behind a problem nothing matters.
      for (std::size_t i = block * kStretchesAtOnce; i < end && i < firstProblem.load(); ++i) {
        if (isProven(claims[i], waiting)) continue;
        lowerTo(firstProblem, i);
      }
      done.add(1.0);
    });
    if (firstProblem.load() == kNoProblem) return {};
    const Claim& claim = claims[firstProblem.load()];
    const CertifiedPair& pair = certificate_.pairs[claim.pair];
    return fmt::format("\"{}\" and \"{}\" are not proven to be {} m apart at {} s", nameOf(pair.part),
                       nameOf(pair.other), claim.stretch.bound,
                       timeAt(certificate_.path, claim.stretch.anchor));
  }

 private:
  const std::string& nameOf(std::size_t part) const { return certificate_.parts[part].name; }

  void parallelWays() {
    ways_.resize(moving_);
    parallelFor(moving_,
                [&](std::size_t i) { ways_[i] = std::make_unique<WayLength>(certificate_.path, parts_[i]); });
  }

  /// Pose of a pair's moving part in the frame of the other.
  RigidTransform poseOf(const CertifiedPair& pair, double place) const {
    const RigidTransform worldFromPart = poseAt(certificate_.path, place) * parts_[pair.part].pose;
    return (parts_[pair.other].pose.inverse() * worldFromPart).normalized();
  }
  /// Max distance by which rounding of that pose may move a point [m].
  double roundingOf(const CertifiedPair& pair, double place) const {
    const JudgedPart &part = parts_[pair.part], &other = parts_[pair.other];
    return kPoseShare * (glm::length(other.pose.translation) + glm::length(part.pose.translation) +
                         glm::length(poseAt(certificate_.path, place).translation) +
                         lengthOfLargest(part.box.lower, part.box.upper) +
                         lengthOfLargest(other.box.lower, other.box.upper));
  }

  /// Checks that stretches follow each other over the whole path, and that each bound leaves the separation.
  std::string coverProblem(const CertifiedPair& pair) const {
    const WayLength& way = *ways_[pair.part];
    const auto fail = [&](const char* problem, double place) {
      return fmt::format("the proof for \"{}\" and \"{}\" {} at {} s", nameOf(pair.part), nameOf(pair.other),
                         problem, timeAt(certificate_.path, place));
    };
    double from = 0.0;
    for (const ProvenStretch& stretch : pair.stretches) {
      if (stretch.from != from || !(stretch.anchor >= from) || !(stretch.to >= stretch.anchor) ||
          !(stretch.to > from))
        return fail("does not go on", from);
      const double middle = way.to(stretch.anchor);
      const double moved = std::max(middle - way.to(from), way.to(stretch.to) - middle);
      if (!(stretch.bound >= certificate_.separation + moved))
        return fail("claims too little for its stretch", from);
      from = stretch.to;
    }
    return from == certificate_.path.end() ? std::string() : fail("ends before the path", from);
  }

  bool doBoxesMeet(const CertifiedPair& pair) const {
    const RigidTransform otherFromPart = poseOf(pair, 0.0);
    return !(gapInFrameOf(parts_[pair.other].box, parts_[pair.part].box, otherFromPart) >
             roundingOf(pair, 0.0));
  }

  bool isAPieceInside(std::size_t inner, std::size_t outer, const RigidTransform& outerFromInner,
                      const std::vector<std::vector<MeshPiece>>& pieces) const {
    return std::ranges::any_of(pieces[inner], [&](const MeshPiece& piece) {
      const glm::dvec3 point = outerFromInner.applyToPoint(parts_[inner].mesh->vertices()[piece.vertex]);
      return isWoundAround(*parts_[outer].mesh, pieces[outer], point);
    });
  }

  /// The stretches that boxes around the two meshes do not prove.
  std::vector<Claim> claimsBeyondBoxes() const {
    std::vector<Claim> claims;
    for (std::size_t i = 0; i < certificate_.pairs.size(); ++i) {
      const CertifiedPair& pair = certificate_.pairs[i];
      const Aabb &part = parts_[pair.part].box, &other = parts_[pair.other].box;
      for (const ProvenStretch& stretch : pair.stretches) {
        const RigidTransform pose = poseOf(pair, stretch.anchor);
        const double gap =
            std::max(gapInFrameOf(other, part, pose), gapInFrameOf(part, other, pose.inverse()));
        if (!(gap >= stretch.bound + roundingOf(pair, stretch.anchor))) claims.push_back({i, stretch});
      }
    }
    return claims;
  }

  void makeTrees(const std::vector<Claim>& claims) {
    for (const Claim& claim : claims) {
      const CertifiedPair& pair = certificate_.pairs[claim.pair];
      trees_.try_emplace(parts_[pair.part].mesh->triangles().data());
      trees_.try_emplace(parts_[pair.other].mesh->triangles().data());
    }
    std::vector<std::unique_ptr<const TriangleBoxes>*> places;
    std::vector<const TriangleMesh*> meshes;
    for (auto& [key, tree] : trees_) {
      places.push_back(&tree);
      meshes.push_back(std::ranges::find(parts_, key, [](const JudgedPart& part) {
                         return part.mesh->triangles().data();
                       })->mesh);
    }
    parallelFor(places.size(),
                [&](std::size_t i) { *places[i] = std::make_unique<const TriangleBoxes>(*meshes[i]); });
  }

  bool isProven(const Claim& claim, TriangleBoxes::Waiting& waiting) const {
    const CertifiedPair& pair = certificate_.pairs[claim.pair];
    const TriangleBoxes& other = *trees_.at(parts_[pair.other].mesh->triangles().data());
    const TriangleBoxes& part = *trees_.at(parts_[pair.part].mesh->triangles().data());
    const double gap = claim.stretch.bound + roundingOf(pair, claim.stretch.anchor);
    return other.isApart(part, poseOf(pair, claim.stretch.anchor), gap, waiting);
  }

  const Certificate& certificate_;
  std::vector<JudgedPart> parts_;
  std::size_t moving_ = 0;  ///< Number of moving parts, which come first.
  std::vector<std::unique_ptr<WayLength>> ways_;
  /// By the triangles of a mesh, which instances share.
  std::map<const Triangle*, std::unique_ptr<const TriangleBoxes>> trees_;
};

/// Says how the parts of a certificate differ from those of the scene; empty if they do not.
std::string partsProblem(const std::vector<CertifiedPart>& certified,
                         const std::vector<CertifiedPart>& present) {
  for (std::size_t i = 0; i < std::min(certified.size(), present.size()); ++i) {
    const CertifiedPart &a = certified[i], &b = present[i];
    if (a.name != b.name || a.isMoving != b.isMoving)
      return fmt::format("the scene has the part \"{}\" where the certificate has \"{}\"", b.name, a.name);
    if (a.meshSha256 != b.meshSha256) return fmt::format("the mesh of \"{}\" differs", a.name);
    if (a.pose != b.pose) return fmt::format("\"{}\" is at another place", a.name);
  }
  if (certified.size() == present.size()) return {};
  if (certified.size() > present.size())
    return fmt::format("the scene does not show the part \"{}\"", certified[present.size()].name);
  return fmt::format("the scene shows the part \"{}\", which the certificate does not have",
                     present[certified.size()].name);
}

}  // namespace

Verification verifyCertificate(const Certificate& certificate, const Scene& scene,
                               const std::string& sceneSha256, const std::optional<AssemblyPath>& path,
                               const ProgressCallback& progress) {
  Verification result;
  const auto refuse = [&](std::string problem) {
    result.problem = std::move(problem);
    return result;
  };
  if (!certificate.sceneSha256.empty() && certificate.sceneSha256 != sceneSha256)
    return refuse("the scene file is not the one that was certified: its bytes differ");
  if (path && !isSamePath(*path, certificate.path))
    return refuse("the path is not the one that was certified: a pose, a name or the centre differs");
  if (!(certificate.separation > 0.0) || !std::isfinite(certificate.separation))
    return refuse("its separation is not valid");
  std::optional<PathBodies> bodies;
  try {
    checkPath(certificate.path, "path");
    bodies = pathBodies(scene, certificate.path);
  } catch (const UsageError& e) {
    return refuse(e.problem());
  }
  std::string problem = partsProblem(certificate.parts, certifiedParts(*bodies));
  if (!problem.empty()) return refuse(std::move(problem));
  CertificateCheck check(certificate, *bodies);
  problem = check.formProblem();
  if (!problem.empty()) return refuse(std::move(problem));
  problem = check.insideProblem();
  if (!problem.empty()) return refuse(std::move(problem));
  problem = check.stretchProblem(progress);
  if (!problem.empty()) return refuse(std::move(problem));
  for (const CertifiedPair& pair : certificate.pairs)
    result.stretches += pair.stretches.size();
  return result;
}

}  // namespace nearfit
