#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/picture/scene_picture.h"
#include "core/report/html/clearance_plot.h"
#include "core/report/html/finding_views.h"
#include "core/report/html/fit_report.h"
#include "core/report/html/html_writer.h"
#include "core/report/scene_check_export.h"

namespace nearfit {
namespace {

/// Sizes of pictures of the scene and of findings [pixels]: two beside each other fill A4 at about 200 to the inch.
constexpr int kSceneWidth = 720, kSceneHeight = 540, kFindingWidth = 560, kFindingHeight = 420;
/// Share of the pictures' progress when meshes are prepared for drawing.
constexpr double kShapesMade = 0.4;
/// Names are listed up to this number in a sentence.
constexpr std::size_t kMaxNamed = 20;

/// Light colours on white; tables and figures are not parted by pages, and heads of tables repeat.
constexpr const char* kPageStyle =
    "@page { margin: 14mm; }\n"
    "* { box-sizing: border-box; }\n"
    "body { font: 10pt/1.4 sans-serif; color: #111; background: #fff; max-width: 190mm; margin: 0 auto; "
    "padding: 4mm;\n"
    "  print-color-adjust: exact; -webkit-print-color-adjust: exact; }\n"
    "h1 { font-size: 18pt; margin: 0 0 2mm; overflow-wrap: anywhere; }\n"
    "h2 { font-size: 13pt; margin: 8mm 0 2mm; border-bottom: 0.3mm solid #999; break-after: avoid; }\n"
    "h3 { font-size: 11pt; margin: 5mm 0 1mm; break-after: avoid; overflow-wrap: anywhere; }\n"
    "table { border-collapse: collapse; width: 100%; font-size: 8.5pt; }\n"
    "thead { display: table-header-group; }\n"
    "tr, figure, li { break-inside: avoid; }\n"
    "th, td { border: 0.2mm solid #bbb; padding: 0.8mm 1.2mm; text-align: left; vertical-align: top;\n"
    "  overflow-wrap: anywhere; }\n"
    "th { background: #eee; }\n"
    "td.number { text-align: right; overflow-wrap: normal; }\n"
    "dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.6mm 4mm; margin: 0; }\n"
    "dt { font-weight: bold; } dd { margin: 0; overflow-wrap: anywhere; }\n"
    "code { font: 7.5pt/1.3 monospace; overflow-wrap: anywhere; }\n"
    "p.verdict { font-size: 12pt; padding: 2mm 3mm; border-left: 2mm solid; overflow-wrap: anywhere; }\n"
    "p.good { background: #e9f6ec; border-color: #1a7f37; }\n"
    "p.bad { background: #fdeceb; border-color: #b3261e; }\n"
    "span.word { padding: 0 1mm; border-radius: 0.8mm; background: #eee; }\n"
    "span.clash, span.contained { background: #f9d6d3; } span.touching { background: #fdecc8; }\n"
    "span.near { background: #fff6cf; } span.clear { background: #ddf3e1; }\n"
    "div.figures { display: grid; grid-template-columns: 1fr 1fr; gap: 3mm; }\n"
    "figure { margin: 0; } figcaption { font-size: 8.5pt; color: #333; }\n"
    "img, svg { display: block; width: 100%; height: auto; border: 0.2mm solid #ccc; }\n"
    "section.finding { break-inside: avoid; }\n"
    "ul, ol { margin: 1mm 0; padding-left: 6mm; }\n";

/// A length for readers, in mm.
std::string mmText(double metres) {
  return fmt::format("{:.6g} mm", 1e3 * metres);
}

std::string pathText(const std::filesystem::path& file) {
  return file.string();
}

/// A picture of the page, drawn before it is written.
struct PagePicture {
  ScenePicture scene;
  int width, height;
  std::string png = {};
};

/// Pictures of a finding, by index among those of the page.
struct PicturedFinding {
  const ComparedFinding* finding;
  std::size_t whole;
  std::optional<std::size_t> close;
};

class ReportPage {
 public:
  ReportPage(const FitReportRequest& request, const FitReport& report)
      : request_(request),
        report_(report),
        rows_(findingsBySeverity(report.findings)),
        html_("Fit report: " + request.title, kPageStyle) {
    for (const Scene::PartPtr& part : request.scene.parts()) {
      if (!hasTriangles(*part)) withoutSurface_.push_back(part->name);
      if (hasTriangles(*part) && part->isVisible) geometries_.push_back(part->geometry);
    }
  }

