// Assemblies written by the programs that ship and read back: STEP, glTF, 3MF and URDF by nearfit-import, whose libraries
// are not those that write glTF, 3MF and URDF; texts and surfaces of STEP files by a reader of their own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/report/scene_export.h"
#include "core/scene/document_load.h"
#include "core/scene/document_parts.h"
#include "tests/app/import/import_fixture.h"
#include "tests/core/report/assembly_fixture.h"
#include "tests/support/places.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::assembly_export_test {
namespace {

namespace fs = std::filesystem;
using test::imported;
using test::importModel;
using test::ScopedVariable;
using testing::HasSubstr;

/// The character of a code point, in UTF-8.
std::string utf8Of(std::uint32_t code) {
  std::string text;
  const auto tail = [&](int shift) { text += static_cast<char>(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xC0U | (code >> 6));
    tail(0);
  } else if (code < 0x10000) {
    text += static_cast<char>(0xE0U | (code >> 12));
    tail(6);
    tail(0);
  } else {
    text += static_cast<char>(0xF0U | (code >> 18));
    tail(12);
    tail(6);
    tail(0);
  }
  return text;
}

/// All strings of a STEP file, as ISO 10303-21 encodes them.
std::multiset<std::string> stringsOf(const std::string& file) {
  std::multiset<std::string> strings;
  for (std::size_t at = 0; at < file.size(); ++at) {
    if (file[at] != '\'') continue;
    std::string text;
    for (++at; at < file.size(); ++at) {
      if (file[at] == '\'') {
        if (at + 1 >= file.size() || file[at + 1] != '\'') break;
        text += file[at++];
      } else if (file.compare(at, 2, "\\\\") == 0) {
        text += '\\';
        ++at;
      } else if (file.compare(at, 4, "\\X2\\") == 0 || file.compare(at, 4, "\\X4\\") == 0) {
        const std::size_t digits = file[at + 2] == '2' ? 4 : 8;
        for (at += 4; file.compare(at, 4, "\\X0\\") != 0; at += digits)
          text += utf8Of(static_cast<std::uint32_t>(std::stoul(file.substr(at, digits), nullptr, 16)));
        at += 3;
      } else if (file[at] != '\n') {
        text += file[at];
      }
    }
    strings.insert(text);
  }
  return strings;
}

std::size_t countOf(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != text.npos; at += word.size())
    ++count;
  return count;
}

class AssemblyExport : public ::testing::Test {
 protected:
  /// Notes of the export.
  std::vector<std::string> write(const Scene& scene, const std::string& name) {
    file_ = folder_.path() / name;
    SceneExport what;
    what.kind = *exportKindOf(file_);
    const ScopedVariable program("NEARFIT_EXPORT", test::builtPath("nearfit-export"));
    return exportScene(scene, {}, what, file_);
  }
  static std::map<std::string, std::size_t> nodesOf(const CadDocument& document) {
    std::map<std::string, std::size_t> nodes;
    // A group may have the name of a part.
    for (const bool isGroup : {false, true})
      for (std::size_t i = 0; i < document.nodes.size(); ++i)
        if ((document.nodes[i].shape < 0) == isGroup) nodes.emplace(document.nodes[i].name, i);
    return nodes;
  }
  /// Names and poses of all visible parts.
  /// @param without  A part that is left out.
  static void expectParts(const CadDocument& document, const Scene& scene, double tolerance,
                          const std::string& without = {}) {
    const auto nodes = nodesOf(document);
    for (const Scene::PartPtr& part : chosenParts(scene, {})) {
      if (part->name == without) continue;
      ASSERT_TRUE(nodes.contains(part->name)) << part->name;
      EXPECT_LT(test::differenceOf(test::matrixOf(test::worldFromNode(document, nodes.at(part->name))),
                                   test::matrixOf(part->worldFromPart)),
                tolerance)
          << part->name;
    }
    EXPECT_FALSE(nodes.contains("Hidden"));
  }
  static const CadShape& shapeOf(const CadDocument& document, std::string_view name) {
    const auto nodes = nodesOf(document);
    return document.shapes.at(static_cast<std::size_t>(document.nodes.at(nodes.at(std::string(name))).shape));
  }
  static std::optional<CadColour> colourOf(const CadDocument& document, const std::string& name) {
    const auto nodes = nodesOf(document);
    return document.nodes.at(nodes.at(name)).colour;
  }

