#include "app/import/step_text.h"

#include <charconv>
#include <cstdint>
#include <optional>

namespace nearfit::importer {
namespace {

void appendUtf8(std::uint32_t code, std::string& to) {
  const auto byte = [&](std::uint32_t b) { to += static_cast<char>(b); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0U | (code >> 6));
    byte(0x80U | (code & 0x3FU));
  } else if (code < 0x10000) {
    byte(0xE0U | (code >> 12));
    byte(0x80U | ((code >> 6) & 0x3FU));
    byte(0x80U | (code & 0x3FU));
  } else {
    byte(0xF0U | (code >> 18));
    byte(0x80U | ((code >> 12) & 0x3FU));
    byte(0x80U | ((code >> 6) & 0x3FU));
    byte(0x80U | (code & 0x3FU));
  }
}

std::optional<std::uint32_t> hexadecimal(std::string_view digits) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

bool isCharacter(std::uint32_t code) {
  return code != 0 && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
}

/// Characters of `size` digits each up to \X0\; returns the bytes taken, 0 if they are no such directive.
std::size_t takeWide(std::string_view text, std::size_t size, std::string& to) {
  constexpr std::string_view kEnd = "\\X0\\";
  const std::size_t end = text.find(kEnd);
  if (end == std::string_view::npos || end % size != 0) return 0;
  std::string decoded;
  std::uint32_t high = 0;
  for (std::size_t i = 0; i < end; i += size) {
    const std::optional<std::uint32_t> code = hexadecimal(text.substr(i, size));
    if (!code) return 0;
    std::uint32_t character = *code;
    // Programs also write UTF-16 where the standard asks for UCS-2.
    if (size == 4 && character >= 0xD800 && character <= 0xDBFF) {
      high = character;
      continue;
    }
    if (high != 0 && character >= 0xDC00 && character <= 0xDFFF)
      character = 0x10000 + ((high - 0xD800) << 10) + (character - 0xDC00);
    high = 0;
    if (isCharacter(character)) appendUtf8(character, decoded);
  }
  to += decoded;
  return end + kEnd.size();
}

/// Takes a directive at the begin of a text; returns its bytes, 0 if there is none.
std::size_t takeDirective(std::string_view text, std::string& to) {
  if (text.starts_with("\\\\")) {
    to += '\\';
    return 2;
  }
  if (text.starts_with("\\X2\\") || text.starts_with("\\X4\\")) {
    const std::size_t taken = takeWide(text.substr(4), text[2] == '2' ? 4 : 8, to);
    return taken == 0 ? 0 : 4 + taken;
  }
  if (text.starts_with("\\X\\") && text.size() >= 5) {
    const std::optional<std::uint32_t> code = hexadecimal(text.substr(3, 2));
    if (!code || !isCharacter(*code)) return 0;
    appendUtf8(*code, to);
    return 5;
  }
  if (text.starts_with("\\S\\") && text.size() >= 4 && static_cast<unsigned char>(text[3]) < 0x80) {
    appendUtf8(static_cast<unsigned char>(text[3]) + 0x80U, to);
    return 4;
  }
  if (text.starts_with("\\N\\")) {
    to += ' ';
    return 3;
  }
  return 0;
}

}  // namespace

std::string decodedStepText(std::string_view text) {
  std::string decoded;
  while (!text.empty()) {
    std::size_t taken = text.front() == '\\' ? takeDirective(text, decoded) : 0;
    if (taken == 0) {
      decoded += text.front();
      taken = 1;
    }
    text.remove_prefix(taken);
  }
  return decoded;
}

}  // namespace nearfit::importer