  std::string write(const ProgressCallback& progress) {
    drawPictures(progress);
    html_.element("header", [&] { putHeader(); });
    html_.element("main", [&] {
      section("summary", "Summary", [&] { putSummary(); });
      section("pictures", "The scene", [&] { putScenePictures(); });
      section("pairs", "Pairs of parts", [&] { putPairs(); });
      section("findings", "Findings in pictures", [&] { putFindings(); });
      if (report_.path) section("path", "Path", [&] { putPath(*report_.path); });
      section("unchecked", "What was not checked", [&] { putUnchecked(); });
      section("parts", "Parts", [&] { putParts(); });
      section("settings", "Settings and rules", [&] { putSettings(); });
      section("inputs", "Inputs", [&] { putInputs(); });
      section("versions", "Versions", [&] { putVersions(); });
    });
    return html_.take();
  }

 private:
  // Pictures.

  std::size_t addPicture(ScenePicture scene, int width, int height) {
    pictures_.push_back({std::move(scene), width, height});
    return pictures_.size() - 1;
  }

  void choosePictures() {
    const AssemblyPath* path = report_.path && report_.path->range > 0.0 ? &report_.path->path : nullptr;
    for (const PictureSide side :
         {PictureSide::Isometric, PictureSide::Front, PictureSide::Right, PictureSide::Top})
      addPicture(sceneView(request_.scene, side, path, kSceneWidth, kSceneHeight), kSceneWidth, kSceneHeight);
    for (const ComparedFinding* row : rows_) {
      if (row->now == nullptr || pictured_.size() == kMaxPicturedFindings) continue;
      FindingViews views = findingViews(request_.scene, *row->now, kFindingWidth, kFindingHeight);
      PicturedFinding pictured{row, addPicture(std::move(views.whole), kFindingWidth, kFindingHeight), {}};
      if (views.close) pictured.close = addPicture(std::move(*views.close), kFindingWidth, kFindingHeight);
      pictured_.push_back(pictured);
    }
  }

  void drawPictures(const ProgressCallback& progress) {
    choosePictures();
    const DrawnShapes shapes(geometries_, stageCallback(progress, 0.0, kShapesMade));
    const ProgressCallback rest = stageCallback(progress, kShapesMade, 1.0);
    SharedProgress done(rest, static_cast<double>(pictures_.size()));
    parallelFor(pictures_.size(), [&](std::size_t i) {
      PagePicture& picture = pictures_[i];
      picture.png = pngOf(drawn(picture.scene, shapes, picture.width, picture.height));
      done.add(1.0);
    });
  }

  void putFigure(std::size_t index, const std::string& description, const std::string& caption) {
    const PagePicture& picture = pictures_[index];
    html_.element("figure", [&] {
      html_.putPicture(picture.png, picture.width, picture.height, description);
      html_.add("figcaption", fmt::format("{} {} across.", caption, mmText(picture.scene.view.extent)));
    });
  }

  // Pieces of the page.

  template <class Content>
  void section(const char* id, const char* heading, const Content& content) {
    html_.element("section", {{"id", id}}, [&] {
      html_.add("h2", heading);
      content();
    });
  }
  template <class Content>
  void paragraph(const Content& content) {
    html_.element("p", content);
  }
  void sentence(std::string_view text) { html_.add("p", text); }

  template <class Content>
  void term(const char* name, const Content& content) {
    html_.add("dt", name);
    html_.element("dd", content);
  }
  void textTerm(const char* name, std::string_view text) {
    html_.add("dt", name);
    html_.add("dd", text);
  }
  void length(double metres) { html_.putNumber(metres, mmText(metres)); }
  void name(PartId id) { html_.putName(request_.scene.get(id).name); }
  void names(const PartPair& pair) {
    name(pair.part);
    html_.put(" – ");
    name(pair.other);
  }
  void hash(const std::string& sha256) {
    if (!sha256.empty()) html_.add("code", sha256);
  }

