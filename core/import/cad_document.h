#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/exact_surface.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Fineness of the triangles that stand for exact surfaces.
struct Tessellation {
  /// Max distance between a surface and its triangles [m]; 0: chosen from the size of each shape.
  double chord = 0.0;
  double angle = 0.0;  ///< Max angle between neighbouring facets of a surface [rad]; 0: the default.
  bool operator==(const Tessellation&) const = default;
};

/// sRGB, each 0 to 1.
using CadColour = std::array<float, 3>;

/// Geometry of a document, which any number of nodes may place: one solid, or the loose shells of one product.
struct CadShape {
  /// Name within its file, unique and not empty: stays the same when the file is read again, whatever the tessellation.
  std::string key;
  std::vector<glm::dvec3> vertices;  ///< In metres, or in the file's units if the document has no unit.
  std::vector<Triangle> triangles;
  SurfaceFaces surfaces;                              ///< No faces for formats of triangles.
  std::vector<std::optional<CadColour>> faceColours;  ///< For each of surfaces.faces, or empty.
  Tessellation tessellation;                          ///< In effect.
  bool isExact = false;               ///< Came from exact surfaces, so that it can be refined.
  double exactVolume = 0.0;           ///< Of the exact solid [m^3]; 0 if unknown.
  std::vector<std::string> warnings;  ///< Such as gaps between its faces.
};

/// A place in the tree of a document: an assembly, or an instance of a shape.
struct CadNode {
  std::int32_t parent = -1;  ///< Index of a node before it; -1 at the top level.
  std::string name;          ///< UTF-8; may be empty or repeat.
  RigidTransform parentFromNode;
  std::int32_t shape = -1;  ///< Index of a shape; -1 for an assembly.
  std::optional<CadColour> colour;
};

/// A file that a document is read from besides its own: a buffer of a glTF file, a mesh of a URDF file.
struct CadCompanion {
  std::string name;    ///< As seen from the document: a path from its folder, or package://PACKAGE/PATH.
  std::string sha256;  ///< Of its bytes when the document was read.
};

/// Tree, shapes, names, colours and unit of an assembly file.
struct CadDocument {
  /// False for formats without units: lengths are in the file's own.
  bool hasUnit = true;
  /// Metres per unit that the file states for its numbers, where it may state a wrong one (3MF); else 1. Lengths here are
  /// in metres all the same.
  double statedUnit = 1.0;
  std::vector<CadShape> shapes;
  std::vector<CadNode> nodes;  ///< Parents first.
  std::vector<std::string> warnings;
  std::string sha256;  ///< Of the file's bytes, and for formats of several files of the main one.
  std::vector<CadCompanion> companions;
  /// False if more than the file and its companions decides what the document shows, such as files that are missing.
  bool areCompanionsKnown = true;
};

}  // namespace nearfit
