#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

#include "core/report/html/html_writer.h"
#include "core/scene/pair_record.h"
#include "core/scene/pair_rule.h"
#include "core/scene/scene.h"

namespace nearfit {

/// A length for readers, in mm.
std::string mmText(double metres);

/// Writes the pieces that sections of a fit report are made of.
class ReportPageWriter : public HtmlWriter {
 public:
  /// @param title  Of the document.
  /// @param scene  Has all parts that are named by their ids; must outlive this.
  ReportPageWriter(std::string_view title, const Scene& scene);

  /// Writes a section under a heading.
  template <class Content>
  void section(const char* id, const char* heading, const Content& content) {
    element("section", {{"id", id}}, [&] {
      add("h2", heading);
      content();
    });
  }
  /// Writes a paragraph of text.
  void sentence(std::string_view text) { add("p", text); }
  /// Says how many rows or figures the page leaves out, if it does.
  void leftOutNote(std::size_t all, std::size_t shown, const char* what);

  /// Writes a term of a list "dl", with what `content()` writes of it.
  template <class Content>
  void term(const char* name, const Content& content) {
    add("dt", name);
    element("dd", content);
  }
  void textTerm(const char* name, std::string_view text);

  /// A table with heads; `rows()` writes its rows.
  template <class Rows>
  void table(std::initializer_list<const char*> heads, const Rows& rows) {
    element("table", [&] {
      putHeads(heads);
      element("tbody", rows);
    });
  }
  template <class Content>
  void cell(const Content& content) {
    element("td", content);
  }
  void textCell(std::string_view text) { add("td", text); }
  template <class Content>
  void numberCell(const Content& content) {
    element("td", {{"class", "number"}}, content);
  }
  void countCell(std::size_t count);

  /// Writes the first of `count` items, each by `putItem(index)`, and how many more than `max` there are.
  template <class PutItem>
  void putList(std::size_t count, std::size_t max, const char* separator, const PutItem& putItem) {
    for (std::size_t i = 0; i < std::min(count, max); ++i) {
      if (i > 0) put(separator);
      putItem(i);
    }
    if (count > max) putMore(count - max);
  }
  void putLength(double metres) { putNumber(metres, mmText(metres)); }
  void putPart(PartId id) { putName(scene_.get(id).name); }
  void putPair(const PartPair& pair);
  void putVerdict(PairVerdict verdict);
  /// The rule in words, its length as the page has lengths.
  void putRule(const PairRule& rule);
  /// @param sha256  Empty: writes nothing.
  void putHash(const std::string& sha256);

 private:
  void putHeads(std::initializer_list<const char*> heads);
  void putMore(std::size_t count);

  const Scene& scene_;
};

}  // namespace nearfit
