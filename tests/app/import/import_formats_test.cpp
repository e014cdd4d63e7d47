// IGES, BREP, glTF, 3MF and URDF, and files compressed by gzip.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/import/import_process.h"
#include "core/import/mesh_import.h"
#include "core/scene/document_load.h"
#include "tests/app/import/import_fixture.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/places.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::import_formats_test {
namespace {

namespace fs = std::filesystem;
using test::boxOf;
using test::imported;
using test::importModel;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(Importer, SaysItsVersionAndThatOfOpenCascade) {
  const test::ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  EXPECT_THAT(importerVersion(),
              testing::MatchesRegex("nearfit-import [0-9.]+, OpenCASCADE [0-9]+\\.[0-9]+.*"));
}

void expectBox(const Aabb& box, const glm::dvec3& lower, const glm::dvec3& upper, double tolerance = 1e-9) {
  EXPECT_LE(glm::distance(box.lower, lower), tolerance)
      << box.lower.x << " " << box.lower.y << " " << box.lower.z;
  EXPECT_LE(glm::distance(box.upper, upper), tolerance)
      << box.upper.x << " " << box.upper.y << " " << box.upper.z;
}

struct BoxOfNode {
  const char* name;
  glm::dvec3 lower, upper;
};

/// Of nodes that have a shape, by their names, in the document's frame.
void expectBoxesOfNodes(const CadDocument& document, const std::vector<BoxOfNode>& boxes, double tolerance) {
  for (const BoxOfNode& wanted : boxes) {
    SCOPED_TRACE(wanted.name);
    const auto node =
        std::ranges::find_if(document.nodes, [&](const CadNode& n) { return n.name == wanted.name; });
    ASSERT_NE(node, document.nodes.end());
    ASSERT_GE(node->shape, 0);
    const auto index = static_cast<std::size_t>(node - document.nodes.begin());
    expectBox(boxOf(document.shapes.at(static_cast<std::size_t>(node->shape)),
                    test::worldFromNode(document, index)),
              wanted.lower, wanted.upper, tolerance);
  }
}

FileError refusal(const fs::path& file) {
  try {
    imported(file);
  } catch (const FileError& error) {
    return error;
  }
  ADD_FAILURE() << file << " was imported";
  return {"", "", ""};
}

TEST(ImportFormats, FacesOfIgesAreSewnToASolid) {
  const CadDocument document = imported(importModel("box.igs"));
  ASSERT_EQ(document.shapes.size(), 1U);
  EXPECT_TRUE(document.hasUnit);
  expectBox(boxOf(document), {0, 0, 0}, {0.04, 0.02, 0.01});
  EXPECT_NEAR(document.shapes[0].exactVolume, 8e-6, 1e-12);
  EXPECT_EQ(test::unmatchedEdges(document.shapes[0]), 0U);
  EXPECT_GT(test::volumeOf(document.shapes[0]), 0.0);
  EXPECT_EQ(document.nodes[0].name, "box 1");
}

TEST(ImportFormats, IgesInInchesKeepsNamesSizesAndColoursOfSewnFaces) {
  const CadDocument document = imported(importModel("parts_inch.igs"));
  constexpr double kInch = 0.0254;
  EXPECT_TRUE(document.hasUnit);
  ASSERT_EQ(document.nodes.size(), 2U);
  ASSERT_EQ(document.shapes.size(), 2U);
  EXPECT_EQ(document.nodes[0].name, "plate");
  EXPECT_EQ(document.nodes[1].name, "block");
  const CadShape& plate = document.shapes.at(static_cast<std::size_t>(document.nodes[0].shape));
  const CadShape& block = document.shapes.at(static_cast<std::size_t>(document.nodes[1].shape));
  expectBox(boxOf(plate, test::worldFromNode(document, 0)), {0, 0, 0}, glm::dvec3(2.0, 1.0, 0.5) * kInch);
  expectBox(boxOf(block, test::worldFromNode(document, 1)), glm::dvec3(3, 0, 0) * kInch,
            glm::dvec3(4, 1, 1) * kInch);
  EXPECT_NEAR(plate.exactVolume, std::pow(kInch, 3), 1e-12);
  EXPECT_EQ(test::unmatchedEdges(plate), 0U);
  // One face is green, that at x = 0; the part and its other faces have no colour.
  EXPECT_FALSE(document.nodes[0].colour.has_value());
  ASSERT_EQ(plate.faceColours.size(), 6U);
  EXPECT_EQ(std::ranges::count_if(plate.faceColours, [](const auto& colour) { return colour.has_value(); }),
            1);
  const CadColour green{0.0F, 1.0F, 0.0F};
  for (std::size_t i = 0; i < plate.triangles.size(); ++i) {
    const bool isAtZero = std::ranges::all_of(
        plate.triangles[i], [&](std::uint32_t v) { return std::abs(plate.vertices[v].x) < 1e-9; });
    const std::optional<CadColour>& colour = plate.faceColours[plate.surfaces.faceOfTriangle[i]];
    EXPECT_EQ(colour, isAtZero ? std::optional(green) : std::nullopt) << i;
  }
  EXPECT_FALSE(document.nodes[1].colour.has_value());
  EXPECT_TRUE(block.faceColours.empty());
}

TEST(ImportFormats, ASolidThatLacksAFaceIsSaidNotToBeClosedAndHasNoExactVolume) {
  const TemporaryFolder folder, cache;
  std::string bytes = test::readBytes(importModel("box.brep"));
  // The faces of the solid's shell, of which it loses the first.
  const std::size_t faces = bytes.find("-25 0 +15 0 -11 0 +7 0 -5 0 +3 0 *");
  ASSERT_NE(faces, std::string::npos);
  bytes.erase(faces, std::string("-25 0 ").size());
  const fs::path file = folder.write("open.brep", bytes);
  const CadDocument document = imported(file);
  ASSERT_EQ(document.shapes.size(), 1U);
  EXPECT_EQ(document.shapes[0].surfaces.faces.size(), 5U);
  EXPECT_EQ(document.shapes[0].exactVolume, 0.0);
  // The face was a rectangle, whose edges are straight.
  const std::string warning = "It is not closed: 4 edges of triangles belong to one face only.";
  EXPECT_THAT(document.shapes[0].warnings, testing::ElementsAre(warning));
  const test::ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  const test::ScopedVariable where("NEARFIT_CACHE", cache.path().string());
  const test::ProcessResult info = test::runCli({"info", "--unit", "mm", file.string()});
  EXPECT_EQ(info.exitCode, 0) << info.err;
  EXPECT_THAT(info.out, testing::AllOf(HasSubstr("warning     open: " + warning), HasSubstr("open, 0.004 x"),
                                       testing::Not(HasSubstr("(exact"))));
}

/// OpenCASCADE makes a shell of such a solid of STEP, and shells may be open: the check of its mesh tells.
TEST(ImportFormats, AStepSolidThatLacksAFaceIsSaidToBeOpen) {
  const TemporaryFolder folder, cache;
  std::string bytes = test::readBytes(importModel("two_solids.step"));
  const std::string head = "CLOSED_SHELL('',(";
  const std::size_t shell = bytes.find(head);
  ASSERT_NE(shell, std::string::npos);
  const std::size_t face = shell + head.size();
  bytes.erase(face, bytes.find(',', face) + 1 - face);
  const fs::path file = folder.write("open.step", bytes);
  const test::ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  const test::ScopedVariable where("NEARFIT_CACHE", cache.path().string());
  const test::ProcessResult info = test::runCli({"info", "--json", file.string()});
  ASSERT_EQ(info.exitCode, 0) << info.err;
  const nlohmann::json shapes = nlohmann::json::parse(info.out)["shapes"];
  ASSERT_EQ(shapes.size(), 2U);
  const std::size_t open = shapes[0]["faces"] == 5 ? 0 : 1;
  EXPECT_EQ(shapes[open]["faces"], 5);
  EXPECT_EQ(shapes[open]["closed"], false);
  EXPECT_TRUE(shapes[open]["exactVolume"].is_null());
  EXPECT_EQ(shapes[open]["warnings"], nlohmann::json::array({"4 edges are open (one face only)."}));
  EXPECT_EQ(shapes[1 - open]["closed"], true);
  EXPECT_TRUE(shapes[1 - open]["warnings"].empty());
}

/// A ball of one face, 20 mm across.
constexpr const char* kBall = R"(ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('ball','2024-01-01T00:00:00',(''),(''),'','','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));
ENDSEC;
DATA;
#1=APPLICATION_CONTEXT('');
#2=PRODUCT_CONTEXT('',#1,'mechanical');
#3=PRODUCT('ball','ball','',(#2));
#4=PRODUCT_DEFINITION_FORMATION('','',#3);
#5=PRODUCT_DEFINITION_CONTEXT('part definition',#1,'design');
#6=PRODUCT_DEFINITION('','',#4,#5);
#7=PRODUCT_DEFINITION_SHAPE('','',#6);
#8=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#12))
GLOBAL_UNIT_ASSIGNED_CONTEXT((#9,#10,#11))REPRESENTATION_CONTEXT('',''));
#9=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#10=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#11=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());
#12=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),#9,'distance_accuracy_value','');
#13=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#14,#20),#8);
#14=AXIS2_PLACEMENT_3D('',#15,#16,#17);
#15=CARTESIAN_POINT('',(0.,0.,0.));
#16=DIRECTION('',(0.,0.,1.));
#17=DIRECTION('',(1.,0.,0.));
#18=SHAPE_DEFINITION_REPRESENTATION(#7,#13);
#20=MANIFOLD_SOLID_BREP('',#21);
#21=CLOSED_SHELL('',(#22));
#22=ADVANCED_FACE('',(#23),#26,.T.);
#23=FACE_BOUND('',#24,.T.);
#24=VERTEX_LOOP('',#25);
#25=VERTEX_POINT('',#27);
#26=SPHERICAL_SURFACE('',#14,10.);
#27=CARTESIAN_POINT('',(0.,0.,-10.));
ENDSEC;
END-ISO-10303-21;
)";

/// OpenCASCADE says nothing while it meshes one face: the bar stood at 15 %.
TEST(ImportFormats, ProgressGrowsWhileOneFaceIsMeshed) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("ball.step", kBall);
  std::vector<double> told;
  const CadDocument document = imported(file, {{7e-7, 0.0}, {}}, [&](double fraction) {
    if (told.empty() || fraction > told.back()) told.push_back(fraction);
    return true;
  });
  ASSERT_EQ(document.shapes.size(), 1U);
  EXPECT_GT(document.shapes[0].triangles.size(), 100'000U);
  EXPECT_NEAR(test::volumeOf(document.shapes[0]), 4.0 / 3.0 * std::numbers::pi * 1e-6, 1e-9);
  // It takes seconds of processor time, of which each tenth is told.
  const auto onTheWay = std::ranges::count_if(told, [](double x) { return x > 0.2 && x < 0.9; });
  EXPECT_GE(onTheWay, 10) << testing::PrintToString(told);
}

/// Fractions below `end` that the importer tells while it opens a file: all of them, however late they are read.
std::vector<double> toldBelow(double end, const fs::path& file) {
  const test::ProcessResult run =
      test::runProcess({test::builtPath("nearfit-import"), "--messages", "1", "--", file.string()});
  EXPECT_EQ(run.exitCode, 0) << run.err;
  std::vector<double> told;
  for (const std::string& line : test::linesOf(run.out)) {
    const double fraction = std::stod(line.substr(line.find('\t') + 1));
    if (fraction > 0.0 && fraction < end) told.push_back(fraction);
  }
  return told;
}

/// Where the reading stage of OpenCASCADE's formats ends, if no tessellation is asked for.
constexpr double kReadEnd = 0.25;

TEST(ImportFormats, ProgressGrowsWhileTheTextOfStepIsRead) {
  const TemporaryFolder folder;
  std::string points;
  for (int i = 0; i < 300'000; ++i)
    points += fmt::format("#{}=CARTESIAN_POINT('',({}.,{}.,{}.));\n", i + 100, i, 2 * i, 3 * i);
  std::string text = kBall;
  text.insert(text.rfind("ENDSEC;"), points);
  const std::vector<double> told = toldBelow(kReadEnd, folder.write("points.step", text));
  EXPECT_GE(told.size(), 5U) << testing::PrintToString(told);
  // Each MB is told, and the text is most of the work: the processor time that is used would stand for less.
  ASSERT_FALSE(told.empty());
  EXPECT_GE(told.back(), 0.6 * kReadEnd) << testing::PrintToString(told);
}

/// A line of an IGES file: its content, the letter of its section and its number.
std::string igesLine(const std::string& content, char section, int number) {
  return fmt::format("{:<72}{}{:>7}\n", content, section, number);
}

/// box.igs and `count` points.
std::string igesOfPoints(int count) {
  std::string head, directory, parameters;
  int directoryLines = 0, parameterLines = 0;
  for (const std::string& line : test::linesOf(test::readBytes(importModel("box.igs")))) {
    const char section = line.at(72);
    if (section == 'S' || section == 'G') head += line + "\n";
    if (section == 'D') {
      directory += line + "\n";
      ++directoryLines;
    }
    if (section == 'P') {
      parameters += line + "\n";
      ++parameterLines;
    }
  }
  for (int i = 0; i < count; ++i) {
    const int entry = directoryLines + 1;
    ++parameterLines;
    // Type 116: a point, of one line of parameters.
    directory += igesLine(fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}", 116, parameterLines, 0,
                                      0, 0, 0, 0, 0, "00000000"),
                          'D', ++directoryLines);
    directory += igesLine(fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}", 116, 0, 0, 1, 0), 'D', ++directoryLines);
    parameters +=
        igesLine(fmt::format("{:<64}{:>8}", fmt::format("116,{}.,1.,2.,0;", i), entry), 'P', parameterLines);
  }
  const auto lines = [&](char section) {
    return std::ranges::count_if(test::linesOf(head),
                                 [&](const std::string& line) { return line.at(72) == section; });
  };
  return head + directory + parameters +
         igesLine(
             fmt::format("S{:>7}G{:>7}D{:>7}P{:>7}", lines('S'), lines('G'), directoryLines, parameterLines),
             'T', 1);
}

TEST(ImportFormats, ProgressGrowsWhileIgesIsRead) {
  const TemporaryFolder folder;
  const std::vector<double> told = toldBelow(kReadEnd, folder.write("points.igs", igesOfPoints(90'000)));
  // Reading takes seconds of processor time; a tenth of one is told.
  EXPECT_FALSE(told.empty());
}

TEST(ImportFormats, BrepHasNoUnit) {
  const CadDocument document = imported(importModel("box.brep"));
  EXPECT_FALSE(document.hasUnit);
  expectBox(boxOf(document), {0, 0, 0}, {4, 2, 1});
  EXPECT_NEAR(document.shapes.at(0).exactVolume, 8.0, 1e-9);
  EXPECT_TRUE(document.shapes[0].isExact);
}

TEST(ImportFormats, GltfIsInMetresAndStandsUp) {
  const CadDocument document = imported(importModel("tetrahedra.glb"));
  EXPECT_TRUE(document.hasUnit);
  ASSERT_EQ(document.nodes.size(), 4U);
  EXPECT_EQ(document.nodes[0].name, "rack");
  EXPECT_EQ(document.nodes[1].name, "one");
  EXPECT_EQ(document.nodes[1].shape, document.nodes[2].shape);
  EXPECT_EQ(document.nodes[1].colour, (CadColour{0.0F, 1.0F, 0.0F}));
  // The file's y, up to 3 + 2, is z here, and its z, up to 2, is -y.
  expectBox(boxOf(document), {0, -2, 0}, {3, 0, 5});
}

TEST(ImportFormats, ThePinsBesideTheRepositoryAreTwoShapesInSevenPlaces) {
  const fs::path file = test::sharedModel("public/trimesh_pins.glb");
  if (!fs::exists(file)) return;
  const CadDocument document = imported(file);
  ASSERT_EQ(document.shapes.size(), 2U);
  ASSERT_EQ(document.nodes.size(), 8U);
  EXPECT_EQ(document.nodes[0].name, "world");
  std::size_t placed = 0, triangles = 0;
  for (const CadNode& node : document.nodes) {
    if (node.shape < 0) continue;
    ++placed;
    triangles += document.shapes.at(static_cast<std::size_t>(node.shape)).triangles.size();
  }
  // Instances, triangles and box of ../shared/models/MANIFEST.tsv; the file's y is z here, and its z is -y.
  EXPECT_EQ(placed, 7U);
  EXPECT_EQ(triangles, 3408U);
  constexpr double kDigitsOfManifest = 1e-3;
  expectBox(boxOf(document), {-63.2372, -215.567, 8.69099}, {190.763, -190.167, 262.691}, kDigitsOfManifest);
  // By trimesh 5.2.0 of PyPI: triangles, volumes, and the box of each mesh that graph.nodes_geometry places.
  EXPECT_EQ(document.shapes[0].key, "sides");
  EXPECT_EQ(document.shapes[0].triangles.size(), 1524U);
  EXPECT_NEAR(test::volumeOf(document.shapes[0]), 809102.27575, 1e-3);
  EXPECT_EQ(document.shapes[1].key, "dowel");
  EXPECT_EQ(document.shapes[1].triangles.size(), 314U);
  EXPECT_NEAR(test::volumeOf(document.shapes[1]), 799.02636406, 1e-6);
  // Rotations have six digits in the file.
  constexpr double kDigitsOfFile = 1e-5;
  expectBoxesOfNodes(
      document,
      {{"sides#1:5:2:4:3", {-63.237232, -215.567468, 8.690994}, {190.762768, -202.867468, 262.690994}},
       {"dowel#1:9:6:8:7", {115.580379, -215.567462, 100.770067}, {121.930379, -190.167462, 107.111907}},
       {"dowel#1:10:6:8:7", {60.589576, -215.567462, 69.016442}, {66.935960, -190.167462, 75.365532}},
       {"dowel#1:11:6:8:7", {60.589576, -215.567462, 196.016449}, {66.935960, -190.167462, 202.365539}},
       {"dowel#1:12:6:8:7", {5.596962, -215.567462, 100.766442}, {11.943346, -190.167462, 107.115532}},
       {"dowel#1:13:6:8:7", {115.582187, -215.567462, 164.266449}, {121.928571, -190.167462, 170.615539}},
       {"dowel#1:14:6:8:7", {5.595154, -215.567462, 164.270074}, {11.945154, -190.167462, 170.611914}}},
      kDigitsOfFile);
}

TEST(ImportFormats, GltfIsWeldedAndAScaleIsBakedIntoTheShape) {
  const CadDocument document = imported(importModel("tetrahedra.glb"));
  ASSERT_EQ(document.shapes.size(), 2U);
  for (const CadShape& shape : document.shapes) {
    EXPECT_EQ(shape.vertices.size(), 4U);
    EXPECT_EQ(test::unmatchedEdges(shape), 0U);
    EXPECT_TRUE(shape.surfaces.faces.empty());
    EXPECT_FALSE(shape.isExact);
  }
  const CadShape& scaled = document.shapes[static_cast<std::size_t>(document.nodes[3].shape)];
  EXPECT_NEAR(test::volumeOf(scaled), 8.0 / 6.0, 1e-12);
}

TEST(ImportFormats, GltfOfInfinitiesIsRefusedInOneSentenceWithARemedyThatHelps) {
  // Nine times infinity as a 32-bit float, then the indices 0, 1, 2 in 16 bits.
  const std::string data = "AACAfwAAgH8AAIB/AACAfwAAgH8AAIB/AACAfwAAgH8AAIB/AAABAAIA";
  const TemporaryFolder folder;
  const fs::path file = folder.write(
      "far.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"far","mesh":0}],
"meshes":[{"name":"far","primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,)" +
          data + R"("}]})");
  const FileError error = refusal(file);
  EXPECT_THAT(error.problem(), testing::AllOf(HasSubstr("no solids, shells or meshes"),
                                              testing::Not(HasSubstr(".)")), testing::Not(HasSubstr(".."))));
  EXPECT_THAT(error.remedy(), testing::AllOf(HasSubstr("finite"), testing::Not(HasSubstr("solids"))));
}

/// A tetrahedron in two primitives of two triangles each.
/// @param first, second  What the two say of their material.
std::string gltfOfTwoPrimitives(const std::string& first, const std::string& second) {
  // Four corners as 32-bit floats: the origin, and 1 along each axis; then the indices 0 2 1, 0 1 3, 1 2 3 and 2 0 3 in 16
  // bits.
  const std::string data =
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
      "AAACAAEAAAABAAMAAQACAAMAAgAAAAMA";
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"two","mesh":0}],
"meshes":[{"name":"two","primitives":[{"attributes":{"POSITION":0},"indices":1)" +
         first + R"(},{"attributes":{"POSITION":0},"indices":2)" + second + R"(}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}},
{"pbrMetallicRoughness":{"baseColorFactor":[0,0,1,1]}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"},
{"bufferView":1,"byteOffset":12,"componentType":5123,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
"buffers":[{"byteLength":72,"uri":"data:application/octet-stream;base64,)" +
         data + R"("}]})";
}

constexpr const char* kOfRed = R"(,"material":0)";
constexpr const char* kOfBlue = R"(,"material":1)";
constexpr CadColour kRedOfGltf{1.0F, 0.0F, 0.0F}, kBlueOfGltf{0.0F, 0.0F, 1.0F};

TEST(ImportFormats, GltfBringsMaterialsOfPrimitivesAsFaces) {
  const TemporaryFolder folder;
  const CadDocument document = imported(folder.write("two.gltf", gltfOfTwoPrimitives(kOfRed, kOfBlue)));
  ASSERT_EQ(document.shapes.size(), 1U);
  ASSERT_EQ(document.nodes.size(), 1U);
  const CadShape& shape = document.shapes[0];
  EXPECT_FALSE(document.nodes[0].colour.has_value());
  EXPECT_EQ(shape.faceColours, (std::vector<std::optional<CadColour>>{kRedOfGltf, kBlueOfGltf}));
  EXPECT_THAT(shape.surfaces.faceOfTriangle, testing::ElementsAre(0, 0, 1, 1));
  EXPECT_EQ(shape.vertices.size(), 4U);
  EXPECT_EQ(test::unmatchedEdges(shape), 0U);
  for (const ExactSurface& surface : shape.surfaces.faces)
    EXPECT_EQ(surface.kind, SurfaceKind::Other);
  EXPECT_FALSE(shape.isExact);
}

TEST(ImportFormats, GltfMeshHasTheColourOfItsPrimitivesOnlyIfAllHaveIt) {
  const TemporaryFolder folder;
  const CadDocument half = imported(folder.write("half.gltf", gltfOfTwoPrimitives(kOfRed, ""))),
                    blue = imported(folder.write("blue.gltf", gltfOfTwoPrimitives(kOfBlue, kOfBlue)));
  ASSERT_EQ(half.shapes.size(), 1U);
  EXPECT_FALSE(half.nodes.at(0).colour.has_value());
  EXPECT_EQ(half.shapes[0].faceColours, (std::vector<std::optional<CadColour>>{kRedOfGltf, std::nullopt}));
  ASSERT_EQ(blue.shapes.size(), 1U);
  // It is the part's, and can be changed with it.
  EXPECT_EQ(blue.nodes.at(0).colour, kBlueOfGltf);
  EXPECT_TRUE(blue.shapes[0].faceColours.empty());
  EXPECT_TRUE(blue.shapes[0].surfaces.faces.empty());
}

/// A .glb of two red and blue materials, and of a tetrahedron's corners (accessor 0), of which accessors 1 and 2 index two
/// triangles each, and accessor 3 all four.
std::string glbOfSharedCorners(const std::string& meshes, const std::string& nodes) {
  const std::array<float, 12> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::array<std::uint16_t, 12> indices{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  const auto raw = [](const auto& values) {
    return std::string(reinterpret_cast<const char*>(values.data()), sizeof(values));
  };
  const auto number = [](std::size_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    std::string bytes(sizeof(bits), '\0');
    std::memcpy(bytes.data(), &bits, sizeof(bits));
    return bytes;
  };
  const std::string data = raw(corners) + raw(indices);
  std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":)" + nodes +
                     R"(,"meshes":)" + meshes +
                     R"(,"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}},
{"pbrMetallicRoughness":{"baseColorFactor":[0,0,1,1]}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"},
{"bufferView":1,"byteOffset":12,"componentType":5123,"count":6,"type":"SCALAR"},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
"buffers":[{"byteLength":72}]})";
  while (text.size() % 4 != 0)
    text += ' ';
  const std::string body =
      number(text.size()) + "JSON" + text + number(data.size()) + std::string("BIN\0", 4) + data;
  return "glTF" + number(2) + number(12 + body.size()) + body;
}

TEST(ImportFormats, GlbPrimitivesThatShareTheirCornersKeepTheirColours) {
  const TemporaryFolder folder;
  // One mesh of two primitives, and one of the first of them in the other colour.
  const CadDocument document = imported(folder.write(
      "shared.glb",
      glbOfSharedCorners(
          R"([{"name":"both","primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0},
{"attributes":{"POSITION":0},"indices":2,"material":1}]},
{"name":"half","primitives":[{"attributes":{"POSITION":0},"indices":1,"material":1}]}])",
          R"([{"name":"both","mesh":0},{"name":"half","mesh":1}])")));
  ASSERT_EQ(document.shapes.size(), 2U);
  ASSERT_EQ(document.nodes.size(), 2U);
  const CadShape& both = document.shapes[static_cast<std::size_t>(document.nodes[0].shape)];
  EXPECT_EQ(both.faceColours, (std::vector<std::optional<CadColour>>{kRedOfGltf, kBlueOfGltf}));
  EXPECT_THAT(both.surfaces.faceOfTriangle, testing::ElementsAre(0, 0, 1, 1));
  EXPECT_EQ(document.nodes[1].colour, kBlueOfGltf);
  EXPECT_EQ(document.shapes[static_cast<std::size_t>(document.nodes[1].shape)].triangles.size(), 2U);
}

