#include "tests/bench/import_load.h"

#include <memory>
#include <set>

#include "core/base/error.h"
#include "core/scene/document_load.h"
#include "core/scene/document_parts.h"
#include "core/scene/moving_body.h"
#include "core/scene/scene.h"
#include "core/servo/servo_scene.h"
#include "tests/bench/bench_clock.h"

namespace nearfit::bench {
namespace {

/// The unit of files that store none [m].
constexpr double kUnit = 1e-3;

DocumentCounts countsOf(const Scene& scene) {
  DocumentCounts counts;
  std::set<const PartGeometry*> seen;
  for (const PartGeometryPtr& geometry : scene.geometries()) {
    const std::size_t triangles = geometry->mesh.triangles().size();
    ++counts.instances;
    counts.placedTriangles += triangles;
    if (!seen.insert(geometry.get()).second) continue;
    ++counts.shapes;
    counts.triangles += triangles;
  }
  return counts;
}

}  // namespace

ImportRun loadToFeel(const std::filesystem::path& file) {
  ImportRun run;
  // A child that runs has not been waited for yet. Its result is read after its end.
  const auto watch = [&run](double) {
    if (peakChildBytes() == 0) run.besideImportBytes = peakResidentBytes();
    return true;
  };
  const double start = secondsBy(BenchClock::Wall);
  Scene scene;
  {
    const LoadedDocument document = loadDocument(file, kUnit, {}, watch);
    run.loadSeconds = secondsBy(BenchClock::Wall) - start;
    run.isFromCache = document.isFromCache;
    addTo(scene, partsOfDocument(document, scene));
  }
  if (scene.parts().empty()) throw FileError(file.string(), "it places no part", "give another file");
  scene.setMovingPart(scene.parts().front()->id);
  prepareToFeel(scene);
  const std::unique_ptr<const ServoScene> servoScene = makeServoScene(scene);
  run.seconds = secondsBy(BenchClock::Wall) - start;
  run.counts = countsOf(scene);
  run.ownPeakBytes = peakResidentBytes();
  // A child counts what its parent had before it became another program. That is little here.
  run.importPeakBytes = run.isFromCache ? 0 : peakChildBytes();
  if (run.isFromCache) run.besideImportBytes = 0;
  return run;
}

}  // namespace nearfit::bench
