#include "core/path/path_certifier.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/parallel/lower_to.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/parallel/work_spaces.h"
#include "core/path/path_bodies.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/surface/surface_distance.h"

namespace nearfit {
namespace {

constexpr std::uint64_t kUnlimitedWork = std::numeric_limits<std::uint64_t>::max();
constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// Share of the room between distance and separation that a stretch takes. The rest is for rounding, here and where
/// others prove it anew.
constexpr double kRoomTaken = 0.99;
/// Stated bounds leave this share of the travel to rounding; together with kRoomTaken below the distance.
constexpr double kTravelSlack = 1.005;
/// And this share of the least room, for parts that hardly move.
constexpr double kLeastSlack = 0.002;
/// Distances are looked for this much beyond what a stretch needs, so that rounding leaves no remainder of it.
constexpr double kReachRounding = 1.001;
/// Least room, as a share of the separation: ends the search where a path grazes.
constexpr double kLeastRoom = 1.0 / 16.0;
/// Separations finer than this share of the lengths involved are refused: rounding (path_bodies.h) must be far below
/// the least room.
constexpr double kLeastSeparation = 1e-9;
/// Levels of halving by which boxes alone are tried, and of what is left to a search: up to 256 stretches a pair.
constexpr unsigned kBoxLevels = 8;

/// A piece of a path that is not proven yet.
struct OpenPiece {
  double from = 0.0, to = 0.0;
  double reach = kNowhere;  ///< Travel that its first stretch probably covers to either side [m].
};

/// A moving part and another one.
struct MovingPair {
  const PathPart* part = nullptr;
  const Part* other = nullptr;
};

/// Where a pair was not proven free.
struct Grazing {
  double place = kNowhere;
  double distance = 0.0;
  bool isInside = false;
};

/// Proves one pair free along a path.
class PairAdvance {
 public:
  PairAdvance(const AssemblyPath& path, const PathTravel& travel, const MovingPair& pair, double separation)
      : path_(path), travel_(travel), pair_(pair), separation_(separation) {}

  /// Proves what boxes alone prove; appends the rest, in order, to `open`.
  /// @param levels  Times that the path is halved for that.
  void byBoxes(unsigned levels, std::vector<ProvenStretch>& proven, std::vector<OpenPiece>& open) const {
    byBoxes(0.0, path_.end(), levels, proven, open);
  }

  /// Finds if one body is in the other, or meets it, at the start.
  Grazing atStart() const {
    const RigidTransform pose = poseOf(0.0);
    const PartGeometry &other = *pair_.other->geometry, &part = *pair_.part->part->geometry;
    if (boxGap(other.mesh.bounds(), part.mesh.bounds(), pose) > slackAt(0.0)) return {};
    const bool isMet = findInterference(other.tree(), part.tree(), pose).kind != InterferenceKind::Disjoint;
    return isMet ? Grazing{0.0, 0.0, true} : Grazing{};
  }

  /// Which place that is not proven is wanted.
  enum class Wanted : std::uint8_t { First, Any };

  /// Proves a piece by distances. Ends at the first place that is not proven, or at any, and skips what lies behind
  /// `limit`, which others lower.
  /// @param maxDistances  Number of distances after which what is left counts as not proven.
  Grazing byDistance(const OpenPiece& piece, LmdScratch& scratch, const std::atomic<double>& limit,
                     std::vector<ProvenStretch>& proven, Wanted wanted = Wanted::First,
                     std::uint64_t maxDistances = kUnlimitedWork) const {
    Grazing first;
    std::vector<OpenPiece> open{piece};
    while (!open.empty()) {
      const OpenPiece at = open.back();
      open.pop_back();
      if (maxDistances-- == 0) return {at.from, 0.0, false};
      if (at.from >= std::min(first.place, limit.load())) continue;
      const double begin = travel_.at(at.from), end = travel_.at(at.to);
      const double half = 0.5 * (end - begin), reach = std::min(half, at.reach);
      const double anchor = end > begin ? travel_.placeAt(begin + reach, at.from, at.to) : at.from;
      const double enough = separation_ + kReachRounding * std::max(reach, leastRoom()) / kRoomTaken;
      const double distance = distanceAt(anchor, enough, scratch);
      const double room = kRoomTaken * (distance - separation_);
      if (!(room >= kRoomTaken * leastRoom())) {
        first = {anchor, std::max(distance, 0.0), false};
        if (wanted == Wanted::Any) return first;
        // Nearer to the true first place than this nobody needs it.
        if (travel_.at(anchor) - begin > leastRoom()) open.push_back({at.from, anchor, 0.5 * reach});
        continue;
      }
      const double middle = travel_.at(anchor);
      const double left = middle - begin <= room ? at.from : travel_.placeAt(middle - room, at.from, anchor);
      const double right = end - middle <= room ? at.to : travel_.placeAt(middle + room, anchor, at.to);
      if (!(right > at.from)) {
        // A step too small for the digits of places.
        first = {at.from, distance, false};
        continue;
      }
      proven.push_back(stretchOf(left, anchor, right));
      const double next = distance >= enough ? 2.0 * reach : room;
      if (right < at.to) open.push_back({right, at.to, std::max(next, leastRoom())});
      if (left > at.from) open.push_back({at.from, left, std::max(next, leastRoom())});
    }
    return first;
  }