TEST(ImportFormats, GlbMeshesThatShareTheirPrimitivesHaveEachItsOwnColours) {
  const TemporaryFolder folder;
  const auto mesh = [](const char* name, int first, int second) {
    return fmt::format(
        R"({{"name":"{}","primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":{}}},
{{"attributes":{{"POSITION":0}},"indices":2,"material":{}}}]}})",
        name, first, second);
  };
  const CadDocument document = imported(folder.write(
      "swapped.glb", glbOfSharedCorners("[" + mesh("one", 0, 1) + "," + mesh("two", 1, 0) + "]",
                                        R"([{"name":"one","mesh":0},{"name":"two","mesh":1}])")));
  ASSERT_EQ(document.nodes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const CadShape& shape = document.shapes.at(static_cast<std::size_t>(document.nodes[i].shape));
    ASSERT_EQ(shape.triangles.size(), 4U) << i;
    ASSERT_EQ(shape.surfaces.faceOfTriangle.size(), 4U) << i;
    for (std::size_t t = 0; t < 4; ++t) {
      const CadColour wanted = (t < 2) == (i == 0) ? kRedOfGltf : kBlueOfGltf;
      EXPECT_EQ(shape.faceColours.at(shape.surfaces.faceOfTriangle[t]), wanted) << i << " " << t;
    }
  }
}

