#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/joint.h"
#include "core/scene/pair_record.h"
#include "core/scene/pair_rule.h"
#include "core/scene/part.h"
#include "core/text/json_file.h"

/// Pieces of scenes as JSON, for scene files (format: scene_file.h) and scripts. Readers throw FileError naming the
/// field that is missing or invalid.
namespace nearfit {

/// Max length of a mesh path [bytes]: Linux's limit.
constexpr std::size_t kMaxPathBytes = 4095;

/// Path of a mesh relative to the folder of a file, with `/` between names. Throws FileError if it is not UTF-8.
std::string meshPathFrom(const std::filesystem::path& mesh, const std::filesystem::path& file);
/// The mesh at a path that meshPathFrom() gave, or an absolute one.
/// @param folder  As meshFolder() returns it.
std::filesystem::path readMeshPath(const JsonField& field, const std::filesystem::path& folder);

nlohmann::ordered_json repairsJson(const MeshRepairs& repairs);
MeshRepairs readRepairs(const JsonField& field);

/// Which shape of a CAD document, and the tessellation that was asked for; null for a mesh file.
nlohmann::ordered_json shapeJson(const PartGeometry& geometry);
struct ShapeOfFile {
  std::string key;  ///< Empty for a mesh file.
  Tessellation tessellation = {};
};
/// @param mesh  The file, which must be a CAD document if there is a shape.
ShapeOfFile readShape(const JsonField& field, const std::filesystem::path& mesh);

/// Three channels, sRGB.
nlohmann::ordered_json colourJson(const Colour& colour);
Colour readColour(const JsonField& field);

/// Adds the keys "position" [m] and "quaternion" (w x y z) to an object.
void addPose(nlohmann::ordered_json& json, const RigidTransform& pose);
/// @param field  An object with these keys.
RigidTransform readPose(const JsonField& field);
/// Three coordinates, or null.
nlohmann::ordered_json pivotJson(const std::optional<glm::dvec3>& pivot);
std::optional<glm::dvec3> readPivot(const JsonField& field);

nlohmann::ordered_json jointFeatureJson(const JointFeature& feature, JointKind kind);
JointKind readJointKind(const JsonField& field);
JointFeature readJointFeature(const JsonField& field, JointKind kind);

nlohmann::ordered_json pairRulesJson(const std::vector<PairRule>& rules);
std::vector<PairRule> readPairRules(const JsonField& field);

/// Adds what a record says about its pair to an object that names the pair.
void addFinding(nlohmann::ordered_json& json, const PairRecord& record);
/// Record of which the pair is not set.
PairRecord readFinding(const JsonField& field);
FindingState readFindingState(const JsonField& field);

/// Runs `check` and turns its UsageError into an error of the field.
template <typename Check>
auto checkedAt(const JsonField& field, Check check) {
  try {
    return check();
  } catch (const UsageError& e) {
    field.fail(e.problem(), e.remedy());
  }
}

/// Finite numbers; throws FileError unless there are as many.
template <std::size_t Count>
std::array<double, Count> readNumbers(const JsonField& field) {
  field.requireSize(Count);
  std::array<double, Count> values{};
  for (std::size_t i = 0; i < Count; ++i)
    values[i] = field.at(i).number();
  return values;
}

}  // namespace nearfit
