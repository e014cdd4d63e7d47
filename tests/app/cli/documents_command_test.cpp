#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/cli/commands.h"
#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/scene/scene_file.h"
#include "tests/support/documents.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::documents_command_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Commands on CAD documents, run in this process: its importer makes them.
class DocumentsCommand : public ::testing::Test {
 protected:
  /// What a command prints. Throws what it throws.
  static std::string output(std::vector<std::string> arguments) {
    CLI::App program;
    cli::addInfoCommand(program);
    cli::addCheckCommand(program);
    cli::addLmdCommand(program);
    cli::addSceneCommand(program);
    program.require_subcommand(1);
    std::ranges::reverse(arguments);
    ::testing::internal::CaptureStdout();
    try {
      program.parse(arguments);
    } catch (...) {
      ::testing::internal::GetCapturedStdout();
      throw;
    }
    return ::testing::internal::GetCapturedStdout();
  }
  static std::string errorOf(const std::vector<std::string>& arguments) {
    try {
      output(arguments);
    } catch (const UsageError& e) {
      return e.what();
    }
    return "";
  }
  std::string path(const char* name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
  FakeImporter importer_;
  std::string vise_ = folder_.write("vise.step", "the vise").string();
  std::string block_ = folder_.write("block.obj", objText(boxMesh({20, 20, 10}))).string();
  std::string scene_ = path("fit.nearfit");
};

TEST_F(DocumentsCommand, InfoShowsShapesTreeAndInstances) {
  const std::string text = output({"info", vise_});
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("unit        the file's own"), HasSubstr("parts       3 of 2 shapes"),
            HasSubstr("shape       body: placed 1 time, 12 triangles, closed, 0.1 x 0.06 x 0.04 m, 6 faces"),
            HasSubstr("shape       pin: placed 2 times"), HasSubstr("chord 0.0001 m"),
            HasSubstr("volume 0.00024 m^3 (exact 0.00024)")));
  EXPECT_THAT(text, HasSubstr("  tree        vise\n"
                              "                body  = body\n"
                              "                jaws\n"
                              "                  pin  = pin\n"
                              "                  pin  = pin\n"
                              "                screws\n"));
}

TEST_F(DocumentsCommand, InfoInJsonHasWhatAScriptNeeds) {
  const std::string text = output({"info", "--json", "--density", "1000", "--chord", "1e-5", vise_});
  ASSERT_EQ(linesOf(text).size(), 1U);
  const Json json = Json::parse(text);
  EXPECT_EQ(json["hasUnit"], true);
  EXPECT_EQ(json["parts"], 3);
  ASSERT_EQ(json["shapes"].size(), 2U);
  const Json &body = json["shapes"][0], &pin = json["shapes"][1];
  EXPECT_EQ(body["key"], "body");
  EXPECT_EQ(body["faces"], 6);
  EXPECT_NEAR(body["mass"].get<double>(), 0.24, 1e-12);
  EXPECT_EQ(pin["instances"], 2);
  EXPECT_NEAR(pin["chord"].get<double>(), 1e-5, 1e-15);
  EXPECT_EQ(json["triangles"]["shapes"], body["triangles"].get<int>() + pin["triangles"].get<int>());
  EXPECT_EQ(json["triangles"]["placed"], body["triangles"].get<int>() + 2 * pin["triangles"].get<int>());
  ASSERT_EQ(json["nodes"].size(), 6U);
  EXPECT_EQ(json["nodes"][0]["parent"], Json());
  EXPECT_EQ(json["nodes"][4]["parent"], 2);
  EXPECT_EQ(json["nodes"][4]["shape"], "pin");
  EXPECT_EQ(json["nodes"][4]["position"], Json({0.0, 0.02, 0.0}));
  EXPECT_EQ(json["nodes"][4]["colour"], Json({0.0, 0.0, 1.0}));
}

