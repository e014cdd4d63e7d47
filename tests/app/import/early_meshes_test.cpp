// Solids that are meshed while others are still read are as good as those meshed later.
#include "app/import/early_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Message_ProgressRange.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Solid.hxx>
#include <gmock/gmock.h>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>
#include <gp_Vec.hxx>
#include <gtest/gtest.h>

#include "app/import/import_job.h"
#include "app/import/occ_progress.h"
#include "app/import/shape_mesher.h"
#include "app/import/solid_bodies.h"
#include "core/import/document_file.h"
#include "tests/support/eventually.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::early_meshes_test {
namespace {

using importer::Body;
using importer::EarlyMeshes;
using importer::MeshRequest;

constexpr double kMetresPerMillimetre = 1e-3;

TopoDS_Shape cylinder(double radius, double x = 0.0) {
  const gp_Ax2 place(gp_Pnt(x, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0));
  return BRepPrimAPI_MakeCylinder(place, radius, 10.0).Shape();
}

TopoDS_Shape shellOf(const TopoDS_Shape& solid) {
  return TopExp_Explorer(solid, TopAbs_SHELL).Current();
}

/// A box with a cavity.
TopoDS_Shape hollowBox() {
  const BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shellOf(BRepPrimAPI_MakeBox(10.0, 10.0, 10.0).Shape()));
  builder.Add(solid, shellOf(BRepPrimAPI_MakeBox(gp_Pnt(2.0, 2.0, 2.0), 5.0, 5.0, 5.0).Shape()).Reversed());
  return solid;
}

/// A prism of so many sides.
TopoDS_Shape prismOf(std::size_t sides) {
  BRepBuilderAPI_MakePolygon outline;
  for (std::size_t i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(sides);
    outline.Add(gp_Pnt(10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.0));
  }
  outline.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()).Shape(), gp_Vec(0.0, 0.0, 5.0))
      .Shape();
}

MeshRequest requestFor(const Body& body) {
  MeshRequest request;
  request.body = body;
  request.isSolid = true;
  request.map = glm::dmat3(kMetresPerMillimetre);
  request.usesAllThreads = false;
  return request;
}

Body bodyOf(const TopoDS_Shape& solid) {
  return importer::bodiesOf(solid).front();
}

void expectSame(const CadShape& a, const CadShape& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.surfaces.faces, b.surfaces.faces);
  EXPECT_EQ(a.surfaces.faceOfTriangle, b.surfaces.faceOfTriangle);
  EXPECT_EQ(a.faceColours, b.faceColours);
  EXPECT_EQ(a.tessellation, b.tessellation);
  EXPECT_EQ(a.exactVolume, b.exactVolume);
  EXPECT_EQ(a.warnings, b.warnings);
}

TEST(EarlyMeshes, AreThoseThatAreMadeLaterAndAreGivenOnce) {
  std::vector<TopoDS_Shape> solids;
  for (const double radius : {1.0, 2.0, 3.0, 4.0})
    solids.push_back(cylinder(radius));
  EarlyMeshes early(requestFor({}), 2);
  for (const TopoDS_Shape& solid : solids)
    early.add(solid);
  ASSERT_TRUE(test::eventually([&] { return early.meshedCount() == 3; }));
  early.finish();
  for (std::size_t i = 0; i < 3; ++i) {
    const Body body = bodyOf(solids[i]);
    // Its shell as it is placed, and turned inside out.
    EXPECT_FALSE(early.take(Body{{body.shells.front().Reversed()}})) << i;
    std::optional<EarlyMeshes::Mesh> mesh = early.take(body);
    ASSERT_TRUE(mesh) << i;
    EXPECT_FALSE(early.take(body)) << i;
    MeshRequest request = requestFor(body);
    // One face of three has a colour.
    const importer::ColourTable colours{
        {TopExp_Explorer(solids[i], TopAbs_FACE).Current().TShape().get(), CadColour{1.0F, 0.0F, 0.0F}}};
    request.colours = &colours;
    importer::colourFaces(mesh->faces, colours, mesh->shape);
    expectSame(mesh->shape, importer::meshBody(request, Message_ProgressRange()));
    EXPECT_EQ(std::ranges::count_if(mesh->shape.faceColours, [](const auto& c) { return c.has_value(); }), 1);
  }
  // The last solid is left to all threads.
  EXPECT_FALSE(early.take(bodyOf(solids[3])));
}

TEST(EarlyMeshes, LeaveWhatSharesFacesHasCavitiesOrManyFaces) {
  const gp_Pln plane(gp_Pnt(20.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0));
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(plane, 0.0, 10.0, 0.0, 10.0).Shape();
  const TopoDS_Shape above = BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, 4.0)).Shape(),
                     below = BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, -6.0)).Shape(),
                     hollow = hollowBox(), many = prismOf(EarlyMeshes::kMaxFaces), next = cylinder(1.0),
                     last = cylinder(2.0);
  EarlyMeshes early(requestFor({}), 1);
  for (const TopoDS_Shape& solid : {above, below, hollow, many, next, last})
    early.add(solid);
  ASSERT_TRUE(test::eventually([&] { return early.meshedCount() == 2; }));
  early.finish();
  EXPECT_TRUE(early.take(bodyOf(above)));
  EXPECT_TRUE(early.take(bodyOf(next)));
  for (const TopoDS_Shape& left : {below, hollow, many, last})
    EXPECT_FALSE(early.take(bodyOf(left)));
}

TEST(EarlyMeshes, WithoutThreadsAllSolidsAreLeft) {
  EarlyMeshes early(requestFor({}), 0);
  const TopoDS_Shape solid = cylinder(1.0);
  early.add(solid);
  early.add(cylinder(2.0));
  early.finish();
  EXPECT_EQ(early.meshedCount(), 0U);
  EXPECT_FALSE(early.take(bodyOf(solid)));
}

