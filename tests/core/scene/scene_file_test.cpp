#include "core/scene/scene_file.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/scene/scene_tree.h"
#include "core/session/session.h"
#include "tests/core/scene/scene_file_fixture.h"
#include "tests/support/trial_share.h"

namespace nearfit::scene_file_test {
namespace {

using Json = nlohmann::json;
class SceneFile : public test::SceneFileFixture {};

/// How many parts the tests of many have.
constexpr int kMany = 10'000 / test::kTrialShare;

/// Where a group stands, as the names from the top down.
std::string pathOf(const Scene& scene, std::optional<GroupId> id) {
  const Group* group = id ? scene.findGroup(*id) : nullptr;
  return group == nullptr ? "" : pathOf(scene, group->parent) + "/" + group->name;
}

void expectSameGroups(const Scene& a, const Scene& b) {
  const auto listOf = [](const Scene& scene) {
    std::vector<std::string> list;
    visitGroups(scene, [&](const Group& group, std::size_t depth) {
      list.push_back(pathOf(scene, group.id) + (group.isLocked ? " locked " : " ") + std::to_string(depth));
    });
    return list;
  };
  EXPECT_EQ(listOf(a), listOf(b));
}

std::string nameOf(const Scene& scene, std::optional<PartId> id) {
  return id ? scene.get(*id).name : "the world";
}

void expectSameJoints(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.joints().size(), b.joints().size());
  for (std::size_t i = 0; i < a.joints().size(); ++i) {
    const Joint &p = a.joints()[i], &q = b.joints()[i];
    EXPECT_EQ(p.kind, q.kind) << i;
    EXPECT_EQ(p.isOn, q.isOn) << i;
    EXPECT_TRUE(p.onPart == q.onPart && p.onBase == q.onBase) << i;
    EXPECT_EQ(nameOf(a, p.part), nameOf(b, q.part)) << i;
    EXPECT_EQ(nameOf(a, p.base), nameOf(b, q.base)) << i;
  }
}

void expectSamePairs(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.pairRules(), b.pairRules());
  ASSERT_EQ(a.pairRecords().size(), b.pairRecords().size());
  for (std::size_t i = 0; i < a.pairRecords().size(); ++i) {
    PairRecord p = a.pairRecords()[i];
    const PairRecord& q = b.pairRecords()[i];
    EXPECT_EQ(nameOf(a, p.pair.part), nameOf(b, q.pair.part)) << i;
    EXPECT_EQ(nameOf(a, p.pair.other), nameOf(b, q.pair.other)) << i;
    p.pair = q.pair;
    EXPECT_TRUE(p == q) << i;
  }
}

void expectSameScene(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.parts().size(), b.parts().size());
  for (std::size_t i = 0; i < a.parts().size(); ++i) {
    const Part &p = *a.parts()[i], &q = *b.parts()[i];
    EXPECT_EQ(p.name, q.name);
    EXPECT_EQ(p.worldFromPart.rotation, q.worldFromPart.rotation);
    EXPECT_EQ(p.worldFromPart.translation, q.worldFromPart.translation);
    EXPECT_EQ(p.colour, q.colour);
    EXPECT_EQ(p.density, q.density);
    EXPECT_EQ(p.isVisible, q.isVisible);
    EXPECT_EQ(p.isLocked, q.isLocked);
    EXPECT_EQ(p.opacity, q.opacity);
    EXPECT_EQ(p.pivot, q.pivot);
    EXPECT_EQ(p.wasVisible, q.wasVisible);
    EXPECT_EQ(pathOf(a, p.group), pathOf(b, q.group));
    EXPECT_EQ(p.geometry->file, q.geometry->file);
    EXPECT_EQ(p.geometry->sha256, q.geometry->sha256);
    EXPECT_EQ(p.geometry->metresPerUnit, q.geometry->metresPerUnit);
    EXPECT_TRUE(p.geometry->repairs == q.geometry->repairs) << p.name;
    EXPECT_EQ(p.geometry->shapeKey, q.geometry->shapeKey);
    EXPECT_EQ(p.geometry->tessellation, q.geometry->tessellation);
    EXPECT_EQ(a.movingPart() == p.id, b.movingPart() == q.id);
  }
  EXPECT_TRUE(a.haptics() == b.haptics());
  expectSameGroups(a, b);
  expectSameJoints(a, b);
  expectSamePairs(a, b);
}