TEST(ImportFormats, GlbMeshesThatShareAllButTheirMaterialKeepTheirColours) {
  const TemporaryFolder folder;
  const CadDocument document = imported(folder.write(
      "twice.glb",
      glbOfSharedCorners(
          R"([{"name":"red","primitives":[{"attributes":{"POSITION":0},"indices":3,"material":0}]},
{"name":"blue","primitives":[{"attributes":{"POSITION":0},"indices":3,"material":1}]}])",
          R"([{"name":"red","mesh":0},{"name":"blue","mesh":1}])")));
  ASSERT_EQ(document.nodes.size(), 2U);
  EXPECT_EQ(document.nodes[0].colour, kRedOfGltf);
  EXPECT_EQ(document.nodes[1].colour, kBlueOfGltf);
}

/// Writes tetrahedra.glb as text, its buffer in a file of its own.
/// @param isBlueMoved  The second tetrahedron is blue instead of green.
fs::path writeGltfOfTwoFiles(const TemporaryFolder& folder, const std::string& name,
                             const std::string& buffer, bool isBlueMoved = false) {
  // Twelve bytes of the file's head; each chunk begins with its size, and four bytes that say what it is.
  const std::string glb = test::readBytes(importModel("tetrahedra.glb"));
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof(size));
  nlohmann::json json = nlohmann::json::parse(glb.substr(20, size));
  json["buffers"][0]["uri"] = fs::path(buffer).filename().string();
  if (isBlueMoved) {
    json["meshes"].push_back(json["meshes"][0]);
    json["meshes"][1]["primitives"][0]["material"] = 1;
    json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorFactor", {0.0, 0.0, 1.0, 1.0}}}}});
    json["nodes"][2]["mesh"] = 1;
  }
  folder.write(buffer, glb.substr(28 + size));
  return folder.write(name, json.dump());
}

