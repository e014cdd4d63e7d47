#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "tests/bench/bench_scene.h"

namespace nearfit::bench {

/// Minima that a query may return: more than any scene here has.
constexpr std::size_t kQueryCapacity = 65536;
/// The cutoff unless something else is asked for, of the larger body's diagonal.
constexpr double kUsualCutoffFraction = 0.05;

/// Hierarchy of a mesh as Nearfit builds it for a part: with its flats merged.
NormalConeTree searchedTree(const TriangleMesh& mesh);

/// A scene with Nearfit's hierarchies, and the cutoff [m].
struct PreparedScene {
  explicit PreparedScene(BenchScene bodies, double cutoffFraction);

  BenchScene meshes;
  NormalConeTree sceneTree, partTree;
  double size, cutoff;
};

/// What a method says of a pose.
struct Answer {
  double distance = 0.0;  ///< Least distance [m]; infinity when nothing is within the cutoff.
  std::size_t count = 0;  ///< Minima or pairs; 1 for a distance alone.
  bool isComplete = true;
};

enum class AnswerKind {
  FullSet,   ///< All local minimum distances within the cutoff.
  Distance,  ///< The least distance alone, at any distance.
  Pairs,     ///< All pairs of triangles within the cutoff.
  /// Minima by another rule than the exact one. Takes as long as pairs; its number is compared with nobody's.
  OtherRule,
};

/// True for methods that take up to seconds a pose: left out unless asked for, and asked at few poses.
inline bool isSlow(AnswerKind kind) noexcept {
  return kind == AnswerKind::Pairs || kind == AnswerKind::OtherRule;
}

/// One way to answer; keeps what it knows from one pose to the next.
class QueryMethod {
 public:
  QueryMethod() = default;
  virtual ~QueryMethod() = default;
  QueryMethod(const QueryMethod&) = delete;
  QueryMethod& operator=(const QueryMethod&) = delete;

  /// This call is what is timed. Poses come in the order of the path, with a jump now and then.
  virtual Answer query(const RigidTransform& sceneFromPart) = 0;

  /// What another thread does between two ticks; not timed. Comes after each query.
  virtual void workAside(const RigidTransform&) {}
  /// What to say of that work under the table; empty for nothing.
  virtual std::string remark() const { return {}; }
};

/// A row of the table of methods. To add a method, add a row to one of the functions below.
struct MethodEntry {
  std::string name;
  AnswerKind kind;
  std::string description;
  /// How far its distance may be from the reference, as a fraction of the scene's size.
  double tolerance;
  std::function<std::unique_ptr<QueryMethod>(const PreparedScene&)> make;
};

std::vector<MethodEntry> nearfitMethods();
std::vector<MethodEntry> paperMethods();  ///< The paper's algorithm: paper_hierarchy.h.
std::vector<MethodEntry> fclMethods();    ///< Where the program is built with FCL.
std::vector<MethodEntry> coalMethods();   ///< Where the program is built with Coal.

/// All that this program is built with, Nearfit's first.
std::vector<MethodEntry> allMethods();

struct BuiltHierarchy {
  std::shared_ptr<const void> keep;
  std::size_t bytes;  ///< That it holds, a copy of the mesh included where it keeps one.
};

/// One way to build a hierarchy, or to have one without building it.
struct BuildEntry {
  std::string name;
  /// The call to this is what is timed.
  std::function<BuiltHierarchy(const TriangleMesh&)> build;
  /// Instead, where something must be there before: makes it, and returns what is timed.
  std::function<std::function<BuiltHierarchy()>(const TriangleMesh&)> prepare = {};
};

std::vector<BuildEntry> nearfitBuilds();
std::vector<BuildEntry> nearfitCacheUses();
std::vector<BuildEntry> fclBuilds();
std::vector<BuildEntry> coalBuilds();
std::vector<BuildEntry> allBuilds();

/// "FCL 0.7.0, Coal 3.0.3" or "not built with FCL", ...
std::string peerDescription();

}  // namespace nearfit::bench