  /// A table with heads; `rows()` writes its rows.
  template <class Rows>
  void table(std::initializer_list<const char*> heads, const Rows& rows) {
    html_.element("table", [&] {
      html_.element("thead", [&] {
        html_.element("tr", [&] {
          for (const char* head : heads)
            html_.add("th", {{"scope", "col"}}, head);
        });
      });
      html_.element("tbody", rows);
    });
  }
  template <class Content>
  void cell(const Content& content) {
    html_.element("td", content);
  }
  void textCell(std::string_view text) { html_.add("td", text); }
  template <class Content>
  void numberCell(const Content& content) {
    html_.element("td", {{"class", "number"}}, content);
  }
  void countCell(std::size_t count) {
    numberCell([&] { html_.put(fmt::format("{}", count)); });
  }
  void verdictWord(PairVerdict verdict) {
    html_.add("span", {{"class", fmt::format("word {}", wordOf(verdict))}}, wordOf(verdict));
  }

  void leftOutNote(std::size_t all, std::size_t shown, const char* what) {
    if (all > shown) sentence(fmt::format("{} more {} are left out of this page.", all - shown, what));
  }

  // Sections.

  void putHeader() {
    html_.element("h1", [&] {
      html_.put("Fit report: ");
      html_.putName(request_.title);
    });
    const ReportOrigin& origin = request_.origin;
    html_.element("dl", [&] {
      textTerm("Date", origin.date);
      if (!origin.author.empty()) term("Made by", [&] { html_.putName(origin.author); });
      textTerm("With", origin.program);
    });
  }

  void putSummary() {
    html_.add("p", {{"class", report_.isGood() ? "verdict good" : "verdict bad"}},
              verdictSentence(request_, report_));
    const SceneCheck& check = report_.check;
    table({"Parts", "Pairs checked", "Clear", "Near", "Touching", "Clash", "Contained", "Not allowed",
           "Left out"},
          [&] {
            html_.element("tr", [&] {
              countCell(check.parts.size());
              countCell(check.checkedPairs());
              for (const PairVerdict verdict : {PairVerdict::Clear, PairVerdict::Near, PairVerdict::Touching,
                                                PairVerdict::Clash, PairVerdict::Contained})
                countCell(check.count(verdict));
              countCell(check.forbidden());
              countCell(check.leftOut.size());
            });
          });
    sentence(fmt::format(
        "Clear: farther apart than the threshold of {}. Near: apart, but nearer. Touching: within what "
        "rounding comes to. Clash: surfaces pass through each other. Contained: one part is inside the "
        "other. Not allowed: clashes and contained parts that no rule allows.",
        mmText(check.threshold)));
    const bool hasLast = std::ranges::any_of(
        report_.findings, [](const ComparedFinding& finding) { return finding.before.has_value(); });
    if (!hasLast) return;
    const FindingChanges changes = changesIn(report_.findings);
    sentence(fmt::format(
        "Since the last check {} new, {} worse, {} better and {} gone. Changed: accepted by the user, and "
        "worse or of "
        "another verdict since.",
        countOf(changes.added, "finding is", "findings are"), changes.worse, changes.better, changes.gone));
  }

  void putScenePictures() {
    constexpr std::array<const char*, 4> kSides{
        "Isometric: from the right, the front and above.", "Front: along +y; x to the right, z up.",
        "Right: along -x; y to the right, z up.", "Top: along -z; x to the right, y up."};
    html_.element("div", {{"class", "figures"}}, [&] {
      for (std::size_t i = 0; i < kSides.size(); ++i)
        putFigure(i, fmt::format("The visible parts of the scene. {}", kSides[i]), kSides[i]);
    });
  }

  void putPairs() {
    if (rows_.empty()) return sentence("No pair is within the threshold.");
    const std::size_t shown = std::min(rows_.size(), kMaxFindingRows);
    table({"No.", "Parts", "Verdict", "Distance", "Depth", "Shared volume", "Rule", "State"}, [&] {
      for (std::size_t i = 0; i < shown; ++i)
        html_.element("tr", [&] { putPairRow(i + 1, *rows_[i]); });
    });
    leftOutNote(rows_.size(), shown, "pairs");
    sentence(
        "Depth: length of the least translation known to free the part; ≤ where a shorter one may exist. "
        "Numbers are those "
        "of the triangles. Each is in the file as it was computed, in SI units (the value of its data "
        "element).");
  }

