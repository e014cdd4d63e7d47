#include "core/scene/name_pattern.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

/// Bytes of the UTF-8 character that begins at `at`; at least one, whatever is there.
std::size_t characterBytes(std::string_view text, std::size_t at) noexcept {
  std::size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    ++end;
  return end - at;
}

/// One element of a pattern that stands for one byte or character.
struct PatternStep {
  std::size_t patternBytes = 0, nameBytes = 0;  ///< Zero if it does not match.
};

PatternStep stepAt(std::string_view pattern, std::size_t p, std::string_view name, std::size_t n) noexcept {
  if (p >= pattern.size()) return {};
  if (pattern[p] == '?') return {1, characterBytes(name, n)};
  const std::size_t literal = pattern[p] == '\\' && p + 1 < pattern.size() ? p + 1 : p;
  return pattern[literal] == name[n] ? PatternStep{literal - p + 1, 1} : PatternStep{};
}

}  // namespace

bool matchesPattern(std::string_view pattern, std::string_view name) noexcept {
  std::size_t p = 0, n = 0, retryName = 0;
  std::optional<std::size_t> afterStar;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      afterStar = ++p;
      retryName = n;
      continue;
    }
    const PatternStep step = stepAt(pattern, p, name, n);
    if (step.nameBytes > 0) {
      p += step.patternBytes;
      n += step.nameBytes;
    } else if (afterStar) {
      // Only the last star can take more: earlier ones have taken the least that they can.
      p = *afterStar;
      n = retryName += characterBytes(name, retryName);
    } else {
      return false;
    }
  }
  return pattern.substr(p).find_first_not_of('*') == pattern.npos;
}

std::string patternOf(std::string_view name) {
  std::string pattern;
  for (const char c : name) {
    if (c == '*' || c == '?' || c == '\\') pattern += '\\';
    pattern += c;
  }
  return pattern;
}

std::optional<std::string> onlyNameOf(std::string_view pattern) {
  std::string name;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] == '*' || pattern[i] == '?') return std::nullopt;
    if (pattern[i] == '\\' && i + 1 < pattern.size()) ++i;
    name += pattern[i];
  }
  return name;
}

void checkPattern(const std::string& pattern) {
  const auto fail = [](const char* problem, const char* remedy) {
    throw UsageError("pattern for names of parts", problem, remedy);
  };
  if (pattern.empty()) fail("it is empty", "give a name, or * for any");
  if (pattern.size() > kMaxPatternBytes) fail("it is longer than any name can be", "shorten it");
  if (!isPrintableUtf8(pattern)) fail("it is not UTF-8, or has control characters", "give printable text");
  std::size_t slashes = 0;
  while (slashes < pattern.size() && pattern[pattern.size() - 1 - slashes] == '\\')
    ++slashes;
  if (slashes % 2 == 0) return;
  throw UsageError(fmt::format("pattern \"{}\"", pattern), "nothing follows the last backslash",
                   "write \\\\ for a backslash");
}

}  // namespace nearfit
