#include "core/report/urdf_export.h"

#include <cmath>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/report/mesh_export.h"
#include "tests/core/report/assembly_fixture.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::urdf_export_test {
namespace {

using testing::HasSubstr;

glm::dmat3 aboutX(double a) {
  return {1, 0, 0, 0, std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a)};
}
glm::dmat3 aboutY(double a) {
  return {std::cos(a), 0, -std::sin(a), 0, 1, 0, std::sin(a), 0, std::cos(a)};
}
glm::dmat3 aboutZ(double a) {
  return {std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a), 0, 0, 0, 1};
}

/// As URDF defines rpy: about fixed axes.
glm::dmat4 matrixOf(const glm::dvec3& xyz, const glm::dvec3& rpy) {
  glm::dmat4 m(aboutZ(rpy.z) * aboutY(rpy.y) * aboutX(rpy.x));
  m[3] = glm::dvec4(xyz, 1.0);
  return m;
}

std::string unescaped(std::string text) {
  const std::pair<const char*, const char*> references[] = {
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}};
  for (const auto& [reference, character] : references)
    for (std::size_t at = 0; (at = text.find(reference, at)) != text.npos; ++at)
      text.replace(at, std::string(reference).size(), character);
  return text;
}

/// The groups of all matches of a pattern.
std::vector<std::vector<std::string>> matchesOf(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::vector<std::string>> matches;
  for (std::sregex_iterator at(text.begin(), text.end(), regex); at != std::sregex_iterator(); ++at)
    matches.emplace_back(at->begin(), at->end());
  return matches;
}

glm::dvec3 vectorOf(const std::string& text) {
  std::istringstream in(text);
  glm::dvec3 v;
  EXPECT_TRUE(in >> v.x >> v.y >> v.z) << text;
  return v;
}

struct JointOfFile {
  std::string parent;
  glm::dmat4 parentFromChild{1.0};
};

class UrdfExportTest : public ::testing::Test {
 protected:
  void write() {
    result_ = exportUrdf(model_.scene, chosenParts(model_.scene, {}), file_);
    text_ = test::readBytes(file_);
  }
  /// By child link.
  std::map<std::string, JointOfFile> joints() const {
    std::map<std::string, JointOfFile> joints;
    for (const std::vector<std::string>& m :
         matchesOf(text_,
                   "<joint name=\"[^\"]*\" type=\"fixed\">(<origin xyz=\"([^\"]*)\" rpy=\"([^\"]*)\"/>)?"
                   "<parent link=\"([^\"]*)\"/><child link=\"([^\"]*)\"/></joint>")) {
      JointOfFile joint{unescaped(m[4]), glm::dmat4(1.0)};
      if (!m[1].empty()) joint.parentFromChild = matrixOf(vectorOf(m[2]), vectorOf(m[3]));
      EXPECT_TRUE(joints.emplace(unescaped(m[5]), joint).second) << "two joints to " << m[5];
    }
    return joints;
  }
  /// From "<link name=NAME>" to its end.
  std::string linkOf(const std::string& escapedName) const {
    const std::size_t begin = text_.find("<link name=\"" + escapedName + "\">");
    EXPECT_NE(begin, text_.npos) << escapedName;
    return begin == text_.npos ? std::string() : text_.substr(begin, text_.find("</link>", begin) - begin);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "fit one.urdf";
  test::AssemblyScene model_;
  UrdfExport result_;
  std::string text_;
};

TEST_F(UrdfExportTest, EachPartIsALinkWithItsNameAndItsPoseInTheWorld) {
  write();
  const auto all = joints();
  for (const Scene::PartPtr& part : chosenParts(model_.scene, {})) {
    glm::dmat4 placed(1.0);
    std::string at = part->name;
    while (at != "world") {
      ASSERT_TRUE(all.contains(at)) << at;
      placed = all.at(at).parentFromChild * placed;
      at = all.at(at).parent;
    }
    EXPECT_LT(test::differenceOf(placed, test::matrixOf(part->worldFromPart)), 1e-12) << part->name;
  }
  EXPECT_EQ(all.at("Ring").parent, "Inner");
  EXPECT_EQ(all.at("Inner").parent, "Outer <1>");
  EXPECT_FALSE(all.contains("Empty"));
  EXPECT_FALSE(all.contains("Hidden"));
  EXPECT_EQ(all.size(), 7U) << "five parts and two groups";
}

TEST_F(UrdfExportTest, NamesOfGroupsAndOfTheRootGiveWayToThoseOfParts) {
  Part part = model_.scene.get(model_.square);
  part.name = "world";
  model_.scene.replace(part);
  part = model_.scene.get(model_.box);
  part.name = "Inner";
  model_.scene.replace(part);
  write();
  const auto all = joints();
  EXPECT_EQ(all.at("world").parent, "world 2");
  EXPECT_EQ(all.at("Inner").parent, "Inner 2");
  EXPECT_THAT(text_, HasSubstr("<link name=\"world 2\"/>"));
}

TEST_F(UrdfExportTest, EachGeometryIsOneMeshInMetresInThePartsFrame) {
  write();
  ASSERT_EQ(result_.meshes.size(), 3U) << "a ring for three parts, a box and a square";
  EXPECT_EQ(result_.folder.filename(), "fit_one_meshes");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(result_.folder))
    ++files;
  EXPECT_EQ(files, 3U);
  const auto named = [&](const std::string& link) {
    const auto found = matchesOf(linkOf(link), "<mesh filename=\"([^\"]*)\"/>");
    EXPECT_EQ(found.size(), 2U) << "visual and collision";
    return folder_.path() / found.at(0)[1];
  };
  EXPECT_EQ(named("Ring"), named("Third ring"));
  const ImportedMesh box = importMesh(named("Box"), {});
  EXPECT_NEAR(box.mesh.bounds().upper.x, 0.05, 1e-8);
  EXPECT_NEAR(box.mesh.bounds().lower.z, -0.15, 1e-8);
  EXPECT_EQ(box.mesh.triangles().size(), 12U);
}

