#include "core/report/html/html_writer.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr const char* kHead =
    "<!DOCTYPE html>\n"
    "<html lang=\"en\">\n"
    "<head>\n"
    "<meta charset=\"utf-8\">\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
    "img-src data:\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";

/// A character of UTF-8 at the start of a text.
struct Utf8Character {
  std::size_t bytes = 0;  ///< 0: there is none.
  std::uint32_t code = 0;
};

Utf8Character firstOf(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t bytes = utf8CharacterLength(text);
  if (bytes == 0) return {};
  std::uint32_t code = bytes == 1 ? lead : lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i)
    code = code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
  return {bytes, code};
}

/// True for characters that HTML cannot hold, that turn the direction of text, or that nobody sees.
bool isDeceptive(std::uint32_t code) {
  constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 8> kRanges{{{0x061C, 0x061C},
                                                                            {0x200B, 0x200B},
                                                                            {0x200E, 0x200F},
                                                                            {0x2028, 0x202E},
                                                                            {0x2060, 0x206F},
                                                                            {0xFDD0, 0xFDEF},
                                                                            {0xFEFF, 0xFEFF},
                                                                            {0xFFF9, 0xFFFB}}};
  for (const auto& [first, last] : kRanges) {
    if (code >= first && code <= last) return true;
  }
  // Tags, and the last two of each plane, which are no characters.
  return (code >= 0xE0000 && code <= 0xE007F) || (code & 0xFFFEU) == 0xFFFEU;
}

void appendEscaped(std::string& to, std::string_view character, std::uint32_t code) {
  switch (code) {
    case '&':
      to += "&amp;";
      return;
    case '<':
      to += "&lt;";
      return;
    case '>':
      to += "&gt;";
      return;
    case '"':
      to += "&quot;";
      return;
    case '\'':
      to += "&#39;";
      return;
    default:
      break;
  }
  const bool isControl = code < 0x20 || (code >= 0x7F && code < 0xA0);
  if (isControl) {
    to += fmt::format("\\x{:02x}", code);
  } else if (isDeceptive(code)) {
    to += fmt::format("\\u{{{:x}}}", code);
  } else {
    to += character;
  }
}

std::string base64Of(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[(group >> (18U - 6U * k)) & 0x3FU] : '=';
  }
  return text;
}

}  // namespace

std::string htmlText(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Utf8Character character = firstOf(text);
    if (character.bytes == 0) {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
    } else {
      appendEscaped(result, text.substr(0, character.bytes), character.code);
    }
    text.remove_prefix(character.bytes == 0 ? 1 : character.bytes);
  }
  return result;
}

HtmlWriter::HtmlWriter(std::string_view title, std::string_view css) : text_(kHead) {
  if (css.find('<') != css.npos) throw Error("style of the page", "it holds a <");
  add("title", title);
  text_ += "\n<style>\n";
  text_ += css;
  text_ += "</style>\n</head>\n<body>\n";
}

void HtmlWriter::add(HtmlName tag, Attributes attributes, std::string_view text) {
  element(tag, attributes, [&] { put(text); });
}

void HtmlWriter::put(std::string_view text) {
  text_ += htmlText(text);
}

void HtmlWriter::putNumber(double value, std::string_view shown) {
  add("data", {{"value", fmt::format("{}", value)}}, shown);
}

void HtmlWriter::putPicture(std::string_view png, int width, int height, std::string_view description) {
  text_ += fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,", width,
                       height, htmlText(description));
  text_ += base64Of(png);
  text_ += "\">";
}

std::string HtmlWriter::take() {
  text_ += "\n</body>\n</html>\n";
  return std::move(text_);
}

void HtmlWriter::begin(HtmlName tag, Attributes attributes) {
  text_ += '<';
  text_ += tag.text();
  for (const HtmlAttribute& attribute : attributes) {
    text_ += ' ';
    text_ += attribute.name.text();
    text_ += "=\"";
    text_ += htmlText(attribute.value);
    text_ += '"';
  }
  text_ += '>';
}

void HtmlWriter::end(HtmlName tag) {
  // Line breaks where they are not seen, so that the file can be read and compared.
  constexpr std::array<std::string_view, 14> kOwnLine{"tr", "table", "section", "figure", "h1", "h2",  "h3",
                                                      "p",  "li",    "ul",      "header", "dl", "svg", "div"};
  text_ += "</";
  text_ += tag.text();
  text_ += '>';
  for (const std::string_view own : kOwnLine) {
    if (tag.text() == own) text_ += '\n';
  }
}

}  // namespace nearfit