TEST_F(SceneFile, ManyPartsOfOneMeshHaveOneGeometry) {
  Json json = json_;
  Json part = json["parts"][1];
  json["parts"] = json["joints"] = Json::array();
  json["moving"] = nullptr;
  for (int i = 0; i < kMany; ++i) {
    part["name"] = "Peg " + std::to_string(i);
    json["parts"].push_back(part);
  }
  folder_.write("fit.nearfit", json.dump());
  int reports = 0;
  const Scene scene = readSceneFile(file_, [&](double) { return ++reports > 0; });
  const std::vector<PartGeometryPtr> geometries = scene.geometries();
  ASSERT_EQ(geometries.size(), std::size_t{kMany});
  for (const PartGeometryPtr& geometry : geometries)
    ASSERT_EQ(geometry, geometries.front());
  // One mesh of four faces was read, and its hierarchy is built once: tens of reports, not tens of thousands.
  prepareHierarchies(geometries, [&](double) { return ++reports > 0; });
  EXPECT_LT(reports, 1000);
  EXPECT_TRUE(areHierarchiesReady(geometries));
}

TEST_F(SceneFile, MeshesThatHaveChangedAreListedOnceEach) {
  constexpr int kMeshes = 100, kParts = kMany;
  const std::filesystem::path meshes = folder_.path() / "meshes";
  for (int i = 0; i < kMeshes; ++i)
    std::filesystem::create_hard_link(meshes / "peg.obj", meshes / (std::to_string(i) + ".obj"));
  Json json = json_;
  Json part = json["parts"][1];
  json["parts"] = json["joints"] = Json::array();
  json["moving"] = nullptr;
  part["sha256"] = std::string(64, '0');
  for (int i = 0; i < kParts; ++i) {
    part["name"] = "Peg " + std::to_string(i);
    part["mesh"] = "meshes/" + std::to_string(i % kMeshes) + ".obj";
    json["parts"].push_back(part);
  }
  folder_.write("fit.nearfit", json.dump());
  std::vector<std::filesystem::path> changed;
  EXPECT_EQ(readSceneFile(file_, {}, &changed).parts().size(), std::size_t{kParts});
  EXPECT_EQ(changed.size(), std::size_t{kMeshes});
}

TEST_F(SceneFile, SceneComesBackAsItWas) {
  expectSameScene(readSceneFile(file_), scene_);
}

TEST_F(SceneFile, SavingWhatWasReadGivesTheSameBytes) {
  const std::string first = test::readBytes(file_);
  writeSceneFile(readSceneFile(file_), file_);
  EXPECT_EQ(test::readBytes(file_), first);
}

TEST_F(SceneFile, FileSaysVersionUnitsAndRelativePaths) {
  EXPECT_EQ(json_["nearfit"], 7);
  EXPECT_EQ(json_["units"]["length"], "m");
  EXPECT_EQ(json_["moving"], "Peg");
  EXPECT_EQ(json_["movingGroup"], nullptr);
  EXPECT_EQ(json_["parts"][0]["mesh"], "meshes/hole.obj");
  EXPECT_EQ(json_["parts"][0]["metresPerUnit"], 0.001);
  EXPECT_EQ(json_["parts"][1]["position"], Json({0.1, -1e-17, 123456.789012345}));
  EXPECT_EQ(json_["parts"][1]["quaternion"], Json({0.5, -0.5, 0.5, 0.5}));
  EXPECT_EQ(json_["parts"][1]["colour"], Json({0.1, 0.2, 0.3}));
  EXPECT_EQ(json_["parts"][2]["name"], "Peg 2");
  EXPECT_EQ(json_["parts"][0]["density"], 1000.0);
  EXPECT_EQ(json_["parts"][1]["density"], 7850.1);
}