TEST(ImportFormats, GltfListsTheFilesOfItsBuffers) {
  const TemporaryFolder folder;
  const CadDocument binary = imported(importModel("tetrahedra.glb"));
  EXPECT_TRUE(binary.areCompanionsKnown && binary.companions.empty());
  const CadDocument text = imported(writeGltfOfTwoFiles(folder, "rack.gltf", "rack.bin"));
  EXPECT_TRUE(text.areCompanionsKnown);
  ASSERT_EQ(text.companions.size(), 1U);
  EXPECT_EQ(text.companions[0].name, "rack.bin");
  EXPECT_EQ(text.companions[0].sha256, sha256OfFile(folder.path() / "rack.bin"));
  EXPECT_EQ(text.shapes.size(), binary.shapes.size());
}

TEST(ImportFormats, GltfWhoseBufferIsMissingOrAPipeIsRefusedAndNamesIt) {
  const TemporaryFolder folder;
  const fs::path file = writeGltfOfTwoFiles(folder, "rack.gltf", "rack.bin");
  fs::remove(folder.path() / "rack.bin");
  EXPECT_THAT(refusal(file).problem(), testing::AllOf(HasSubstr("rack.bin"), HasSubstr("no such file")));
  ASSERT_EQ(::mkfifo((folder.path() / "rack.bin").c_str(), 0600), 0);
  EXPECT_THAT(refusal(file).where(), HasSubstr("rack.bin"));
}

