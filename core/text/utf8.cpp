#include "core/text/utf8.h"

#include <fmt/format.h>

namespace nearfit {

std::size_t utf8CharacterLength(std::string_view text) noexcept {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto isContinuation = [&](std::size_t i, unsigned lower = 0x80, unsigned upper = 0xBF) {
    return i < text.size() && byte(i) >= lower && byte(i) <= upper;
  };
  if (text.empty()) return 0;
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return isContinuation(1) ? 2 : 0;
  if (lead >= 0xE0 && lead <= 0xEF) {
    const unsigned lower = lead == 0xE0 ? 0xA0 : 0x80, upper = lead == 0xED ? 0x9F : 0xBF;
    return isContinuation(1, lower, upper) && isContinuation(2) ? 3 : 0;
  }
  if (lead >= 0xF0 && lead <= 0xF4) {
    const unsigned lower = lead == 0xF0 ? 0x90 : 0x80, upper = lead == 0xF4 ? 0x8F : 0xBF;
    return isContinuation(1, lower, upper) && isContinuation(2) && isContinuation(3) ? 4 : 0;
  }
  return 0;
}

namespace {

/// Like utf8CharacterLength(), but 0 for control characters.
std::size_t printableLength(std::string_view text) noexcept {
  const std::size_t length = utf8CharacterLength(text);
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (length == 1 && (byte(0) < 0x20 || byte(0) == 0x7F)) return 0;
  if (length == 2 && byte(0) == 0xC2 && byte(1) < 0xA0) return 0;
  return length;
}

bool consistsOf(std::size_t (*lengthOfFirst)(std::string_view) noexcept, std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t length = lengthOfFirst(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

}  // namespace

bool isUtf8(std::string_view text) noexcept {
  return consistsOf(utf8CharacterLength, text);
}

bool isPrintableUtf8(std::string_view text) noexcept {
  return consistsOf(printableLength, text);
}

std::string truncatedUtf8(std::string_view text, std::size_t maxBytes) {
  if (text.size() <= maxBytes) return std::string(text);
  const auto isContinuation = [text](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  while (maxBytes > 0 && isContinuation(maxBytes))
    --maxBytes;
  return std::string(text.substr(0, maxBytes));
}

std::string printableText(std::string_view text) {
  std::string printable;
  while (!text.empty()) {
    const std::size_t length = printableLength(text);
    if (length == 0) {
      printable += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
      text.remove_prefix(1);
    } else {
      printable += text.substr(0, length);
      text.remove_prefix(length);
    }
  }
  return printable;
}

}  // namespace nearfit