TEST_F(SceneFile, FileSaysGroupsByTheirNumberAndTheLook) {
  const Json expected = Json::parse(R"([{"name": "Spare", "group": null, "locked": true},
                                        {"name": "Frame \u00e4", "group": null, "locked": false},
                                        {"name": "Pegs", "group": 1, "locked": false}])");
  EXPECT_EQ(json_["groups"], expected);
  EXPECT_EQ(json_["parts"][0]["group"], nullptr);
  EXPECT_EQ(json_["parts"][1]["group"], 2);
  EXPECT_EQ(json_["parts"][2]["group"], 0);
  EXPECT_EQ(json_["parts"][0]["opacity"], 1.0);
  EXPECT_EQ(json_["parts"][1]["opacity"], 0.30000000000000004);
  EXPECT_EQ(json_["parts"][0]["wasVisible"], false);
  EXPECT_EQ(json_["parts"][1]["wasVisible"], true);
  EXPECT_EQ(json_["parts"][2]["wasVisible"], nullptr);
}

TEST_F(SceneFile, GroupsThatWerePutIntoLaterOnesComeBack) {
  const GroupId pegs = *scene_.parts()[1]->group;
  const GroupId late = scene_.addGroup({{}, "Late", {}, false});
  Group frame = *scene_.findGroup(*scene_.findGroup(pegs)->parent);
  frame.parent = late;
  scene_.replaceGroup(frame);
  writeSceneFile(scene_, file_);
  expectSameScene(readSceneFile(file_), scene_);
}

TEST_F(SceneFile, IsolationIsTakenBackExactlyAfterReading) {
  Session session;
  session.reset(readSceneFile(file_), file_);
  session.endIsolation();
  const auto& parts = session.scene().parts();
  EXPECT_TRUE(!parts[0]->isVisible && parts[1]->isVisible && !parts[2]->isVisible);
}

TEST_F(SceneFile, FileSaysPivotsInTheirPartsFrames) {
  EXPECT_EQ(json_["parts"][0]["pivot"], nullptr);
  EXPECT_EQ(json_["parts"][1]["pivot"], Json({0.30000000000000004, -1e-17, 1e9}));
}

TEST_F(SceneFile, FileSaysJointsByTheNamesOfTheirParts) {
  const Json expected = Json::parse(R"([
    {"kind": "axis", "part": "Peg", "base": "Hole \u00e4", "on": true,
     "onPart": {"point": [0.30000000000000004, -1e-17, 1e9], "direction": [0.6, 0.0, 0.8]},
     "onBase": {"point": [0.3333333333333333, 2.0, 3.0], "direction": [0.0, -1.0, 0.0]}},
    {"kind": "plane", "part": "Hole \u00e4", "base": "Peg", "on": true,
     "onPart": {"point": [0.30000000000000004, -1e-17, 1e9], "direction": [0.6, 0.0, 0.8]},
     "onBase": {"point": [0.3333333333333333, 2.0, 3.0], "direction": [0.0, -1.0, 0.0]}},
    {"kind": "point", "part": "Peg 2", "base": null, "on": false,
     "onPart": {"point": [0.30000000000000004, -1e-17, 1e9]},
     "onBase": {"point": [0.3333333333333333, 2.0, 3.0]}}
  ])");
  EXPECT_EQ(json_["joints"], expected);
}