TEST_F(UrdfExportTest, AnOlderFileKeepsItsMeshes) {
  write();
  const auto before = result_.meshes;
  Part box = model_.scene.get(model_.box);
  box.geometry = test::solidGeometryOf(test::boxMesh({0.2, 0.2, 0.2}));
  model_.scene.replace(box);
  write();
  for (const auto& mesh : before)
    EXPECT_TRUE(std::filesystem::exists(mesh));
  EXPECT_EQ(before.back(), result_.meshes.back()) << "the square";
  EXPECT_NE(before[1], result_.meshes[1]) << "the box";
}

TEST_F(UrdfExportTest, MassIsWrittenWhereADensityIsSetAndTheMeshHasAVolume) {
  Part box = model_.scene.get(model_.box);
  box.density = 2000.0;
  model_.scene.replace(box);
  Part square = model_.scene.get(model_.square);
  square.density = 2000.0;
  model_.scene.replace(square);
  write();
  const auto numbers =
      matchesOf(linkOf("Box"),
                "<inertial><origin xyz=\"([^\"]*)\" rpy=\"0 0 0\"/><mass value=\"([^\"]*)\"/>"
                "<inertia ixx=\"([^\"]*)\" ixy=\"([^\"]*)\" ixz=\"([^\"]*)\" iyy=\"([^\"]*)\" "
                "iyz=\"([^\"]*)\" izz=\"([^\"]*)\"/></inertial>");
  ASSERT_EQ(numbers.size(), 1U);
  // 0.1 by 0.2 by 0.3 m.
  const double mass = 12.0;
  EXPECT_NEAR(std::stod(numbers[0][2]), mass, 1e-9);
  EXPECT_NEAR(std::stod(numbers[0][3]), mass / 12.0 * (0.04 + 0.09), 1e-9);
  EXPECT_NEAR(std::stod(numbers[0][6]), mass / 12.0 * (0.01 + 0.09), 1e-9);
  EXPECT_NEAR(std::stod(numbers[0][8]), mass / 12.0 * (0.01 + 0.04), 1e-9);
  EXPECT_NEAR(std::stod(numbers[0][4]), 0.0, 1e-12);
  EXPECT_THAT(linkOf("Third ring"), Not(HasSubstr("inertial"))) << "no density is set";
  EXPECT_THAT(linkOf("Square"), Not(HasSubstr("inertial"))) << "it has no volume";
}

TEST_F(UrdfExportTest, ColoursAreMaterialsThatPartsShare) {
  write();
  EXPECT_THAT(text_, HasSubstr("<color rgba=\"0.25 0.5 0.75 1\"/>"));
  EXPECT_THAT(text_, HasSubstr("<color rgba=\"1 0 0 0.5\"/>"));
  const auto materialOf = [&](const std::string& link) {
    return matchesOf(linkOf(link), "<material name=\"([^\"]*)\"/>").at(0)[1];
  };
  EXPECT_NE(materialOf("Ring"), materialOf("Third ring"));
}

TEST_F(UrdfExportTest, CancellingKeepsTheOldFile) {
  folder_.write("fit one.urdf", "old");
  EXPECT_THROW(exportUrdf(model_.scene, chosenParts(model_.scene, {}), file_, [](double) { return false; }),
               Cancelled);
  EXPECT_THROW(exportUrdf(model_.scene, {}, file_), UsageError);
  EXPECT_EQ(test::readBytes(file_), "old");
}

void expectSameRotation(const glm::dquat& q) {
  const auto [roll, pitch, yaw] = rollPitchYaw(q);
  EXPECT_LE(std::abs(pitch), std::numbers::pi / 2 + 1e-15);
  EXPECT_LE(std::max(std::abs(roll), std::abs(yaw)), std::numbers::pi + 1e-15);
  EXPECT_LT(test::differenceOf(matrixOf({}, {roll, pitch, yaw}), test::matrixOf({q, {}})), 1e-14)
      << q.w << ' ' << q.x << ' ' << q.y << ' ' << q.z;
}

TEST(RollPitchYaw, IsTheSameRotation) {
  test::RandomValues random(5);
  for (int i = 0; i < 1000; ++i)
    expectSameRotation(random.pose().normalized().rotation);
  for (const glm::dquat& q : {glm::dquat(1, 0, 0, 0), glm::dquat(0, 1, 0, 0), glm::dquat(0, 0, 1, 0),
                              glm::dquat(0, 0, 0, 1), glm::dquat(-1, 0, 0, 0)})
    expectSameRotation(q);
}

TEST(RollPitchYaw, IsAsExactWhereThePitchIsARightAngle) {
  test::RandomValues random(6);
  for (const double sign : {-1.0, 1.0}) {
    for (const double off : {0.0, 1e-16, 1e-12, 1e-9, 1e-8, 1e-6, 1e-3}) {
      const double half = sign * (std::numbers::pi / 2 - off) / 2;
      for (int i = 0; i < 50; ++i) {
        const double roll = random.pose().translation.x, yaw = random.pose().translation.x;
        const glm::dquat q = glm::dquat(std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)) *
                             glm::dquat(std::cos(half), 0, std::sin(half), 0) *
                             glm::dquat(std::cos(roll / 2), std::sin(roll / 2), 0, 0);
        expectSameRotation(RigidTransform{q, {}}.normalized().rotation);
      }
    }
  }
}

}  // namespace
}  // namespace nearfit::urdf_export_test
