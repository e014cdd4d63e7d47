#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nearfit {

/// Whether the text is well-formed UTF-8: no overlong forms, surrogates or values beyond U+10FFFF.
/// Source: The Unicode Standard 15, table 3-7.
bool isUtf8(std::string_view text) noexcept;

/// Whether it also holds no control characters (C0, DEL, C1).
bool isPrintableUtf8(std::string_view text) noexcept;

/// The longest beginning of well-formed UTF-8 text that has at most `maxBytes` bytes and cuts no character.
std::string truncatedUtf8(std::string_view text, std::size_t maxBytes);

/// The text with each byte that is not printable UTF-8 as `\xNN`: what a message may show of a hostile name.
std::string printableText(std::string_view text);

}  // namespace nearfit