TEST_F(SceneFile, FileSaysRulesByPatternsAndRecordsByTheNumbersOfTheirParts) {
  Json rules = Json::parse(R"([
    {"kind": "leaveOut", "part": "Peg*", "other": "Hole \u00e4", "interference": 0.0},
    {"kind": "sameGroup", "part": "*", "other": "*", "interference": 0.0},
    {"kind": "touching", "part": "\\*", "other": "?", "interference": 0.0},
    {"kind": "pressFit", "part": "Peg", "other": "*"}
  ])");
  rules[3]["interference"] = 1e-5 / 3.0;
  EXPECT_EQ(json_["pairRules"], rules);
  Json records = Json::parse(R"([
    {"part": 0, "other": 1, "verdict": "clash", "distance": 0.0, "state": "accepted", "reason": "fits \u00e4"},
    {"part": 1, "other": 2, "verdict": "near", "distance": 0.30000000000000004, "depth": null, "state": "new",
     "reason": ""}
  ])");
  records[0]["depth"] = 1e-4 / 3.0;
  EXPECT_EQ(json_["pairRecords"], records);
}

TEST_F(SceneFile, AMovingGroupIsSavedByItsNumberAndComesBack) {
  const GroupId pegs = *scene_.parts()[1]->group;
  scene_.setMovingGroup(*scene_.findGroup(pegs)->parent);
  writeSceneFile(scene_, file_);
  const Json json = Json::parse(test::readBytes(file_));
  EXPECT_EQ(json["moving"], nullptr);
  EXPECT_EQ(json["movingGroup"], 1);
  const Scene scene = readSceneFile(file_);
  expectSameScene(scene, scene_);
  ASSERT_TRUE(scene.movingGroup());
  EXPECT_EQ(scene.findGroup(*scene.movingGroup())->name, "Frame \xC3\xA4");
  EXPECT_EQ(scene.get(*scene.movingPart()).name, "Peg");
}

TEST_F(SceneFile, FileSaysTheRepairsOfEachPart) {
  Json expected = Json::parse(R"([{"kind": "weld"}, {"kind": "orient", "size": 0.0}])");
  expected[0]["size"] = 1e-5 / 3.0;
  EXPECT_EQ(json_["parts"][0]["repairs"], expected);
  EXPECT_EQ(json_["parts"][1]["repairs"], Json::array());
}

TEST_F(SceneFile, RepairsAreMadeToWhatIsReadAndTheFileStays) {
  // A tetrahedron without one of its faces.
  const TriangleMesh whole = test::tetrahedronMesh(1);
  const std::string text = test::objText({{whole.vertices().begin(), whole.vertices().end()},
                                          {whole.triangles().begin(), whole.triangles().end() - 1}});
  const std::filesystem::path mesh = folder_.write("meshes/open.obj", text);
  const GeometryRepair repair = repairGeometry(*loadPartGeometry(mesh, 1.0), {{RepairKind::FillHoles, 10.0}});
  ASSERT_NE(repair.geometry, nullptr);
  Scene scene;
  Part part;
  part.name = "Closed";
  part.geometry = repair.geometry;
  scene.add(part);
  part.name = "Open";
  part.geometry = loadPartGeometry(mesh, 1.0);
  scene.add(part);
  writeSceneFile(scene, file_);
  const Scene read = readSceneFile(file_);
  expectSameScene(read, scene);
  EXPECT_TRUE(read.findByName("Closed")->geometry->mesh.topology().isClosed());
  EXPECT_EQ(read.findByName("Open")->geometry->mesh.topology().openEdges, 3U);
  EXPECT_TRUE(std::ranges::equal(read.findByName("Closed")->geometry->mesh.triangles(),
                                 repair.geometry->mesh.triangles()));
  EXPECT_EQ(test::readBytes(mesh), text);
}

TEST_F(SceneFile, Version6KeepsAllThatItSaysAndHasNoRulesOrRecordsOfPairs) {
  EXPECT_EQ(errorOf(version6().dump()), "");
  const Scene scene = readSceneFile(file_);
  EXPECT_TRUE(scene.pairRules().empty() && scene.pairRecords().empty());
  dropPairs();
  EXPECT_EQ(errorOf(json_.dump()), "");
  expectSameScene(scene, readSceneFile(file_));
}

