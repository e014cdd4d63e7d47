#include "core/scene/names.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

/// "Peg 12" without its number: "Peg".
std::string withoutNumber(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789");
  if (end == std::string::npos || end + 1 == name.size() || name[end] != ' ' || end == 0) return name;
  return name.substr(0, end);
}

}  // namespace

void checkName(const char* kind, const std::string& name, std::size_t maxBytes) {
  if (name.empty()) throw UsageError("name", fmt::format("a {}'s name is empty", kind), "give it a name");
  if (name.size() > maxBytes) {
    throw UsageError("name", fmt::format("a {}'s name is longer than {} bytes", kind, maxBytes),
                     "shorten it");
  }
  if (!isPrintableUtf8(name)) {
    throw UsageError("name", fmt::format("a {}'s name holds control characters or is not UTF-8", kind),
                     "use printable text");
  }
}

std::string freeName(const std::string& wanted, const std::unordered_set<std::string_view>& taken,
                     std::size_t maxBytes) {
  if (!taken.contains(wanted)) return wanted;
  const std::string stem = withoutNumber(wanted);
  for (std::size_t number = 2;; ++number) {
    const std::string suffix = fmt::format(" {}", number);
    std::string name = truncatedUtf8(stem, maxBytes - suffix.size()) + suffix;
    if (!taken.contains(name)) return name;
  }
}

}  // namespace nearfit