TEST_F(DocumentsCommand, InfoOnOneShapeIsThatOfItsMesh) {
  const Json json = Json::parse(output({"info", "--json", vise_ + "#body"}));
  EXPECT_EQ(json["triangles"], 12);
  EXPECT_NEAR(json["mass"]["volume"].get<double>(), 0.1 * 0.06 * 0.04, 1e-15);
}

TEST_F(DocumentsCommand, ImportKeepsTreePlacementsAndColours) {
  EXPECT_THAT(
      output({"scene", "new", scene_, "--import", vise_, "--moving", "pin 2", "--density", "body=7850"}),
      HasSubstr("3 parts, moving: pin 2"));
  const Scene scene = readSceneFile(scene_);
  ASSERT_EQ(scene.parts().size(), 3U);
  EXPECT_EQ(scene.groups().size(), 2U);
  const Part& pin = *scene.findByName("pin 2");
  EXPECT_EQ(pin.worldFromPart.translation, glm::dvec3(0.1, 0.02, 0.0));
  EXPECT_EQ(pin.colour, (Colour{0.0F, 0.0F, 1.0F}));
  EXPECT_EQ(pin.geometry, scene.findByName("pin")->geometry);
  EXPECT_EQ(scene.movingPart(), pin.id);
  EXPECT_EQ(scene.findByName("body")->density, 7850.0);
}

TEST_F(DocumentsCommand, DocumentsAndMeshesGoTogether) {
  output({"scene", "new", scene_, "--unit", "mm", "--import", vise_, "--import", block_, "--part",
          "Stop=" + vise_ + "#pin@0,0,1,1,0,0,0"});
  const Scene scene = readSceneFile(scene_);
  ASSERT_EQ(scene.parts().size(), 5U);
  EXPECT_EQ(scene.findByName("Stop")->worldFromPart.translation.z, 1.0);
  EXPECT_EQ(scene.findByName("Stop")->geometry->shapeKey, "pin");
  EXPECT_NEAR(scene.findByName("block")->geometry->mesh.bounds().upper.x, 0.01, 1e-15);
  EXPECT_NEAR(scene.findByName("body")->geometry->mesh.bounds().upper.x, 0.05, 1e-15) << "in its own unit";
}

TEST_F(DocumentsCommand, MissingUnitIsAnErrorThatNamesTheOption) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", block_},
        {"check", block_},
        {"lmd", vise_ + "#pin", block_, "--cutoff", "0.1", "--pose", "0,0,1,1,0,0,0"},
        {"scene", "new", scene_, "--import", vise_, "--part", "Block=" + block_}})
    EXPECT_THAT(errorOf(arguments), AllOf(HasSubstr("--unit: "), HasSubstr("block.obj stores no unit")));
  EXPECT_EQ(importer_.runs(), 0);
  EXPECT_FALSE(std::filesystem::exists(scene_));
}

TEST_F(DocumentsCommand, SeveralShapesAreNamedWhereOneIsNeeded) {
  const std::string error =
      errorOf({"lmd", vise_, vise_ + "#pin", "--cutoff", "0.1", "--pose", "0,0,1,1,0,0,0"});
  EXPECT_THAT(error, AllOf(HasSubstr("2 shapes"), HasSubstr("\"body\""), HasSubstr("\"pin\"")));
}

TEST_F(DocumentsCommand, MinimaOfShapesAreFound) {
  // The pin, 30 mm high, stands 10 mm above the body, whose top is at 20 mm.
  const Json json = Json::parse(
      output({"lmd", vise_ + "#body", vise_ + "#pin", "--cutoff", "0.015", "--pose", "0,0,0.045,1,0,0,0"}));
  ASSERT_FALSE(json["lmds"].empty());
  EXPECT_NEAR(json["lmds"][0]["distance"].get<double>(), 0.01, 1e-12);
  EXPECT_EQ(importer_.runs(), 1);
}

