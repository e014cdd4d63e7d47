#include "core/report/glb_export.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/mesh/flat_groups.h"
#include "core/mesh/shaded_mesh.h"
#include "core/report/assembly_tree.h"
#include "core/report/gltf_format.h"
#include "core/report/mesh_file.h"

namespace nearfit {
namespace {

using Json = nlohmann::ordered_json;

/// An index of all ones has a meaning of its own: meshes of fewer vertices have indices of 16 bits.
constexpr std::size_t kMaxShortVertices = std::numeric_limits<std::uint16_t>::max();
constexpr std::uint64_t kGlbHeadBytes = 12, kChunkHeadBytes = 8;
constexpr std::uint64_t kMaxGlbBytes = std::numeric_limits<std::uint32_t>::max();
/// Roughness of all materials: dull, as the view draws parts.
constexpr double kGlbRoughness = 0.6;
/// Progress once normals are known.
constexpr double kGlbShaded = 0.5;

std::uint64_t paddedToFour(std::uint64_t bytes) {
  return (bytes + 3) / 4 * 4;
}

/// A run of triangles of one colour.
struct ColourRun {
  std::optional<CadColour> colour;  ///< std::nullopt: the part's.
  std::size_t first = 0, count = 0;
};

/// A geometry as it is written: triangles in the order of their colours.
struct GlbGeometry {
  const TriangleMesh* mesh = nullptr;
  ShadedMesh shaded;
  std::vector<ColourRun> runs;
  int positions = 0, normals = 0;  ///< Accessors.
  std::vector<int> indices;        ///< Accessors, by run.

  bool hasShortIndices() const { return shaded.vertices.size() < kMaxShortVertices; }
  std::uint64_t vertexBytes() const { return shaded.vertices.size() * 3 * sizeof(float); }
  std::uint64_t indexBytes() const {
    return shaded.triangles.size() * 3 * (hasShortIndices() ? sizeof(std::uint16_t) : sizeof(std::uint32_t));
  }
};

/// Sorts the triangles by the colours of their faces, the part's colour first.
std::vector<ColourRun> sortByColour(const PartGeometry& geometry, std::vector<Triangle>& triangles) {
  if (geometry.faceColours.empty() || geometry.surfaces == nullptr)
    return {{std::nullopt, 0, triangles.size()}};
  std::map<std::optional<CadColour>, std::vector<Triangle>> byColour;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    byColour[geometry.faceColours[geometry.surfaces->faceOfTriangle[i]]].push_back(triangles[i]);
  std::vector<ColourRun> runs;
  triangles.clear();
  for (const auto& [colour, some] : byColour) {
    runs.push_back({colour, triangles.size(), some.size()});
    triangles.insert(triangles.end(), some.begin(), some.end());
  }
  return runs;
}

GlbGeometry shadedGeometry(const PartGeometry& geometry) {
  GlbGeometry result;
  result.mesh = &geometry.mesh;
  result.shaded = shadedMesh(geometry.mesh, kSharpAngle,
                             flatTolerance(geometry.mesh, geometry.report.coordinateRounding));
  result.runs = sortByColour(geometry, result.shaded.triangles);
  return result;
}

glm::vec3 positionOf(const GlbGeometry& geometry, std::size_t vertex) {
  return glm::vec3(geometry.mesh->vertices()[geometry.shaded.vertices[vertex]]);
}

/// The format wants unit vectors, also where faces have no area or cancel out.
glm::vec3 normalOf(const GlbGeometry& geometry, std::size_t vertex) {
  const glm::dvec3 normal(geometry.shaded.normals[vertex]);
  const double length = glm::length(normal);
  return length > 0.5 ? glm::vec3(normal / length) : glm::vec3(0.0F, 0.0F, 1.0F);
}

Json vectorJson(const glm::vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// The JSON of a file, which refers to the bytes that follow it.
class GlbDocument {
 public:
  GlbDocument(const AssemblyTree& tree, std::vector<GlbGeometry>& geometries, const std::string& name)
      : tree_(tree), geometries_(geometries), name_(name) {}

  /// Throws UsageError if the bytes are more than a file can hold.
  std::string text() {
    for (GlbGeometry& geometry : geometries_)
      addGeometry(geometry);
    addNodes();
    if (bytes_ > kMaxGlbBytes)
      throw UsageError("glTF export", "its triangles are more than a file of 4 GiB can hold",
                       "export fewer parts at a time");
    json_["asset"] = {{"version", "2.0"}, {"generator", "Nearfit " NEARFIT_VERSION}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"name", name_}, {"nodes", Json::array({0})}}});
    json_["nodes"] = std::move(nodes_);
    json_["meshes"] = std::move(meshes_);
    json_["materials"] = std::move(materials_);
    json_["accessors"] = std::move(accessors_);
    json_["bufferViews"] = std::move(views_);
    json_["buffers"] = Json::array({{{"byteLength", bytes_}}});
    std::string text = json_.dump();
    text.resize(paddedToFour(text.size()), ' ');
    return text;
  }
  std::uint64_t binaryBytes() const { return bytes_; }