  test::TemporaryFolder folder_;
  fs::path file_;
  test::AssemblyScene model_;
};

/// A scene of a document's parts.
Scene sceneOf(const fs::path& file, double metresPerUnit = 1.0) {
  const ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  Scene scene;
  addTo(scene, partsOfDocument(loadDocument(file, metresPerUnit), scene));
  return scene;
}

void expectColour(const std::optional<CadColour>& colour, const CadColour& expected) {
  ASSERT_TRUE(colour);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR((*colour)[k], expected[k], 0.005);
}

TEST_F(AssemblyExport, StepHasNamesGroupsAndPoses) {
  EXPECT_TRUE(write(model_.scene, "fit.step").empty());
  const CadDocument document = imported(file_);
  // Readers decode what a text itself spells as a directive once more.
  expectParts(document, model_.scene, 1e-9, test::kHostileName);
  const auto nodes = nodesOf(document);
  const auto groupOf = [&](const std::string& name) {
    return document.nodes.at(static_cast<std::size_t>(document.nodes.at(nodes.at(name)).parent)).name;
  };
  EXPECT_EQ(groupOf("Ring"), "Inner");
  EXPECT_EQ(groupOf("Inner"), "Outer <1>");
  EXPECT_EQ(groupOf("Outer <1>"), "fit");
  EXPECT_EQ(document.nodes.at(0).parent, -1);
}

TEST_F(AssemblyExport, StepTextsAreEncodedWhateverTheyHold) {
  write(model_.scene, "fit.step");
  const std::string text = test::readBytes(file_);
  EXPECT_TRUE(std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; }));
  EXPECT_EQ(text.find("NFNAME"), text.npos);
  const auto strings = stringsOf(text);
  EXPECT_GE(strings.count(test::kHostileName), 1U);
  EXPECT_GE(strings.count("Outer <1>"), 1U);
  EXPECT_THAT(text, HasSubstr("AUTOMOTIVE_DESIGN"));
}

TEST_F(AssemblyExport, StepInstancesShareAProductOfTheirColour) {
  write(model_.scene, "fit.step");
  const std::string text = test::readBytes(file_);
  // Ring in two colours, box and square; groups and the whole.
  EXPECT_EQ(countOf(text, "=PRODUCT(") + countOf(text, "= PRODUCT("), 7U);
  EXPECT_EQ(countOf(text, "NEXT_ASSEMBLY_USAGE_OCCURRENCE("), 7U) << "five parts and two groups";
  const CadDocument document = imported(file_);
  expectColour(colourOf(document, "Ring"), {0.25F, 0.5F, 0.75F});
  expectColour(colourOf(document, "Third ring"), {1.0F, 0.0F, 0.0F});
}

TEST_F(AssemblyExport, StepFacetsAreTheMeshAndClosedOnesAreSolids) {
  write(model_.scene, "fit.step");
  const std::string text = test::readBytes(file_);
  EXPECT_EQ(countOf(text, "MANIFOLD_SOLID_BREP("), 3U) << "two rings and a box";
  const CadDocument document = imported(file_);
  const CadShape& ring = shapeOf(document, "Ring");
  const TriangleMesh& mesh = model_.scene.get(model_.firstRing).geometry->mesh;
  EXPECT_NEAR(test::volumeOf(ring), massProperties(mesh).volume, 1e-9 * massProperties(mesh).volume);
  EXPECT_EQ(test::unmatchedEdges(ring), 0U);
  const CadShape& box = shapeOf(document, "Box");
  EXPECT_NEAR(test::volumeOf(box), 0.006, 1e-12);
  EXPECT_EQ(box.surfaces.faces.size(), 6U) << "flats are polygons";
  for (const ExactSurface& face : box.surfaces.faces)
    EXPECT_EQ(face.kind, SurfaceKind::Plane);
  EXPECT_NEAR(test::areaOf(shapeOf(document, "Square")), 0.01, 1e-12);
  EXPECT_EQ(shapeOf(document, "Square").surfaces.faces.size(), 1U);
}

