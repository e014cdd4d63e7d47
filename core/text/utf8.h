#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nearfit {

/// True if the text is well-formed UTF-8: no overlong forms, surrogates or values beyond U+10FFFF. Source:
/// The Unicode Standard 15, table 3-7.
bool isUtf8(std::string_view text) noexcept;

/// Length of the UTF-8 character at the start of the text [bytes]; 0 if there is none.
std::size_t utf8CharacterLength(std::string_view text) noexcept;

/// True if the text is well-formed UTF-8 without control characters (C0, DEL, C1).
bool isPrintableUtf8(std::string_view text) noexcept;

/// Longest prefix of well-formed UTF-8 text with at most `maxBytes` bytes that splits no character.
std::string truncatedUtf8(std::string_view text, std::size_t maxBytes);

/// The text with each byte that is not printable UTF-8 written as `\xNN`; safe to show in messages.
std::string printableText(std::string_view text);

}  // namespace nearfit