TEST(ImportFormats, ThreeMfBringsColoursOfTrianglesAsFaces) {
  const CadDocument document = imported(importModel("colours.3mf"));
  ASSERT_EQ(document.shapes.size(), 3U);
  ASSERT_EQ(document.nodes.size(), 3U);
  const CadColour red{1.0F, 0.0F, 0.0F}, teal{0.0F, 128.0F / 255.0F, 64.0F / 255.0F}, blue{0.0F, 0.0F, 1.0F};
  const CadShape& mixed = document.shapes[0];
  EXPECT_EQ(document.nodes[0].colour, red);
  ASSERT_EQ(mixed.triangles.size(), 4U);
  // The object's colour is the part's, and can be changed with it.
  EXPECT_EQ(mixed.faceColours, (std::vector<std::optional<CadColour>>{std::nullopt, teal, blue}));
  EXPECT_THAT(mixed.surfaces.faceOfTriangle, testing::ElementsAre(0, 1, 2, 2));
  for (const ExactSurface& surface : mixed.surfaces.faces)
    EXPECT_EQ(surface.kind, SurfaceKind::Other);
  EXPECT_FALSE(mixed.isExact);
}

TEST(ImportFormats, ThreeMfObjectWhoseTrianglesHaveOneColourIsAPartOfThatColour) {
  const CadDocument document = imported(importModel("colours.3mf"));
  ASSERT_EQ(document.shapes.size(), 3U);
  EXPECT_EQ(document.nodes[1].colour, (CadColour{0.0F, 1.0F, 0.0F}));
  EXPECT_FALSE(document.nodes[2].colour.has_value());
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_TRUE(document.shapes[i].surfaces.faces.empty()) << i;
    EXPECT_TRUE(document.shapes[i].faceColours.empty()) << i;
  }
}

/// tetrahedra.glb as text that holds its buffer.
std::string gltfOfOneFile() {
  const std::string glb = test::readBytes(importModel("tetrahedra.glb"));
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof(size));
  nlohmann::json json = nlohmann::json::parse(glb.substr(20, size));
  const TemporaryFolder folder;
  const fs::path buffer = folder.write("buffer", glb.substr(28 + size));
  json["buffers"][0]["uri"] =
      "data:application/octet-stream;base64," + test::runProcess({"base64", "--wrap=0", buffer.string()}).out;
  return json.dump();
}

