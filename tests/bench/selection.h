#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace nearfit::bench {

/// Entries of the names asked for, in that order; every entry when `names` is just "all".
/// Throws UsageError for a name that no entry has, listing those that there are.
/// @tparam Entry  Has a `name`.
template <typename Entry>
std::vector<Entry> chosen(const std::vector<Entry>& entries, const std::vector<std::string>& names,
                          const std::string& option) {
  if (names == std::vector<std::string>{"all"}) return entries;
  std::vector<Entry> out;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.name == name; });
    if (found == entries.end()) {
      std::string known;
      for (const Entry& entry : entries)
        known += (known.empty() ? "" : ", ") + entry.name;
      throw UsageError(option, "there is no \"" + name + "\"", "choose from " + known);
    }
    out.push_back(*found);
  }
  return out;
}

}  // namespace nearfit::bench
