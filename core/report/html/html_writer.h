#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace nearfit {

/// A text for content or attributes of HTML in UTF-8: &, <, > and quotes as references. Control characters, those that
/// change the direction of text or have no width, and what HTML cannot hold are made visible as `\x1b` or `\u{202e}`,
/// as are bytes that are no UTF-8: nothing looks like what it is not.
std::string htmlText(std::string_view text);

/// Name of an element or attribute. The compiler refuses all that could run or load something (scripts, links, events)
/// and elements without an end.
class HtmlName {
 public:
  consteval HtmlName(const char* name)
      : name_(name) {  // NOLINT(google-explicit-constructor): checks a literal.
    if (!isHarmless(name_)) throw "no HTML name, or one that could run or load something, or has no end";
  }
  constexpr std::string_view text() const noexcept { return name_; }

 private:
  static consteval bool isHarmless(std::string_view name) {
    for (const char c : name) {
      const bool isLetter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
      if (!isLetter && c != '-' && !(c >= '0' && c <= '9')) return false;
    }
    for (const std::string_view loading :
         {"script", "style", "link",   "iframe",     "frame",  "object", "embed",  "base",
          "form",   "img",   "image",  "use",        "audio",  "video",  "source", "src",
          "srcset", "href",  "action", "background", "poster", "ping",   "area",   "br",
          "col",    "hr",    "input",  "meta",       "param",  "track",  "wbr"}) {
      if (name == loading) return false;
    }
    return !name.empty() && !name.starts_with("on");
  }

  std::string_view name_;
};

struct HtmlAttribute {
  HtmlName name;
  std::string value;  ///< As it is to be read; the writer escapes it.
};

/// Writes one HTML5 document that needs nothing else. Whatever texts it is given, elements are nested and closed, and
/// no text becomes markup.
class HtmlWriter {
 public:
  using Attributes = std::initializer_list<HtmlAttribute>;

  /// Begins a document in English.
  /// @param css  For its style; must not hold '<'. Throws Error if it does.
  HtmlWriter(std::string_view title, std::string_view css);

  /// Writes an element with what `content()` writes in it.
  template <class Content>
  void element(HtmlName tag, Attributes attributes, const Content& content) {
    begin(tag, attributes);
    content();
    end(tag);
  }
  template <class Content>
  void element(HtmlName tag, const Content& content) {
    element(tag, {}, content);
  }
  /// Writes an element with a text in it.
  void add(HtmlName tag, Attributes attributes, std::string_view text);
  void add(HtmlName tag, std::string_view text) { add(tag, {}, text); }
  /// Writes text.
  void put(std::string_view text);
  /// Writes a name that a user or a file gave, kept apart from the direction of the text around it.
  void putName(std::string_view name) { add("bdi", name); }
  /// Writes a number for readers, and as it is for programs: with the fewest digits that read back as the same.
  void putNumber(double value, std::string_view shown);
  /// Writes a picture into the document itself.
  /// @param png          Bytes of a PNG file.
  /// @param description  For who cannot see it.
  void putPicture(std::string_view png, int width, int height, std::string_view description);

  /// Bytes written so far.
  std::size_t size() const noexcept { return text_.size(); }
  /// Ends the document and returns it. To be called once, last.
  std::string take();

 private:
  void begin(HtmlName tag, Attributes attributes);
  void end(HtmlName tag);

  std::string text_;
};

}  // namespace nearfit
