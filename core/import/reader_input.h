#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/mesh_builder.h"

namespace nearfit {

/// Input of each format's reader: a whole file in memory.
struct ReaderInput {
  std::string name;  ///< The file's path, for messages.
  /// The whole file; must outlive the reader.
  std::span<const char> bytes;
  std::function<void(double fraction)> progress;  ///< Called now and then; throws Cancelled. May be empty.

  void report(double fraction) const {
    if (progress) progress(fraction);
  }
};

/// Output of each format's reader.
struct ReaderResult {
  PolygonSoup soup;
  std::vector<std::string> warnings;  ///< Sentences about the file, not about the shape.
};

/// Quotes text from a file for a message: shortened, with control and non-ASCII characters replaced.
std::string inQuotes(std::string_view text);

}  // namespace nearfit
