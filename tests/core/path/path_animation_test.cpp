#include "core/path/path_animation.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/path_scenes.h"

namespace nearfit::path_animation_test {
namespace {

/// A binary glTF file, taken apart by its specification.
class Glb {
 public:
  explicit Glb(const std::string& file) {
    EXPECT_EQ(word(file, 0), 0x46546C67U) << "the letters glTF";
    EXPECT_EQ(word(file, 4), 2U);
    EXPECT_EQ(word(file, 8), file.size());
    const std::size_t jsonSize = word(file, 12);
    EXPECT_EQ(jsonSize % 4, 0U);
    EXPECT_EQ(word(file, 16), 0x4E4F534AU);
    json = nlohmann::json::parse(file.substr(20, jsonSize));
    const std::size_t data = 20 + jsonSize;
    EXPECT_EQ(word(file, data + 4), 0x004E4942U);
    EXPECT_EQ(data + 8 + word(file, data), file.size());
    bytes_ = file.substr(data + 8);
    EXPECT_EQ(json.at("buffers").at(0).at("byteLength"), bytes_.size());
  }

  std::vector<float> floats(std::size_t accessor) const {
    const auto& a = json.at("accessors").at(accessor);
    EXPECT_EQ(a.at("componentType"), 5126);
    return numbers<float>(a);
  }
  std::vector<std::uint32_t> indices(std::size_t accessor) const {
    const auto& a = json.at("accessors").at(accessor);
    EXPECT_EQ(a.at("componentType"), 5125);
    return numbers<std::uint32_t>(a);
  }
  /// Index of the node with a name.
  std::size_t node(const std::string& name) const {
    for (std::size_t i = 0; i < json.at("nodes").size(); ++i) {
      if (json.at("nodes").at(i).at("name") == name) return i;
    }
    ADD_FAILURE() << "no node " << name;
    return 0;
  }

  nlohmann::json json;

 private:
  static std::uint32_t word(const std::string& file, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, sizeof value);
    return value;
  }
  template <class T>
  std::vector<T> numbers(const nlohmann::json& accessor) const {
    const std::string shape = accessor.at("type");
    const std::size_t each = shape == "SCALAR" ? 1 : shape == "VEC3" ? 3 : 4;
    const auto& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const std::size_t offset = view.at("byteOffset"), size = view.at("byteLength");
    std::vector<T> values(each * accessor.at("count").get<std::size_t>());
    EXPECT_EQ(offset % sizeof(T), 0U);
    EXPECT_EQ(values.size() * sizeof(T), size);
    EXPECT_LE(offset + size, bytes_.size());
    std::memcpy(values.data(), bytes_.data() + offset, size);
    return values;
  }

