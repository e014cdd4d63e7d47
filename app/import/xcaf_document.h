#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "app/import/document_builder.h"
#include "app/import/import_job.h"
#include "app/import/shape_mesher.h"

class Message_ProgressRange;
class Quantity_Color;
class TDocStd_Document;
class TopoDS_Shape;

namespace nearfit::importer {

class EarlyMeshes;
class OccProgress;

/// How the shapes of an OpenCASCADE document are to be taken.
struct XcafOptions {
  double metresPerUnit = 1e-3;  ///< Of the document's coordinates; 1 and hasUnit false if they have none.
  bool hasUnit = true;
  bool areTriangles = false;   ///< Its shapes hold triangles alone.
  bool sewsFaces = false;      ///< Faces come one by one, and are to be joined where they meet.
  bool hasDirectives = false;  ///< Control directives of STEP stand for characters in its names.
  /// If it is set, the colour of a face of triangles, as its product places it: in a document of OpenCASCADE, faces that
  /// products share have the colour of the first one.
  std::function<std::optional<CadColour>(const TopoDS_Shape& face)> colourOfFace = {};
  /// Solids that are being meshed already, at their own scale; null: none.
  EarlyMeshes* early = nullptr;
};

/// Geometry of a document before it is meshed. Valid while ImportJob::takeExact runs.
struct ExactShape {
  const std::string& key;       ///< CadShape::key of the shape that it would become.
  const Body& body;             ///< Shells of a solid, or loose shells and faces.
  bool isSolid = false;         ///< The body is one.
  double metresPerUnit = 1e-3;  ///< Unit of the body's coordinates; negative if its placements mirror it.
  const ColourTable& colours;   ///< Colours of its product.
};

/// A colour of OpenCASCADE as ours.
CadColour cadColourOf(const Quantity_Color& colour);

/// Turns an OpenCASCADE document into ours: products are meshed once, however often they are placed. Throws FileError.
CadDocument readXcaf(TDocStd_Document& document, const XcafOptions& options, const ImportJob& job,
                     OccProgress& progress);

}  // namespace nearfit::importer
