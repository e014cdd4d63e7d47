#include "core/path/path_animation.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/path/path_bodies.h"
#include "core/report/gltf_format.h"

namespace nearfit {
namespace {

static_assert(std::endian::native == std::endian::little, "binary files are written as memory has them");

using GltfJson = nlohmann::ordered_json;

GltfJson vectorJson(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
GltfJson rotationJson(const glm::dquat& q) {
  return {q.x, q.y, q.z, q.w};
}

/// An array of one element.
GltfJson only(GltfJson element) {
  GltfJson array = GltfJson::array();
  array.push_back(std::move(element));
  return array;
}

/// Builds the JSON and the buffer of one file.
class GlbBuilder {
 public:
  GlbBuilder(const AssemblyPath& path, const PathBodies& bodies) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Nearfit " NEARFIT_VERSION}};
    json_["scene"] = 0;
    json_["scenes"] = only({{"nodes", GltfJson::array({0})}});
    // The first node turns z up to y up.
    const double half = std::sqrt(0.5);
    nodes_.push_back(
        {{"name", "Nearfit"}, {"rotation", {-half, 0.0, 0.0, half}}, {"children", GltfJson::array()}});
    const std::size_t moved = addNode(0, {{"name", "Path of " + path.parts.front()}});
    nodes_[moved]["translation"] = vectorJson(path.poses.front().worldFromLead.applyToPoint(path.centre));
    nodes_[moved]["rotation"] = rotationJson(path.poses.front().worldFromLead.rotation);
    for (const PathPart& part : bodies.moving) {
      addPart(moved, *part.part, {part.leadFromPart.rotation, part.leadFromPart.translation - path.centre});
    }
    for (const Scene::PartPtr& part : bodies.others)
      addPart(0, *part, part->worldFromPart);
    addAnimation(moved, path);
  }

  std::string take() {
    json_["nodes"] = std::move(nodes_);
    json_["meshes"] = std::move(meshes_);
    json_["materials"] = std::move(materials_);
    json_["accessors"] = std::move(accessors_);
    json_["bufferViews"] = std::move(views_);
    json_["buffers"] = only({{"byteLength", data_.size()}});
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + data_.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
      throw UsageError("glTF", "the scene is too large for one file of 4 GiB",
                       "hide parts that are not needed");
    std::string file;
    file.reserve(total);
    for (const std::uint32_t word : {gltf::kGlbMagic, gltf::kGlbVersion, static_cast<std::uint32_t>(total),
                                     static_cast<std::uint32_t>(text.size()), gltf::kJsonChunk})
      appendWord(file, word);
    file += text;
    appendWord(file, static_cast<std::uint32_t>(data_.size()));
    appendWord(file, gltf::kBinaryChunk);
    return file + data_;
  }

 private:
  /// Where a geometry's accessors are.
  struct Shape {
    std::size_t positions = 0, indices = 0;
  };

  static void appendWord(std::string& text, std::uint32_t word) {
    std::array<char, 4> bytes{};
    std::memcpy(bytes.data(), &word, bytes.size());
    text.append(bytes.data(), bytes.size());
  }
  void append(float value) { appendWord(data_, std::bit_cast<std::uint32_t>(value)); }

  std::size_t addNode(std::size_t parent, GltfJson node) {
    nodes_.push_back(std::move(node));
    nodes_[parent]["children"].push_back(nodes_.size() - 1);
    return nodes_.size() - 1;
  }

  void addPart(std::size_t parent, const Part& part, const RigidTransform& parentFromPart) {
    const glm::dvec3 middle = part.geometry->mesh.bounds().centre();
    const std::size_t node = addNode(parent, {{"name", part.name}, {"mesh", meshOf(part)}});
    nodes_[node]["translation"] = vectorJson(parentFromPart.applyToPoint(middle));
    nodes_[node]["rotation"] = rotationJson(parentFromPart.rotation);
  }

  /// A mesh has its material, so that parts of other colours have meshes of their own around the same numbers.
  std::size_t meshOf(const Part& part) {
    const auto key = std::make_tuple(part.geometry.get(), part.colour.r, part.colour.g, part.colour.b,
                                     static_cast<float>(part.opacity));
    const auto known = meshOf_.find(key);
    if (known != meshOf_.end()) return known->second;
    const Shape shape = shapeOf(*part.geometry);
    GltfJson material = {{"pbrMetallicRoughness",
                          {{"baseColorFactor",
                            {gltf::linearOf(part.colour.r), gltf::linearOf(part.colour.g),
                             gltf::linearOf(part.colour.b), part.opacity}},
                           {"metallicFactor", 0.1},
                           {"roughnessFactor", 0.6}}},
                         {"doubleSided", true}};
    if (part.opacity < 1.0) material["alphaMode"] = "BLEND";
    materials_.push_back(std::move(material));
    GltfJson primitive;
    primitive["attributes"] = {{"POSITION", shape.positions}};
    primitive["indices"] = shape.indices;
    primitive["material"] = materials_.size() - 1;
    GltfJson mesh;
    mesh["name"] = part.name;
    mesh["primitives"] = only(std::move(primitive));
    meshes_.push_back(std::move(mesh));
    return meshOf_[key] = meshes_.size() - 1;
  }

  Shape shapeOf(const PartGeometry& geometry) {
    const auto known = shapeOf_.find(&geometry);
    if (known != shapeOf_.end()) return known->second;
    const TriangleMesh& mesh = geometry.mesh;
    const glm::dvec3 middle = mesh.bounds().centre();
    Aabb box;
    const std::size_t positions = data_.size();
    for (const glm::dvec3& vertex : mesh.vertices()) {
      const glm::vec3 p(vertex - middle);
      for (glm::length_t i = 0; i < 3; ++i)
        append(p[i]);
      box.add(glm::dvec3(p));
    }
    const std::size_t ends = data_.size();
    for (const Triangle& triangle : mesh.triangles()) {
      for (const std::uint32_t index : triangle)
        appendWord(data_, index);
    }
    Shape shape;
    shape.positions =
        addAccessor({positions, ends, gltf::kArrayTarget}, gltf::kFloatType, mesh.vertices().size(), "VEC3");
    // They must be those of the numbers in the buffer.
    accessors_.back()["min"] = vectorJson(box.lower);
    accessors_.back()["max"] = vectorJson(box.upper);
    shape.indices = addAccessor({ends, data_.size(), gltf::kIndexTarget}, gltf::kUint32Type,
                                3 * mesh.triangles().size(), "SCALAR");
    return shapeOf_[&geometry] = shape;
  }

  void addAnimation(std::size_t node, const AssemblyPath& path) {
    const double start = path.poses.front().time;
    std::vector<const PathPose*> kept;
    std::vector<float> times;
    for (const PathPose& pose : path.poses) {
      const auto time = static_cast<float>(pose.time - start);
      if (times.empty() || time > times.back()) {
        times.push_back(time);
        kept.push_back(&pose);
      } else {
        kept.back() = &pose;
      }
    }
    const std::size_t begin = data_.size();
    for (const float time : times)
      append(time);
    const std::size_t afterTimes = data_.size();
    for (const PathPose* pose : kept) {
      const glm::vec3 at(pose->worldFromLead.applyToPoint(path.centre));
      for (glm::length_t i = 0; i < 3; ++i)
        append(at[i]);
    }
    const std::size_t afterShifts = data_.size();
    glm::dquat last = kept.front()->worldFromLead.rotation;
    for (const PathPose* pose : kept) {
      glm::dquat q = pose->worldFromLead.rotation;
      // Some viewers take the longer way between quaternions of opposite sense.
      if (glm::dot(q, last) < 0.0) q = -q;
      last = q;
      for (const double value : {q.x, q.y, q.z, q.w})
        append(static_cast<float>(value));
    }
    const std::size_t input = addAccessor({begin, afterTimes, 0}, gltf::kFloatType, times.size(), "SCALAR");
    accessors_.back()["min"] = GltfJson::array({static_cast<double>(times.front())});
    accessors_.back()["max"] = GltfJson::array({static_cast<double>(times.back())});
    const std::size_t shifts =
        addAccessor({afterTimes, afterShifts, 0}, gltf::kFloatType, times.size(), "VEC3");
    const std::size_t turns =
        addAccessor({afterShifts, data_.size(), 0}, gltf::kFloatType, times.size(), "VEC4");
    GltfJson samplers = GltfJson::array(), channels = GltfJson::array();
    for (const auto& [output, what] : {std::pair(shifts, "translation"), std::pair(turns, "rotation")}) {
      GltfJson sampler;
      sampler["input"] = input;
      sampler["output"] = output;
      sampler["interpolation"] = "LINEAR";
      GltfJson target;
      target["node"] = node;
      target["path"] = what;
      GltfJson channel;
      channel["sampler"] = samplers.size();
      channel["target"] = std::move(target);
      samplers.push_back(std::move(sampler));
      channels.push_back(std::move(channel));
    }
    GltfJson animation;
    animation["name"] = "Path";
    animation["samplers"] = std::move(samplers);
    animation["channels"] = std::move(channels);
    json_["animations"] = only(std::move(animation));
  }

  struct Bytes {
    std::size_t begin, end;
    int target;  ///< 0: none.
  };

  std::size_t addAccessor(const Bytes& bytes, int type, std::size_t count, const char* shape) {
    GltfJson view;
    view["buffer"] = 0;
    view["byteOffset"] = bytes.begin;
    view["byteLength"] = bytes.end - bytes.begin;
    if (bytes.target != 0) view["target"] = bytes.target;
    views_.push_back(std::move(view));
    GltfJson accessor;
    accessor["bufferView"] = views_.size() - 1;
    accessor["componentType"] = type;
    accessor["count"] = count;
    accessor["type"] = shape;
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }

  GltfJson json_, nodes_ = GltfJson::array(), meshes_ = GltfJson::array(), materials_ = GltfJson::array(),
                  accessors_ = GltfJson::array(), views_ = GltfJson::array();
  std::string data_;  ///< Whole words, so that everything in it is aligned.
  std::map<const PartGeometry*, Shape> shapeOf_;
  std::map<std::tuple<const PartGeometry*, float, float, float, float>, std::size_t> meshOf_;
};

}  // namespace

std::string pathGlb(const Scene& scene, const AssemblyPath& path) {
  checkPath(path, "path");
  return GlbBuilder(path, pathBodies(scene, path)).take();
}

void writePathGlb(const Scene& scene, const AssemblyPath& path, const std::filesystem::path& file) {
  atomicWrite(file, pathGlb(scene, path));
}

}  // namespace nearfit