  std::string bytes_;
};

test::PathScene peg() {
  test::PathScene made = test::pegScrewedIn(0.5);
  made.path.centre = {0.1, 0.2, 0.3};
  return made;
}

TEST(PathAnimation, MovesANodeAsThePathDoes) {
  const test::PathScene made = peg();
  const Glb glb(pathGlb(made.scene, made.path));
  const auto& animation = glb.json.at("animations").at(0);
  const std::size_t moved = glb.node("Path of Peg");
  ASSERT_EQ(animation.at("channels").size(), 2U);
  for (const auto& channel : animation.at("channels")) {
    EXPECT_EQ(channel.at("target").at("node"), moved);
    const auto& sampler = animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
    EXPECT_EQ(sampler.at("interpolation"), "LINEAR");
    const std::vector<float> times = glb.floats(sampler.at("input")),
                             values = glb.floats(sampler.at("output"));
    const auto& input = glb.json.at("accessors").at(sampler.at("input").get<std::size_t>());
    ASSERT_EQ(times.size(), made.path.poses.size());
    EXPECT_EQ(input.at("min").at(0).get<double>(), static_cast<double>(times.front()));
    EXPECT_EQ(input.at("max").at(0).get<double>(), static_cast<double>(times.back()));
    const bool isShift = channel.at("target").at("path") == "translation";
    for (std::size_t i = 0; i < times.size(); ++i) {
      const RigidTransform& pose = made.path.poses[i].worldFromLead;
      EXPECT_EQ(times[i], static_cast<float>(i));
      if (isShift) {
        const glm::dvec3 wanted = pose.applyToPoint(made.path.centre);
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(values[3 * i + k], wanted[static_cast<glm::length_t>(k)], 1e-6);
      } else {
        const double x = values[4 * i], y = values[4 * i + 1], z = values[4 * i + 2], w = values[4 * i + 3];
        EXPECT_NEAR(x * x + y * y + z * z + w * w, 1.0, 1e-6);
        const glm::dquat q = pose.rotation;
        EXPECT_NEAR(std::abs(w * q.w + x * q.x + y * q.y + z * q.z), 1.0, 1e-6) << "the same turn";
        if (i > 0) {
          EXPECT_GE(
              x * values[4 * i - 4] + y * values[4 * i - 3] + z * values[4 * i - 2] + w * values[4 * i - 1],
              0.0)
              << "the shorter way";
        }
      }
    }
  }
}

TEST(PathAnimation, HoldsTheMeshesOfAllVisiblePartsWhereTheyAre) {
  test::PathScene made = peg();
  Part bore = made.part("Bore");
  bore.worldFromPart = test::at(10.0, 20.0, 30.0);
  made.scene.replace(bore);
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Hidden"));
  Part hidden = made.part("Hidden");
  hidden.isVisible = false;
  made.scene.replace(hidden);
  const Glb glb(pathGlb(made.scene, made.path));
  EXPECT_EQ(glb.json.at("nodes").size(), 4U) << "the root, the one that moves, peg and bore";
  for (const char* name : {"Bore", "Peg"}) {
    const Part& part = made.part(name);
    const auto& node = glb.json.at("nodes").at(glb.node(name));
    const auto& primitive =
        glb.json.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives").at(0);
    const std::size_t accessor = primitive.at("attributes").at("POSITION");
    const std::vector<float> positions = glb.floats(accessor);
    const std::vector<std::uint32_t> indices = glb.indices(primitive.at("indices"));
    ASSERT_EQ(indices.size(), 3 * part.geometry->mesh.triangles().size());
    ASSERT_EQ(positions.size(), 3 * part.geometry->mesh.vertices().size());
    for (const std::uint32_t index : indices)
      ASSERT_LT(index, part.geometry->mesh.vertices().size());
    const auto& bounds = glb.json.at("accessors").at(accessor);
    for (std::size_t k = 0; k < 3; ++k) {
      float lower = INFINITY, upper = -INFINITY;
      for (std::size_t i = k; i < positions.size(); i += 3) {
        lower = std::min(lower, positions[i]);
        upper = std::max(upper, positions[i]);
      }
      EXPECT_EQ(bounds.at("min").at(k).get<double>(), static_cast<double>(lower));
      EXPECT_EQ(bounds.at("max").at(k).get<double>(), static_cast<double>(upper));
    }
  }
  const auto& place = glb.json.at("nodes").at(glb.node("Bore")).at("translation");
  EXPECT_NEAR(place.at(0).get<double>(), 10.0, 1e-9);
  EXPECT_NEAR(place.at(2).get<double>(), 30.0, 1e-9);
  // The peg hangs from the node at the path's centre.
  const auto& own = glb.json.at("nodes").at(glb.node("Peg")).at("translation");
  EXPECT_NEAR(own.at(0).get<double>(), -0.1, 1e-12);
  EXPECT_NEAR(own.at(2).get<double>(), -0.3, 1e-12);
}

TEST(PathAnimation, TimesIncreaseThoughSinglePrecisionDoesNotTellThemApart) {
  test::PathScene made = test::cubePastCube(0.1);
  made.path.poses.clear();
  for (int i = 0; i < 100; ++i)
    made.path.poses.push_back({5e5 + 1e-3 * i + (i == 0 ? -5e5 : 0.0), test::at(0.01 * i, 5.0, 0.0)});
  const Glb glb(pathGlb(made.scene, made.path));
  const auto& sampler = glb.json.at("animations").at(0).at("samplers").at(0);
  const std::vector<float> times = glb.floats(sampler.at("input")), values = glb.floats(sampler.at("output"));
  for (std::size_t i = 1; i < times.size(); ++i)
    EXPECT_GT(times[i], times[i - 1]);
  EXPECT_NEAR(values[values.size() - 3], 0.99, 1e-6) << "the last pose is there";
}

}  // namespace
}  // namespace nearfit::path_animation_test
