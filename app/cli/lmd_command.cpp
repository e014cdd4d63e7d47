#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/document_options.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/haptics/spring_law.h"
#include "core/math/finite.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/tracking/lmd_set.h"
#include "core/report/clearance.h"
#include "core/scene/document_load.h"
#include "core/scene/part_geometry.h"
#include "device/simulated/simulated_device.h"

namespace nearfit::cli {
namespace {

/// Limit of minima per pose; bounds memory at some gigabytes.
constexpr std::size_t kMaxLmds = 4'000'000;

struct LmdOptions {
  std::string sceneMesh, partMesh, pose, poses, law = "linear", mode = "cold", rule = "exact", unit;
  SpringParameters springs;
  TessellationOptions tessellation;
};

std::string numberText(double value) {
  return fmt::format("{:.17g}", value);
}

std::string vectorText(const glm::dvec3& v) {
  return fmt::format("[{:.17g},{:.17g},{:.17g}]", v.x, v.y, v.z);
}

std::string extentText(const RegionExtent& extent) {
  return fmt::format(R"({{"dimension":{},"measure":{},"axis":{},"half":[{},{}]}})", extent.dimension,
                     numberText(extent.measure), vectorText(extent.axis), numberText(extent.halfLength),
                     numberText(extent.halfWidth));
}

/// @param tellsMerged  Minima of an area of contact have been merged.
std::string lmdText(const Lmd& lmd, bool tellsMerged) {
  const std::string extent = lmd.isRegion ? ",\"extent\":" + extentText(lmd.extent) : "";
  const std::string merged = tellsMerged ? fmt::format(",\"merged\":{}", lmd.isMerged) : "";
  return fmt::format(
      R"({{"distance":{},"scene":{},"part":{},"features":["{}","{}"],"region":{}{},"blocked":{},"marginal":{}{}}})",
      numberText(lmd.distance), vectorText(lmd.scenePoint), vectorText(lmd.partPoint),
      nameOf(lmd.sceneFeature), nameOf(lmd.partFeature), lmd.isRegion, extent, lmd.isBlocked, lmd.isMarginal,
      merged);
}

/// Returns the output line of a pose. Throws Error if minima were left out or the wrench is not finite.
std::string poseLine(std::size_t pose, const LmdSet& set, const Wrench& wrench, InterferenceKind overlap,
                     bool tellsMerged) {
  const std::string where = fmt::format("pose {}", pose);
  if (!set.isComplete) {
    throw Error(where, fmt::format("there are more than {} minima within the cutoff", kMaxLmds),
                "give a smaller cutoff");
  }
  if (!isFinite(wrench.force) || !isFinite(wrench.torque)) {
    throw Error(where, "the force is too large for a number", "give a smaller stiffness");
  }
  std::string text = fmt::format(R"({{"pose":{},"lmds":[)", pose);
  for (std::size_t i = 0; i < set.lmds.size(); ++i)
    text += (i == 0 ? "" : ",") + lmdText(set.lmds[i], tellsMerged);
  return text + fmt::format("],\"force\":{},\"torque\":{},\"overlap\":\"{}\",\"query_us\":{}}}\n",
                            vectorText(wrench.force), vectorText(wrench.torque), nameOf(overlap),
                            numberText(1e6 * set.queryTime));
}

/// Tells of poses at which the bodies overlap: the set may be empty there.
std::string overlapNote(const std::vector<std::size_t>& overlapping, std::size_t poses) {
  const std::string where = poses == 1 ? std::string()
                                       : fmt::format(" at {} of {} poses, the first of them pose {}",
                                                     overlapping.size(), poses, overlapping.front());
  return fmt::format("note: the bodies overlap{}; minima do not tell how far", where);
}

SpringParameters springsOf(const LmdOptions& options) {
  SpringParameters springs = options.springs;
  checkPositive("--cutoff", springs.cutoff);
  checkPositive("--stiffness", springs.stiffness, true);
  springs.law = options.law == "printed" ? SpringLaw::Printed : SpringLaw::Linear;
  return springs;
}

/// Loads scene and part with their hierarchies; both are the same one if the files are.
std::pair<PartGeometryPtr, PartGeometryPtr> loadBodies(const LmdOptions& options) {
  const FileArgument scene = fileArgumentOf(options.sceneMesh), part = fileArgumentOf(options.partMesh);
  const double metresPerUnit = unitOfFiles(options.unit, std::array{scene.file, part.file});
  const Tessellation tessellation = tessellationOf(options.tessellation);
  std::vector<MeshSource> sources{
      {scene.file, unitToOpen(scene.file, metresPerUnit), {}, scene.shape, tessellation}};
  if (normalisedPath(part.file) != normalisedPath(scene.file) || part.shape != scene.shape)
    sources.push_back({part.file, unitToOpen(part.file, metresPerUnit), {}, part.shape, tessellation});
  std::vector<PartGeometryPtr> bodies;
  for (const LoadedPart& loaded : loadPartGeometries(sources)) {
    if (loaded.problem) std::rethrow_exception(loaded.problem);
    bodies.push_back(loaded.geometry);
  }
  if (options.rule == "exact") prepareHierarchies(bodies);
  return {bodies.front(), bodies.back()};
}

/// The hierarchies to search, built by the chosen rule.
class Hierarchies {
 public:
  Hierarchies(const LmdOptions& options, PartGeometryPtr scene, PartGeometryPtr part)
      : scene_(std::move(scene)), part_(std::move(part)) {
    if (options.rule == "exact") return;
    approximateScene_.emplace(scene_->mesh, ProgressCallback{}, AcceptanceRule::NormalSpan);
    if (part_ != scene_)
      approximatePart_.emplace(part_->mesh, ProgressCallback{}, AcceptanceRule::NormalSpan);
  }

