#include "core/text/xml_text.h"

#include <algorithm>
#include <cstddef>

#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// Reference that stands for a character; empty if it stands for itself.
std::string_view referenceOf(std::string_view character) {
  if (character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF") return kReplacement;
  if (character.size() != 1) return {};
  switch (character.front()) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&apos;";
    case '\t':
      return "&#9;";
    case '\n':
      return "&#10;";
    case '\r':
      return "&#13;";
    default:
      return static_cast<unsigned char>(character.front()) < ' ' ? kReplacement : std::string_view();
  }
}

}  // namespace

std::string xmlText(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8CharacterLength(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    const std::string_view reference = length == 0 ? kReplacement : referenceOf(character);
    const std::string_view written = reference.empty() ? character : reference;
    result += written;
    text.remove_prefix(character.size());
  }
  return result;
}

}  // namespace nearfit
