#include "core/scene/scene_file.h"

#include <bit>
#include <filesystem>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/temporary_folder.h"

namespace nearfit {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

void expectSameScene(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.parts().size(), b.parts().size());
  for (std::size_t i = 0; i < a.parts().size(); ++i) {
    const Part &p = *a.parts()[i], &q = *b.parts()[i];
    EXPECT_EQ(p.name, q.name);
    EXPECT_EQ(p.worldFromPart.rotation, q.worldFromPart.rotation);
    EXPECT_EQ(p.worldFromPart.translation, q.worldFromPart.translation);
    EXPECT_EQ(p.colour, q.colour);
    EXPECT_EQ(p.isVisible, q.isVisible);
    EXPECT_EQ(p.isLocked, q.isLocked);
    EXPECT_EQ(p.geometry->file, q.geometry->file);
    EXPECT_EQ(p.geometry->sha256, q.geometry->sha256);
    EXPECT_EQ(p.geometry->metresPerUnit, q.geometry->metresPerUnit);
    EXPECT_EQ(a.movingPart() == p.id, b.movingPart() == q.id);
  }
  EXPECT_EQ(a.springs().cutoff, b.springs().cutoff);
  EXPECT_EQ(a.springs().stiffness, b.springs().stiffness);
  EXPECT_EQ(a.springs().damping, b.springs().damping);
  EXPECT_EQ(a.springs().law, b.springs().law);
}

class SceneFile : public ::testing::Test {
 protected:
  SceneFile() {
    std::filesystem::create_directory(folder_.path() / "meshes");
    const auto hole = folder_.write("meshes/hole.obj", test::objText(test::boxMesh({2, 2, 1})));
    const auto peg = folder_.write("meshes/peg.obj", test::objText(test::tetrahedronMesh(1)));
    Part part;
    part.geometry = loadPartGeometry(hole, 0.001);
    part.name = "Hole \xC3\xA4";
    part.isLocked = true;
    scene_.add(part);
    part.geometry = loadPartGeometry(peg, 0.0254);
    part.name = "Peg";
    part.isLocked = false;
    part.colour = {0.1F, 0.2F, 0.3F};
    part.worldFromPart = {{0.5, -0.5, 0.5, 0.5}, {0.1, -1e-17, 123456.789012345}};
    scene_.setMovingPart(scene_.add(part));
    part.isVisible = false;
    scene_.add(part);
    scene_.setSprings({0.1 + 0.2, 1e6 / 3, 0.7, SpringLaw::Linear});
    writeSceneFile(scene_, file_);
    json_ = Json::parse(test::readBytes(file_));
  }