  const NormalConeTree& scene() const { return approximateScene_ ? *approximateScene_ : scene_->tree(); }
  const NormalConeTree& part() const {
    if (part_ == scene_) return scene();
    return approximatePart_ ? *approximatePart_ : part_->tree();
  }

 private:
  PartGeometryPtr scene_, part_;
  std::optional<NormalConeTree> approximateScene_, approximatePart_;
};

void runLmd(const LmdOptions& options) {
  const SpringParameters springs = springsOf(options);
  const std::vector<RigidTransform> poses =
      options.poses.empty() ? std::vector{parsePose("--pose", options.pose)} : readPosePath(options.poses);
  const auto [scene, part] = loadBodies(options);
  const Hierarchies trees(options, scene, part);
  // Only once nothing but the output can fail, so that a failure is one line.
  printCacheWarnings();
  printWarnings(*scene);
  if (part != scene) printWarnings(*part);
  LmdCollector collector(kMaxLmds);
  std::vector<std::size_t> overlapping;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    LmdSet set = options.mode == "tracked"
                     ? collector.collectTracked(trees.scene(), trees.part(), poses[i], springs.cutoff)
                     : collector.collect(trees.scene(), trees.part(), poses[i], springs.cutoff);
    if (springs.onePerArea) collector.mergeByArea(trees.scene(), trees.part(), poses[i], springs.cutoff, set);
    const glm::dvec3 centre = poses[i].applyToPoint(part->mass.centre);
    const InterferenceKind overlap = findInterference(trees.scene(), trees.part(), poses[i]).kind;
    if (overlap != InterferenceKind::Disjoint) overlapping.push_back(i);
    print(poseLine(i, set, springWrench(set.lmds, springs, centre, {}), overlap, springs.onePerArea));
  }
  if (!overlapping.empty()) printError(overlapNote(overlapping, poses.size()));
}

// clang-format off
constexpr const char* kLmdFooter =
    R"(Prints one JSON object per pose, each on its own line:
  {"pose":0,"lmds":[{"distance":d,"scene":[x,y,z],"part":[x,y,z],"features":["vertex","face"],
   "region":false,"blocked":false,"marginal":false}],"force":[x,y,z],"torque":[x,y,z],
   "overlap":"no","query_us":t}
lmds      All local minimum distances within the cutoff, nearest first. "scene" and "part": the two
          points, both in the scene mesh's frame [m]. "features": what carries them (vertex, edge, face),
          the scene's first. "region": true if the pair stands for a flat set of equal minima (faces or
          edges parallel to within a microradian); its points are then at the centroid of the set, which
          may lie outside it, as that of a ring does. "blocked": true if the segment between the points
          passes through either surface. "marginal": true if rounding decides a condition or the cutoff,
          so that double precision cannot tell whether the pair is a minimum, or whether a neighbouring
          feature carries it; and for a region more than 10,000 sizes from the origin, whose extent may
          be wrong.
          A region also has "extent":{"dimension":2,"measure":m,"axis":[x,y,z],"half":[a,b]}. A region
          between faces has dimension 2 and its area [m^2]; one of an edge with an edge or face has
          dimension 1 and its length [m]. "half": half lengths [m], along the axis and across it, of the
          rectangle with the same second moments of area.
          With --one-per-area each minimum also has "merged": true if a nearer one stands for its area of
          contact: their directions differ by at most 30 degrees, and at a quarter, half and three quarters
          of the way between them either surface is at most a twentieth of the cutoff farther off than at the
          farther one.
