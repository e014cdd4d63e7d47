#include "core/text/xml_text.h"

#include <gtest/gtest.h>

namespace nearfit::xml_text_test {
namespace {

TEST(XmlText, WhatHasAMeaningInXmlBecomesAReference) {
  EXPECT_EQ(xmlText("a<b>&\"c\" 'd'"), "a&lt;b&gt;&amp;&quot;c&quot; &apos;d&apos;");
  EXPECT_EQ(xmlText("\t\n\r"), "&#9;&#10;&#13;");
  EXPECT_EQ(xmlText("]]>"), "]]&gt;");
}

TEST(XmlText, OtherTextStays) {
  EXPECT_EQ(xmlText(""), "");
  EXPECT_EQ(xmlText("Bolzen \xC3\xBC \xE2\x82\xAC \xF0\x9F\x94\xA9"),
            "Bolzen \xC3\xBC \xE2\x82\xAC \xF0\x9F\x94\xA9");
}

TEST(XmlText, WhatXmlCannotHoldIsReplaced) {
  EXPECT_EQ(xmlText(std::string_view("a\0b\x1F", 4)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD");
  EXPECT_EQ(xmlText("\xEF\xBF\xBE\xEF\xBF\xBF"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(xmlText("\xC3"), "\xEF\xBF\xBD") << "cut off";
  EXPECT_EQ(xmlText("\xC3(\xA9"), "\xEF\xBF\xBD(\xEF\xBF\xBD");
}

}  // namespace
}  // namespace nearfit::xml_text_test
