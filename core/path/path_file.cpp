#include "core/path/path_file.h"

#include <array>
#include <cstddef>
#include <iterator>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/input_file.h"
#include "core/scene/part.h"
#include "core/text/json_file.h"
#include "core/text/json_text.h"

namespace nearfit {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kPathVersion = 1;
/// Numbers of a pose: time, position, quaternion.
constexpr std::size_t kPoseNumbers = 8;
/// Max number of parts that move: as many as a scene file holds.
constexpr std::size_t kMaxPathParts = 10'000;
/// Room for kMaxPathPoses poses of eight numbers of up to 25 digits, with names and brackets.
constexpr JsonLimits kPathLimits{.maxBytes = 128U << 20U, .maxDepth = 8, .maxValues = 6'000'000};

std::array<double, kPoseNumbers> numbersOf(const PathPose& pose) {
  const glm::dvec3& t = pose.worldFromLead.translation;
  const glm::dquat& q = pose.worldFromLead.rotation;
  return {pose.time, t.x, t.y, t.z, q.w, q.x, q.y, q.z};
}

PathPose poseOfJson(const JsonField& json) {
  json.requireSize(kPoseNumbers);
  std::array<double, kPoseNumbers> v{};
  for (std::size_t i = 0; i < kPoseNumbers; ++i)
    v[i] = json.at(i).number();
  return {v[0], {glm::dquat(v[4], v[5], v[6], v[7]), glm::dvec3(v[1], v[2], v[3])}};
}

}  // namespace

nlohmann::ordered_json pathJson(const AssemblyPath& path) {
  OrderedJson json;
  json["parts"] = path.parts;
  json["centre"] = {path.centre.x, path.centre.y, path.centre.z};
  OrderedJson poses = OrderedJson::array();
  for (const PathPose& pose : path.poses)
    poses.push_back(numbersOf(pose));
  json["poses"] = std::move(poses);
  return json;
}

AssemblyPath pathOfJson(const JsonField& json) {
  AssemblyPath path;
  const JsonField parts = json.at("parts"), centre = json.at("centre"), poses = json.at("poses");
  if (parts.size() > kMaxPathParts) parts.fail(fmt::format("it has more than {} elements", kMaxPathParts));
  if (poses.size() > kMaxPathPoses) poses.fail(fmt::format("it has more than {} elements", kMaxPathPoses));
  for (std::size_t i = 0; i < parts.size(); ++i)
    path.parts.push_back(parts.at(i).text(kMaxPartNameBytes));
  centre.requireSize(3);
  path.centre = {centre.at(0).number(), centre.at(1).number(), centre.at(2).number()};
  path.poses.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    path.poses.push_back(poseOfJson(poses.at(i)));
  try {
    checkPath(path, "path");
  } catch (const UsageError& e) {
    json.fail(e.problem(), e.remedy());
  }
  return path;
}

std::string pathFileText(const AssemblyPath& path) {
  OrderedJson json;
  json["path"] = kPathVersion;
  json["program"] = "Nearfit " NEARFIT_VERSION;
  json.update(pathJson(path));
  return prettyJson(json);
}

void writePathFile(const AssemblyPath& path, const std::filesystem::path& file) {
  atomicWrite(file, pathFileText(path));
}

AssemblyPath readPathFile(const std::filesystem::path& file) {
  const nlohmann::json json = readJsonFile(file, kPathLimits);
  const JsonField root(json, file);
  if (root.at("path").number() != kPathVersion)
    root.at("path").fail("this version of path files is not known", "use a newer Nearfit");
  return pathOfJson(root);
}

bool isJsonFile(const std::filesystem::path& file) {
  std::array<char, 256> begin{};
  InputFile input(file);
  const std::size_t count = input.read(begin);
  for (const char c : std::span(begin).first(count)) {
    if (c != ' ' && c != '\t' && c != '\n' && c != '\r') return c == '{';
  }
  return false;
}

std::string pathCsv(const AssemblyPath& path) {
  std::string text = "t_s,tx,ty,tz,qw,qx,qy,qz\n";
  for (const PathPose& pose : path.poses) {
    const auto numbers = numbersOf(pose);
    fmt::format_to(std::back_inserter(text), "{}", numbers[0]);
    for (std::size_t i = 1; i < numbers.size(); ++i)
      fmt::format_to(std::back_inserter(text), ",{}", numbers[i]);
    text += '\n';
  }
  return text;
}

}  // namespace nearfit
