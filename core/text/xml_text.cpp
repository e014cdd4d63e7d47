#include "core/text/xml_text.h"

#include <algorithm>
#include <cstddef>

#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// Bytes of the character that begins the text, by its first one; 1 for what begins none.
std::size_t characterBytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t size = first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  return std::min(size, text.size());
}

/// What stands for a character; empty for itself.
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
    std::string_view character = text.substr(0, characterBytes(text));
    std::string_view written = character;
    if (!isUtf8(character)) {
      character = character.substr(0, 1);
      written = kReplacement;
    } else if (const std::string_view reference = referenceOf(character); !reference.empty()) {
      written = reference;
    }
    result += written;
    text.remove_prefix(character.size());
  }
  return result;
}

}  // namespace nearfit