  void putPairRow(std::size_t number, const ComparedFinding& row) {
    const PairFinding* now = row.now;
    countCell(number);
    cell([&] { names(row.pair); });
    cell([&] {
      verdictWord(now != nullptr ? now->verdict : PairVerdict::Clear);
      if (now == nullptr) html_.put(" (gone)");
    });
    numberCell([&] {
      if (now != nullptr) length(now->distance);
    });
    numberCell([&] {
      if (now == nullptr || !now->depth()) return;
      if (!now->clash->isDepthExact) html_.put("≤ ");
      length(*now->depth());
    });
    numberCell([&] { putVolume(now); });
    cell([&] {
      if (now != nullptr && now->allowedBy) html_.putName(textOf(report_.check.rules[*now->allowedBy]));
      if (now != nullptr && now->isForbidden()) html_.put("not allowed");
    });
    cell([&] {
      const std::string_view state = stateWord(row.state, row.reason), change = wordOf(row.change);
      html_.put(state);
      if (change != state) html_.put(fmt::format(", {}", change));
      if (row.change != FindingChange::Same) putBefore(row.before);
      if (row.reason.empty()) return;
      html_.put(": ");
      html_.putName(row.reason);
    });
  }

  /// Findings of the last check, where this one finds something else.
  void putBefore(const std::optional<PairRecord>& before) {
    if (!before) return;
    html_.put(fmt::format(", was {}", wordOf(before->verdict)));
    if (before->verdict == PairVerdict::Near || before->depth) {
      html_.put(", ");
      length(before->depth.value_or(before->distance));
    }
  }

  void putVolume(const PairFinding* now) {
    if (now == nullptr || !now->clash) return;
    if (now->clash->volume) {
      html_.putNumber(*now->clash->volume, fmt::format("{:.5g} mm³", 1e9 * *now->clash->volume));
    } else {
      html_.put(textOf(now->clash->volumeProblem));
    }
  }

  void putFindings() {
    if (pictured_.empty()) return sentence("There is none to show.");
    sentence(
        "The other parts are left out, and the larger part is translucent. Orange segments are local minimum "
        "distances, the "
        "nearest in red; crimson curves are where surfaces meet; a green line frees the part named first. "
        "What is behind a "
        "surface is drawn through it. The frame shows where the close picture is.");
    for (std::size_t i = 0; i < pictured_.size(); ++i) {
      html_.element("section", {{"class", "finding"}, {"id", fmt::format("finding-{}", i + 1)}},
                    [&] { putFinding(i + 1, pictured_[i]); });
    }
    const auto all = static_cast<std::size_t>(
        std::ranges::count_if(rows_, [](const ComparedFinding* row) { return row->now != nullptr; }));
    leftOutNote(all, pictured_.size(), "findings");
  }

  void putFinding(std::size_t number, const PicturedFinding& pictured) {
    const PairFinding& finding = *pictured.finding->now;
    const std::string parts = fmt::format("“{}” and “{}”", request_.scene.get(finding.pair.part).name,
                                          request_.scene.get(finding.pair.other).name);
    html_.element("h3", [&] {
      html_.put(fmt::format("{}. ", number));
      names(finding.pair);
      html_.put(": ");
      verdictWord(finding.verdict);
    });
    paragraph([&] { putMeasures(finding); });
    html_.element("div", {{"class", "figures"}}, [&] {
      putFigure(pictured.whole, fmt::format("Both parts, {}: {}", parts, wordOf(finding.verdict)),
                "Both parts.");
      if (pictured.close)
        putFigure(*pictured.close, fmt::format("The place where {} are nearest or meet", parts), "Close.");
    });
  }