/// A robot of a base with a mesh and an arm of primitives.
std::string robot(const std::string& mesh) {
  return R"(<robot name="arm"><link name="base"><visual><origin xyz="0 0 1"/><geometry><mesh filename=")" +
         mesh +
         R"(" scale="2 2 2"/></geometry><material name="m"><color rgba="1 0.5 0 1"/></material></visual></link>
<link name="tip"><collision><geometry><box size="0.2 0.4 0.6"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="base"/><child link="tip"/><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>)";
}

TEST(ImportFormats, DocumentsOfSeveralFilesComeFromTheCacheUntilOneChanges) {
  const TemporaryFolder folder, cache;
  const test::ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  const test::ScopedVariable where("NEARFIT_CACHE", cache.path().string());
  fs::create_directories(folder.path() / "arm" / "meshes");
  folder.write("arm/meshes/cube.stl", test::stlBinary(test::boxMesh(glm::dvec3(1.0), glm::dvec3(0.5))));
  const fs::path gltf = writeGltfOfTwoFiles(folder, "rack.gltf", "rack.bin"),
                 urdf = folder.write("arm/arm.urdf", robot("package://arm/meshes/cube.stl")),
                 buffer = folder.path() / "rack.bin";
  for (const fs::path& file : {gltf, urdf}) {
    EXPECT_FALSE(loadDocument(file, 1.0).isFromCache) << file;
    EXPECT_TRUE(loadDocument(file, 1.0).isFromCache) << file;
  }
  // The x of a corner that is at 1 in the first triangle, and of a cube.
  std::string bytes = test::readBytes(buffer);
  const float longer = 1.5F;
  for (std::size_t at = 0; at + 12 <= 144; at += 12) {
    float x = 0.0F;
    std::memcpy(&x, bytes.data() + at, sizeof(x));
    if (x == 1.0F) std::memcpy(bytes.data() + at, &longer, sizeof(longer));
  }
  folder.write("rack.bin", bytes);
  folder.write("arm/meshes/cube.stl", test::stlBinary(test::boxMesh(glm::dvec3(3.0), glm::dvec3(0.5))));
  const LoadedDocument rack = loadDocument(gltf, 1.0), arm = loadDocument(urdf, 1.0);
  EXPECT_FALSE(rack.isFromCache || arm.isFromCache);
  EXPECT_NEAR(rack.shapes[0]->mesh.bounds().upper.x, 1.5, 1e-6);
  EXPECT_NEAR(arm.shapes[0]->mass.volume, 8.0 * 27.0, 1e-6);
  EXPECT_TRUE(loadDocument(gltf, 1.0).isFromCache && loadDocument(urdf, 1.0).isFromCache);
}

TEST(ImportFormats, ThreeMfBringsItsUnitComponentsAndNames) {
  const CadDocument document = imported(importModel("set.3mf"));
  constexpr double kInch = 0.0254;
  EXPECT_EQ(document.statedUnit, kInch);
  ASSERT_EQ(document.nodes.size(), 3U);
  EXPECT_EQ(document.nodes[0].name, "set");
  EXPECT_EQ(document.nodes[1].name, "H\xC3\xBClse");
  EXPECT_EQ(document.shapes.size(), 1U);
  // One at (10, 0, 0); the other turned by 90 degrees about z: its x becomes y, and its y -x.
  expectBox(boxOf(document), glm::dvec3(10, 0, 0) * kInch, glm::dvec3(15, 7, 8) * kInch, 1e-7);
  expectBox(boxOf(document.shapes[0], test::worldFromNode(document, 2)), glm::dvec3(14, 6, 7) * kInch,
            glm::dvec3(15, 7, 8) * kInch, 1e-7);
  EXPECT_NEAR(test::volumeOf(document.shapes[0]), std::pow(kInch, 3) / 6.0, 1e-12);
}

TEST(ImportFormats, ThreeMfBringsTheColourOfAnObjectsMaterial) {
  const CadDocument document = imported(importModel("set.3mf"));
  ASSERT_EQ(document.nodes.size(), 3U);
  EXPECT_FALSE(document.nodes[0].colour.has_value());
  for (const std::size_t i : {1U, 2U}) {
    ASSERT_TRUE(document.nodes[i].colour.has_value());
    const CadColour wanted{0.0F, 128.0F / 255.0F, 64.0F / 255.0F};
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR((*document.nodes[i].colour)[k], wanted[k], 1e-6);
  }
}

/// A folder of a package with the robot in urdf/ and a cube of 1 m in meshes/.
class Package {
 public:
  explicit Package(const std::string& mesh) {
    fs::create_directories(root() / "urdf");
    fs::create_directories(root() / "meshes");
    folder_.write("arm_description/meshes/cube.stl",
                  test::stlBinary(test::boxMesh(glm::dvec3(1.0), glm::dvec3(0.5))));
    folder_.write("outside.stl", test::stlBinary(test::boxMesh(glm::dvec3(1.0), glm::dvec3(0.5))));
    file_ = folder_.write("arm_description/urdf/arm.urdf", robot(mesh));
  }
  fs::path root() const { return folder_.path() / "arm_description"; }
  const fs::path& file() const { return file_; }

 private:
  TemporaryFolder folder_;
  fs::path file_;
};

TEST(ImportFormats, UrdfPlacesLinksByTheirJointsAtZero) {
  const Package package("package://arm_description/meshes/cube.stl");
  const CadDocument document = imported(package.file());
  ASSERT_EQ(document.nodes.size(), 3U);
  EXPECT_EQ(document.nodes[0].name, "arm");
  EXPECT_EQ(document.nodes[1].name, "base");
  EXPECT_EQ(document.nodes[1].colour, (CadColour{1.0F, 0.5F, 0.0F}));
  EXPECT_EQ(document.nodes[2].name, "tip");
  expectBox(boxOf(document.shapes[static_cast<std::size_t>(document.nodes[1].shape)],
                  test::worldFromNode(document, 1)),
            {0, 0, 1}, {2, 2, 3});
  // A quarter turn: the box is 0.4 long along x.
  expectBox(boxOf(document.shapes[static_cast<std::size_t>(document.nodes[2].shape)],
                  test::worldFromNode(document, 2)),
            {0.8, 1.9, 2.7}, {1.2, 2.1, 3.3});
}

TEST(ImportFormats, UrdfListsItsMeshesWhateverIsWantedOfIt) {
  const Package package("package://arm_description/meshes/cube.stl");
  for (const std::vector<std::string>& wanted :
       {std::vector<std::string>(), std::vector<std::string>{"tip box"}}) {
    const CadDocument document = imported(package.file(), {{}, wanted});
    EXPECT_TRUE(document.areCompanionsKnown);
    ASSERT_EQ(document.companions.size(), 1U);
    EXPECT_EQ(document.companions[0].name, "package://arm_description/meshes/cube.stl");
    EXPECT_EQ(document.companions[0].sha256, sha256OfFile(package.root() / "meshes/cube.stl"));
  }
  EXPECT_FALSE(imported(Package("../meshes/missing.stl").file()).areCompanionsKnown);
}

