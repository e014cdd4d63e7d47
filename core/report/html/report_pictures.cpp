#include "core/report/html/report_pictures.h"

#include <utility>

#include <fmt/format.h>

#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/report/html/finding_views.h"

namespace nearfit {
namespace {

/// Sizes of pictures of the scene and of findings [pixels]: two beside each other fill A4 at about 200 to the inch.
constexpr int kSceneWidth = 720, kSceneHeight = 540, kFindingWidth = 560, kFindingHeight = 420;
/// Share of the pictures' progress when meshes are prepared for drawing.
constexpr double kShapesMade = 0.4;

std::size_t addPicture(ReportPictures& pictures, ScenePicture scene, int width, int height) {
  pictures.all.push_back({std::move(scene), width, height});
  return pictures.all.size() - 1;
}

ReportPictures choosePictures(const FitReportRequest& request, const FitReport& report,
                              std::span<const ComparedFinding* const> rows) {
  ReportPictures pictures;
  const AssemblyPath* path = report.path && report.path->range > 0.0 ? &report.path->path : nullptr;
  for (const ReportSide& from : kReportSides)
    addPicture(pictures, sceneView(request.scene, from.side, path, kSceneWidth, kSceneHeight), kSceneWidth,
               kSceneHeight);
  for (const ComparedFinding* row : rows) {
    if (row->now == nullptr) continue;
    if (request.maxPictured != 0 && pictures.findings.size() == request.maxPictured) break;
    FindingViews views = findingViews(request.scene, *row->now, kFindingWidth, kFindingHeight);
    PicturedFinding pictured{
        row, addPicture(pictures, std::move(views.whole), kFindingWidth, kFindingHeight), {}};
    if (views.close)
      pictured.close = addPicture(pictures, std::move(*views.close), kFindingWidth, kFindingHeight);
    pictures.findings.push_back(pictured);
  }
  return pictures;
}

std::vector<PartGeometryPtr> drawnGeometries(const Scene& scene) {
  std::vector<PartGeometryPtr> geometries;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (hasTriangles(*part) && part->isVisible) geometries.push_back(part->geometry);
  }
  return geometries;
}

}  // namespace

ReportPictures drawReportPictures(const FitReportRequest& request, const FitReport& report,
                                  std::span<const ComparedFinding* const> rows,
                                  const ProgressCallback& progress) {
  ReportPictures pictures = choosePictures(request, report, rows);
  const DrawnShapes shapes(drawnGeometries(request.scene), stageCallback(progress, 0.0, kShapesMade));
  const ProgressCallback rest = stageCallback(progress, kShapesMade, 1.0);
  SharedProgress done(rest, static_cast<double>(pictures.all.size()));
  parallelFor(pictures.all.size(), [&](std::size_t i) {
    ReportPicture& picture = pictures.all[i];
    picture.png = pngOf(drawn(picture.scene, shapes, picture.width, picture.height));
    done.add(1.0);
  });
  return pictures;
}

void putFigure(ReportPageWriter& page, const ReportPicture& picture, const std::string& description,
               const std::string& caption) {
  page.element("figure", [&] {
    page.putPicture(picture.png, picture.width, picture.height, description);
    page.add("figcaption", fmt::format("{} {:.3g} mm across.", caption, 1e3 * picture.scene.view.extent));
  });
}

}  // namespace nearfit
