#pragma once

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include <glm/mat3x3.hpp>

#include "app/import/solid_bodies.h"
#include "core/import/cad_document.h"

class Message_ProgressRange;
class TopoDS_Shape;

namespace nearfit::importer {

/// Colours of faces and solids of a product, by TopoDS_TShape.
using ColourTable = std::unordered_map<const void*, CadColour>;

/// The colour of a shape; std::nullopt if the table has none.
std::optional<CadColour> findColour(const ColourTable& colours, const void* identity);

/// Geometry that becomes one CadShape.
struct MeshRequest {
  Body body;             ///< Shells of a solid, or loose shells and faces.
  bool isSolid = false;  ///< The body is one: its triangles should be closed, and look outward.
  glm::dmat3 map{1.0};   ///< From OpenCASCADE's coordinates to the shape's [m]; a multiple of the identity.
  bool hasUnit = true;  ///< False: the limits of the default tessellation, which are in metres, do not apply.
  Tessellation wanted;  ///< In the units of the shape.
  const ColourTable* colours = nullptr;
  /// If it is set, takes the TopoDS_TShape of each of the shape's surfaces.faces, for colourFaces().
  std::vector<const void*>* faces = nullptr;
  bool usesAllThreads = true;  ///< False: the calling one alone, beside others that mesh.
};

/// Triangles of exact surfaces, with their faces. Without triangles if none of them can be meshed.
///
/// Faces share the points on their common edges: these are joined by the edge, not by their distance, so that the
/// triangles of a sound solid are closed however coarse they are. What stays open is told in the warnings.
///
/// Writes into the faces and edges of the body meanwhile: thread-safe for bodies that share neither; see planMeshing().
CadShape meshBody(const MeshRequest& request, const Message_ProgressRange& progress);

/// Sets the colours of a shape's faces, where any has one.
/// @param faces  MeshRequest::faces.
void colourFaces(const std::vector<const void*>& faces, const ColourTable& colours, CadShape& shape);

/// Triangles of a shape that has nothing else, as files of triangles give. Those of faces of one colour become a face of
/// no known surface, if any has a colour.
/// @param map  From the shape's coordinates to those of the result.
CadShape meshTriangulated(const TopoDS_Shape& shape, const glm::dmat3& map, const ColourTable& colours);

}  // namespace nearfit::importer