TEST_F(SceneFile, Version5KeepsAllThatItSaysAndHasNoShapesRepairsOrMovingGroup) {
  EXPECT_EQ(errorOf(version5().dump()), "");
  const Scene scene = readSceneFile(file_);
  dropRepairs();
  dropPairs();
  EXPECT_EQ(errorOf(json_.dump()), "");
  expectSameScene(scene, readSceneFile(file_));
  EXPECT_FALSE(scene.movingGroup());
}

TEST_F(SceneFile, Version4KeepsAllThatItSaysAndHasNoJoints) {
  EXPECT_EQ(errorOf(version4().dump()), "");
  const Scene scene = readSceneFile(file_);
  EXPECT_TRUE(scene.joints().empty());
  dropRepairs();
  dropPairs();
  json_["joints"] = Json::array();
  EXPECT_EQ(errorOf(json_.dump()), "");
  expectSameScene(scene, readSceneFile(file_));
}

TEST_F(SceneFile, Version3KeepsAllThatItSaysAndTurnsAboutCentresOfMass) {
  EXPECT_EQ(errorOf(version3().dump()), "");
  const Scene scene = readSceneFile(file_);
  for (Json& part : json_["parts"])
    part["pivot"] = nullptr;
  dropRepairs();
  dropPairs();
  json_["joints"] = Json::array();
  EXPECT_EQ(errorOf(json_.dump()), "");
  expectSameScene(scene, readSceneFile(file_));
  for (const Scene::PartPtr& part : scene.parts())
    EXPECT_FALSE(part->pivot) << part->name;
}

TEST_F(SceneFile, Version2KeepsAllThatItSaysAndStandsAtTheTop) {
  EXPECT_EQ(errorOf(version2().dump()), "");
  const Scene scene = readSceneFile(file_);
  EXPECT_TRUE(scene.groups().empty());
  ASSERT_EQ(scene.parts().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    Part expected = *scene_.parts()[i];
    expected.id = scene.parts()[i]->id;
    expected.geometry = scene.parts()[i]->geometry;
    expected.group.reset();
    expected.opacity = 1.0;
    expected.wasVisible.reset();
    expected.pivot.reset();
    EXPECT_TRUE(isSame(*scene.parts()[i], expected)) << i;
  }
  EXPECT_TRUE(scene.haptics() == scene_.haptics());
  EXPECT_EQ(scene.movingPart(), scene.parts()[1]->id);
}

TEST_F(SceneFile, ManyPartsInAsManyGroupsAreWrittenSoThatTheyCanBeRead) {
  Scene scene;
  Part part = *scene_.parts()[1];
  part.name = std::string(100, 'x');
  std::optional<GroupId> group;
  for (int i = 0; i < kMany; ++i) {
    group = scene.addGroup({{}, std::string(100, 'g'), i % 20 == 0 ? std::nullopt : group, false});
    part.group = group;
    part.name = "Part " + std::to_string(i);
    scene.add(part);
  }
  writeSceneFile(scene, file_);
  const Scene read = readSceneFile(file_);
  EXPECT_EQ(read.parts().size(), std::size_t{kMany});
  expectSameGroups(read, scene);
}

TEST_F(SceneFile, FileSaysEverySettingOfTheFeel) {
  const Json expected = Json::parse(R"({
    "mode": "springs",
    "springs": {"cutoff": 0.30000000000000004, "stiffness": 333333.3333333333, "damping": 0.7, "law": "printed"},
    "proxy": {"margin": 0.0003333333333333333, "friction": 0.35},
    "coupling": {"automatic": false, "stiffness": 142.85714285714286, "damping": 0.1,
                 "rotationalStiffness": 0.7999999999999999, "rotationalDamping": 0.0003333333333333333},
    "weight": {"weight": true, "inertia": true, "gravity": [0.1, -9.7, 1e-17]},
    "mapping": {"scale": 12.5, "orientation": [0.5, -0.5, 0.5, 0.5], "translationLocks": [true, false, true],
                "rotationLocks": [false, true, false]}
  })");
  EXPECT_EQ(json_["haptics"], expected);
}

