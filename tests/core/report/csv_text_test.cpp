#include "core/report/csv_text.h"

#include <gtest/gtest.h>

namespace nearfit::csv_text_test {
namespace {

TEST(CsvField, PlainNamesStayAsTheyAre) {
  for (const char* name : {"", "Peg", "Peg 2", "M8x20", "a=b", "x-y", "\xC3\xA4", "/home/me/part's.stl"})
    EXPECT_EQ(csvField(name), name);
}

TEST(CsvField, WhatWouldEndAFieldIsQuoted) {
  EXPECT_EQ(csvField("a,b"), "\"a,b\"");
  EXPECT_EQ(csvField("a;b"), "\"a;b\"");
  EXPECT_EQ(csvField("say \"a\""), "\"say \"\"a\"\"\"");
  EXPECT_EQ(csvField("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csvField(" a"), "\" a\"");
  EXPECT_EQ(csvField("a "), "\"a \"");
}

TEST(CsvField, NamesThatASpreadsheetWouldRunAreMarkedAsText) {
  EXPECT_EQ(csvField("=1+1"), "\"'=1+1\"");
  EXPECT_EQ(csvField("=HYPERLINK(\"http://a\")"), "\"'=HYPERLINK(\"\"http://a\"\")\"");
  for (const char* name : {"+1", "-1+1", "@SUM(A1)", "\tx", "\rx", "\nx", "="})
    EXPECT_EQ(csvField(name), "\"'" + std::string(name) + "\"");
}

// Excel runs "＝cmd|'/C calc'!A0" in a Japanese environment (github.com/OWASP/www-community/issues/1088).
TEST(CsvField, FullWidthSignsOfFormulasAreMarkedAsText) {
  for (const char* name : {"\xEF\xBC\x9D"
                           "1",
                           "\xEF\xBC\x8B"
                           "1",
                           "\xEF\xBC\x8D"
                           "1",
                           "\xEF\xBC\xA0"
                           "SUM(A1)"})
    EXPECT_EQ(csvField(name), "\"'" + std::string(name) + "\"");
  // Full-width letters share the first two bytes.
  for (const char* name : {"\xEF\xBC\xA1", "\xEF\xBC", "A\xEF\xBC\x9D"})
    EXPECT_EQ(csvField(name), name);
}

}  // namespace
}  // namespace nearfit::csv_text_test
