#pragma once

#include <cstddef>
#include <string>

#include "app/cli/place_run.h"

namespace nearfit::cli {

/// What `place` tells of a run.
struct PlaceSummary {
  const std::string& part;
  std::size_t others;                 ///< Parts that could be felt.
  std::size_t poses;                  ///< Of the path; a device has none.
  const ServoParameters& parameters;  ///< That it ran with.
  const PlaceResult& result;
  const std::string& record;      ///< Empty when none was written.
  const std::string& exportFile;  ///< Empty when none was written.
};

/// Lines for a reader; each ends in a line break.
std::string summaryText(const PlaceSummary& summary);

/// One JSON object on one line; SI units but for the times in microseconds, whose names say so.
std::string summaryJson(const PlaceSummary& summary);

}  // namespace nearfit::cli
