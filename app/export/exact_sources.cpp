#include "app/export/exact_sources.h"

#include <cmath>
#include <map>
#include <utility>

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Solid.hxx>
#include <fmt/format.h>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>

#include "app/import/document_builder.h"
#include "app/import/read_document.h"
#include "app/import/solid_bodies.h"
#include "app/import/xcaf_document.h"
#include "core/base/error.h"

namespace nearfit::exporter {
namespace {

/// Difference of a scale from 1 that products of units leave.
constexpr double kScaleRounding = 1e-12;

TopoDS_Shape shapeOf(const importer::ExactShape& exact) {
  const std::vector<TopoDS_Shape>& shells = exact.body.shells;
  if (!exact.isSolid) {
    // A product has no place of its own.
    const bool isPlain = shells.size() == 1 && shells.front().Location().IsIdentity();
    return isPlain ? shells.front() : TopoDS_Shape(importer::compoundOf(shells));
  }
  const BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  for (const TopoDS_Shape& shell : shells)
    builder.Add(solid, shell);
  // Shells that were sewn, or of files that do not care, may look inward.
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

/// @param scale  From the shape's coordinates to millimetres.
ProductShape productOf(const importer::ExactShape& exact, double scale) {
  ProductShape product{shapeOf(exact), {}};
  for (TopExp_Explorer face(product.shape, TopAbs_FACE); face.More(); face.Next()) {
    const auto colour = exact.colours.find(face.Current().TShape().get());
    if (colour != exact.colours.end()) product.faceColours.emplace_back(face.Current(), colour->second);
  }
  if (std::abs(scale - 1.0) <= kScaleRounding) return product;
  gp_Trsf map;
  map.SetScale(gp_Pnt(0.0, 0.0, 0.0), scale);
  BRepBuilderAPI_Transform transform(product.shape, map, Standard_True);
  product.shape = transform.Shape();
  for (auto& entry : product.faceColours)
    entry.first = transform.ModifiedShape(entry.first);
  return product;
}

bool hasExactSurfaces(importer::DocumentFormat format) {
  return format == importer::DocumentFormat::Step || format == importer::DocumentFormat::Iges ||
         format == importer::DocumentFormat::Brep;
}

}  // namespace

ExactSources::ExactSources(const StepRequest& request)
    : request_(request), found_(request.document.shapes.size()) {
  std::map<std::pair<std::filesystem::path, std::string>, std::vector<std::size_t>> shapesOf;
  for (std::size_t i = 0; i < request.sources.size(); ++i)
    if (const auto& source = request.sources[i]) shapesOf[{source->file, source->sha256}].push_back(i);
  for (const auto& [file, shapes] : shapesOf) {
    try {
      importer::ImportOptions options;
      options.file = file.first;
      for (const std::size_t shape : shapes)
        options.onlyShapes.push_back(request.sources[shape]->key);
      Opened opened{importer::openJob(options), shapes};
      if (opened.job.sha256 != file.second) {
        importer::addWarning(notes_,
                             fmt::format("{} has changed since it was imported: its parts are written as "
                                         "facets.",
                                         file.first.string()));
      } else if (hasExactSurfaces(opened.job.format)) {
        files_.push_back(std::move(opened));
      }
    } catch (const Error& error) {
      importer::addWarning(notes_, fmt::format("{}: {}; its parts are written as facets.",
                                               file.first.string(), error.problem()));
    }
  }
}

std::uint64_t ExactSources::bytes() const {
  std::uint64_t sum = 0;
  for (const Opened& opened : files_)
    sum += opened.job.bytes.size();
  return sum;
}

void ExactSources::read(const std::function<void(double fraction)>& progress) {
  const auto count = static_cast<double>(files_.size());
  for (std::size_t i = 0; i < files_.size(); ++i) {
    Opened& opened = files_[i];
    opened.job.progress = [&, i](double fraction) { progress((static_cast<double>(i) + fraction) / count); };
    opened.job.endStage = [](const char*) {};
    try {
      readOne(opened);
    } catch (const Error& error) {
      importer::addWarning(notes_, fmt::format("{}: {}; its parts are written as facets.",
                                               opened.job.file.string(), error.problem()));
    }
    opened.job.bytes = {};
    progress(static_cast<double>(i + 1) / count);
  }
  for (auto& found : found_)
    if (found && found->shape.IsNull()) found.reset();
}

void ExactSources::readOne(Opened& opened) {
  std::map<std::string, std::vector<std::size_t>> byKey;
  for (const std::size_t shape : opened.shapes)
    byKey[request_.sources[shape]->key].push_back(shape);
  opened.job.takeExact = [&](const importer::ExactShape& exact) {
    for (const std::size_t shape : byKey[exact.key]) {
      const double scale =
          exact.metresPerUnit * request_.sources[shape]->metresPerUnit * kMillimetresPerMetre;
      try {
        found_[shape] = productOf(exact, scale);
      } catch (const Standard_Failure& failure) {
        importer::addWarning(
            notes_, fmt::format("\"{}\" is written as facets: {}.", exact.key, failure.GetMessageString()));
      }
    }
  };
  importer::readDocumentOf(opened.job);
  std::size_t missing = 0;
  for (const std::size_t shape : opened.shapes)
    if (!found_[shape]) ++missing;
  if (missing > 0)
    importer::addWarning(notes_, fmt::format("{}: {} of its shapes are written as facets.",
                                             opened.job.file.string(), missing));
}

}  // namespace nearfit::exporter
