#include "core/report/html/html_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/html_document.h"
#include "tests/support/random_values.h"

namespace nearfit::html_writer_test {
namespace {

using ::testing::HasSubstr;

TEST(HtmlText, MarkupBecomesReferences) {
  EXPECT_EQ(htmlText("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&#39;");
  EXPECT_EQ(htmlText("Größe µ 螺絲 🔩"), "Größe µ 螺絲 🔩");
  EXPECT_EQ(htmlText(""), "");
}

TEST(HtmlText, CharactersThatDeceiveAreMadeVisible) {
  EXPECT_EQ(htmlText("a\tb\x1B[31m\x7F"), "a\\x09b\\x1b[31m\\x7f");
  EXPECT_EQ(htmlText(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(htmlText("\xC2\x85"), "\\x85") << "a control character of C1";
  EXPECT_EQ(htmlText("\u202Etxt.exe\u202C"), "\\u{202e}txt.exe\\u{202c}");
  EXPECT_EQ(htmlText("\u200B\u200F\u2066\uFEFF"), "\\u{200b}\\u{200f}\\u{2066}\\u{feff}");
  EXPECT_EQ(htmlText("\xEF\xBF\xBF"), "\\u{ffff}") << "no character";
  EXPECT_EQ(htmlText("\xF3\xA0\x81\x81"), "\\u{e0041}") << "a tag nobody sees";
}

TEST(HtmlText, BytesThatAreNoUtf8AreMadeVisible) {
  EXPECT_EQ(htmlText("a\xFFz"), "a\\xffz");
  EXPECT_EQ(htmlText("\xC3"), "\\xc3") << "cut";
  EXPECT_EQ(htmlText("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(htmlText("\xC0\xBC"), "\\xc0\\xbc") << "an overlong <";
}

TEST(HtmlWriter, APageIsValidWhateverTextsItHolds) {
  test::RandomValues random(3);
  for (int round = 0; round < 300; ++round) {
    const auto text = [&] {
      std::string bytes;
      const int size = static_cast<int>(random.in(1, 12));
      for (int i = 0; i < size; ++i) {
        constexpr std::string_view kLikely = "<>&\"'/=-!";
        const auto any = static_cast<char>(static_cast<int>(random.in(0, 255.9)));
        bytes += random.flip(0.5) ? kLikely[static_cast<std::size_t>(random.in(0, 8.9))] : any;
      }
      return bytes;
    };
    HtmlWriter html(text(), "p { color: #111; }\n");
    html.element("main", {{"id", "only"}, {"class", text()}}, [&] {
      html.add("h1", text() + "x");
      html.putName(text());
      html.element("p", [&] { html.putNumber(0.1, text()); });
      html.putPicture(text(), 2, 3, text() + "x");
    });
    const test::HtmlElement root = test::htmlDocument(html.take());
    ASSERT_EQ(test::elementsOf(root, "main").size(), 1U);
    ASSERT_EQ(test::elementsOf(root, "main").front().children.size(), 4U);
    if (HasFailure()) FAIL() << "round " << round;
  }
}

TEST(HtmlWriter, TextsAndPicturesReadBack) {
  HtmlWriter html("Title", "");
  std::string png;
  for (int i = 0; i < 256; ++i)
    png += static_cast<char>(i);
  html.add("h1", {{"title", "a \"b\" & c"}}, "1 < 2");
  for (std::size_t size = 0; size < 5; ++size)
    html.putPicture(png.substr(0, 252 + size), 4, 5, "noise");
  html.putNumber(0.1 + 0.2, "0.3");
  const test::HtmlElement root = test::htmlDocument(html.take());
  const test::HtmlElement heading = test::elementsOf(root, "h1").front();
  EXPECT_EQ(heading.text, "1 < 2");
  EXPECT_EQ(heading.attribute("title"), "a \"b\" & c");
  const auto pictures = test::elementsOf(root, "img");
  ASSERT_EQ(pictures.size(), 5U);
  for (std::size_t size = 0; size < 5; ++size)
    EXPECT_EQ(test::dataOfPicture(pictures[size]), png.substr(0, 252 + size));
  EXPECT_EQ(std::stod(test::elementsOf(root, "data").front().attribute("value")), 0.1 + 0.2);
}

TEST(HtmlWriter, AStyleThatWouldEndItselfIsRefused) {
  EXPECT_THROW(HtmlWriter("t", "</style><p>"), Error);
}

TEST(HtmlWriter, ThePageForbidsWhatItDoesNotNeed) {
  HtmlWriter html("t", "");
  html.add("h1", "t");
  EXPECT_THAT(html.take(), HasSubstr("default-src 'none'; style-src 'unsafe-inline'; img-src data:"));
}

}  // namespace
}  // namespace nearfit::html_writer_test
