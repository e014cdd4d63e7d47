#include "tests/support/html_document.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>

#include "core/text/utf8.h"

namespace nearfit::test {
namespace {

const std::set<std::string> kVoidTags{"meta", "img", "br", "hr", "link", "input", "col", "wbr"};
const std::set<std::string> kLoadingTags{"script", "link", "iframe", "object", "embed",
                                         "base",   "form", "audio",  "video"};

/// Reads a page from its start. After the first mistake it only ends.
class HtmlReader {
 public:
  explicit HtmlReader(const std::string& page) : page_(page) {}

  HtmlElement read() {
    skipBlanks();
    const std::string doctype = "<!DOCTYPE html>";
    EXPECT_EQ(page_.substr(at_, doctype.size()), doctype);
    at_ = std::min(page_.size(), at_ + doctype.size());
    skipBlanks();
    HtmlElement root = element();
    skipBlanks();
    if (!hasFailed_ && at_ != page_.size()) fail("bytes behind the end");
    return root;
  }

 private:
  void fail(const std::string& problem) {
    if (!hasFailed_) {
      ADD_FAILURE() << problem << " at byte " << at_ << ": " << page_.substr(at_ < 40 ? 0 : at_ - 40, 80);
    }
    hasFailed_ = true;
    at_ = page_.size();
  }
  char here() const { return at_ < page_.size() ? page_[at_] : '\0'; }
  void skipBlanks() {
    while (here() == ' ' || here() == '\n')
      ++at_;
  }
  bool take(const std::string& text) {
    if (page_.compare(at_, text.size(), text) != 0) return false;
    at_ += text.size();
    return true;
  }
  void require(const std::string& text) {
    if (!take(text)) fail("no " + text);
  }
  std::string name() {
    const std::size_t begin = at_;
    while (std::isalnum(static_cast<unsigned char>(here())) != 0 || here() == '-')
      ++at_;
    if (begin == at_) fail("no name");
    return page_.substr(begin, at_ - begin);
  }

