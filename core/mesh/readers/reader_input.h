#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/mesh_builder.h"

namespace nearfit {

/// What each format's reader gets: a whole file in memory.
struct ReaderInput {
  std::string name;  ///< The file's path, for messages.
  std::span<const char> bytes;
  std::function<void(double fraction)> progress;  ///< Called now and then; throws Cancelled. May be empty.

  void report(double fraction) const {
    if (progress) progress(fraction);
  }
};

/// What each format's reader returns.
struct ReaderResult {
  PolygonSoup soup;
  std::vector<std::string> warnings;  ///< Sentences about the file, not about the shape.
};

/// A piece of a file fit for a message: shortened, control and non-ASCII characters replaced, in quotes.
std::string inQuotes(std::string_view text);

}  // namespace nearfit
