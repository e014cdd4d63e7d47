#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/bench_clock.h"
#include "tests/bench/error_method.h"
#include "tests/bench/paper_figures.h"
#include "tests/bench/paper_rows.h"
#include "tests/bench/query_method.h"

/// Times and counts of the paper's appendix, and the sweeps of what the paper says that they depend on.
namespace nearfit::bench {

struct PaperRunOptions {
  std::size_t poses = 2000;      ///< Of a hand's path.
  std::size_t sweepPoses = 400;  ///< Of the path at each setting of a sweep.
  std::size_t slowStride = 40;   ///< Slow methods (isSlow) answer each so-many-th pose.
  std::size_t block = 100;       ///< Poses that a method answers before the next has its turn.
  std::uint64_t seed = 1;        ///< Of paths.
  BenchClock clock = BenchClock::Thread;
};

/// Whose answers are judged against exact arithmetic, and whose loops are timed: exact sets, one spring for each area of
/// contact, both readings of the paper, and the nearest pair alone if there is FCL.
std::vector<ErrorMethodEntry> judgedMethods();

/// A hand's path that begins at a row's pose and stays near it, within its configuration.
std::vector<RigidTransform> pathOfRow(const PreparedScene& scene, std::size_t poses, std::uint64_t seed);

/// A row of the appendix: minima at its pose by each rule beside the paper's count, time of each query and of the
/// whole loop beside the paper's rate, time to build.
std::vector<PaperFigure> appendixFigures(const PaperRow& row, BenchScene meshes,
                                         const PaperRunOptions& options);

/// Times of the judged methods on a hand's path, as appendixFigures() has them, for a pair that the appendix has not.
std::vector<PaperFigure> judgedTimes(const PaperRow& row, BenchScene meshes, const PaperRunOptions& options);

/// Cutoffs of the sweep, as fractions of the larger body's diagonal.
std::span<const double> sweptCutoffs();
/// Times and counts on one path at each cutoff. The path keeps the bodies near by the smallest.
std::vector<PaperFigure> cutoffFigures(const PaperRow& row, const BenchScene& meshes,
                                       const PaperRunOptions& options);

/// Bodies whose triangles are swept.
struct SweptBody {
  std::string name;
  /// @param triangles  Wanted of both meshes together; the nearest that the shape can have.
  BenchScene (*make)(std::size_t triangles);
};
std::span<const SweptBody> sweptBodies();
/// Triangles of both meshes, 512 to a million.
std::span<const std::size_t> sweptTriangles();
/// @param maxPaperTriangles  Beyond so many the paper's algorithm is not asked: a pose takes it seconds.
std::vector<PaperFigure> trianglesFigures(const SweptBody& body, std::size_t triangles,
                                          std::size_t maxPaperTriangles, const PaperRunOptions& options);

}  // namespace nearfit::bench