 private:
  std::size_t addView(std::uint64_t bytes, int target) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}, {"target", target}});
    bytes_ += paddedToFour(bytes);
    return views_.size() - 1;
  }

  int addAccessor(Json accessor) {
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
  }

  void addGeometry(GlbGeometry& geometry) {
    const std::size_t count = geometry.shaded.vertices.size();
    glm::vec3 lower(std::numeric_limits<float>::max()), upper(std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < count; ++i) {
      lower = glm::min(lower, positionOf(geometry, i));
      upper = glm::max(upper, positionOf(geometry, i));
    }
    Json positions = {{"bufferView", addView(geometry.vertexBytes(), gltf::kArrayTarget)},
                      {"componentType", gltf::kFloatType},
                      {"count", count},
                      {"type", "VEC3"}};
    positions["min"] = vectorJson(lower);
    positions["max"] = vectorJson(upper);
    geometry.positions = addAccessor(std::move(positions));
    geometry.normals = addAccessor({{"bufferView", addView(geometry.vertexBytes(), gltf::kArrayTarget)},
                                    {"componentType", gltf::kFloatType},
                                    {"count", count},
                                    {"type", "VEC3"}});
    const std::size_t view = addView(geometry.indexBytes(), gltf::kIndexTarget);
    const std::size_t size = geometry.hasShortIndices() ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
    for (const ColourRun& run : geometry.runs) {
      geometry.indices.push_back(
          addAccessor({{"bufferView", view},
                       {"byteOffset", 3 * size * run.first},
                       {"componentType", geometry.hasShortIndices() ? gltf::kUint16Type : gltf::kUint32Type},
                       {"count", 3 * run.count},
                       {"type", "SCALAR"}}));
    }
  }

  int materialOf(const CadColour& colour, double opacity, bool isOpen) {
    const auto [at, isNew] =
        materialAt_.try_emplace({colour, opacity, isOpen}, static_cast<int>(materials_.size()));
    if (!isNew) return at->second;
    Json material = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor",
           {gltf::linearOf(colour[0]), gltf::linearOf(colour[1]), gltf::linearOf(colour[2]), opacity}},
          {"metallicFactor", 0.0},
          {"roughnessFactor", kGlbRoughness}}}};
    if (opacity < 1.0) material["alphaMode"] = "BLEND";
    if (isOpen) material["doubleSided"] = true;
    materials_.push_back(std::move(material));
    return at->second;
  }

  int meshOf(const AssemblyNode& node) {
    const Part& part = *node.part;
    const CadColour own{part.colour.r, part.colour.g, part.colour.b};
    const double opacity = std::clamp(part.opacity, 0.0, 1.0);
    const auto [at, isNew] =
        meshAt_.try_emplace({node.geometry, own, opacity}, static_cast<int>(meshes_.size()));
    if (!isNew) return at->second;
    const GlbGeometry& geometry = geometries_[static_cast<std::size_t>(node.geometry)];
    const bool isOpen = !geometry.mesh->topology().isClosed();
    Json primitives = Json::array();
    for (std::size_t i = 0; i < geometry.runs.size(); ++i) {
      primitives.push_back({{"attributes", {{"POSITION", geometry.positions}, {"NORMAL", geometry.normals}}},
                            {"indices", geometry.indices[i]},
                            {"material", materialOf(geometry.runs[i].colour.value_or(own), opacity, isOpen)},
                            {"mode", gltf::kTrianglesMode}});
    }
    meshes_.push_back({{"name", geometryName(*part.geometry)}, {"primitives", std::move(primitives)}});
    return at->second;
  }

  void addNodes() {
    // Node 0 is the root.
    std::vector<std::vector<std::size_t>> children(tree_.nodes.size() + 1);
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      const std::int32_t above = tree_.nodes[i].parent + 1;
      children[static_cast<std::size_t>(above)].push_back(i + 1);
    }
    const double half = std::numbers::sqrt2 / 2.0;
    nodes_.push_back({{"name", name_}, {"rotation", {-half, 0.0, 0.0, half}}, {"children", children[0]}});
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      const AssemblyNode& node = tree_.nodes[i];
      Json json = {{"name", node.name}};
      if (node.part != nullptr) {
        const RigidTransform pose = node.part->worldFromPart.normalized();
        const glm::dquat& q = pose.rotation;
        const glm::dvec3& t = pose.translation;
        json["mesh"] = meshOf(node);
        json["rotation"] = {q.x, q.y, q.z, q.w};
        // The format allows no more than 1, which normalising may pass by a rounding.
        for (Json& x : json["rotation"])
          x = std::clamp(x.get<double>(), -1.0, 1.0);
        json["translation"] = {t.x, t.y, t.z};
      } else {
        json["children"] = children[i + 1];
      }
      nodes_.push_back(std::move(json));
    }
  }

  const AssemblyTree& tree_;
  std::vector<GlbGeometry>& geometries_;
  const std::string& name_;
  Json json_, nodes_ = Json::array(), meshes_ = Json::array(), materials_ = Json::array(),
              accessors_ = Json::array(), views_ = Json::array();
  std::map<std::tuple<CadColour, double, bool>, int> materialAt_;
  std::map<std::tuple<std::int32_t, CadColour, double>, int> meshAt_;
  std::uint64_t bytes_ = 0;
};

