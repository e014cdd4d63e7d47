// A reader of its own: chunks, accessors and nodes as the specification gives them.
#include "core/report/glb_export.h"

#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "tests/core/report/assembly_fixture.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::glb_export_test {
namespace {

using nlohmann::json;

template <class T>
T valueAt(const std::string& bytes, std::size_t at) {
  T value{};
  if (at + sizeof(T) > bytes.size()) {
    ADD_FAILURE() << "byte " << at << " is behind the end";
    return value;
  }
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

struct Glb {
  explicit Glb(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(valueAt<std::uint32_t>(bytes, 4), 2U);
    EXPECT_EQ(valueAt<std::uint32_t>(bytes, 8), bytes.size());
    const std::size_t jsonBytes = valueAt<std::uint32_t>(bytes, 12);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(jsonBytes % 4, 0U);
    document = json::parse(bytes.substr(20, jsonBytes));
    const std::size_t binaryBytes = valueAt<std::uint32_t>(bytes, 20 + jsonBytes);
    EXPECT_EQ(binaryBytes % 4, 0U);
    EXPECT_EQ(bytes.substr(24 + jsonBytes, 4), std::string("BIN\0", 4));
    EXPECT_EQ(28 + jsonBytes + binaryBytes, bytes.size());
    EXPECT_EQ(document["buffers"][0]["byteLength"], binaryBytes);
    binary = bytes.substr(28 + jsonBytes);
  }

  /// Where an accessor's values begin; checks that they are within its view, and the view within the buffer.
  std::size_t beginOf(const json& accessor, std::size_t bytesEach) const {
    const json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t offset = view["byteOffset"], length = view["byteLength"];
    EXPECT_EQ(offset % 4, 0U);
    EXPECT_LE(offset + length, binary.size());
    const std::size_t begin = accessor.value("byteOffset", std::size_t{0});
    EXPECT_LE(begin + bytesEach * accessor["count"].get<std::size_t>(), length);
    return offset + begin;
  }
  std::vector<glm::vec3> vectors(std::size_t index) const {
    const json& accessor = document["accessors"][index];
    EXPECT_EQ(accessor["componentType"], 5126);
    EXPECT_EQ(accessor["type"], "VEC3");
    const std::size_t begin = beginOf(accessor, 12);
    std::vector<glm::vec3> values(accessor["count"].get<std::size_t>());
    for (std::size_t i = 0; i < values.size(); ++i)
      for (int k = 0; k < 3; ++k)
        values[i][k] = valueAt<float>(binary, begin + 12 * i + 4 * static_cast<std::size_t>(k));
    return values;
  }
  std::vector<std::uint32_t> indices(std::size_t index) const {
    const json& accessor = document["accessors"][index];
    EXPECT_EQ(accessor["type"], "SCALAR");
    const bool isShort = accessor["componentType"] == 5123;
    EXPECT_TRUE(isShort || accessor["componentType"] == 5125);
    const std::size_t size = isShort ? 2 : 4, begin = beginOf(accessor, size);
    EXPECT_EQ(begin % size, 0U);
    std::vector<std::uint32_t> values(accessor["count"].get<std::size_t>());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = isShort ? valueAt<std::uint16_t>(binary, begin + 2 * i)
                          : valueAt<std::uint32_t>(binary, begin + 4 * i);
    return values;
  }
  const json& meshOf(const json& node) const { return document["meshes"][node["mesh"].get<std::size_t>()]; }
  const json& nodeNamed(const std::string& name) const {
    for (const json& node : document["nodes"])
      if (node["name"] == name) return node;
    ADD_FAILURE() << "no node " << name;
    return document["nodes"][0];
  }

  json document;
  std::string binary;
};

RigidTransform ownTransform(const json& node) {
  RigidTransform pose;
  if (node.contains("rotation")) {
    const json& q = node["rotation"];
    pose.rotation = glm::dquat(q[3], q[0], q[1], q[2]);
  }
  if (node.contains("translation")) {
    const json& t = node["translation"];
    pose.translation = {t[0], t[1], t[2]};
  }
  return pose;
}

/// Matrices from each node to the scene, by name; and the parent of each.
void placeBelow(const Glb& glb, std::size_t index, const glm::dmat4& outer, const std::string& parent,
                std::map<std::string, glm::dmat4>& placed, std::map<std::string, std::string>& parents) {
  const json& node = glb.document["nodes"][index];
  const glm::dmat4 own = outer * test::matrixOf(ownTransform(node));
  const std::string name = node["name"];
  EXPECT_TRUE(placed.emplace(name, own).second) << "twice: " << name;
  parents[name] = parent;
  if (!node.contains("children")) return;
  EXPECT_FALSE(node["children"].empty());
  for (const json& child : node["children"])
    placeBelow(glb, child.get<std::size_t>(), own, name, placed, parents);
}

class GlbExport : public ::testing::Test {
 protected:
  Glb exported(const std::vector<PartId>& only = {}) {
    exportGlb(model_.scene, chosenParts(model_.scene, only), file_);
    return Glb(test::readBytes(file_));
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "fit.glb";
  test::AssemblyScene model_;
};

TEST_F(GlbExport, NamesGroupsAndPosesAreReadBackWithUpAsY) {
  const Glb glb = exported();
  std::map<std::string, glm::dmat4> placed;
  std::map<std::string, std::string> parents;
  ASSERT_EQ(glb.document["scenes"][0]["nodes"], json::array({0}));
  placeBelow(glb, 0, glm::dmat4(1.0), "", placed, parents);
  EXPECT_EQ(placed.size(), glb.document["nodes"].size()) << "each node is placed once";
  EXPECT_EQ(parents.at("fit"), "");
  EXPECT_EQ(parents.at("Outer <1>"), "fit");
  EXPECT_EQ(parents.at("Inner"), "Outer <1>");
  EXPECT_EQ(parents.at("Ring"), "Inner");
  EXPECT_EQ(parents.at("Third ring"), "Outer <1>");
  EXPECT_EQ(parents.at(test::kHostileName), "fit");
  EXPECT_FALSE(parents.contains("Empty"));
  EXPECT_FALSE(parents.contains("Hidden"));
  // x stays, z becomes y, y becomes -z.
  const glm::dmat4 upright(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  for (const Scene::PartPtr& part : chosenParts(model_.scene, {}))
    EXPECT_LT(test::differenceOf(placed.at(part->name), upright * test::matrixOf(part->worldFromPart)), 1e-12)
        << part->name;
}

TEST_F(GlbExport, TrianglesAreThoseOfTheMeshInMetres) {
  const Glb glb = exported();
  const json& primitive = glb.meshOf(glb.nodeNamed("Ring"))["primitives"].at(0);
  const auto positions = glb.vectors(primitive["attributes"]["POSITION"]);
  const auto indices = glb.indices(primitive["indices"]);
  const TriangleMesh& mesh = model_.scene.get(model_.firstRing).geometry->mesh;
  ASSERT_EQ(indices.size(), 3 * mesh.triangles().size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    ASSERT_LT(indices[i], positions.size());
    const glm::dvec3 corner = mesh.vertices()[mesh.triangles()[i / 3][i % 3]];
    EXPECT_LT(glm::distance(glm::dvec3(positions[indices[i]]), corner), 1e-8);
  }
}

TEST_F(GlbExport, BoundsAreThoseOfThePositionsAndNormalsAreUnitAndOutward) {
  const Glb glb = exported();
  std::size_t meshes = 0;
  for (const json& mesh : glb.document["meshes"]) {
    for (const json& primitive : mesh["primitives"]) {
      const std::size_t index = primitive["attributes"]["POSITION"];
      const auto positions = glb.vectors(index), normals = glb.vectors(primitive["attributes"]["NORMAL"]);
      ASSERT_EQ(positions.size(), normals.size());
      for (int k = 0; k < 3; ++k) {
        float lower = positions[0][k], upper = lower;
        for (const glm::vec3& p : positions) {
          lower = std::min(lower, p[k]);
          upper = std::max(upper, p[k]);
        }
        const auto at = static_cast<std::size_t>(k);
        EXPECT_EQ(glb.document["accessors"][index]["min"][at].get<float>(), lower);
        EXPECT_EQ(glb.document["accessors"][index]["max"][at].get<float>(), upper);
      }
      const auto indices = glb.indices(primitive["indices"]);
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const glm::vec3 a = positions[indices[i]], b = positions[indices[i + 1]],
                        c = positions[indices[i + 2]];
        for (std::size_t k = 0; k < 3; ++k) {
          const glm::vec3 n = normals[indices[i + k]];
          EXPECT_NEAR(glm::length(n), 1.0F, 1e-5F);
          EXPECT_GT(glm::dot(n, glm::cross(b - a, c - a)), 0.0F);
        }
      }
      ++meshes;
    }
  }
  EXPECT_GE(meshes, 5U);
}

TEST_F(GlbExport, EdgesOfABoxStaySharp) {
  const Glb glb = exported({model_.box});
  const json& primitive = glb.document["meshes"][0]["primitives"].at(0);
  for (const glm::vec3& n : glb.vectors(primitive["attributes"]["NORMAL"]))
    EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1.0F, 1e-6F);
}

TEST_F(GlbExport, InstancesOfOneColourShareAMeshAndOthersItsAccessors) {
  const Glb glb = exported();
  EXPECT_EQ(glb.nodeNamed("Ring")["mesh"], glb.nodeNamed(test::kHostileName)["mesh"]);
  EXPECT_NE(glb.nodeNamed("Ring")["mesh"], glb.nodeNamed("Third ring")["mesh"]);
  const json first = glb.meshOf(glb.nodeNamed("Ring"))["primitives"][0],
             third = glb.meshOf(glb.nodeNamed("Third ring"))["primitives"][0];
  EXPECT_EQ(first["attributes"], third["attributes"]);
  EXPECT_EQ(first["indices"], third["indices"]);
  EXPECT_NE(first["material"], third["material"]);
}

TEST_F(GlbExport, ColoursAreLinearAndOpacityBlends) {
  const Glb glb = exported();
  const auto materialOf = [&](const json& primitive) -> const json& {
    return glb.document["materials"][primitive["material"].get<std::size_t>()];
  };
  const json& ring = materialOf(glb.meshOf(glb.nodeNamed("Ring"))["primitives"][0]);
  const json& factor = ring["pbrMetallicRoughness"]["baseColorFactor"];
  // Of 0.25, 0.5 and 0.75, from the tables of sRGB.
  EXPECT_NEAR(factor[0].get<double>(), 0.0508761, 1e-6);
  EXPECT_NEAR(factor[1].get<double>(), 0.2140411, 1e-6);
  EXPECT_NEAR(factor[2].get<double>(), 0.5225216, 1e-6);
  EXPECT_EQ(factor[3], 1.0);
  EXPECT_FALSE(ring.contains("alphaMode"));
  const json& third = materialOf(glb.meshOf(glb.nodeNamed("Third ring"))["primitives"][0]);
  EXPECT_EQ(third["alphaMode"], "BLEND");
  EXPECT_EQ(third["pbrMetallicRoughness"]["baseColorFactor"], json::array({1.0, 0.0, 0.0, 0.5}));
  EXPECT_TRUE(materialOf(glb.meshOf(glb.nodeNamed("Square"))["primitives"][0])["doubleSided"]);
}

TEST_F(GlbExport, FacesHaveTheirColours) {
  const Glb glb = exported({model_.box});
  std::map<std::vector<double>, std::size_t> corners;
  for (const json& primitive : glb.document["meshes"][0]["primitives"]) {
    const json& material = glb.document["materials"][primitive["material"].get<std::size_t>()];
    corners[material["pbrMetallicRoughness"]["baseColorFactor"].get<std::vector<double>>()] +=
        glb.indices(primitive["indices"]).size();
  }
  ASSERT_EQ(corners.size(), 3U);
  EXPECT_EQ((corners[{0, 1, 0, 1}]), 12U);
  EXPECT_EQ((corners[{0, 0, 1, 1}]), 6U);
}

TEST_F(GlbExport, ManyVerticesGetIndicesOf32Bits) {
  Scene scene;
  scene.add(test::partOf(test::geometryOf(test::squareMesh(1.0, 260)), "Fine"));
  exportGlb(scene, chosenParts(scene, {}), file_);
  const Glb glb{test::readBytes(file_)};
  const json& primitive = glb.document["meshes"][0]["primitives"][0];
  EXPECT_EQ(glb.document["accessors"][primitive["indices"].get<std::size_t>()]["componentType"], 5125);
  const auto indices = glb.indices(primitive["indices"]);
  EXPECT_EQ(indices.size(), 3U * 2U * 260U * 260U);
  EXPECT_EQ(*std::max_element(indices.begin(), indices.end()) + 1,
            glb.vectors(primitive["attributes"]["POSITION"]).size());
}

TEST_F(GlbExport, NothingAndCancellingKeepTheOldFile) {
  folder_.write("fit.glb", "old");
  EXPECT_THROW(exportGlb(model_.scene, {}, file_), UsageError);
  EXPECT_THROW(exportGlb(model_.scene, chosenParts(model_.scene, {}), file_, [](double) { return false; }),
               Cancelled);
  EXPECT_EQ(test::readBytes(file_), "old");
}

}  // namespace
}  // namespace nearfit::glb_export_test
