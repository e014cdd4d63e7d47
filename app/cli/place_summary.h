#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/cli/place_run.h"

namespace nearfit::cli {

/// Input of the summary of `place`.
struct PlaceSummary {
  const std::string& part;
  std::size_t others;                 ///< Parts that can be felt.
  std::size_t poses;                  ///< Length of the path; 0 with a device.
  const ServoParameters& parameters;  ///< In force during the run.
  const PlaceResult& result;
  const std::string& record;      ///< Empty if none was written.
  const std::string& exportFile;  ///< Empty if none was written.
  /// Names of the parts of the group `part` that move as one, the one that leads first; empty for a part alone.
  std::vector<std::string> members{};
};

/// Returns lines for a reader; each ends in a line break.
std::string summaryText(const PlaceSummary& summary);

/// Returns one JSON object on one line; SI units, except times in microseconds, whose names say so.
std::string summaryJson(const PlaceSummary& summary);

}  // namespace nearfit::cli
