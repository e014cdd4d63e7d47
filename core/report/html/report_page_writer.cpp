#include "core/report/html/report_page_writer.h"

#include <fmt/format.h>

namespace nearfit {
namespace {

/// Light colours on white; rows, figures and lists of terms are not parted by pages, and heads of tables repeat. Pictures are
/// so high that all of the scene's stand on the first page, and three findings on each that follows, on A4 and Letter.
/// Columns are as wide as the words that are usual in them; what is longer breaks anywhere.
constexpr const char* kPageStyle =
    "@page { margin: 14mm; }\n"
    "* { box-sizing: border-box; }\n"
    "body { font: 10pt/1.4 sans-serif; color: #111; background: #fff; max-width: 190mm; margin: 0 auto; "
    "padding: 4mm;\n"
    "  print-color-adjust: exact; -webkit-print-color-adjust: exact; }\n"
    "h1 { font-size: 18pt; margin: 0 0 2mm; overflow-wrap: anywhere; }\n"
    "h2 { font-size: 13pt; margin: 8mm 0 2mm; border-bottom: 0.3mm solid #999; break-after: avoid; }\n"
    "h2 + p { break-after: avoid; break-inside: avoid; }\n"
    "h3 { font-size: 11pt; margin: 5mm 0 1mm; break-after: avoid; overflow-wrap: anywhere; }\n"
    "table { border-collapse: collapse; width: 100%; font-size: 8.5pt; }\n"
    "thead { display: table-header-group; }\n"
    "tr, figure, li, dl { break-inside: avoid; }\n"
    "li { overflow-wrap: anywhere; }\n"
    "th, td { border: 0.2mm solid #bbb; padding: 0.8mm 1.2mm; text-align: left; vertical-align: top;\n"
    "  overflow-wrap: anywhere; }\n"
    "th { background: #eee; overflow-wrap: normal; }\n"
    "td { min-width: 19mm; }\n"
    "td.number { text-align: right; overflow-wrap: normal; min-width: 0; }\n"
    "td.number data { white-space: nowrap; }\n"
    "dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.6mm 4mm; margin: 0; }\n"
    "dt { font-weight: bold; } dd { margin: 0; overflow-wrap: anywhere; }\n"
    "#path > dl { break-after: avoid; margin-bottom: 2mm; }\n"
    "code { font: 7.5pt/1.3 monospace; overflow-wrap: anywhere; }\n"
    "p.verdict { font-size: 12pt; padding: 2mm 3mm; border-left: 2mm solid; background: #eee;\n"
    "  overflow-wrap: anywhere; }\n"
    "p.good { background: #e9f6ec; border-color: #1a7f37; }\n"
    "p.bad { background: #fdeceb; border-color: #b3261e; }\n"
    "span.word { padding: 0 1mm; border-radius: 0.8mm; background: #eee; white-space: nowrap; }\n"
    "span.clash, span.contained { background: #f9d6d3; } span.touching { background: #fdecc8; }\n"
    "span.near { background: #fff6cf; } span.clear { background: #ddf3e1; }\n"
    "div.figures { display: grid; grid-template-columns: 1fr 1fr; gap: 3mm; }\n"
    "figure { margin: 0; } figcaption { font-size: 8.5pt; color: #333; }\n"
    "img, svg { display: block; width: 100%; height: auto; border: 0.2mm solid #ccc; padding: 0.3mm; }\n"
    "div.figures img { max-height: 52mm; object-fit: contain; }\n"
    "section.finding { break-inside: avoid; }\n"
    "ul, ol { margin: 1mm 0; padding-left: 6mm; }\n";

}  // namespace

std::string mmText(double metres) {
  return fmt::format("{:.6g} mm", 1e3 * metres);
}

ReportPageWriter::ReportPageWriter(std::string_view title, const Scene& scene)
    : HtmlWriter(title, kPageStyle), scene_(scene) {}

void ReportPageWriter::leftOutNote(std::size_t all, std::size_t shown, const char* what) {
  if (all > shown) sentence(fmt::format("{} more {} are left out of this page.", all - shown, what));
}

void ReportPageWriter::textTerm(const char* name, std::string_view text) {
  add("dt", name);
  add("dd", text);
}

void ReportPageWriter::putHeads(std::initializer_list<const char*> heads) {
  element("thead", [&] {
    element("tr", [&] {
      for (const char* head : heads)
        add("th", {{"scope", "col"}}, head);
    });
  });
}

void ReportPageWriter::countCell(std::size_t count) {
  numberCell([&] { put(fmt::format("{}", count)); });
}

void ReportPageWriter::putMore(std::size_t count) {
  put(fmt::format(" and {} more", count));
}

void ReportPageWriter::putPair(const PartPair& pair) {
  putPart(pair.part);
  put(" – ");
  putPart(pair.other);
}

void ReportPageWriter::putVerdict(PairVerdict verdict) {
  add("span", {{"class", fmt::format("word {}", wordOf(verdict))}}, wordOf(verdict));
}

void ReportPageWriter::putRule(const PairRule& rule) {
  if (rule.kind != PairRuleKind::PressFit) return putName(textOf(rule));
  put("press fit of ");
  putName(rule.part);
  put(" with ");
  putName(rule.other);
  put(" up to ");
  putLength(rule.interference);
}

void ReportPageWriter::putHash(const std::string& sha256) {
  if (!sha256.empty()) add("code", sha256);
}

}  // namespace nearfit