void appendVector(MeshFile& out, const glm::vec3& v) {
  for (glm::length_t k = 0; k < 3; ++k)
    out.append(v[k]);
  out.step();
}

void writeGeometry(MeshFile& out, const GlbGeometry& geometry) {
  for (std::size_t i = 0; i < geometry.shaded.vertices.size(); ++i)
    appendVector(out, positionOf(geometry, i));
  for (std::size_t i = 0; i < geometry.shaded.vertices.size(); ++i)
    appendVector(out, normalOf(geometry, i));
  for (const Triangle& triangle : geometry.shaded.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (geometry.hasShortIndices()) {
        out.append(static_cast<std::uint16_t>(corner));
      } else {
        out.append(corner);
      }
    }
    out.step();
  }
  // Each view begins at a multiple of four bytes.
  for (std::uint64_t i = geometry.indexBytes(); i < paddedToFour(geometry.indexBytes()); ++i)
    out.append(std::uint8_t{0});
}

}  // namespace

MeshExportSize exportGlb(const Scene& scene, std::span<const Scene::PartPtr> parts,
                         const std::filesystem::path& file, const ProgressCallback& progress) {
  const AssemblyTree tree = assemblyTree(scene, parts);
  const auto shade = stageOf(progress, 0.0, kGlbShaded);
  std::vector<GlbGeometry> geometries;
  std::uint64_t steps = 0;
  for (const PartGeometryPtr& geometry : tree.geometries) {
    shade(static_cast<double>(geometries.size()) / static_cast<double>(tree.geometries.size()));
    geometries.push_back(shadedGeometry(*geometry));
    steps += 2 * geometries.back().shaded.vertices.size() + geometries.back().shaded.triangles.size();
  }
  const std::string name = assemblyName(file);
  GlbDocument document(tree, geometries, name);
  const std::string json = document.text();
  const std::uint64_t total = kGlbHeadBytes + 2 * kChunkHeadBytes + json.size() + document.binaryBytes();
  if (total > kMaxGlbBytes)
    throw UsageError("glTF export", "its triangles are more than a file of 4 GiB can hold",
                     "export fewer parts at a time");
  const ProgressCallback write = stageCallback(progress, kGlbShaded, 1.0);
  MeshFile out(file, steps, write);
  out.append(gltf::kGlbMagic);
  out.append(gltf::kGlbVersion);
  out.append(static_cast<std::uint32_t>(total));
  out.append(static_cast<std::uint32_t>(json.size()));
  out.append(gltf::kJsonChunk);
  out.text() += json;
  out.append(static_cast<std::uint32_t>(document.binaryBytes()));
  out.append(gltf::kBinaryChunk);
  for (const GlbGeometry& geometry : geometries)
    writeGeometry(out, geometry);
  MeshExportSize size = meshExportSize(parts, MeshFileKind::StlBinary);
  size.bytes = out.commit();
  return size;
}

}  // namespace nearfit