 private:
  double leastRoom() const noexcept { return kLeastRoom * separation_; }
  RigidTransform poseOf(double place) const noexcept {
    return otherFromPart(*pair_.other, poseAt(path_, place), *pair_.part);
  }
  double slackAt(double place) const noexcept {
    return placeRounding(*pair_.other, poseAt(path_, place), *pair_.part);
  }

  ProvenStretch stretchOf(double from, double anchor, double to) const noexcept {
    const double middle = travel_.at(anchor);
    const double moved = std::max(middle - travel_.at(from), travel_.at(to) - middle);
    return {from, anchor, to, separation_ + kTravelSlack * moved + kLeastSlack * leastRoom()};
  }

  /// Lower bound on the distance of the two meshes as loaded [m]; at least `enough` if nothing is nearer.
  double distanceAt(double place, double enough, LmdScratch& scratch) const {
    const NormalConeTree &other = pair_.other->geometry->tree(), &part = pair_.part->part->geometry->tree();
    const double slack = slackAt(place) + other.deviation() + part.deviation();
    // The search subtracts its own rounding, which must not make far surfaces look near.
    constexpr double kSearchRounding = 1.0 + 1e-9;
    const double within = kSearchRounding * (enough + slack) +
                          1e-11 * (other.size() + part.size() + glm::length(poseOf(place).translation));
    const SurfaceDistance found =
        leastSurfaceDistance(other, part, poseOf(place), within, scratch, kUnlimitedWork);
    return found.lowerBound - slack;
  }

  void byBoxes(double from, double to, unsigned levels, std::vector<ProvenStretch>& proven,
               std::vector<OpenPiece>& open) const {
    const double begin = travel_.at(from), end = travel_.at(to);
    const double anchor = travel_.placeAt(0.5 * (begin + end), from, to);
    const ProvenStretch whole = stretchOf(from, anchor, to);
    const double gap = boxGap(pair_.other->geometry->mesh.bounds(), pair_.part->part->geometry->mesh.bounds(),
                              poseOf(anchor)) -
                       slackAt(anchor);
    // As much is left to rounding as by distances.
    if (kRoomTaken * (gap - separation_) >=
        std::max((whole.bound - separation_) / kTravelSlack, leastRoom())) {
      proven.push_back(whole);
    } else if (levels == 0 || !(anchor > from) || !(anchor < to)) {
      open.push_back({from, to, kNowhere});
    } else {
      byBoxes(from, anchor, levels - 1, proven, open);
      byBoxes(anchor, to, levels - 1, proven, open);
    }
  }