  std::string reference() {
    static const std::map<std::string, std::string> kNamed{
        {"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}};
    for (const auto& [text, character] : kNamed) {
      if (take(text)) return character;
    }
    fail("an unknown reference");
    return "";
  }

  /// Text up to one of the characters.
  std::string textUpTo(const std::string& ends) {
    std::string text;
    while (at_ < page_.size() && ends.find(here()) == ends.npos) {
      if (here() == '&') {
        text += reference();
      } else if (here() == '<' || here() == '>') {
        fail("a stray " + std::string(1, here()));
      } else {
        text += page_[at_++];
      }
    }
    return text;
  }

  void readAttributes(HtmlElement& element) {
    while (!hasFailed_ && here() == ' ') {
      ++at_;
      const std::string key = name();
      require("=\"");
      const std::string value = textUpTo("\"");
      require("\"");
      if (!element.attributes.emplace(key, value).second) fail("an attribute twice: " + key);
    }
  }

  HtmlElement element() {
    HtmlElement element;
    require("<");
    if (hasFailed_) return element;
    element.tag = name();
    readAttributes(element);
    require(">");
    if (kVoidTags.contains(element.tag)) return element;
    if (element.tag == "style") {
      const std::size_t end = page_.find("</style>", at_);
      if (end == page_.npos) fail("a style without an end");
      if (!hasFailed_) element.text = page_.substr(at_, end - at_);
      if (!hasFailed_) at_ = end;
    }
    while (!hasFailed_ && page_.compare(at_, 2, "</") != 0) {
      if (at_ >= page_.size()) fail("no end of " + element.tag);
      if (here() == '<') {
        element.children.push_back(this->element());
        element.text += element.children.back().text;
      } else {
        element.text += textUpTo("<");
      }
    }
    require("</" + element.tag + ">");
    return element;
  }

  const std::string& page_;
  std::size_t at_ = 0;
  bool hasFailed_ = false;
};

void expectCharacters(const std::string& page) {
  std::string withoutBreaks = page;
  std::erase(withoutBreaks, '\n');
  EXPECT_TRUE(isPrintableUtf8(withoutBreaks)) << "a control character, or no UTF-8";
}

void expectNothingLoaded(const HtmlElement& element) {
  EXPECT_FALSE(kLoadingTags.contains(element.tag)) << element.tag;
  for (const auto& [key, value] : element.attributes) {
    EXPECT_FALSE(key.starts_with("on")) << key;
    EXPECT_NE(key, "href");
    EXPECT_NE(key, "srcset");
    const bool isInside =
        key == "src" ? value.starts_with("data:image/png;base64,") : value.find("url(") == value.npos;
    EXPECT_TRUE(isInside) << key << ": " << value.substr(0, 40);
  }
  if (element.tag == "style") {
    EXPECT_EQ(element.text.find("url("), element.text.npos);
    EXPECT_EQ(element.text.find("@import"), element.text.npos);
  }
}

void expectOrderOfHeadings(const HtmlElement& root) {
  int last = 0, first = 0;
  forEachElement(root, [&](const HtmlElement& element) {
    const std::string& tag = element.tag;
    if (tag.size() != 2 || tag[0] != 'h' || tag[1] < '1' || tag[1] > '6') return;
    const int level = tag[1] - '0';
    EXPECT_LE(level, last + 1) << element.text;
    EXPECT_FALSE(element.text.empty());
    first += level == 1 ? 1 : 0;
    last = level;
  });
  EXPECT_EQ(first, 1) << "one main heading";
}

void expectTables(const HtmlElement& root) {
  for (const HtmlElement& table : elementsOf(root, "table")) {
    const std::size_t heads = elementsOf(table, "th").size();
    for (const HtmlElement& body : elementsOf(table, "tbody")) {
      for (const HtmlElement& row : body.children) {
        EXPECT_EQ(row.tag, "tr");
        EXPECT_EQ(row.children.size(), heads) << row.text;
      }
    }
  }
}

}  // namespace

HtmlElement htmlDocument(const std::string& page) {
  expectCharacters(page);
  HtmlElement root = HtmlReader(page).read();
  EXPECT_EQ(root.tag, "html");
  EXPECT_FALSE(root.attribute("lang").empty());
  EXPECT_EQ(root.children.size(), 2U);
  for (const char* tag : {"head", "title", "body"})
    EXPECT_EQ(elementsOf(root, tag).size(), 1U) << tag;
  bool hasCharset = false;
  std::set<std::string> ids;
  forEachElement(root, [&](const HtmlElement& element) {
    expectNothingLoaded(element);
    if (element.tag == "meta" && element.attribute("charset") == "utf-8") hasCharset = true;
    EXPECT_TRUE(element.tag != "img" || !element.attribute("alt").empty());
    const std::string id = element.attribute("id");
    EXPECT_TRUE(id.empty() || ids.insert(id).second) << "twice: " << id;
  });
  EXPECT_TRUE(hasCharset);
  expectOrderOfHeadings(root);
  expectTables(root);
  return root;
}

void forEachElement(const HtmlElement& element, const std::function<void(const HtmlElement&)>& visit) {
  visit(element);
  for (const HtmlElement& child : element.children)
    forEachElement(child, visit);
}

std::vector<HtmlElement> elementsOf(const HtmlElement& root, const std::string& tag) {
  std::vector<HtmlElement> found;
  forEachElement(root, [&](const HtmlElement& element) {
    if (element.tag == tag) found.push_back(element);
  });
  return found;
}

HtmlElement elementWithId(const HtmlElement& root, const std::string& id) {
  HtmlElement found;
  bool isThere = false;
  forEachElement(root, [&](const HtmlElement& element) {
    if (element.attribute("id") != id) return;
    found = element;
    isThere = true;
  });
  EXPECT_TRUE(isThere) << id;
  return found;
}

std::string dataOfPicture(const HtmlElement& picture) {
  const std::string start = "data:image/png;base64,",
                    digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::string source = picture.attribute("src");
  EXPECT_TRUE(source.starts_with(start));
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : source.substr(std::min(start.size(), source.size()))) {
    if (c == '=') break;
    const std::size_t digit = digits.find(c);
    EXPECT_NE(digit, digits.npos) << c;
    bits = bits << 6U | static_cast<unsigned>(digit & 0x3FU);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((bits >> static_cast<unsigned>(count)) & 0xFFU);
  }
  return bytes;
}

}  // namespace nearfit::test
