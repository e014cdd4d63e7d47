// Bodies that are meshed at the same time share nothing that OpenCASCADE writes to, and are as good as those meshed alone.
#include "app/import/meshing_plan.h"

#include <array>
#include <vector>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <gmock/gmock.h>
#include <gp_Pln.hxx>
#include <gp_Vec.hxx>
#include <gtest/gtest.h>

#include "app/import/solid_bodies.h"
#include "core/import/cad_document.h"
#include "tests/app/import/import_fixture.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::meshing_plan_test {
namespace {

using importer::Body;
using importer::MeshingPlan;
using testing::ElementsAre;
using testing::IsEmpty;

TopoDS_Shape box(double x) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, 0.0, 0.0), 1.0, 1.0, 1.0).Shape();
}

std::vector<TopoDS_Shape> facesOf(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    faces.push_back(face.Current());
  return faces;
}

MeshingPlan planFor(const std::vector<Body>& bodies, std::size_t threads) {
  std::vector<const Body*> pointers;
  for (const Body& body : bodies)
    pointers.push_back(&body);
  return importer::planMeshing(pointers, threads);
}

TEST(MeshingPlan, BodiesThatShareAnEdgeOrAFaceAreOneGroup) {
  // The first two faces of a box are opposite, the third meets both.
  const std::vector<TopoDS_Shape> faces = facesOf(box(0.0));
  const std::vector<Body> bodies{{{faces[0]}}, {{box(5.0)}}, {{faces[1]}}, {{faces[2]}}, {{faces[0]}}};
  const MeshingPlan plan = planFor(bodies, 1);
  EXPECT_THAT(plan.large, IsEmpty());
  EXPECT_THAT(plan.small, ElementsAre(ElementsAre(1U), ElementsAre(0U, 2U, 3U, 4U)));
  const std::vector<Body> apart{{{faces[0]}}, {{faces[1]}}};
  EXPECT_THAT(planFor(apart, 2).small, ElementsAre(ElementsAre(0U), ElementsAre(1U)));
}

TEST(MeshingPlan, OnlyBodiesWithMostOfTheFacesHaveAllThreads) {
  const std::vector<TopoDS_Shape> faces = facesOf(box(0.0));
  const std::vector<Body> bodies{
      {{facesOf(box(1.0))[0]}}, {{box(2.0)}}, {{facesOf(box(3.0))[0]}}, {{faces[0]}}};
  const MeshingPlan plan = planFor(bodies, 2);
  EXPECT_THAT(plan.large, ElementsAre(ElementsAre(1U)));
  EXPECT_THAT(plan.small, ElementsAre(ElementsAre(0U), ElementsAre(2U), ElementsAre(3U)));
}

TEST(MeshingPlan, SolidsThatShareAFaceAreClosedBoth) {
  // 24 pairs of prisms on the two sides of one face, so that there is always one to mesh beside another.
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  constexpr int kPairs = 24;
  for (int i = 0; i < kPairs; ++i) {
    const gp_Pln plane(gp_Pnt(20.0 * i, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0));
    const TopoDS_Shape face = BRepBuilderAPI_MakeFace(plane, 0.0, 10.0, 0.0, 10.0).Shape();
    for (const double height : {4.0, -6.0})
      builder.Add(all, BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, height)).Shape());
  }
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "prisms.brep";
  ASSERT_TRUE(BRepTools::Write(all, file.c_str()));
  const CadDocument document = test::imported(file);
  ASSERT_EQ(document.shapes.size(), 2U * kPairs);
  for (std::size_t i = 0; i < document.shapes.size(); ++i) {
    const CadShape& shape = document.shapes[i];
    EXPECT_THAT(shape.warnings, IsEmpty()) << i;
    EXPECT_EQ(shape.triangles.size(), 12U) << i;
    EXPECT_EQ(shape.vertices.size(), 8U) << i;
    // A file without units is read as it stands.
    EXPECT_NEAR(shape.exactVolume, i % 2 == 0 ? 400.0 : 600.0, 1e-6) << i;
  }
}

}  // namespace
}  // namespace nearfit::meshing_plan_test
