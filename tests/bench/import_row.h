#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/bench/import_run.h"

namespace nearfit::bench {

/// Max values of a document's figures; 0: none is set.
struct ImportGoals {
  double seconds = 0.0;        ///< From the file until it can be felt.
  double cachedSeconds = 0.0;  ///< The same from the cache.
  double occRatio = 0.0;       ///< As a multiple of OpenCASCADE's own time.
  double triangleBytes = 0.0;  ///< Of both processes, for a triangle of the scene.
};

/// Runs of one document, in turns.
struct ImportSamples {
  std::string document;
  ImportGoals goals;
  std::vector<ImportRun> fresh, cached;
  std::vector<OccRun> occ;  ///< Empty where nearfit-bench-occ is not built.
};

/// One figure of a document.
struct ImportFigure {
  std::string document, name, unit;
  DocumentCounts counts;
  std::size_t runs = 0;
  double median = 0.0, max = 0.0;
  double goal = 0.0;  ///< The median is at most this; 0: none is set.

  bool isMet() const { return median <= goal; }
};

/// All figures of a document. Of a ratio the samples are those of each turn.
/// @param samples  With one run or more of each that is not empty.
std::vector<ImportFigure> figuresOf(const ImportSamples& samples);

std::string importTableHeader();
std::string importTableLine(const ImportFigure& figure);
std::string importCsvHeader();
std::string importCsvLine(const ImportFigure& figure);

/// Returns why figures are void, a sentence each: a first load from the cache, a second one without it, other counts
/// from run to run, or than OpenCASCADE's where both are to mesh the same by the same tolerances.
std::vector<std::string> problemsOf(const ImportSamples& samples);

}  // namespace nearfit::bench