TEST_F(DocumentsCommand, MinimaAreThoseOfTheTessellationThatIsGiven) {
  const std::vector<std::string> arguments{
      "lmd",     vise_ + "#body", vise_ + "#pin", "--cutoff", "0.015", "--pose", "0,0,0.045,1,0,0,0",
      "--chord", "1e-6",          "--angle",      "9"};
  EXPECT_NEAR(Json::parse(output(arguments))["lmds"][0]["distance"].get<double>(), 0.01, 1e-12);
  ASSERT_EQ(importer_.runs(), 1);
  EXPECT_EQ(importer_.asked()[0].tessellation.chord, 1e-6);
  EXPECT_NEAR(importer_.asked()[0].tessellation.angle, 0.1570796326794897, 1e-15);
  EXPECT_THAT(errorOf({"lmd", vise_ + "#body", vise_ + "#pin", "--cutoff", "0.015", "--pose",
                       "0,0,0.045,1,0,0,0", "--chord", "1e-9"}),
              HasSubstr("--chord: 1e-09 m is out of range"));
}

TEST_F(DocumentsCommand, RefiningOnePartTakesAllItsInstancesAlong) {
  output({"scene", "new", scene_, "--import", vise_});
  const Scene before = readSceneFile(scene_);
  EXPECT_THAT(output({"scene", "refine", scene_, "pin", "--chord", "1e-6", "--angle", "5"}),
              HasSubstr("2 parts of 1 shape with "));
  const Scene after = readSceneFile(scene_);
  for (const char* name : {"pin", "pin 2"}) {
    const Part &coarse = *before.findByName(name), &fine = *after.findByName(name);
    EXPECT_GT(fine.geometry->mesh.triangles().size(), 4 * coarse.geometry->mesh.triangles().size());
    EXPECT_EQ(fine.worldFromPart.translation, coarse.worldFromPart.translation);
    EXPECT_EQ(fine.geometry->tessellation.chord, 1e-6);
  }
  EXPECT_EQ(after.findByName("body")->geometry->tessellation, Tessellation{});
  EXPECT_THAT(errorOf({"scene", "refine", scene_, "pin", "--chord", "1e-9"}),
              HasSubstr("--chord: 1e-09 m is out of range"));
  EXPECT_THAT(errorOf({"scene", "refine", scene_, "nut"}), HasSubstr("there is no part \"nut\""));
  output({"scene", "new", scene_, "--unit", "mm", "--import", block_});
  EXPECT_THAT(errorOf({"scene", "refine", scene_, "block"}), HasSubstr("no exact surfaces"));
  EXPECT_THAT(errorOf({"scene", "refine", scene_}), HasSubstr("no part of exact surfaces"));
}

TEST_F(DocumentsCommand, EachShapeIsCheckedOrTheOneThatIsNamed) {
  const std::string all = output({"check", vise_});
  EXPECT_THAT(all, AllOf(HasSubstr("vise.step#body\n  triangles            12\n  no findings\n"),
                         HasSubstr("vise.step#pin\n")));
  const Json pin = Json::parse(output({"check", "--json", "--chord", "1e-6", vise_ + "#pin"}));
  EXPECT_THAT(pin["file"].get<std::string>(), HasSubstr("vise.step#pin"));
  EXPECT_GT(pin["triangles"].get<int>(), 300)
      << "facets of a chord of 1 um on a radius of 5 mm turn by 40 mrad at most";
  EXPECT_TRUE(pin["check"]["findings"].empty());
}

TEST_F(DocumentsCommand, AShapeIsRepairedIntoAMeshFileInTheUnitThatIsNamed) {
  const std::string out = path("body.obj");
  EXPECT_THAT(errorOf({"check", vise_, "--orient", "--repair", out}), HasSubstr("2 shapes"));
  EXPECT_THAT(errorOf({"check", vise_ + "#body", "--orient", "--repair", vise_}), HasSubstr("vise.step"));
  output({"check", "--unit", "mm", vise_ + "#body", "--orient", "--repair", out});
  MeshBuildOptions options;
  options.metresPerUnit = 0.001;
  EXPECT_NEAR(importMesh(out, options).mesh.bounds().upper.x, 0.05, 1e-9);
}

}  // namespace
}  // namespace nearfit::test::documents_command_test