force     Sum of the spring forces on the part [N], without those of blocked and merged minima, in the scene mesh's
          frame; torque [N m] about the part's centre of mass. Nothing moves, so damping has no effect.
overlap   How the bodies overlap, decided exactly: "no", "surfaces meet" (or touch), "inside the other" (the
          part in the scene mesh), "the other inside". Minima do not tell how far; the set may be empty. A
          note on stderr says at how many poses they overlap.
query_us  Time of the query alone [us]; with --mode tracked, without the search ahead, which the servo
          leaves to another thread.
--rule    normal-span accepts a pair if the segment between its points lies in the span of the surface
          normals at both, as in Johnson and Willemsen (2003). On convex vertices, edges and faces that
          is exact. At saddles and jagged vertices it adds pairs that are not minima: a neighbouring face
          is nearer. On closed meshes it misses none; on open ones it misses minima at rims. Its
          hierarchies are built again in each run.
A pose maps from the part's frame to the scene's: p_scene = R(q) p_part + t. The cutoff and translations
are in metres, whatever the unit of the meshes. A shape of a CAD document is in its own frame, wherever
the document places it. Quaternions are normalised; one whose length is off by
more than 0.001 is refused.
Example: nearfit-cli lmd --unit mm hole.stl peg.stl --cutoff 0.002 --pose 0,0,0.01,1,0,0,0)";
// clang-format on

}  // namespace

void addLmdCommand(CLI::App& program) {
  const auto options = std::make_shared<LmdOptions>();
  CLI::App* command = program.add_subcommand(
      "lmd", "Finds all local minimum distances between two meshes at one or more poses, and their force.");
  command
      ->add_option(
          "scene_mesh", options->sceneMesh,
          "Mesh at rest: STL, OBJ, PLY, OFF, or a CAD document; FILE#KEY names one of several shapes of that")
      ->required()
      ->type_name("FILE");
  command->add_option("part_mesh", options->partMesh, "Mesh of the part that is put at each pose")
      ->required()
      ->type_name("FILE");
  command->add_option("--cutoff", options->springs.cutoff, "Largest distance to look for [m]")
      ->required()
      ->type_name("METRES");
  CLI::Option_group* where = command->add_option_group("Poses");
  where->add_option("--pose", options->pose, kPoseHelp)->type_name("POSE");
  where
      ->add_option(
          "--poses", options->poses,
          "CSV file of poses, one per row; lines that start with # are comments, a header is allowed")
      ->type_name("FILE");
  where->require_option(1);
  command
      ->add_option("--stiffness", options->springs.stiffness,
                   "Stiffness of each spring [N/m], or [N/m^2] with the printed law")
      ->capture_default_str()
      ->type_name("K");
  command
      ->add_option("--law", options->law,
                   "Force of a minimum at distance d: linear is K (cutoff - d); printed, as in the paper, is "
                   "K (cutoff - d) d")
      ->check(CLI::IsMember({"linear", "printed"}))
      ->capture_default_str();
  command->add_flag("--one-per-area", options->springs.onePerArea,
                    "One spring for each area of contact, at its nearest minimum (see \"merged\" below)");
  command
      ->add_option("--mode", options->mode,
                   "cold searches each pose from scratch; tracked follows the part from pose to pose, as the "
                   "servo does. Both find the same minima")
      ->check(CLI::IsMember({"cold", "tracked"}))
      ->capture_default_str();
  command
      ->add_option("--rule", options->rule,
                   "When a pair counts as a minimum: exact is the definition; normal-span is the rule of the "
                   "paper, approximate, for comparison (see below)")
      ->check(CLI::IsMember({"exact", "normal-span"}))
      ->capture_default_str();
  command->add_option("--unit", options->unit, kFileUnitHelp);
  addTessellationOptions(*command, options->tessellation);
  command->footer(kLmdFooter);
  command->callback([options] { runLmd(*options); });
}

}  // namespace nearfit::cli
