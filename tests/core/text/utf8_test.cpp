#include "core/text/utf8.h"

#include <gtest/gtest.h>

namespace nearfit::utf8_test {
namespace {

// Boundaries from The Unicode Standard 15, table 3-7.
TEST(Utf8, WellFormedTextIsPrintable) {
  for (const char* text : {"", "Peg 2", "Zahnrad \xC3\xA4", "\xC2\xA0", "\xDF\xBF", "\xE0\xA0\x80",
                           "\xED\x9F\xBF", "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_TRUE(isPrintableUtf8(text)) << printableText(text);
  }
}

TEST(Utf8, IllFormedTextAndControlCharactersAreNot) {
  using namespace std::string_view_literals;
  for (const std::string_view text :
       {"\0"sv, "a\tb"sv, "\x7F"sv, "\xC2\x80"sv, "\xC2\x9F"sv, "\x80"sv, "\xC0\xAF"sv, "\xC1\xBF"sv,
        "\xC3"sv, "\xC3(\xC3"sv, "\xE0\x9F\xBF"sv, "\xED\xA0\x80"sv, "\xE2\x82"sv, "\xF0\x8F\xBF\xBF"sv,
        "\xF4\x90\x80\x80"sv, "\xF5\x80\x80\x80"sv, "\xFF"sv}) {
    EXPECT_FALSE(isPrintableUtf8(text)) << printableText(text);
  }
}

TEST(Utf8, ControlCharactersAreUtf8AllTheSame) {
  EXPECT_TRUE(isUtf8("a\tb\n\x7F\xC2\x80"));
  EXPECT_FALSE(isUtf8("a\t\xFF"));
}

TEST(Utf8, TruncationCutsNoCharacter) {
  EXPECT_EQ(truncatedUtf8("abc", 5), "abc");
  EXPECT_EQ(truncatedUtf8("abc", 2), "ab");
  EXPECT_EQ(truncatedUtf8("a\xE2\x82\xAC", 3), "a");
  EXPECT_EQ(truncatedUtf8("\xE2\x82\xAC", 2), "");
}

TEST(Utf8, PrintableTextShowsBytesThatAreNot) {
  EXPECT_EQ(printableText("\x1B[31mred\xFF \xC3\xA4"), "\\x1b[31mred\\xff \xC3\xA4");
}

}  // namespace
}  // namespace nearfit::utf8_test