TEST_F(AssemblyExport, StepFacesHaveTheirColours) {
  write(model_.scene, "fit.step");
  const CadShape box = shapeOf(imported(file_), "Box");
  ASSERT_EQ(box.faceColours.size(), 6U);
  std::map<std::string, int> count;
  for (const std::optional<CadColour>& colour : box.faceColours)
    ++count[!colour || ((*colour)[1] < 0.9F && (*colour)[2] < 0.9F) ? "part's"
            : (*colour)[1] > 0.9F                                   ? "green"
                                                                    : "blue"];
  EXPECT_EQ(count, (std::map<std::string, int>{{"green", 2}, {"blue", 1}, {"part's", 3}}));
}

TEST_F(AssemblyExport, APlateWithAHoleIsAPolygonWithAHole) {
  Scene scene;
  scene.add(test::partOf(test::solidGeometryOf(test::tubeMesh(0.01, 0.02, 0.03, 12)), "Tube"));
  write(scene, "tube.step");
  const CadShape tube = shapeOf(imported(file_), "Tube");
  EXPECT_EQ(tube.surfaces.faces.size(), 26U) << "two rings, and two walls of twelve faces";
  const double area = 12.0 / 2.0 * std::sin(2.0 * std::numbers::pi / 12.0) * (0.02 * 0.02 - 0.01 * 0.01);
  EXPECT_NEAR(test::volumeOf(tube), 0.03 * area, 1e-9 * area);
}

TEST_F(AssemblyExport, ACavityIsAVoidOfItsSolidAndShellsApartAreSolids) {
  const TriangleMesh outer = test::boxMesh(glm::dvec3(0.1));
  const TriangleMesh hollow = test::joined(outer, test::turned(test::boxMesh(glm::dvec3(0.05))));
  const TriangleMesh two = test::joined(hollow, test::boxMesh(glm::dvec3(0.02), glm::dvec3(0.5, 0.0, 0.0)));
  Scene scene;
  scene.add(test::partOf(test::solidGeometryOf(two), "Hollow"));
  write(scene, "hollow.step");
  const std::string text = test::readBytes(file_);
  EXPECT_EQ(countOf(text, "BREP_WITH_VOIDS("), 1U);
  EXPECT_EQ(countOf(text, "MANIFOLD_SOLID_BREP("), 1U);
}

TEST_F(AssemblyExport, TwoPartsAtOnePlaceStayTwo) {
  Scene scene;
  const PartGeometryPtr box = test::solidGeometryOf(test::boxMesh(glm::dvec3(0.1)));
  scene.add(test::partOf(box, "First"));
  scene.add(test::partOf(box, "Second"));
  write(scene, "twins.step");
  const CadDocument document = imported(file_);
  expectParts(document, scene, 1e-9);
}

