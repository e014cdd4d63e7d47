#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "tests/bench/bench_scene.h"
#include "tests/bench/paper_hierarchy.h"

/// The rows of Appendix A of Johnson and Willemsen (2003), on meshes of the same counts of triangles.
///
/// The paper's meshes, poses and cutoffs are not published; its counts of triangles and LMDs, its rates and its
/// pictures are. So a row here has its counts of triangles, and a pose at which the paper's own rule, read
/// strictly (PaperRule::NormalSpans), gives its count of LMDs: see searchPose(). A pair of scans, of which the paper
/// prints nothing, is judged beside them.
namespace nearfit::bench {

struct PaperRow {
  /// Figures that the paper prints for a row.
  struct Printed {
    std::size_t minima;  ///< "# of LMDs".
    double rate;         ///< "Rate (Hz)".
  };

  std::string name;           ///< A letter of the appendix, or "scan".
  std::string scene;          ///< Name of a scene of sharedScenes().
  std::string configuration;  ///< What of it: "near a gap".
  std::size_t partTriangles, sceneTriangles;
  std::optional<Printed> printed;  ///< None for the scans.
  double cutoffFraction;           ///< Of the larger body's diagonal.

  /// Where poses are searched: a box for the middle of the part's bounding box, in the scene's frame, where the
  /// larger body's diagonal is 1; and how far the part may be turned from how its file has it [rad].
  glm::dvec3 regionCentre, regionHalf;
  double maxTurn;
  RigidTransform pose;  ///< sceneFromPart: what searchPose() found.
};

/// Rows a to f.
const std::array<PaperRow, 6>& paperRows();

/// The pair of scans: bunny and armadillo.
const PaperRow& scanRow();

/// The meshes of a row, its pose as the start. @param folder  Of shared models. Throws FileError.
BenchScene paperScene(const PaperRow& row, const std::filesystem::path& folder);

/// The first of up to kMaxPoses random poses in a row's region, in the order that kPoseSeed gives, at which
/// PaperRule::NormalSpans gives as many minima as the paper prints, or any for the scans, no two triangles meet, and the
/// bodies are farther apart than kMinGap. None if no pose has that.
std::optional<RigidTransform> searchPose(const PaperRow& row, const BenchScene& meshes);

constexpr std::uint64_t kPoseSeed = 2003;
constexpr std::size_t kMaxPoses = 20'000;
/// Of the cutoff: a hand can move there.
constexpr double kMinGap = 0.1;

}  // namespace nearfit::bench