  const AssemblyPath& path_;
  const PathTravel& travel_;
  const MovingPair& pair_;
  double separation_;
};

void requireJudgeable(const Part& part) {
  const NormalConeTree& tree = part.geometry->tree();
  const std::size_t thin = tree.mesh().triangles().size() - tree.faces().size();
  if (thin == 0) return;
  throw UsageError(fmt::format("part \"{}\"", part.name),
                   fmt::format("{} of its triangles are too thin to measure distances to", thin),
                   "clean its mesh (nearfit-cli check --clean)");
}

/// Length beside which rounding is to be far smaller than the separation [m].
double reachOf(const PathBodies& bodies) {
  double reach = bodies.radius + glm::length(bodies.worldFromLead.translation);
  for (const Scene::PartPtr& other : bodies.others)
    reach = std::max(reach, glm::length(other->worldFromPart.translation) +
                                other->geometry->mesh.bounds().largestCoordinate());
  return reach;
}

}  // namespace

struct PathCertifier::Search {
  AssemblyPath frame;  ///< Parts and centre.
  PathBodies bodies;
  std::vector<MovingPair> pairs;
  double separation = 0.0;
  /// The traversal's stack is all that distances need.
  mutable WorkSpaces<LmdScratch> scratches{[] { return std::make_unique<LmdScratch>(1); }};

  /// Work on one pair along a path.
  struct PairWork {
    std::vector<OpenPiece> open;
    std::vector<ProvenStretch> proven;
    Grazing start;
  };
  /// A piece of a pair.
  struct Task {
    std::size_t pair = 0;
    OpenPiece piece;
    std::vector<ProvenStretch> proven;
    Grazing grazing;
  };

  std::vector<PathTravel> travels(const AssemblyPath& path) const {
    std::vector<PathTravel> all;
    all.reserve(bodies.moving.size());
    for (const PathPart& part : bodies.moving)
      all.emplace_back(path, part);
    return all;
  }
  PairAdvance advance(const AssemblyPath& path, const std::vector<PathTravel>& travels,
                      std::size_t pair) const {
    const auto part = static_cast<std::size_t>(pairs[pair].part - bodies.moving.data());
    return {path, travels[part], pairs[pair], separation};
  }

  PathProof prove(const AssemblyPath& path, const ProgressCallback& progress) const {
    constexpr double kBoxesDone = 0.1;
    const std::vector<PathTravel> travelOf = travels(path);
    std::vector<PairWork> work(pairs.size());
    std::atomic<double> limit{kNowhere};
    const ProgressCallback first = stageCallback(progress, 0.0, kBoxesDone);
    SharedProgress boxes(first, std::max(1.0, static_cast<double>(pairs.size())));
    parallelFor(pairs.size(), [&](std::size_t i) {
      const PairAdvance pair = advance(path, travelOf, i);
      pair.byBoxes(kBoxLevels, work[i].proven, work[i].open);
      work[i].start = pair.atStart();
      lowerTo(limit, work[i].start.place);
      boxes.add(1.0);
    });
    std::vector<Task> tasks;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (const OpenPiece& piece : work[i].open)
        tasks.push_back({i, piece, {}, {}});
    }
    const ProgressCallback second = stageCallback(progress, kBoxesDone, 1.0);
    SharedProgress distances(second, std::max(1.0, static_cast<double>(tasks.size())));
    parallelFor(tasks.size(), [&](std::size_t i) {
      Task& task = tasks[i];
      scratches.with([&](LmdScratch& scratch) {
        task.grazing = advance(path, travelOf, task.pair).byDistance(task.piece, scratch, limit, task.proven);
      });
      lowerTo(limit, task.grazing.place);
      distances.add(1.0);
    });
    return proofOf(path, work, tasks);
  }