TEST(EarlyMeshes, EndWhileSolidsWait) {
  // As where the rest of a file cannot be read.
  EarlyMeshes early(requestFor({}), 1);
  for (int i = 0; i < 50; ++i)
    early.add(cylinder(1.0 + i));
}

std::string bytesOf(const CadDocument& document) {
  std::string bytes;
  writeDocument(document, [&](std::span<const std::byte> part) {
    bytes.append(reinterpret_cast<const char*>(part.data()), part.size());
  });
  return bytes;
}

/// Reads a STEP file in this process. Nothing is meshed early if shapes are named.
CadDocument readHere(const std::filesystem::path& file, const std::vector<std::string>& onlyShapes = {}) {
  importer::ImportOptions options;
  options.file = file;
  options.onlyShapes = onlyShapes;
  importer::ImportJob job = importer::openJob(options);
  job.progress = [](double) {};
  job.endStage = [](const char*) {};
  return importer::readStep(job);
}

TEST(EarlyMeshes, DocumentHasTheSameBytesWithAndWithoutThem) {
  constexpr std::size_t kSolids = 24;
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "cylinders.step";
  importer::setUpOcc();
  STEPControl_Writer writer;
  for (std::size_t i = 0; i < kSolids; ++i) {
    const double at = static_cast<double>(i);
    ASSERT_EQ(writer.Transfer(cylinder(1.0 + 0.1 * at, 20.0 * at), STEPControl_AsIs), IFSelect_RetDone);
  }
  ASSERT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
  importer::ImportOptions options;
  options.file = file;
  std::size_t seen = 0;
  const auto read = [&] {
    importer::ImportJob job = importer::openJob(options);
    job.progress = [](double) {};
    job.endStage = [](const char*) {};
    job.tellEarly = [&](std::size_t solids, std::size_t) { seen = solids; };
    return importer::readStep(job);
  };
  const CadDocument whole = read();
  ASSERT_EQ(whole.shapes.size(), kSolids);
  // All were there to be meshed before the whole was, but perhaps the last.
  EXPECT_GE(seen, kSolids - 1);
  for (const CadShape& shape : whole.shapes)
    options.onlyShapes.push_back(shape.key);
  EXPECT_EQ(bytesOf(read()), bytesOf(whole));
  for (std::size_t i = 0; i < kSolids; ++i) {
    const double radius = kMetresPerMillimetre * (1.0 + 0.1 * static_cast<double>(i));
    const double volume = std::numbers::pi * radius * radius * 10.0 * kMetresPerMillimetre;
    EXPECT_NEAR(whole.shapes[i].exactVolume, volume, 1e-6 * volume) << i;
  }
}

/// The two solids of a model file, and entities that share with the first of them: a solid of the same shell, and an open
/// shell of one of its faces.
class SharedEntities : public ::testing::Test {
 protected:
  SharedEntities() {
    std::string text = test::readBytes(test::sourceFolder() / "tests/app/import/models/two_solids.step");
    const auto replace = [&text](const std::string& before, const std::string& after) {
      const std::size_t at = text.find(before);
      ASSERT_NE(at, std::string::npos) << before;
      text.replace(at, before.size(), after);
    };
    replace("(#11,#15,#345)", "(#11,#9001,#15,#9002,#345)");
    replace("#15 = MANIFOLD_SOLID_BREP('',#16);",
            "#15 = MANIFOLD_SOLID_BREP('',#16);\n#9001 = MANIFOLD_SOLID_BREP('',#16);\n"
            "#9002 = SHELL_BASED_SURFACE_MODEL('',(#9003));\n#9003 = OPEN_SHELL('',(#17));");
    folder_.write("shared.step", text);
    importer::setUpOcc();
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "shared.step";
};

/// Early meshes rest on this: no thread meshes what OpenCASCADE, or another thread, still works on.
TEST_F(SharedEntities, AreMadeForEachSolidAndOpenShellAnew) {
  STEPControl_Reader reader;
  ASSERT_EQ(reader.ReadFile(file_.c_str()), IFSelect_RetDone);
  reader.TransferRoots();
  const TopoDS_Shape whole = reader.OneShape();
  std::vector<TopoDS_Shape> bodies;
  for (TopExp_Explorer solid(whole, TopAbs_SOLID); solid.More(); solid.Next())
    bodies.push_back(solid.Current());
  ASSERT_EQ(bodies.size(), 3U);
  for (TopExp_Explorer shell(whole, TopAbs_SHELL, TopAbs_SOLID); shell.More(); shell.Next())
    bodies.push_back(shell.Current());
  for (TopExp_Explorer face(whole, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
    bodies.push_back(face.Current());
  ASSERT_EQ(bodies.size(), 4U);
  std::map<const void*, std::size_t> owners;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    std::size_t count = 0;
    for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX}) {
      for (TopExp_Explorer each(bodies[i], kind); each.More(); each.Next()) {
        const auto [owner, isNew] = owners.emplace(each.Current().TShape().get(), i);
        EXPECT_EQ(owner->second, i) << "kind " << kind;
        ++count;
      }
    }
    EXPECT_GT(count, 0U);
  }
}

TEST_F(SharedEntities, AreMeshedEarlyAsTheyAreLater) {
  const CadDocument whole = readHere(file_);
  std::vector<std::string> keys;
  for (const CadShape& shape : whole.shapes)
    keys.push_back(shape.key);
  ASSERT_EQ(keys.size(), 4U);
  EXPECT_EQ(bytesOf(readHere(file_, keys)), bytesOf(whole));
}

}  // namespace
}  // namespace nearfit::early_meshes_test