TEST_F(SceneFile, ProxyKeepsTheLawThatTheSpringsHaveBesideIt) {
  // A stiffness that only the printed law allows must come back also while the springs are not in use.
  HapticSettings haptics;
  haptics.springs = {.cutoff = 0.01, .stiffness = 1e9, .damping = 0.0, .law = SpringLaw::Printed};
  scene_.setHaptics(haptics);
  writeSceneFile(scene_, file_);
  expectSameScene(readSceneFile(file_), scene_);
}

TEST_F(SceneFile, OneSpringForEachAreaIsKeptAndAFileWithoutItHasOneForEachMinimum) {
  HapticSettings haptics;
  haptics.springs.onePerArea = true;
  scene_.setHaptics(haptics);
  writeSceneFile(scene_, file_);
  EXPECT_TRUE(readSceneFile(file_).haptics().springs.onePerArea);
  Json json = Json::parse(test::readBytes(file_));
  json["haptics"]["springs"]["onePerArea"] = 1;
  EXPECT_THAT(errorOf(json.dump()), testing::HasSubstr("haptics.springs.onePerArea: it is of type number"));
  json["haptics"]["springs"].erase("onePerArea");
  EXPECT_EQ(errorOf(json.dump()), "");
  EXPECT_FALSE(readSceneFile(file_).haptics().springs.onePerArea);
}

TEST_F(SceneFile, Version1KeepsItsSpringsAndGetsTheRestOfANewScene) {
  EXPECT_EQ(errorOf(version1().dump()), "");
  const Scene scene = readSceneFile(file_);
  HapticSettings expected;
  expected.springs = scene_.haptics().springs;
  expected.proxy.margin = 0.01 * expected.springs.cutoff;
  EXPECT_TRUE(scene.haptics() == expected);
  EXPECT_EQ(scene.haptics().mode, HapticMode::Proxy);
  ASSERT_EQ(scene.parts().size(), 3U);
  for (const Scene::PartPtr& part : scene.parts())
    EXPECT_EQ(part->density, 1000.0);
  EXPECT_EQ(scene.parts()[1]->worldFromPart.translation, scene_.parts()[1]->worldFromPart.translation);
  writeSceneFile(scene, file_);
  EXPECT_EQ(Json::parse(test::readBytes(file_))["nearfit"], 7);
  expectSameScene(readSceneFile(file_), scene);
}

TEST_F(SceneFile, Version1OfAnyCutoffOpens) {
  Json json = version1();
  for (const double cutoff : {1e-7, 1e-3, 1e3}) {
    json["springs"]["cutoff"] = cutoff;
    EXPECT_EQ(errorOf(json.dump()), "") << cutoff;
  }
}

TEST_F(SceneFile, RandomDoublesComeBackBitForBit) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Scene scene;
  Part part = *scene_.parts()[0];
  for (int i = 0; i < 2000; ++i) {
    const glm::dquat q{uniform(random), uniform(random), uniform(random), uniform(random)};
    const double scale = std::exp2(40.0 * uniform(random) - 21.0);
    part.name = "Part " + std::to_string(i);
    part.worldFromPart =
        RigidTransform{q, scale * glm::dvec3{uniform(random), uniform(random), uniform(random)}}.normalized();
    part.colour = {std::abs(static_cast<float>(uniform(random))), 0.0F, 1.0F};
    scene.add(part);
  }
  writeSceneFile(scene, file_);
  expectSameScene(readSceneFile(file_), scene);
}

