#include "core/scene/name_check.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/text/utf8.h"

namespace nearfit {

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

}  // namespace nearfit