TEST_F(AssemblyExport, PartsOfAStepFileKeepTheirExactSurfaces) {
  for (const char* name :
       {"bracket.step", "assembly_ap242.step", "assembly_inch.step", "two_solids.step", "box.igs"}) {
    const Scene scene = sceneOf(importModel(name));
    EXPECT_TRUE(write(scene, "again.step").empty()) << name;
    const CadDocument document = imported(file_);
    const auto nodes = nodesOf(document);
    for (const Scene::PartPtr& part : chosenParts(scene, {})) {
      const PartGeometry& geometry = *part->geometry;
      ASSERT_TRUE(nodes.contains(part->name)) << name << ": " << part->name;
      const CadShape& shape = shapeOf(document, part->name);
      EXPECT_NEAR(shape.exactVolume, geometry.exactVolume, 1e-7 * geometry.exactVolume) << name;
      std::map<SurfaceKind, std::size_t> before, after;
      for (const ExactSurface& face : geometry.surfaces->faces)
        ++before[face.kind];
      for (const ExactSurface& face : shape.surfaces.faces)
        ++after[face.kind];
      EXPECT_EQ(after, before) << name << ": " << part->name;
    }
    expectParts(document, scene, 1e-9);
  }
}

TEST_F(AssemblyExport, ABrepFileIsScaledByItsUnit) {
  const Scene scene = sceneOf(importModel("box.brep"), 0.01);
  EXPECT_TRUE(write(scene, "box.step").empty());
  const CadDocument document = imported(file_);
  const PartGeometry& geometry = *scene.parts().front()->geometry;
  const CadShape& shape = shapeOf(document, scene.parts().front()->name);
  EXPECT_NEAR(shape.exactVolume, geometry.exactVolume, 1e-9 * geometry.exactVolume);
}

TEST_F(AssemblyExport, PartsOfAFileThatChangedOrIsGoneAreFacetsWithANote) {
  const fs::path source = folder_.path() / "bracket.step";
  fs::copy_file(importModel("bracket.step"), source);
  const Scene scene = sceneOf(source);
  const auto roundFaces = [&] {
    std::size_t count = 0;
    for (const CadShape& shape : imported(file_).shapes)
      count += static_cast<std::size_t>(std::ranges::count_if(
          shape.surfaces.faces, [](const ExactSurface& face) { return face.kind != SurfaceKind::Plane; }));
    return count;
  };
  write(scene, "exact.step");
  EXPECT_GT(roundFaces(), 0U);
  folder_.write("bracket.step", test::readBytes(source) + "\n");
  std::vector<std::string> notes = write(scene, "changed.step");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("has changed"));
  EXPECT_EQ(roundFaces(), 0U);
  fs::remove(source);
  notes = write(scene, "gone.step");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("facets"));
}

TEST_F(AssemblyExport, TooManyFacetsAreRefusedAndTheOldFileStays) {
  Scene scene;
  scene.add(test::partOf(test::freshGeometryOf(test::starMesh(3, 1.0, 7, 0.2)), "Star"));
  folder_.write("star.step", "old");
  try {
    write(scene, "star.step");
    ADD_FAILURE() << "327,680 faces were written";
  } catch (const FileError& error) {
    EXPECT_THAT(error.problem(), HasSubstr("100000 faces"));
    EXPECT_FALSE(error.remedy().empty());
  }
  EXPECT_EQ(test::readBytes(file_), "old");
}

/// OpenCASCADE takes the id for a name without ASCII characters: both sides see to it that nothing is lost.
TEST_F(AssemblyExport, NamesInOtherScriptsAloneComeBack) {
  Scene scene;
  const PartGeometryPtr geometry = test::geometryOf(test::boxMesh(glm::dvec3(1.0)));
  for (const char* name : {"軸", "Ось", "\U0001F529"})
    scene.add(test::partOf(geometry, name));
  write(scene, "other.step");
  std::string text = test::readBytes(file_);
  EXPECT_NE(text.find("_OCCURRENCE('\\X2\\8EF8\\X0\\',"), std::string::npos) << "the id is the name too";
  const auto names = [this] {
    const CadDocument document = imported(file_);
    const auto nodes = nodesOf(document);
    return nodes.contains("軸") && nodes.contains("Ось") && nodes.contains("\U0001F529");
  };
  EXPECT_TRUE(names());
  // As other programs write it.
  for (std::size_t at = 0; (at = text.find("_OCCURRENCE('\\X", at)) != std::string::npos; ++at)
    text.replace(at + 13, text.find("',", at) - at - 13, "7");
  folder_.write("other.step", text);
  EXPECT_TRUE(names());
}