TEST(ImportFormats, UrdfFindsMeshesWithinItsPackage) {
  for (const char* mesh : {"../meshes/cube.stl", "package://arm_description/meshes/cube.stl",
                           "package://renamed/meshes/cube.stl"})
    EXPECT_EQ(imported(Package(mesh).file()).shapes.size(), 2U) << mesh;
}

TEST(ImportFormats, UrdfReadsNothingOutsideOfItsPackage) {
  const Package elsewhere("x");
  for (const std::string& mesh :
       {std::string("../../outside.stl"), std::string("package://arm_description/../outside.stl"),
        "file://" + (elsewhere.root() / "meshes/cube.stl").string(),
        (elsewhere.root() / "meshes/cube.stl").string()}) {
    const CadDocument document = imported(Package(mesh).file());
    EXPECT_EQ(document.shapes.size(), 1U) << mesh;
    ASSERT_EQ(document.warnings.size(), 1U) << mesh;
    EXPECT_THAT(document.warnings[0], HasSubstr("is left out")) << mesh;
  }
}

/// A robot of a mesh, in a colour if that is given.
std::string robotOf(const std::string& mesh, const std::string& rgba = {}) {
  const std::string material =
      rgba.empty() ? std::string() : R"(<material name="m"><color rgba=")" + rgba + R"("/></material>)";
  return R"(<robot name="arm"><link name="base"><visual><origin xyz="0 0 1"/><geometry><mesh filename=")" +
         mesh + R"(" scale="2 2 2"/></geometry>)" + material + "</visual></link></robot>";
}

TEST(ImportFormats, UrdfTakesAGltfFileAsOneShapeOfAllItsNodes) {
  const TemporaryFolder folder;
  folder.write("rack.glb", test::readBytes(importModel("tetrahedra.glb")));
  const CadDocument document = imported(folder.write("arm.urdf", robotOf("rack.glb")));
  ASSERT_EQ(document.shapes.size(), 1U);
  ASSERT_EQ(document.nodes.size(), 2U);
  EXPECT_TRUE(document.warnings.empty());
  // The glTF file by itself is 3 x 2 x 5 m large, of which y, up in the file, is z; here it is twice that, 1 m up.
  expectBox(boxOf(document), {0, -4, 1}, {6, 0, 11});
  const CadShape& shape = document.shapes[0];
  EXPECT_EQ(shape.triangles.size(), 12U);
  EXPECT_EQ(test::unmatchedEdges(shape), 0U);
  // Two tetrahedra of a sixth, and one of twice the size, all twice as large.
  EXPECT_NEAR(test::volumeOf(shape), 8.0 * (2.0 + 8.0) / 6.0, 1e-12);
  EXPECT_EQ(document.nodes[1].name, "base");
  EXPECT_EQ(document.nodes[1].colour, (CadColour{0.0F, 1.0F, 0.0F}));
  EXPECT_TRUE(shape.faceColours.empty());
}

TEST(ImportFormats, UrdfKeepsTheColoursOfAGltfFileUnlessItGivesOneItself) {
  const TemporaryFolder folder;
  writeGltfOfTwoFiles(folder, "rack.gltf", "rack.bin", true);
  const CadDocument plain = imported(folder.write("plain.urdf", robotOf("rack.gltf")));
  ASSERT_EQ(plain.shapes.size(), 1U);
  const CadColour green{0.0F, 1.0F, 0.0F}, blue{0.0F, 0.0F, 1.0F};
  EXPECT_FALSE(plain.nodes.at(1).colour.has_value());
  EXPECT_EQ(plain.shapes[0].faceColours, (std::vector<std::optional<CadColour>>{green, blue}));
  EXPECT_EQ(plain.shapes[0].surfaces.faceOfTriangle,
            (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0}));
  const CadDocument red = imported(folder.write("red.urdf", robotOf("rack.gltf", "1 0 0 1")));
  ASSERT_EQ(red.shapes.size(), 1U);
  EXPECT_EQ(red.nodes.at(1).colour, (CadColour{1.0F, 0.0F, 0.0F}));
  EXPECT_TRUE(red.shapes[0].faceColours.empty());
}

TEST(ImportFormats, UrdfKeepsTheMaterialsOfPrimitivesUnlessItGivesAColourItself) {
  const TemporaryFolder folder;
  folder.write("two.gltf", gltfOfTwoPrimitives(kOfRed, kOfBlue));
  const CadDocument plain = imported(folder.write("plain.urdf", robotOf("two.gltf")));
  ASSERT_EQ(plain.shapes.size(), 1U);
  EXPECT_FALSE(plain.nodes.at(1).colour.has_value());
  EXPECT_EQ(plain.shapes[0].faceColours, (std::vector<std::optional<CadColour>>{kRedOfGltf, kBlueOfGltf}));
  EXPECT_THAT(plain.shapes[0].surfaces.faceOfTriangle, testing::ElementsAre(0, 0, 1, 1));
  const CadDocument green = imported(folder.write("green.urdf", robotOf("two.gltf", "0 1 0 1")));
  ASSERT_EQ(green.shapes.size(), 1U);
  EXPECT_EQ(green.nodes.at(1).colour, (CadColour{0.0F, 1.0F, 0.0F}));
  EXPECT_TRUE(green.shapes[0].faceColours.empty());
}

TEST(ImportFormats, UrdfListsTheBuffersOfItsGltfFilesToo) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "arm" / "meshes");
  folder.write("arm/package.xml", "<package/>");
  writeGltfOfTwoFiles(folder, "arm/meshes/rack.gltf", "arm/meshes/rack.bin");
  const fs::path file = folder.write("arm/arm.urdf", robotOf("package://arm/meshes/rack.gltf"));
  const CadDocument document = imported(file);
  EXPECT_TRUE(document.areCompanionsKnown);
  ASSERT_EQ(document.companions.size(), 2U);
  EXPECT_EQ(document.companions[0].name, "package://arm/meshes/rack.gltf");
  EXPECT_EQ(document.companions[1].name, "package://arm/meshes/rack.bin");
  EXPECT_EQ(document.companions[1].sha256, sha256OfFile(folder.path() / "arm/meshes/rack.bin"));
}