TEST_F(SceneFile, MeshFileOfSeveralPartsIsLoadedOnceForEachUnit) {
  json_["parts"][2]["mesh"] = "meshes/../meshes/peg.obj";
  json_["parts"].push_back(json_["parts"][2]);
  json_["parts"][3]["name"] = "Big peg";
  json_["parts"][3]["metresPerUnit"] = 1.0;
  folder_.write("fit.nearfit", json_.dump());
  const Scene scene = readSceneFile(file_);
  EXPECT_EQ(scene.parts()[1]->geometry, scene.parts()[2]->geometry);
  EXPECT_NE(scene.parts()[1]->geometry, scene.parts()[3]->geometry);
}

TEST_F(SceneFile, FolderMovesWithItsMeshes) {
  const std::filesystem::path elsewhere = folder_.path() / "elsewhere";
  std::filesystem::create_directory(elsewhere);
  std::filesystem::rename(folder_.path() / "meshes", elsewhere / "meshes");
  std::filesystem::rename(file_, elsewhere / "fit.nearfit");
  const Scene scene = readSceneFile(elsewhere / "fit.nearfit");
  EXPECT_EQ(scene.parts()[0]->geometry->file, std::filesystem::canonical(elsewhere / "meshes/hole.obj"));
}

TEST_F(SceneFile, SceneBehindALinkFindsItsMeshes) {
  std::filesystem::create_directory(folder_.path() / "links");
  const std::filesystem::path link = folder_.path() / "links/fit.nearfit";
  std::filesystem::create_symlink(file_, link);
  const Scene scene = readSceneFile(link);
  EXPECT_EQ(scene.parts().size(), 3U);
  writeSceneFile(scene, link);
  EXPECT_EQ(Json::parse(test::readBytes(file_)), json_);
}

TEST_F(SceneFile, AbsoluteMeshPathsWork) {
  EXPECT_EQ(errorWith("/parts/0/mesh", (folder_.path() / "meshes/hole.obj").string()), "");
}

TEST_F(SceneFile, UnknownKeysAreIgnored) {
  EXPECT_EQ(errorWith("/note", "made by hand"), "");
  EXPECT_EQ(errorWith("/parts/0/material", {{"density", 7850}}), "");
}

TEST_F(SceneFile, QuaternionOfFourDigitsIsNormalised) {
  EXPECT_EQ(errorWith("/parts/1/quaternion", {0.7071, 0, 0.7071, 0}), "");
  EXPECT_NEAR(readSceneFile(file_).parts()[1]->worldFromPart.rotation.w, std::sqrt(0.5), 1e-15);
}

TEST_F(SceneFile, ReadingReportsProgressAndStopsWhenAsked) {
  double last = 0.0;
  readSceneFile(file_, [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0 + 1e-12);
    last = fraction;
    return true;
  });
  EXPECT_NEAR(last, 1.0, 1e-12);
  EXPECT_THROW(readSceneFile(file_, [](double) { return false; }), Cancelled);
}

TEST_F(SceneFile, WriteErrorLeavesTheOldFile) {
  const std::string before = test::readBytes(file_);
  EXPECT_THROW(writeSceneFile(scene_, folder_.path() / "none/fit.nearfit"), FileError);
  EXPECT_THROW(writeSceneFile(scene_, folder_.path()), FileError);
  EXPECT_EQ(test::readBytes(file_), before);
}

TEST_F(SceneFile, SessionSavesAndTakesTheFileAsItsOwn) {
  Session session;
  session.reset(readSceneFile(file_), file_);
  session.movePart(session.scene().parts()[1]->id, {});
  EXPECT_TRUE(session.isModified());
  const std::filesystem::path other = folder_.path() / "other.nearfit";
  EXPECT_THROW(session.save(folder_.path() / "none/x.nearfit"), FileError);
  EXPECT_EQ(session.file(), file_);
  EXPECT_TRUE(session.isModified());
  session.save(other);
  EXPECT_EQ(session.file(), other);
  EXPECT_FALSE(session.isModified());
  expectSameScene(readSceneFile(other), session.scene());
  session.undo();
  EXPECT_TRUE(session.isModified());
  session.redo();
  EXPECT_FALSE(session.isModified());
}

}  // namespace
}  // namespace nearfit::scene_file_test