  void putMeasures(const PairFinding& finding) {
    html_.put("Distance ");
    length(finding.distance);
    const auto place = [&](const glm::dvec3& p) {
      html_.put(fmt::format("({:.6g}, {:.6g}, {:.6g}) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z));
    };
    if (!finding.clash) {
      html_.put(", from ");
      place(finding.partPoint);
      html_.put(" to ");
      place(finding.otherPoint);
      if (finding.verdict == PairVerdict::Near)
        html_.put(fmt::format("; {}{} within the threshold", finding.isEveryMinimum ? "" : "more than ",
                              countOf(finding.minima.size(), "minimum", "minima")));
    }
    if (finding.depth()) {
      // Rounding leaves traces in components that are 0.
      constexpr double kNothing = 1e-9;
      const auto said = [](double x) { return std::abs(x) < kNothing ? 0.0 : x; };
      const glm::dvec3& direction = finding.clash->freeing->direction;
      html_.put(finding.clash->isDepthExact ? "; depth " : "; depth at most ");
      length(*finding.depth());
      html_.put(fmt::format(", along ({:.4g}, {:.4g}, {:.4g})", said(direction.x), said(direction.y),
                            said(direction.z)));
    }
    if (finding.clash && finding.clash->volume) {
      html_.put("; shared volume ");
      putVolume(&finding);
    }
    html_.put(".");
  }

  void putPath(const PathFindings& path) {
    const std::vector<PathPose>& poses = path.path.poses;
    html_.element("dl", [&] {
      term("Moves", [&] {
        for (std::size_t i = 0; i < std::min(path.path.parts.size(), kMaxNamed); ++i) {
          if (i > 0) html_.put(", ");
          html_.putName(path.path.parts[i]);
        }
        if (path.path.parts.size() > kMaxNamed)
          html_.put(fmt::format(" and {} more", path.path.parts.size() - kMaxNamed));
      });
      textTerm("Poses", fmt::format("{}, from {:.6g} s to {:.6g} s", poses.size(), poses.front().time,
                                    poses.back().time));
      if (path.least) {
        term("Least clearance", [&] {
          length(path.least->distance);
          html_.put(" to ");
          name(path.least->other);
          html_.put(fmt::format(" at {:.6g} s, at the poses", path.least->time));
        });
      }
    });
    if (!path.clearances.empty()) putPlot(path);
    if (path.clearances.empty() && path.range > 0.0)
      sentence(fmt::format("No other part comes within {} at the poses.", mmText(path.range)));
    if (path.verification) putCertificate(*request_.certificate, *path.verification);
  }

  void putPlot(const PathFindings& path) {
    std::vector<double> times;
    for (const PathPose& pose : path.path.poses)
      times.push_back(pose.time);
    ClearancePlot plot{times, {}, path.range, {}};
    for (const PathClearance& clearance : path.clearances)
      plot.curves.push_back({request_.scene.get(clearance.other).name, clearance.distances});
    if (path.isProven()) plot.separation = request_.certificate->separation;
    html_.element("figure", [&] {
      putClearancePlot(plot, html_);
      html_.add(
          "figcaption",
          fmt::format(
              "Clearance at the poses to the nearest {} of {} within {}. Gaps: farther away. Of more than {} "
              "poses the least in each stretch of time is drawn.",
              nearestCurves(plot).size(), countOf(plot.curves.size(), "part", "parts"), mmText(path.range),
              kMaxPlotPoints));
    });
  }

  void putCertificate(const Certificate& certificate, const Verification& verification) {
    html_.add("h3", "Certificate");
    if (verification.isProven()) {
      sentence(
          fmt::format("Proven anew for this report: everywhere on the path, also between its poses, the "
                      "surfaces of what moves and of "
                      "all other visible parts are at least {} apart, and none is inside another. Verified "
                      "by {} of {}, which share no "
                      "search with what made the certificate.",
                      mmText(certificate.separation), countOf(verification.stretches, "stretch", "stretches"),
                      countOf(certificate.pairs.size(), "pair", "pairs")));
    } else {
      html_.element("p", {{"class", "verdict bad"}}, [&] {
        html_.put("The certificate is refused: ");
        html_.putName(verification.problem);
        html_.put(". It proves nothing here.");
      });
    }
    html_.element("dl", [&] {
      term("Separation", [&] { length(certificate.separation); });
      term("Made with", [&] { html_.putName(certificate.program); });
      if (!certificate.sceneSha256.empty()) term("Scene", [&] { hash(certificate.sceneSha256); });
    });
    std::size_t stretches = 0;
    double least = std::numeric_limits<double>::infinity();
    for (const CertifiedPair& pair : certificate.pairs) {
      stretches += pair.stretches.size();
      for (const ProvenStretch& stretch : pair.stretches)
        least = std::min(least, stretch.bound);
    }
    if (stretches > 0)
      sentence(fmt::format("Least bound of its {}: {} between surfaces at the anchor.",
                           countOf(stretches, "stretch", "stretches"), mmText(least)));
    const std::size_t shown = std::min(certificate.parts.size(), kMaxPartRows);
    table({"Certified part", "Moves", "SHA-256 of its mesh"}, [&] {
      for (std::size_t i = 0; i < shown; ++i) {
        html_.element("tr", [&] {
          cell([&] { html_.putName(certificate.parts[i].name); });
          textCell(certificate.parts[i].isMoving ? "yes" : "no");
          cell([&] { hash(certificate.parts[i].meshSha256); });
        });
      }
    });
    leftOutNote(certificate.parts.size(), shown, "parts");
  }

  void putParts() {
    const std::vector<Scene::PartPtr>& parts = request_.scene.parts();
    const std::size_t shown = std::min(parts.size(), kMaxPartRows);
    table({"Part", "Source and its SHA-256", "Surface", "Size", "Mass", "Placement"}, [&] {
      for (std::size_t i = 0; i < shown; ++i)
        html_.element("tr", [&] { putPartRow(*parts[i]); });
    });
    leftOutNote(parts.size(), shown, "parts");
    sentence(
        "Size: of the box along the axes of the part's own frame. Mass: where a density is set and the mesh "
        "is closed. "
        "Placement: position, and unit quaternion w x y z, of the part's frame in the world.");
  }

  void putPartRow(const Part& part) {
    cell([&] {
      html_.putName(part.name);
      if (!part.isVisible) html_.put(" (hidden)");
      if (request_.scene.isMoving(part.id)) html_.put(" (moving)");
    });
    if (!part.geometry) {
      for (int column = 0; column < 4; ++column)
        textCell("");
    } else {
      putGeometryCells(part);
    }
    cell([&] {
      const glm::dvec3& t = part.worldFromPart.translation;
      const glm::dquat& q = part.worldFromPart.rotation;
      html_.put(fmt::format("({:.6g}, {:.6g}, {:.6g}) mm; ({:.6g}, {:.6g}, {:.6g}, {:.6g})", 1e3 * t.x,
                            1e3 * t.y, 1e3 * t.z, q.w, q.x, q.y, q.z));
    });
  }

  void putGeometryCells(const Part& part) {
    const PartGeometry& geometry = *part.geometry;
    cell([&] {
      html_.putName(pathText(geometry.file.filename()));
      if (!geometry.shapeKey.empty()) {
        html_.put(", shape ");
        html_.putName(geometry.shapeKey);
      }
      html_.put(" ");
      hash(geometry.sha256);
    });
    cell([&] {
      html_.put(countOf(geometry.mesh.triangles().size(), "triangle", "triangles"));
      if (geometry.surfaces)
        html_.put(fmt::format(", {}", countOf(geometry.surfaces->faces.size(), "face", "faces")));
    });
    cell([&] {
      const Aabb& box = geometry.mesh.bounds();
      if (box.isEmpty()) return;
      const glm::dvec3 size = 1e3 * (box.upper - box.lower);
      html_.put(fmt::format("{:.5g} × {:.5g} × {:.5g} mm", size.x, size.y, size.z));
    });
    numberCell([&] {
      const bool isKnown =
          part.density != kDefaultDensity && geometry.mass.basis == MassBasis::VolumeIntegrals;
      if (isKnown) html_.putNumber(massOf(part), fmt::format("{:.5g} kg", massOf(part)));
    });
  }

  void putSettings() {
    const SceneCheckRequest& check = request_.check;
    html_.element("dl", [&] {
      term("Threshold", [&] { length(check.threshold); });
      textTerm("Minima", fmt::format("up to {} of a pair, the nearest", check.maxMinima));
      textTerm("Volumes", check.maxVolumeTriangles == 0
                              ? std::string("not computed")
                              : fmt::format("of pairs of up to {} triangles", check.maxVolumeTriangles));
      textTerm("Depths", check.hasDepths ? "of clashes" : "not computed");
      textTerm("Touching", "a gap or depth of up to a millionth of the smaller part, at most 0.001 mm");
      if (report_.path && report_.path->range > 0.0)
        term("Range along path", [&] { length(report_.path->range); });
    });
    html_.add("h3", "Rules");
    if (check.rules.empty())
      return sentence("There are none: all pairs are checked, and every clash counts.");
    html_.element("ol", [&] {
      for (const PairRule& rule : check.rules)
        html_.element("li", [&] { html_.putName(textOf(rule)); });
    });
  }

  void putInputs() {
    std::map<std::string, std::pair<std::string, std::string>> files;  // Kind and hash by file.
    for (const Scene::PartPtr& part : request_.scene.parts()) {
      if (!part->geometry) continue;
      files.try_emplace(pathText(part->geometry->file), "geometry", part->geometry->sha256);
      if (!part->geometry->companions) continue;
      for (const CompanionFile& companion : *part->geometry->companions)
        files.try_emplace(pathText(companion.file), "companion", companion.sha256);
    }
    std::size_t shown = 0;
    table({"Kind", "File", "SHA-256"}, [&] {
      for (const ReportInput& input : request_.inputs)
        putInputRow(input.kind, pathText(input.file), input.sha256);
      for (const auto& [file, kindAndHash] : files) {
        if (shown == kMaxPartRows) break;
        putInputRow(kindAndHash.first, file, kindAndHash.second);
        ++shown;
      }
    });
    leftOutNote(files.size(), shown, "files");
    if (request_.sceneSha256.empty())
      sentence("The scene was not saved as it is here: no hash stands for its parts' places and its rules.");
  }

  void putInputRow(std::string_view kind, const std::string& file, const std::string& sha256) {
    html_.element("tr", [&] {
      textCell(kind);
      cell([&] { html_.putName(file); });
      cell([&] { sha256.empty() ? html_.put("not as saved") : hash(sha256); });
    });
  }

  void putVersions() {
    html_.element("dl", [&] {
      textTerm("Program", request_.origin.program);
      textTerm("Libraries", request_.origin.libraries);
      textTerm("System", request_.origin.system);
    });
  }

  // Section on all that was not checked.

  /// Writes an entry that names parts.
  void namedEntry(const std::string& text, const std::vector<std::string>& parts) {
    if (parts.empty()) return;
    html_.element("li", [&] {
      html_.put(text + ": ");
      for (std::size_t i = 0; i < std::min(parts.size(), kMaxListedCases); ++i) {
        if (i > 0) html_.put(", ");
        html_.putName(parts[i]);
      }
      if (parts.size() > kMaxListedCases)
        html_.put(fmt::format(" and {} more", parts.size() - kMaxListedCases));
      html_.put(".");
    });
  }
  void entry(std::string_view text) { html_.add("li", text); }

  void putUnchecked() {
    html_.element("ul", [&] {
      putUncheckedParts();
      putUncheckedPairs();
      putUncheckedPath();
      entry("Parts are rigid; tolerances of manufacture, weight and heat are not considered.");
    });
  }

  template <class Choose>
  std::vector<std::string> namesWhere(const Choose& isChosen) const {
    std::vector<std::string> chosen;
    for (const Scene::PartPtr& part : request_.scene.parts()) {
      if (part->isVisible && hasTriangles(*part) && isChosen(*part)) chosen.push_back(part->name);
    }
    return chosen;
  }

  void putUncheckedParts() {
    std::vector<std::string> hidden;
    for (const Scene::PartPtr& part : request_.scene.parts()) {
      if (!part->isVisible) hidden.push_back(part->name);
    }
    namedEntry(fmt::format("{} hidden, not checked", countOf(hidden.size(), "part is", "parts are")), hidden);
    namedEntry("Parts without triangles, not checked", withoutSurface_);
    namedEntry("Meshes that are not closed, so that nothing can be found inside them and no volume is known",
               namesWhere([](const Part& part) { return !part.geometry->mesh.topology().isClosed(); }));
    namedEntry("Meshes whose faces are not all turned outward alike",
               namesWhere([](const Part& part) { return !part.geometry->mesh.topology().isOriented(); }));
    namedEntry("Meshes that differ from their files by repairs",
               namesWhere([](const Part& part) { return !part.geometry->repairs.empty(); }));
    double chord = 0.0;
    for (const Scene::PartPtr& part : request_.scene.parts()) {
      if (part->isVisible && part->geometry)
        chord = std::max(chord, part->geometry->effectiveTessellation.chord);
    }
    if (chord > 0.0)
      entry(fmt::format(
          "Triangles stand for exact surfaces, from which they are up to {} away; distances are those of the "
          "triangles.",
          mmText(chord)));
  }

  void putUncheckedPairs() {
    const SceneCheck& check = report_.check;
    if (!check.leftOut.empty()) {
      html_.element("li", [&] {
        html_.put(fmt::format("Rules left out {} within the threshold: ",
                              countOf(check.leftOut.size(), "pair", "pairs")));
        for (std::size_t i = 0; i < std::min(check.leftOut.size(), kMaxListedCases); ++i) {
          if (i > 0) html_.put("; ");
          names(check.leftOut[i].pair);
          html_.put(fmt::format(" (rule {})", check.leftOut[i].rule + 1));
        }
        if (check.leftOut.size() > kMaxListedCases)
          html_.put(fmt::format(" and {} more", check.leftOut.size() - kMaxListedCases));
        html_.put(".");
      });
    }
    entry(fmt::format("How far pairs are apart beyond the threshold of {} was not measured.",
                      mmText(check.threshold)));
    casesEntry("more minima than are kept", [](const PairFinding& f) { return !f.isEveryMinimum; });
    casesEntry("a volume that is not known",
               [](const PairFinding& f) { return f.clash && !f.clash->volume; });
    casesEntry("no known translation that frees the part",
               [](const PairFinding& f) { return f.clash && !f.clash->freeing; });
    casesEntry("more curves than were searched",
               [](const PairFinding& f) { return f.clash && !f.clash->isEveryCurve; });
    std::size_t kept = 0;
    for (const ComparedFinding& finding : report_.findings) {
      if (finding.now == nullptr && finding.change != FindingChange::Gone) ++kept;
    }
    if (kept > 0)
      entry(fmt::format("{} of earlier checks were not checked this time, or were gone before.",
                        countOf(kept, "finding", "findings")));
  }

  template <class Choose>
  void casesEntry(const char* what, const Choose& isCase) {
    std::vector<PartPair> pairs;
    for (const PairFinding& finding : report_.check.findings) {
      if (isCase(finding)) pairs.push_back(finding.pair);
    }
    if (pairs.empty()) return;
    html_.element("li", [&] {
      html_.put(fmt::format("{} with {}: ", countOf(pairs.size(), "pair", "pairs"), what));
      for (std::size_t i = 0; i < std::min(pairs.size(), kMaxListedCases); ++i) {
        if (i > 0) html_.put("; ");
        names(pairs[i]);
      }
      if (pairs.size() > kMaxListedCases)
        html_.put(fmt::format(" and {} more", pairs.size() - kMaxListedCases));
      html_.put(".");
    });
  }

  void putUncheckedPath() {
    if (!report_.path) return entry("How the parts get to their places: no path was given.");
    const PathFindings& path = *report_.path;
    if (!path.isProven()) entry("Between the poses of the path nothing is proven.");
    if (!path.verification) entry("No certificate of the path was given.");
    if (path.range == 0.0) entry("Clearance along the path of the refused certificate was not computed.");
  }

  const FitReportRequest& request_;
  const FitReport& report_;
  std::vector<const ComparedFinding*> rows_;
  HtmlWriter html_;
  std::vector<PartGeometryPtr> geometries_;
  std::vector<std::string> withoutSurface_;
  std::vector<PagePicture> pictures_;
  std::vector<PicturedFinding> pictured_;
};

}  // namespace

std::string fitReportPage(const FitReportRequest& request, const FitReport& report,
                          const ProgressCallback& progress) {
  return ReportPage(request, report).write(progress);
}

}  // namespace nearfit
