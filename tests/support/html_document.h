#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace nearfit::test {

/// An element of a page.
struct HtmlElement {
  std::string tag;
  std::map<std::string, std::string> attributes;  ///< References resolved.
  std::string text;                               ///< Of it and all in it, references resolved.
  std::vector<HtmlElement> children;

  std::string attribute(const std::string& name) const {
    const auto found = attributes.find(name);
    return found == attributes.end() ? "" : found->second;
  }
};

/// Reads a page as a strict reader of HTML5 would, and fails the test where it does not keep to this: a doctype; elements
/// nested and closed, void ones not; attributes in quotes and named once; no stray <, > in text or unknown reference;
/// UTF-8 without control characters; one head with title and charset, one body; language; ids unique; headings in
/// order, each deeper by one at most; pictures with descriptions; rows of a table with as many cells as heads; no
/// script, no event, nothing loaded from elsewhere.
/// Returns the element `html`.
HtmlElement htmlDocument(const std::string& page);

/// Calls `visit` for an element and all in it, in their order.
void forEachElement(const HtmlElement& element, const std::function<void(const HtmlElement&)>& visit);

/// All elements of a tag.
std::vector<HtmlElement> elementsOf(const HtmlElement& root, const std::string& tag);
/// The element with an id; fails the test if there is none.
HtmlElement elementWithId(const HtmlElement& root, const std::string& id);

/// Bytes of a picture in the page: of an `img` with a data URI. Fails the test if it is none.
std::string dataOfPicture(const HtmlElement& picture);

}  // namespace nearfit::test