  PathProof proofOf(const AssemblyPath& path, std::vector<PairWork>& work, std::vector<Task>& tasks) const {
    PathProof proof;
    proof.separation = separation;
    const auto consider = [&](std::size_t pair, const Grazing& grazing) {
      if (grazing.place == kNowhere || (proof.unproven && grazing.place >= proof.unproven->place)) return;
      proof.unproven = UnprovenPlace{grazing.place,
                                     timeAt(path, grazing.place),
                                     pairs[pair].part->part->id,
                                     pairs[pair].other->id,
                                     grazing.distance,
                                     grazing.isInside};
    };
    for (std::size_t i = 0; i < pairs.size(); ++i)
      consider(i, work[i].start);
    for (const Task& task : tasks)
      consider(task.pair, task.grazing);
    if (proof.unproven) return proof;
    for (Task& task : tasks)
      work[task.pair].proven.insert(work[task.pair].proven.end(), task.proven.begin(), task.proven.end());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      std::ranges::sort(work[i].proven, {}, &ProvenStretch::from);
      proof.pairs.push_back({pairs[i].part->part->id, pairs[i].other->id, std::move(work[i].proven)});
    }
    return proof;
  }

  bool isSegmentFree(const PathSegment& segment, LmdScratch& scratch, std::uint64_t maxDistances) const {
    AssemblyPath path{frame.parts, frame.centre, {{0.0, segment.from}, {1.0, segment.to}}};
    const std::vector<PathTravel> travelOf = travels(path);
    const std::atomic<double> limit{kNowhere};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const PairAdvance pair = advance(path, travelOf, i);
      PairWork work;
      // A distance tells more of a short motion than many boxes.
      pair.byBoxes(0, work.proven, work.open);
      for (const OpenPiece& piece : work.open) {
        const Grazing grazing =
            pair.byDistance(piece, scratch, limit, work.proven, PairAdvance::Wanted::Any, maxDistances);
        if (grazing.place != kNowhere) return false;
      }
    }
    return true;
  }
};

double defaultSeparation(const Scene& scene, const AssemblyPath& path) {
  // As for parts that touch: touchTolerance() in core/verdict/pair_separation.h.
  constexpr double kShare = 1e-6, kMax = 1e-6;
  double size = kNowhere;
  const PathBodies bodies = pathBodies(scene, path);
  for (const PathPart& moving : bodies.moving)
    size = std::min(size, moving.part->geometry->mesh.bounds().diagonal());
  return std::max(std::min(kShare * size, kMax), 2.0 * kLeastSeparation * reachOf(bodies));
}

PathCertifier::PathCertifier(const Scene& scene, const AssemblyPath& path, double separation,
                             const ProgressCallback& progress) {
  auto search = std::make_unique<Search>();
  search->frame.parts = path.parts;
  search->frame.centre = path.centre;
  search->bodies = pathBodies(scene, path);
  search->separation = separation;
  const double least = kLeastSeparation * reachOf(search->bodies);
  if (!(separation >= least) || !std::isfinite(separation) || !(separation > 0.0)) {
    throw UsageError("separation", fmt::format("{} m is not a separation that can be certified", separation),
                     fmt::format("give at least {:.1g} m", 2.0 * least));
  }
  std::vector<PartGeometryPtr> geometries;
  for (const PathPart& moving : search->bodies.moving)
    geometries.push_back(moving.part->geometry);
  for (const Scene::PartPtr& other : search->bodies.others)
    geometries.push_back(other->geometry);
  prepareHierarchies(geometries, progress);
  for (const PathPart& moving : search->bodies.moving)
    requireJudgeable(*moving.part);
  for (const Scene::PartPtr& other : search->bodies.others)
    requireJudgeable(*other);
  for (const PathPart& moving : search->bodies.moving) {
    for (const Scene::PartPtr& other : search->bodies.others)
      search->pairs.push_back({&moving, other.get()});
  }
  search_ = std::move(search);
}
PathCertifier::~PathCertifier() = default;
PathCertifier::PathCertifier(PathCertifier&&) noexcept = default;

PathProof PathCertifier::prove(const AssemblyPath& path, const ProgressCallback& progress) const {
  checkPath(path, "path");
  return search_->prove(path, progress);
}

std::vector<char> PathCertifier::freeSegments(std::span<const PathSegment> segments,
                                              const ProgressCallback& progress,
                                              std::uint64_t maxDistances) const {
  // A few at a time, so that threads seldom meet.
  constexpr std::size_t kBlock = 4;
  std::vector<char> isFree(segments.size(), 0);
  SharedProgress done(progress, std::max(1.0, static_cast<double>(segments.size())));
  parallelFor((segments.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    search_->scratches.with([&](LmdScratch& scratch) {
      const std::size_t end = std::min(segments.size(), (block + 1) * kBlock);
      for (std::size_t i = block * kBlock; i < end; ++i)
        isFree[i] = search_->isSegmentFree(segments[i], scratch, maxDistances) ? 1 : 0;
    });
    done.add(static_cast<double>(kBlock));
  });
  return isFree;
}

double PathCertifier::radius() const noexcept {
  return search_->bodies.radius;
}

}  // namespace nearfit
