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

std::string TakenNames::takeFree(const std::string& wanted) {
  if (names_.insert(wanted).second) return wanted;
  const std::string stem = withoutNumber(wanted);
  std::size_t first = 2;
  for (std::size_t digits = 1, end = 10;; ++digits, end *= 10) {
    const std::string cut = truncatedUtf8(stem, maxBytes_ - digits - 1);
    std::size_t& next = next_.try_emplace(std::pair(cut, digits), first).first->second;
    while (next < end) {
      std::string name = fmt::format("{} {}", cut, next++);
      if (names_.insert(name).second) return name;
    }
    first = end;
  }
}

}  // namespace nearfit