TEST(ImportFormats, UrdfLeavesOutAGltfFileThatIsDamagedOrLacksItsBuffer) {
  const TemporaryFolder folder;
  writeGltfOfTwoFiles(folder, "rack.gltf", "rack.bin");
  fs::remove(folder.path() / "rack.bin");
  EXPECT_THAT(refusal(folder.write("a.urdf", robotOf("rack.gltf"))).problem(),
              testing::AllOf(HasSubstr("rack.gltf is left out"), HasSubstr("rack.bin")));
  folder.write("rack.glb", "glTF");
  EXPECT_THAT(refusal(folder.write("b.urdf", robotOf("rack.glb"))).problem(),
              testing::AllOf(HasSubstr("rack.glb is left out"), HasSubstr("cut off")));
}

TEST(ImportFormats, UrdfSaysThatColladaIsNotRead) {
  const Package package("../meshes/arm.dae");
  {
    std::ofstream(package.root() / "meshes/arm.dae") << "<COLLADA/>";
  }
  const CadDocument document = imported(package.file());
  ASSERT_EQ(document.warnings.size(), 1U);
  EXPECT_THAT(document.warnings[0],
              testing::AllOf(HasSubstr("COLLADA (.dae) is not read"), HasSubstr("glTF")));
}

TEST(ImportFormats, TheRobotBesideTheRepositoryOpensWithAllLinksInTheirPlaces) {
  const fs::path file = test::sharedModel("public/unitree_dex1/dex1_1.urdf");
  if (!fs::exists(file)) return;
  const CadDocument document = imported(file);
  EXPECT_EQ(document.shapes.size(), 7U);
  EXPECT_EQ(document.nodes.size(), 8U);
  // By yourdfpy 0.0.60 and trimesh 5.2.0 of PyPI: boxes of the geometry in URDF.load(file).scene, all joints at 0.
  expectBoxesOfNodes(
      document,
      {{"base_link", {-0.034965925, 2e-9, -0.035}, {0.034965921, 0.073799998, 0.089048624}},
       {"Link1_1", {-0.039449998, 0.054299997, 0.0072}, {0.040549999, 0.068299996, 0.021700001}},
       {"Link1_2", {0.02155, 0.0655, -0.015200001}, {0.040549999, 0.147299996, 0.0152}},
       {"Link1_3", {0.025030833, 0.095337667, -0.0142}, {0.02903083, 0.144842958, 0.0142}},
       {"Link2_1", {-0.040549999, 0.054299997, -0.021700001}, {0.039449998, 0.068299996, -0.0072}},
       {"Link2_2", {-0.040549999, 0.0655, -0.0152}, {-0.02155, 0.147299996, 0.015200001}},
       {"Link2_3", {-0.02903083, 0.095337667, -0.0142}, {-0.025030833, 0.144842958, 0.0142}}},
      1e-7);
}

TEST(ImportFormats, GzipIsUnpackedWithinABound) {
  const TemporaryFolder folder;
  for (const char* name : {"bracket.step", "box.igs", "box.brep"}) {
    const fs::path copy = folder.write(name, test::readBytes(importModel(name)));
    ASSERT_EQ(test::runProcess({"gzip", copy.string()}).exitCode, 0);
    const fs::path packed = copy.string() + ".gz";
    EXPECT_TRUE(isDocumentFile(packed));
    const CadDocument plain = imported(importModel(name)), unpacked = imported(packed);
    EXPECT_EQ(unpacked.shapes.at(0).triangles, plain.shapes.at(0).triangles) << name;
    EXPECT_NE(unpacked.sha256, plain.sha256) << name;
  }
}

TEST(ImportFormats, GzipOfGltfAndUrdfIsUnpacked) {
  const Package package("package://arm_description/meshes/cube.stl");
  const TemporaryFolder folder;
  for (const fs::path& file : {folder.write("rack.gltf", gltfOfOneFile()), package.file()}) {
    const CadDocument plain = imported(file);
    ASSERT_EQ(test::runProcess({"gzip", "--keep", file.string()}).exitCode, 0);
    const fs::path packed = file.string() + ".gz";
    EXPECT_TRUE(isDocumentFile(packed));
    const CadDocument unpacked = imported(packed);
    ASSERT_FALSE(plain.shapes.empty());
    ASSERT_EQ(unpacked.shapes.size(), plain.shapes.size()) << packed;
    for (std::size_t i = 0; i < plain.shapes.size(); ++i) {
      EXPECT_FALSE(plain.shapes[i].triangles.empty());
      EXPECT_EQ(unpacked.shapes[i].vertices, plain.shapes[i].vertices) << packed;
      EXPECT_EQ(unpacked.shapes[i].triangles, plain.shapes[i].triangles) << packed;
    }
    ASSERT_EQ(unpacked.nodes.size(), plain.nodes.size()) << packed;
    for (std::size_t i = 0; i < plain.nodes.size(); ++i)
      EXPECT_EQ(unpacked.nodes[i].name, plain.nodes[i].name) << packed;
    EXPECT_EQ(unpacked.warnings, plain.warnings) << packed;
  }
}

TEST(ImportFormats, FilesOfAnotherFormatThanTheirNameSaysAreRefused) {
  const TemporaryFolder folder;
  for (const char* name : {"x.step", "x.igs", "x.brep", "x.gltf", "x.glb", "x.3mf", "x.urdf"}) {
    for (const std::string& content :
         {std::string("solid x\nendsolid x\n"), std::string(1000, '\0'), std::string()}) {
      const FileError error = refusal(folder.write(name, content));
      EXPECT_THAT(error.where(), HasSubstr(name));
      EXPECT_FALSE(error.remedy().empty()) << name;
    }
  }
}

TEST(ImportFormats, EachPrefixOfASmallFileIsReadOrRefused) {
  const TemporaryFolder folder;
  for (const char* name :
       {"box.brep", "set.3mf", "colours.3mf", "tetrahedra.glb", "box.igs", "two_solids.step"}) {
    const std::string bytes = test::readBytes(importModel(name));
    for (std::size_t k = 1; k < 12; ++k) {
      try {
        imported(folder.write(name, bytes.substr(0, bytes.size() * k / 12)));
      } catch (const FileError& error) {
        EXPECT_THAT(error.where(), HasSubstr(name));
      }
    }
  }
}

TEST(ImportFormats, ExtensionsTellDocumentsFromMeshes) {
  for (const char* name : {"a.step", "a.STP", "a.iges", "a.igs", "a.brep", "a.gltf", "a.GLB", "a.3mf",
                           "a.urdf", "a.step.gz", "a.URDF.GZ"})
    EXPECT_TRUE(isDocumentFile(name)) << name;
  for (const char* name :
       {"a.stl", "a.stl.gz", "a.3mf.gz", "a.glb.gz", "a.gz", "a", "step", "a.xacro", "a.dae"})
    EXPECT_FALSE(isDocumentFile(name)) << name;
  EXPECT_THAT(documentExtensions(), testing::Contains("step"));
}

}  // namespace
}  // namespace nearfit::import_formats_test