TEST_F(AssemblyExport, GltfIsReadByOpenCascade) {
  write(model_.scene, "fit.glb");
  const CadDocument document = imported(file_);
  const auto nodes = nodesOf(document);
  // The library turns frames of parts too, so that places in the world are compared.
  for (const Scene::PartPtr& part : chosenParts(model_.scene, {})) {
    ASSERT_TRUE(nodes.contains(part->name)) << part->name;
    const std::size_t node = nodes.at(part->name);
    const Aabb box = test::boxOf(shapeOf(document, part->name), test::worldFromNode(document, node));
    Aabb expected;
    for (const glm::dvec3& vertex : part->geometry->mesh.vertices())
      expected.add(glm::dvec3(test::matrixOf(part->worldFromPart) * glm::dvec4(vertex, 1.0)));
    EXPECT_LT(glm::distance(box.lower, expected.lower), 1e-7) << part->name;
    EXPECT_LT(glm::distance(box.upper, expected.upper), 1e-7) << part->name;
  }
  expectColour(colourOf(document, "Third ring"), {1.0F, 0.0F, 0.0F});
}

TEST_F(AssemblyExport, ThreeMfIsReadByLib3mf) {
  write(model_.scene, "fit.3mf");
  const CadDocument document = imported(file_);
  const auto nodes = nodesOf(document);
  // The library keeps transforms in single precision.
  for (const char* name : {"Box", "Square"})
    EXPECT_LT(test::differenceOf(test::matrixOf(test::worldFromNode(document, nodes.at(name))),
                                 test::matrixOf(model_.scene.findByName(name)->worldFromPart)),
              1e-5)
        << name;
  EXPECT_TRUE(nodes.contains("Ring"));
  EXPECT_TRUE(nodes.contains(test::kHostileName));
  EXPECT_NEAR(test::volumeOf(shapeOf(document, "Box")), 0.006, 1e-7);
}

TEST_F(AssemblyExport, UrdfIsReadByUrdfdom) {
  write(model_.scene, "fit.urdf");
  const CadDocument document = imported(file_);
  EXPECT_TRUE(document.warnings.empty()) << document.warnings.front();
  expectParts(document, model_.scene, 1e-9);
  EXPECT_NEAR(test::volumeOf(shapeOf(document, "Box")), 0.006, 1e-8);
  expectColour(colourOf(document, "Third ring"), {1.0F, 0.0F, 0.0F});
}

TEST_F(AssemblyExport, TheCommandLineWritesStepOfBothSchemas) {
  const std::string scene = (folder_.path() / "s.nearfit").string(),
                    out = (folder_.path() / "o.stp").string();
  const ScopedVariable importer("NEARFIT_IMPORT", test::builtPath("nearfit-import")),
      exporter("NEARFIT_EXPORT", test::builtPath("nearfit-export"));
  ASSERT_EQ(
      test::runCli({"scene", "new", scene, "--import", importModel("assembly_ap242.step").string()}).exitCode,
      0);
  ASSERT_EQ(test::runCli({"export", scene, "-o", out}).exitCode, 0);
  EXPECT_THAT(test::readBytes(out), HasSubstr("AUTOMOTIVE_DESIGN"));
  ASSERT_EQ(test::runCli({"export", scene, "-o", out, "--schema", "ap242"}).exitCode, 0);
  EXPECT_THAT(test::readBytes(out), HasSubstr("AP242"));
  EXPECT_EQ(test::runCli({"export", scene, "-o", (folder_.path() / "o.glb").string(), "--schema", "ap242"})
                .exitCode,
            2);
}

}  // namespace
}  // namespace nearfit::assembly_export_test
