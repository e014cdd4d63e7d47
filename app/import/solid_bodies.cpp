#include "app/import/solid_bodies.h"

#include <algorithm>
#include <optional>

#include <BRepBndLib.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Pnt.hxx>

namespace nearfit::importer {
namespace {

/// Shells that are compared with each other, which takes time by the square of their number. Castings have a dozen.
constexpr std::size_t kMaxComparedShells = 200;

Bnd_Box boxOf(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, Standard_False);
  return box;
}

bool isBoxWithin(const Bnd_Box& inner, const Bnd_Box& outer) {
  if (inner.IsVoid() || outer.IsVoid()) return false;
  const gp_Pnt a = inner.CornerMin(), b = inner.CornerMax(), c = outer.CornerMin(), d = outer.CornerMax();
  return a.X() >= c.X() && a.Y() >= c.Y() && a.Z() >= c.Z() && b.X() <= d.X() && b.Y() <= d.Y() &&
         b.Z() <= d.Z();
}

std::optional<gp_Pnt> pointOf(const TopoDS_Shape& shell) {
  const TopExp_Explorer vertices(shell, TopAbs_VERTEX);
  if (!vertices.More()) return std::nullopt;
  return BRep_Tool::Pnt(TopoDS::Vertex(vertices.Current()));
}

/// True if `inner` lies in the space that `outer` encloses, whichever way its faces look.
bool isWithin(const TopoDS_Shape& inner, const TopoDS_Shape& outer) {
  const std::optional<gp_Pnt> point = pointOf(inner);
  if (!point) return false;
  BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, outer);
  BRepClass3d_SolidClassifier classifier(solid);
  // A solid inside out holds what is far away.
  classifier.PerformInfinitePoint(Precision::Confusion());
  const bool isInsideOut = classifier.State() == TopAbs_IN;
  classifier.Perform(*point, Precision::Confusion());
  return classifier.State() == (isInsideOut ? TopAbs_OUT : TopAbs_IN);
}

}  // namespace

std::vector<Body> bodiesOf(const TopoDS_Shape& solid) {
  std::vector<TopoDS_Shape> shells;
  for (TopoDS_Iterator child(solid); child.More(); child.Next())
    if (child.Value().ShapeType() == TopAbs_SHELL) shells.push_back(child.Value());
  const std::size_t count = shells.size();
  if (count < 2 || count > kMaxComparedShells) return {Body{shells}};
  std::vector<Bnd_Box> boxes;
  for (const TopoDS_Shape& shell : shells)
    boxes.push_back(boxOf(shell));
  // How many shells are around each, and which: one within an odd number of others is a cavity.
  std::vector<std::vector<std::size_t>> around(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j)
      if (i != j && isBoxWithin(boxes[i], boxes[j]) && isWithin(shells[i], shells[j])) around[i].push_back(j);
  std::vector<Body> bodies;
  std::vector<std::size_t> bodyOf(count, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (around[i].size() % 2 != 0) continue;
    bodyOf[i] = bodies.size();
    bodies.push_back({{shells[i]}});
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (around[i].size() % 2 == 0) continue;
    // Directly around it is the one with one shell less around.
    for (const std::size_t outer : around[i])
      if (around[outer].size() + 1 == around[i].size() && bodyOf[outer] < count)
        bodies[bodyOf[outer]].shells.push_back(shells[i]);
  }
  return bodies;
}

TopoDS_Compound compoundOf(const std::vector<TopoDS_Shape>& shapes) {
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes)
    builder.Add(compound, shape);
  return compound;
}

}  // namespace nearfit::importer
