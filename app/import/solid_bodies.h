#pragma once

#include <vector>

class TopoDS_Compound;
class TopoDS_Shape;

namespace nearfit::importer {

/// One body of a solid: its outer shell, and the shells of its cavities.
struct Body {
  std::vector<TopoDS_Shape> shells;  ///< The outer one first.
};

/// Bodies of a solid. A solid of several shells has one outer shell and cavities, in theory; programs also write solids
/// apart from each other as one. Shells within no other are bodies; those within one of them its cavities, and so on.
std::vector<Body> bodiesOf(const TopoDS_Shape& solid);

TopoDS_Compound compoundOf(const std::vector<TopoDS_Shape>& shapes);

}  // namespace nearfit::importer