  /// What reading the file gives when it holds this; "" when it is a scene.
  std::string errorOf(const std::string& text) {
    folder_.write("fit.nearfit", text);
    try {
      readSceneFile(file_);
    } catch (const FileError& e) {
      return e.what();
    }
    return "";
  }
  std::string errorWith(const std::string& pointer, const Json& value) {
    Json json = json_;
    json[Json::json_pointer(pointer)] = value;
    return errorOf(json.dump());
  }
  std::string errorWithout(const std::string& pointer, const std::string& key) {
    Json json = json_;
    json[Json::json_pointer(pointer)].erase(key);
    return errorOf(json.dump());
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "fit.nearfit";
  Scene scene_;
  Json json_;
};

TEST_F(SceneFile, SceneComesBackAsItWas) {
  expectSameScene(readSceneFile(file_), scene_);
}

TEST_F(SceneFile, SavingWhatWasReadGivesTheSameBytes) {
  const std::string first = test::readBytes(file_);
  writeSceneFile(readSceneFile(file_), file_);
  EXPECT_EQ(test::readBytes(file_), first);
}

TEST_F(SceneFile, FileSaysVersionUnitsAndRelativePaths) {
  EXPECT_EQ(json_["nearfit"], 1);
  EXPECT_EQ(json_["units"]["length"], "m");
  EXPECT_EQ(json_["moving"], "Peg");
  EXPECT_EQ(json_["parts"][0]["mesh"], "meshes/hole.obj");
  EXPECT_EQ(json_["parts"][0]["metresPerUnit"], 0.001);
  EXPECT_EQ(json_["parts"][1]["position"], Json({0.1, -1e-17, 123456.789012345}));
  EXPECT_EQ(json_["parts"][1]["quaternion"], Json({0.5, -0.5, 0.5, 0.5}));
  EXPECT_EQ(json_["parts"][1]["colour"], Json({0.1, 0.2, 0.3}));
  EXPECT_EQ(json_["parts"][2]["name"], "Peg 2");
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
        RigidTransform{q, scale * glm::dvec3(uniform(random), uniform(random), uniform(random))}.normalized();
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

TEST_F(SceneFile, MissingFileIsToldByName) {
  EXPECT_THROW(readSceneFile(folder_.path() / "none.nearfit"), FileError);
  EXPECT_THROW(readSceneFile(folder_.path()), FileError);
}

TEST_F(SceneFile, UnknownVersionSaysWhichOneThisProgramReads) {
  EXPECT_THAT(errorWith("/nearfit", 2), AllOf(HasSubstr("fit.nearfit: nearfit: "), HasSubstr("version 2"),
                                              HasSubstr("reads version 1"), HasSubstr("newer Nearfit")));
  EXPECT_THAT(errorWith("/nearfit", "1"), HasSubstr("nearfit: it is of type string"));
  EXPECT_THAT(errorOf(R"({"asset": {"version": "2.0"}})"), HasSubstr("no Nearfit scene"));
  EXPECT_THAT(errorOf("[]"), HasSubstr("it is of type array where an object is wanted"));
}

TEST_F(SceneFile, MissingMeshSaysWhichFileAndPart) {
  std::filesystem::remove(folder_.path() / "meshes/peg.obj");
  EXPECT_THAT(errorOf(json_.dump()), AllOf(HasSubstr("fit.nearfit: parts[1].mesh: "),
                                           HasSubstr("meshes/peg.obj is missing; put it back")));
}

TEST_F(SceneFile, ChangedMeshSaysSoAndWhatToDo) {
  folder_.write("meshes/peg.obj", test::objText(test::tetrahedronMesh(2)));
  EXPECT_THAT(errorOf(json_.dump()), AllOf(HasSubstr("fit.nearfit: parts[1].sha256: "),
                                           HasSubstr("SHA-256 differs"), HasSubstr("put the old file back")));
  folder_.write("meshes/peg.obj", "no mesh at all");
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("SHA-256 differs"));
}

TEST_F(SceneFile, PartsThatShareAMeshMustAgreeOnItsHash) {
  EXPECT_THAT(errorWith("/parts/2/sha256", std::string(64, '0')), HasSubstr("parts[2].sha256: "));
}

TEST_F(SceneFile, MalformedFileIsToldByLineAndColumn) {
  std::string text = test::readBytes(file_);
  const std::size_t colon = text.find(':', text.find('\n', text.find('\n') + 1));
  text[colon] = ';';
  const std::size_t column = colon - text.rfind('\n', colon);
  EXPECT_THAT(errorOf(text),
              HasSubstr("fit.nearfit:3:" + std::to_string(column) + ": this is not valid JSON"));
}

TEST_F(SceneFile, EveryFieldIsCheckedAndNamed) {
  const std::string longName(300, 'x');
  const std::vector<std::tuple<std::string, Json, std::string>> faults = {
      {"/units", 1, "units: it is of type number"},
      {"/units/length", "mm", "units.length: this unit is not known; give values in m"},
      {"/springs/cutoff", 0, "springs.cutoff: 0 m is out of range"},
      {"/springs/cutoff", "1", "springs.cutoff: it is of type string"},
      {"/springs/stiffness", -1, "springs.stiffness: -1 N/m is out of range"},
      {"/springs/damping", 1e300, "springs.damping: 1e+300 N s/m is out of range"},
      {"/springs/law", "cubic", "springs.law: this law is not known"},
      {"/moving", 3, "moving: it is of type number"},
      {"/moving", "Pin", "moving: there is no part \"Pin\""},
      {"/moving", "Hole \xC3\xA4", "moving: this part is locked"},
      {"/parts", nullptr, "parts: it is of type null where an array is wanted"},
      {"/parts/1", 7, "parts[1]: it is of type number where an object is wanted"},
      {"/parts/1/name", "", "parts[1].name: a part's name is empty"},
      {"/parts/1/name", "a\nb", "parts[1].name: a part's name holds control characters"},
      {"/parts/1/name", longName, "parts[1].name: it is longer than 200 bytes"},
      {"/parts/2/name", "Peg", "parts[2].name: parts[1] has the same name"},
      {"/parts/1/mesh", "", "parts[1].mesh: it is empty"},
      {"/parts/1/mesh", std::string("meshes/peg.obj\0.stl", 19), "parts[1].mesh: it holds a NUL character"},
      {"/parts/1/mesh", std::string(5000, 'x'), "parts[1].mesh: it is longer than 4095 bytes"},
      {"/parts/1/mesh", std::string(4000, 'x'), "parts[1].mesh: the mesh file"},
      {"/parts/1/mesh", "..", "parts[1].mesh: "},
      {"/parts/1/mesh", "/dev/zero", "parts[1].mesh: /dev/zero: "},
      {"/parts/1/sha256", "abc", "parts[1].sha256: it is no SHA-256"},
      {"/parts/1/sha256", std::string(64, 'g'), "parts[1].sha256: it is no SHA-256"},
      {"/parts/1/metresPerUnit", 0, "parts[1].metresPerUnit: 0 metres to the unit is out of range"},
      {"/parts/1/position", {0, 0}, "parts[1].position: it has 2 numbers where 3 are wanted"},
      {"/parts/1/position", {0, 0, "1"}, "parts[1].position[2]: it is of type string"},
      {"/parts/1/position", {0, 0, 1e10}, "parts[1].position: a coordinate is 10000000000 m"},
      {"/parts/1/quaternion", {0, 0, 0, 0}, "parts[1].quaternion: its length is 0, not 1"},
      {"/parts/1/quaternion", {1, 1, 0, 0}, "parts[1].quaternion: its length is 1.414"},
      {"/parts/1/quaternion", {1e200, 0, 0, 0}, "parts[1].quaternion: its length is inf"},
      {"/parts/1/colour", {0, 0, 1.5}, "parts[1].colour[2]: 1.5 is out of range"},
      {"/parts/1/colour", "#ffffff", "parts[1].colour: it is of type string"},
      {"/parts/1/visible", 1, "parts[1].visible: it is of type number where true or false is wanted"},
      {"/parts/1/locked", "no", "parts[1].locked: it is of type string"},
  };
  for (const auto& [pointer, value, message] : faults) {
    const std::string error = errorWith(pointer, value);
    EXPECT_NE(error, "") << pointer;
    EXPECT_THAT(error, HasSubstr(message));
    EXPECT_THAT(error, HasSubstr("fit.nearfit"));
  }
}

TEST_F(SceneFile, EveryKeyIsNeeded) {
  for (const auto& [key, value] : json_.items())
    EXPECT_NE(errorWithout("", key), "") << key;
  for (const auto& [key, value] : json_["springs"].items()) {
    EXPECT_THAT(errorWithout("/springs", key), HasSubstr("springs." + key + ": it is missing"));
  }
  for (const auto& [key, value] : json_["parts"][2].items()) {
    EXPECT_THAT(errorWithout("/parts/2", key), HasSubstr("parts[2]." + key + ": it is missing"));
  }
}

TEST_F(SceneFile, QuaternionOfFourDigitsIsNormalised) {
  EXPECT_EQ(errorWith("/parts/1/quaternion", {0.7071, 0, 0.7071, 0}), "");
  EXPECT_NEAR(readSceneFile(file_).parts()[1]->worldFromPart.rotation.w, std::sqrt(0.5), 1e-15);
}

TEST_F(SceneFile, TooBigAFileIsRefused) {
  EXPECT_THAT(errorOf(std::string(kMaxSceneFileBytes + 1, ' ')), HasSubstr("bigger than"));
}

TEST_F(SceneFile, TooManyPartsAreRefused) {
  json_["parts"] = Json::array();
  for (std::size_t i = 0; i <= kMaxSceneFileParts; ++i)
    json_["parts"].push_back(0);
  EXPECT_THAT(errorOf(json_.dump()), HasSubstr("parts: there are more than 10000 parts"));
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

TEST_F(SceneFile, EveryPrefixIsRefused) {
  const std::string text = test::readBytes(file_);
  for (std::size_t length = 0; length + 2 < text.size(); ++length) {
    ASSERT_NE(errorOf(text.substr(0, length)), "") << length << " bytes";
  }
}

TEST_F(SceneFile, FlippedBytesGiveAnErrorOrAScene) {
  const std::string text = test::readBytes(file_);
  std::mt19937 random(17);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = text;
    for (auto flips = 1 + random() % 3; flips > 0; --flips) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    // Anything but a scene or a FileError ends the test.
    ASSERT_NO_THROW(errorOf(damaged)) << damaged;
  }
}

TEST_F(SceneFile, HostileValuesInAnyPlaceGiveAnErrorOrAScene) {
  const Json flat = json_.flatten();
  std::vector<std::string> places{"", "/parts", "/parts/1", "/units", "/springs", "/parts/1/position"};
  for (const auto& [pointer, value] : flat.items())
    places.push_back(pointer);
  const std::vector<Json> hostile = {nullptr,
                                     true,
                                     -1,
                                     0,
                                     1e308,
                                     -1e-320,
                                     std::numeric_limits<std::uint64_t>::max(),
                                     "",
                                     std::string(1, '\0'),
                                     "../../../../../../etc/passwd",
                                     "/proc/self/mem",
                                     ".",
                                     std::string(100'000, 'A'),
                                     Json::array(),
                                     Json::object(),
                                     Json::array({Json::array()}),
                                     {{"nearfit", 1}}};
  for (const std::string& place : places) {
    for (const Json& value : hostile)
      ASSERT_NO_THROW(errorWith(place, value)) << place << " = " << value.dump();
  }
}

TEST_F(SceneFile, WriteErrorLeavesTheOldFile) {
  const std::string before = test::readBytes(file_);
  EXPECT_THROW(writeSceneFile(scene_, folder_.path() / "none/fit.nearfit"), FileError);
  EXPECT_THROW(writeSceneFile(scene_, folder_.path()), FileError);
  EXPECT_EQ(test::readBytes(file_), before);
}

TEST_F(SceneFile, MeshPathThatIsNotUtf8IsToldWhenSaving) {
  const auto odd = folder_.write("odd\xFF.obj", test::objText(test::tetrahedronMesh(1)));
  Part part;
  part.name = "Odd";
  part.geometry = loadPartGeometry(odd, 1.0);
  scene_.add(part);
  try {
    writeSceneFile(scene_, file_);
    FAIL() << "a path that is not UTF-8 was written";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("odd\\xff.obj"), HasSubstr("not UTF-8")));
  }
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
}  // namespace nearfit
