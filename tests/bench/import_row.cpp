#include "tests/bench/import_row.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "tests/bench/statistics.h"
#include "tests/bench/units.h"

namespace nearfit::bench {
namespace {

/// Difference of triangles, as a fraction of them, from which on others were meshed: the importer leaves out those that
/// collapse and faces that bound nothing, a per cent or so.
constexpr double kSameTriangles = 0.05;

template <typename Run>
std::vector<double> valuesOf(const std::vector<Run>& runs, const std::function<double(const Run&)>& value) {
  std::vector<double> values;
  for (const Run& run : runs)
    values.push_back(value(run));
  return values;
}

/// The figures of one document, one after the other.
class FigureList {
 public:
  explicit FigureList(const ImportSamples& samples) : samples_(samples) {}

  void add(const char* name, const char* unit, const std::vector<double>& values, double goal = 0.0) {
    if (values.empty()) return;
    const SampleSummary summary(values);
    figures_.push_back({samples_.document, name, unit, samples_.fresh.front().counts, values.size(),
                        summary.percentile(0.5), summary.max(), goal});
  }
  std::vector<ImportFigure> take() { return std::move(figures_); }

 private:
  const ImportSamples& samples_;
  std::vector<ImportFigure> figures_;
};

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / kMegabyte;
}

/// Most that both processes together had at any time, or more: the import beside all that Nearfit had until then, or what
/// Nearfit had after it.
double bytesPerTriangle(const ImportRun& run) {
  const std::uint64_t most = std::max(run.ownPeakBytes, run.besideImportBytes + run.importPeakBytes);
  return static_cast<double>(most) /
         static_cast<double>(std::max<std::size_t>(run.counts.placedTriangles, 1));
}

std::vector<double> ratiosOf(const ImportSamples& samples) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(samples.fresh.size(), samples.occ.size()); ++i)
    ratios.push_back(samples.fresh[i].seconds / samples.occ[i].seconds());
  return ratios;
}

const char* metText(const ImportFigure& figure, const char* missed) {
  if (figure.goal <= 0.0) return "";
  return figure.isMet() ? "yes" : missed;
}

bool isNearlyAsMany(std::size_t a, std::size_t b) {
  const auto x = static_cast<double>(a), y = static_cast<double>(b);
  return std::abs(x - y) <= kSameTriangles * std::max(x, y);
}

}  // namespace

std::vector<ImportFigure> figuresOf(const ImportSamples& samples) {
  const auto ofFresh = [&](const std::function<double(const ImportRun&)>& value) {
    return valuesOf(samples.fresh, value);
  };
  const auto ofOcc = [&](const std::function<double(const OccRun&)>& value) {
    return valuesOf(samples.occ, value);
  };
  const ImportGoals& goals = samples.goals;
  FigureList list(samples);
  list.add("file to ready to feel", "s", ofFresh([](const ImportRun& run) { return run.seconds; }),
           goals.seconds);
  list.add("thereof to all meshes", "s", ofFresh([](const ImportRun& run) { return run.loadSeconds; }));
  list.add("cache to ready to feel", "s",
           valuesOf<ImportRun>(samples.cached, [](const ImportRun& run) { return run.seconds; }),
           goals.cachedSeconds);
  list.add("OpenCASCADE alone", "s", ofOcc([](const OccRun& run) { return run.seconds(); }));
  list.add("thereof reading", "s", ofOcc([](const OccRun& run) { return run.readSeconds; }));
  list.add("thereof transfer", "s", ofOcc([](const OccRun& run) { return run.transferSeconds; }));
  list.add("thereof meshing", "s", ofOcc([](const OccRun& run) { return run.meshSeconds; }));
  list.add("ratio to OpenCASCADE", "x", ratiosOf(samples), goals.occRatio);
  list.add("triangles of OpenCASCADE", "1",
           ofOcc([](const OccRun& run) { return static_cast<double>(run.counts.placedTriangles); }));
  list.add("memory of nearfit-import", "MB",
           ofFresh([](const ImportRun& run) { return megabytes(run.importPeakBytes); }));
  list.add("memory of Nearfit", "MB",
           ofFresh([](const ImportRun& run) { return megabytes(run.ownPeakBytes); }));
  list.add("memory of OpenCASCADE", "MB", ofOcc([](const OccRun& run) { return megabytes(run.peakBytes); }));
  list.add("memory in all a triangle", "B", ofFresh(bytesPerTriangle), goals.triangleBytes);
  return list.take();
}

std::string importTableHeader() {
  return fmt::format("{:<20}{:>7}{:>10}{:>11}{:>11}  {:<26}{:<5}{:>5}{:>12}{:>12}{:>9}  {}\n", "document",
                     "shapes", "instances", "triangles", "placed", "figure", "unit", "runs", "median", "max",
                     "goal", "met");
}

std::string importTableLine(const ImportFigure& f) {
  const DocumentCounts& c = f.counts;
  return fmt::format("{:<20}{:>7}{:>10}{:>11}{:>11}  {:<26}{:<5}{:>5}{:>12.3f}{:>12.3f}{:>9}  {}\n",
                     f.document, c.shapes, c.instances, c.triangles, c.placedTriangles, f.name, f.unit,
                     f.runs, f.median, f.max, f.goal > 0.0 ? fmt::format("{:g}", f.goal) : std::string(),
                     metText(f, "NO"));
}

std::string importCsvHeader() {
  return "document,shapes,instances,triangles,placed_triangles,figure,unit,runs,median,max,goal,met\n";
}

std::string importCsvLine(const ImportFigure& f) {
  const DocumentCounts& c = f.counts;
  return fmt::format("{},{},{},{},{},{},{},{},{:.4f},{:.4f},{},{}\n", f.document, c.shapes, c.instances,
                     c.triangles, c.placedTriangles, f.name, f.unit, f.runs, f.median, f.max,
                     f.goal > 0.0 ? fmt::format("{:g}", f.goal) : std::string(), metText(f, "no"));
}

std::vector<std::string> problemsOf(const ImportSamples& samples) {
  std::vector<std::string> problems;
  const auto tell = [&](const std::string& problem) {
    problems.push_back(fmt::format("{}: {}", samples.document, problem));
  };
  const DocumentCounts& counts = samples.fresh.front().counts;
  const auto isAnother = [&](const ImportRun& run) { return run.counts != counts; };
  if (std::ranges::any_of(samples.fresh, &ImportRun::isFromCache)) tell("it came from an empty cache");
  if (!std::ranges::all_of(samples.cached, &ImportRun::isFromCache))
    tell("it was imported again although it was cached");
  if (std::ranges::any_of(samples.fresh, isAnother) || std::ranges::any_of(samples.cached, isAnother))
    tell("its counts differ from run to run");
  for (const OccRun& run : samples.occ) {
    if (run.counts.instances == counts.instances &&
        isNearlyAsMany(run.counts.placedTriangles, counts.placedTriangles))
      continue;
    tell(fmt::format("OpenCASCADE alone has {} instances of {} triangles, Nearfit {} of {}",
                     run.counts.instances, run.counts.placedTriangles, counts.instances,
                     counts.placedTriangles));
    break;
  }
  return problems;
}

}  // namespace nearfit::bench
