#include "core/report/html/fit_report.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/path/path_certifier.h"
#include "core/path/path_file.h"
#include "core/verdict/finding_states.h"
#include "tests/support/html_document.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/path_scenes.h"
#include "tests/support/png_picture.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trial_share.h"

namespace nearfit::fit_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const ReportOrigin kOrigin{"2026-01-31T12:00:00Z", "Ada",       "Nearfit 0.0.0", "none 1.0", "Test 1, x",
                           "0123456789ab",         "reader 2.0"};

Part box(const char* name, const glm::dvec3& place) {
  return test::partOf(test::solidGeometryOf(test::boxMesh(glm::dvec3(1.0))), name,
                      {glm::dquat(1, 0, 0, 0), place});
}

/// A box, one that clashes with it by 0.1, and one that is 0.2 away from it and farther from the other.
Scene boxes() {
  Scene scene;
  scene.add(box("Base", {0, 0, 0}));
  scene.add(box("Lid", {0, 0, 0.9}));
  scene.add(box("Side", {1.2, 0, -0.2}));
  return scene;
}

/// How many findings have pictures in tests of many; drawing them takes most of these tests' time.
constexpr std::size_t kPictured = kDefaultPicturedFindings / test::kTrialShare;

FitReportRequest requestOf(const Scene& scene, double threshold) {
  FitReportRequest request = fitReportRequest(scene, "/tmp/pump.nearfit", std::string(64, 'a'), threshold);
  request.origin = kOrigin;
  return request;
}

test::HtmlElement pageOf(const FitReportRequest& request) {
  return test::htmlDocument(fitReportPage(request, makeFitReport(request)));
}

/// Rows of the first table in a section.
std::vector<test::HtmlElement> rowsOf(const test::HtmlElement& page, const char* section) {
  const auto tables = test::elementsOf(test::elementWithId(page, section), "table");
  if (tables.empty()) return {};
  return test::elementsOf(tables.front(), "tbody").front().children;
}

/// The number that a cell has for programs.
double valueOf(const test::HtmlElement& cell) {
  const auto numbers = test::elementsOf(cell, "data");
  EXPECT_EQ(numbers.size(), 1U) << cell.text;
  return numbers.empty() ? -1.0 : std::stod(numbers.front().attribute("value"));
}

std::string textOfSection(const test::HtmlElement& page, const char* section) {
  return test::elementWithId(page, section).text;
}

TEST(FitReport, ThePageHasTheNumbersOfTheCheckAndOfTheShapes) {
  const FitReportRequest request = requestOf(boxes(), 0.25);
  const FitReport report = makeFitReport(request);
  EXPECT_FALSE(report.isGood());
  const test::HtmlElement page = test::htmlDocument(fitReportPage(request, report));
  EXPECT_EQ(test::elementsOf(page, "h1").front().text, "Fit report: pump");
  EXPECT_THAT(test::elementsOf(page, "header").front().text, HasSubstr("Ada"));
  const auto rows = rowsOf(page, "pairs");
  ASSERT_EQ(rows.size(), 3U) << "the clash, and the side near both";
  const auto& clash = rows[0].children;
  EXPECT_EQ(clash[1].text, "Base – Lid");
  EXPECT_EQ(clash[2].text, "clash");
  const PairFinding& finding = report.check.findings.front();
  EXPECT_EQ(valueOf(clash[3]), 0.0);
  EXPECT_EQ(valueOf(clash[4]), *finding.depth());
  EXPECT_NEAR(valueOf(clash[4]), 0.1, 1e-12);
  EXPECT_THAT(clash[4].text, HasSubstr("100 mm"));
  EXPECT_EQ(valueOf(clash[5]), *finding.clash->volume);
  EXPECT_NEAR(valueOf(clash[5]), 0.1, 1e-12);
  EXPECT_THAT(clash[5].text, HasSubstr("1e+08 mm³"));
  EXPECT_EQ(clash[6].text, "not allowed");
  EXPECT_EQ(rows[1].children[1].text, "Base – Side");
  EXPECT_EQ(rows[1].children[2].text, "near");
  EXPECT_NEAR(valueOf(rows[1].children[3]), 0.2, 1e-12);
  EXPECT_THAT(rows[1].children[3].text, HasSubstr("200 mm"));
  const auto counts = rowsOf(page, "summary").front().children;
  const std::vector<std::string> expected{"3", "3", "0", "2", "0", "1", "0", "1", "0"};
  ASSERT_EQ(counts.size(), expected.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    EXPECT_EQ(counts[i].text, expected[i]) << i;
}

TEST(FitReport, TheVerdictIsOneSentence) {
  const auto sentenceOf = [](const Scene& scene, double threshold, std::vector<PairRule> rules = {}) {
    FitReportRequest request = requestOf(scene, threshold);
    request.check.rules = std::move(rules);
    return verdictSentence(request, makeFitReport(request));
  };
  EXPECT_EQ(sentenceOf(boxes(), 0.25),
            "Does not fit: 1 of 3 pairs clash, or one part is inside the other, and no rule allows it.");
  EXPECT_EQ(sentenceOf(boxes(), 0.25, {{PairRuleKind::PressFit, "Base", "Lid", 0.2}}),
            "Fits by its rules: they allow the clashes of 1 of 3 pairs, and no other pair clashes; nearest "
            "are \"Base\" and "
            "\"Side\", 200 mm apart.");
  EXPECT_EQ(sentenceOf(boxes(), 0.25, {{PairRuleKind::LeaveOut, "Base", "Lid"}}),
            "Fits: of 2 pairs none clashes; nearest are \"Base\" and \"Side\", 200 mm apart.");
  EXPECT_EQ(sentenceOf(boxes(), 0.001, {{PairRuleKind::LeaveOut, "Base", "Lid"}}),
            "Fits: of 2 pairs none clashes; all are farther apart than 1 mm.");
  EXPECT_THAT(sentenceOf(Scene(), 0.25), StartsWith("Nothing was judged"));
}

TEST(FitReport, EachFindingHasPicturesThatShowIt) {
  const test::HtmlElement page = pageOf(requestOf(boxes(), 0.25));
  const auto scene = test::elementsOf(test::elementWithId(page, "pictures"), "img");
  ASSERT_EQ(scene.size(), 4U);
  const auto all = test::elementsOf(page, "img");
  EXPECT_GE(all.size(), 4U + 3U);
  for (const test::HtmlElement& image : all) {
    const test::PngPicture picture = test::pngPicture(test::dataOfPicture(image));
    EXPECT_EQ(std::to_string(picture.width), image.attribute("width"));
    EXPECT_EQ(std::to_string(picture.height), image.attribute("height"));
    const auto drawn = static_cast<std::size_t>(std::ranges::count_if(
        picture.pixels, [](const auto& pixel) { return pixel[0] + pixel[1] + pixel[2] < 3 * 250; }));
    EXPECT_GT(drawn, picture.pixels.size() / 20) << image.attribute("alt");
    EXPECT_LT(drawn, picture.pixels.size()) << image.attribute("alt");
  }
  const auto first = test::elementsOf(test::elementWithId(page, "finding-1"), "img");
  const test::PngPicture clash = test::pngPicture(test::dataOfPicture(first.front()));
  EXPECT_TRUE(std::ranges::any_of(clash.pixels, [](const auto& pixel) {
    return pixel[0] > 150 && pixel[1] < 60 && pixel[2] > 40 && pixel[2] < 140;
  })) << "the curve of the clash";
}

TEST(FitReport, HostileNamesStayText) {
  const std::string hostile = "<script>alert(1)</script>\" onload='x' &lt; \u202Egpj";
  Scene scene;
  scene.add(box(hostile.c_str(), {0, 0, 0}));
  scene.add(box("</td></table><img src=x>", {0, 0, 0.9}));
  scene.setPairRules({{PairRuleKind::Touching, "<b>*", "<!--"}});
  const PartPair pair{scene.parts()[0]->id, scene.parts()[1]->id};
  scene.setPairRecords({{pair, PairVerdict::Clash, 0.0, 0.1, FindingState::Accepted, "</li><style>"}});
  FitReportRequest request = requestOf(scene, 0.25);
  request.title = hostile;
  request.origin.author = "</header>";
  request.inputs.push_back({"path", std::string("/a/\xFF<b>"), ""});
  const std::string text = fitReportPage(request, makeFitReport(request));
  EXPECT_THAT(text, Not(HasSubstr("<script")));
  EXPECT_THAT(text, Not(HasSubstr("\u202E")));
  const test::HtmlElement page = test::htmlDocument(text);
  const std::string shown = "<script>alert(1)</script>\" onload='x' &lt; \\u{202e}gpj";
  EXPECT_EQ(test::elementsOf(page, "h1").front().text, "Fit report: " + shown);
  const auto rows = rowsOf(page, "pairs");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].children[1].text, shown + " – </td></table><img src=x>");
  EXPECT_EQ(rows[0].children[7].text, "accepted, as before: </li><style>");
  EXPECT_THAT(textOfSection(page, "settings"), HasSubstr("<b>* and <!-- are meant to touch"));
  EXPECT_THAT(textOfSection(page, "inputs"), HasSubstr("/a/\\xff<b>"));
}

TEST(FitReport, PressFitsHaveTheirDepthInThePagesUnit) {
  Scene scene = boxes();
  scene.setPairRules({{PairRuleKind::PressFit, "Li*", "Base", 2e-5}});
  EXPECT_THAT(textOfSection(pageOf(requestOf(scene, 0.25)), "settings"),
              HasSubstr("press fit of Li* with Base up to 0.02 mm"));
}

TEST(FitReport, ACheckThatFindsTheSameSaysThatNothingHasChanged) {
  Scene scene = boxes();
  const auto summary = [&scene] { return textOfSection(pageOf(requestOf(scene, 0.25)), "summary"); };
  EXPECT_THAT(summary(), Not(HasSubstr("last check")));
  scene.setPairRecords(recordsOf(makeFitReport(requestOf(scene, 0.25)).findings));
  EXPECT_THAT(summary(), HasSubstr("Nothing has changed since the last check."));
  Part lid = *scene.parts()[1];
  lid.worldFromPart.translation.z = 0.8;
  scene.replace(lid);
  // It is deeper in the base, and nearer to the side: 0.2 m instead of the root of 0.05.
  EXPECT_THAT(summary(), HasSubstr("Since the last check 0 findings are new, 2 worse, 0 better"));
}

/// A report said "Does not fit" for ever after its clash was accepted.
TEST(FitReport, AnAcceptedClashIsNamedAndPassesUntilItIsDeeper) {
  Scene scene = boxes();
  std::vector<PairRecord> records = recordsOf(makeFitReport(requestOf(scene, 0.25)).findings);
  for (PairRecord& record : records) {
    record.state = FindingState::Accepted;
    record.reason = "glued";
  }
  scene.setPairRecords(records);
  const FitReport accepted = makeFitReport(requestOf(scene, 0.25));
  EXPECT_TRUE(accepted.isGood());
  EXPECT_EQ(
      verdictSentence(requestOf(scene, 0.25), accepted),
      "Fits but for what the user has accepted: 1 of 3 pairs clash, or one part is inside the other, and "
      "no rule allows it.");
  Part lid = *scene.parts()[1];
  lid.worldFromPart.translation.z = 0.8;
  scene.replace(lid);
  const FitReport deeper = makeFitReport(requestOf(scene, 0.25));
  EXPECT_FALSE(deeper.isGood());
  EXPECT_THAT(verdictSentence(requestOf(scene, 0.25), deeper), HasSubstr("Does not fit: 1 of 3 pairs"));
}

/// Four pictures of nothing stood there, and the verdict was green.
TEST(FitReport, ASceneWithoutPartsHasNoPicturesAndNoGoodVerdict) {
  const std::string text = fitReportPage(requestOf(Scene(), 0.25), makeFitReport(requestOf(Scene(), 0.25)));
  EXPECT_THAT(text, HasSubstr("<p class=\"verdict\">Nothing was judged"));
  EXPECT_THAT(text, Not(HasSubstr("<img")));
  EXPECT_TRUE(rowsOf(test::htmlDocument(text), "parts").empty());
}

TEST(FitReport, WhatWasNotCheckedIsTold) {
  Scene scene = boxes();
  Part hidden = box("Cover", {0, 0, 5});
  hidden.isVisible = false;
  scene.add(hidden);
  scene.add(
      test::partOf(test::solidGeometryOf(test::squareMesh(1.0, 1)), "Sheet", {{1, 0, 0, 0}, {0, 0, 9}}));
  scene.add(test::partOf(nullptr, "Empty"));
  scene.setPairRules({{PairRuleKind::LeaveOut, "Lid", "Side"}});
  const std::string text = textOfSection(pageOf(requestOf(scene, 0.25)), "unchecked");
  EXPECT_THAT(text, HasSubstr("1 part is hidden, not checked: Cover."));
  EXPECT_THAT(text, HasSubstr("Parts without triangles, not checked: Empty."));
  EXPECT_THAT(text, HasSubstr("no volume is known: Sheet."));
  EXPECT_THAT(
      text,
      HasSubstr("1 pair with surfaces that meet, whose other near places were not looked for: Base – Lid."));
  EXPECT_THAT(text, HasSubstr("Rules left out 1 pair within the threshold: Lid – Side (rule 1)."));
  EXPECT_THAT(text, HasSubstr("beyond the threshold of 250 mm was not measured"));
  EXPECT_THAT(text, HasSubstr("no path was given"));
}

TEST(FitReport, TheTableOfPartsHasSourcesSizesMassesAndPlaces) {
  Scene scene = boxes();
  Part lid = *scene.parts()[1];
  lid.density = 7850.0;
  scene.replace(lid);
  const auto rows = rowsOf(pageOf(requestOf(scene, 0.25)), "parts");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].children[0].text, "Lid");
  EXPECT_EQ(rows[1].children[2].text, "12 triangles");
  EXPECT_EQ(rows[1].children[3].text, "1000 × 1000 × 1000 mm");
  EXPECT_NEAR(valueOf(rows[1].children[4]), 7850.0, 1e-6);
  EXPECT_EQ(rows[0].children[4].text, "") << "no density is set";
  EXPECT_EQ(rows[1].children[5].text, "(0, 0, 900) mm; (1, 0, 0, 0)");
}

TEST(FitReport, APageOfManyFindingsIsBoundedAndSaysWhatItLeavesOut) {
  Scene scene;
  const PartGeometryPtr geometry = test::geometryOf(test::boxMesh(glm::dvec3(1.0)));
  std::vector<Part> parts;
  for (int i = 0; i < static_cast<int>(kMaxFindingRows) + 5; ++i)
    parts.push_back(test::partOf(geometry, "Box", {glm::dquat(1, 0, 0, 0), glm::dvec3(1.125 * i, 0, 0)}));
  scene.addAll(parts);
  FitReportRequest request = requestOf(scene, 0.25);
  EXPECT_EQ(request.maxPictured, kDefaultPicturedFindings);
  request.maxPictured = kPictured;
  const std::string text = fitReportPage(request, makeFitReport(request));
  EXPECT_LT(text.size(), 8U << 20U);
  const test::HtmlElement page = test::htmlDocument(text);
  EXPECT_EQ(rowsOf(page, "pairs").size(), kMaxFindingRows);
  EXPECT_THAT(textOfSection(page, "pairs"), HasSubstr("4 more pairs are left out of this page."));
  EXPECT_THAT(textOfSection(page, "findings"),
              HasSubstr(fmt::format("{} more findings are left out", kMaxFindingRows + 4 - kPictured)));
  EXPECT_LE(test::elementsOf(page, "img").size(), 4 + 2 * kPictured);
}

TEST(FitReport, AsManyFindingsHavePicturesAsAreAskedFor) {
  Scene scene;
  const PartGeometryPtr geometry = test::geometryOf(test::boxMesh(glm::dvec3(1.0)));
  constexpr int kBoxes = static_cast<int>(kPictured) + 3;
  for (int i = 0; i < kBoxes; ++i)
    scene.add(test::partOf(geometry, "Box", {glm::dquat(1, 0, 0, 0), glm::dvec3(1.125 * i, 0, 0)}));
  FitReportRequest request = requestOf(scene, 0.25);
  const FitReport report = makeFitReport(request);
  const auto pictured = [&](std::size_t count) {
    request.maxPictured = count;
    const auto page = test::htmlDocument(fitReportPage(request, report));
    const auto sections = test::elementsOf(test::elementWithId(page, "findings"), "h3");
    EXPECT_EQ(textOfSection(page, "findings").find("left out of this page") == std::string::npos,
              sections.size() == kBoxes - 1U);
    return sections.size();
  };
  EXPECT_EQ(pictured(kPictured), kPictured);
  EXPECT_EQ(pictured(2), 2U);
  EXPECT_EQ(pictured(500), kBoxes - 1U);
  EXPECT_EQ(pictured(0), kBoxes - 1U) << "each";
}

TEST(FitReport, TheVersionsHaveTheRevisionAndTheReaderOfDocuments) {
  FitReportRequest request = requestOf(boxes(), 0.25);
  const FitReport report = makeFitReport(request);
  const auto versions = [&] {
    return textOfSection(test::htmlDocument(fitReportPage(request, report)), "versions");
  };
  EXPECT_THAT(versions(), HasSubstr("0123456789ab"));
  EXPECT_THAT(versions(), HasSubstr("reader 2.0"));
  request.origin.revision = request.origin.importer = "";
  EXPECT_THAT(versions(), Not(HasSubstr("Revision")));
  EXPECT_THAT(versions(), Not(HasSubstr("Reader")));
}

TEST(FitReport, TheImporterIsAskedWhereAPartComesFromADocument) {
  const test::TemporaryFolder folder;
  const auto importer =
      folder.write("importer", "#!/bin/sh\necho nearfit-import 9.8\necho OpenCASCADE 7.6.5\n");
  std::filesystem::permissions(importer, std::filesystem::perms::owner_all);
  const test::ScopedVariable chosen("NEARFIT_IMPORT", importer.string());
  Scene scene = boxes();
  EXPECT_EQ(fitReportRequest(scene, {}, {}, 0.25).origin.importer, "") << "no part comes from a document";
  const auto geometry = std::make_shared<PartGeometry>(*scene.parts()[1]->geometry);
  geometry->shapeKey = "0:1:1:2";
  Part lid = *scene.parts()[1];
  lid.geometry = geometry;
  scene.replace(lid);
  EXPECT_EQ(fitReportRequest(scene, {}, {}, 0.25).origin.importer, "nearfit-import 9.8, OpenCASCADE 7.6.5");
  folder.write("importer", "#!/bin/sh\nexit 1\n");
  EXPECT_THAT(fitReportRequest(scene, {}, {}, 0.25).origin.importer, StartsWith("unknown: "));
}

TEST(FitReport, TheSameRequestGivesTheSamePage) {
  const FitReportRequest request = requestOf(boxes(), 0.25);
  EXPECT_EQ(fitReportPage(request, makeFitReport(request)), fitReportPage(request, makeFitReport(request)));
}

/// The cube that passes the post with a gap of 10 mm, with a pose beside it, where the gap is seen.
test::PathScene cubeBesidePost() {
  test::PathScene made = test::cubePastCube(0.01);
  made.path = test::pathThrough("Cube", {test::at(-3, 1.01, 0), test::at(0, 1.01, 0), test::at(3, 1.01, 0)});
  return made;
}

/// A request with its certificate.
FitReportRequest certifiedRequest() {
  const test::PathScene made = cubeBesidePost();
  FitReportRequest request = requestOf(made.scene, 0.02);
  request.path = made.path;
  const PathProof proof = PathCertifier(made.scene, made.path, 0.005).prove(made.path);
  EXPECT_TRUE(proof.isFree());
  request.certificate = certificateOf(made.scene, made.path, proof, request.sceneSha256);
  return request;
}

TEST(FitReport, AProvenPathHasItsPlotAndTheStatementOfItsCertificate) {
  const FitReportRequest request = certifiedRequest();
  const FitReport report = makeFitReport(request);
  EXPECT_TRUE(report.isGood());
  EXPECT_THAT(verdictSentence(request, report),
              HasSubstr("The path is proven to keep 5 mm from all other parts."));
  const test::HtmlElement page = test::htmlDocument(fitReportPage(request, report));
  const test::HtmlElement path = test::elementWithId(page, "path");
  EXPECT_EQ(test::elementsOf(path, "svg").size(), 1U);
  EXPECT_THAT(path.text, HasSubstr("Proven anew for this report"));
  EXPECT_THAT(path.text, HasSubstr("at least 5 mm apart"));
  EXPECT_THAT(path.text, HasSubstr(request.certificate->parts[0].meshSha256));
  EXPECT_THAT(path.text, HasSubstr(std::string(64, 'a')));
  EXPECT_THAT(textOfSection(page, "unchecked"), Not(HasSubstr("between the poses")));
}

TEST(FitReport, WithoutACertificateNothingIsProvenBetweenPoses) {
  const test::PathScene made = cubeBesidePost();
  FitReportRequest request = requestOf(made.scene, 0.02);
  request.path = made.path;
  const FitReport report = makeFitReport(request);
  ASSERT_TRUE(report.path && report.path->least);
  EXPECT_NEAR(report.path->least->distance, 0.01, 1e-12);
  EXPECT_THAT(
      verdictSentence(request, report),
      HasSubstr(
          "At its poses the path comes no nearer than 10 mm, to \"Post\"; between them nothing is proven."));
  EXPECT_THAT(textOfSection(pageOf(request), "unchecked"),
              HasSubstr("Between the poses of the path nothing is proven."));
  request.path = test::pathThrough("Cube", {test::at(-3, 0, 0), test::at(0.5, 0.25, 0.125)});
  const FitReport meeting = makeFitReport(request);
  EXPECT_FALSE(meeting.isGood());
  EXPECT_THAT(verdictSentence(request, meeting), HasSubstr("The path meets \"Post\" at 1 s."));
}

TEST(FitReport, ACertificateOfAnotherSceneIsRefused) {
  FitReportRequest request = certifiedRequest();
  Part post = *request.scene.findByName("Post");
  post.worldFromPart.translation.y -= 1e-9;
  request.scene.replace(post);
  const FitReport report = makeFitReport(request);
  EXPECT_FALSE(report.isGood());
  EXPECT_THAT(verdictSentence(request, report), HasSubstr("The certificate of the path is refused."));
  const test::HtmlElement page = test::htmlDocument(fitReportPage(request, report));
  EXPECT_THAT(textOfSection(page, "path"), HasSubstr("The certificate is refused: "));
  EXPECT_THAT(textOfSection(page, "path"), Not(HasSubstr("Proven anew")));
  EXPECT_THAT(textOfSection(page, "path"), Not(HasSubstr("certified separation")));
  // Without a path of its own there is nothing left to plot.
  request.path.reset();
  EXPECT_THAT(textOfSection(pageOf(request), "unchecked"), HasSubstr("refused certificate was not computed"));
}

TEST(FitReport, PathAndCertificateFilesAreReadAndHashed) {
  const test::TemporaryFolder folder;
  FitReportRequest request = certifiedRequest();
  const auto pathFile = folder.path() / "in.nfpath";
  writePathFile(*request.path, pathFile);
  const auto certificate = folder.write("in.nfcert", certificateText(*request.certificate));
  FitReportRequest read = requestOf(request.scene, 0.02);
  addPath(read, pathFile);
  addCertificate(read, certificate);
  EXPECT_TRUE(makeFitReport(read).isGood());
  ASSERT_EQ(read.inputs.size(), 3U);
  EXPECT_EQ(read.inputs[0].kind, "scene");
  EXPECT_EQ(read.inputs[1].sha256.size(), 64U);
  EXPECT_EQ(read.inputs[2].file, certificate);
  const auto changed = folder.write("changed.nfcert", test::readBytes(certificate) + "\n");
  EXPECT_THROW(addCertificate(read, changed), FileError);
  EXPECT_THROW(addPath(read, folder.path() / "none.nfpath"), FileError);
}

TEST(FitReport, AFileIsReplacedWholeOrNotAtAll) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("report.html", "the old one");
  const FitReportRequest request = requestOf(boxes(), 0.25);
  for (const double until : {0.0, 0.3, 0.85, 0.95}) {
    EXPECT_THROW(writeFitReport(request, file, [until](double fraction) { return fraction < until; }),
                 Cancelled);
    EXPECT_EQ(test::readBytes(file), "the old one") << until;
  }
  double last = 0.0;
  bool hasFallen = false;
  const FitReportOutcome outcome = writeFitReport(request, file, [&](double fraction) {
    hasFallen = hasFallen || fraction < last || fraction > 1.0;
    last = fraction;
    return true;
  });
  EXPECT_FALSE(hasFallen);
  EXPECT_FALSE(outcome.isGood);
  EXPECT_THAT(outcome.sentence, StartsWith("Does not fit"));
  EXPECT_THAT(test::readBytes(file), StartsWith("<!DOCTYPE html>"));
  EXPECT_THROW(writeFitReport(request, folder.path() / "none" / "report.html"), FileError);
  EXPECT_THROW(writeFitReport(request, folder.path()), FileError);
}

TEST(FitReport, AnUnsavedSceneHasNoHashAndSaysSo) {
  FitReportRequest request = fitReportRequest(boxes(), {}, {}, 0.25);
  EXPECT_THAT(request.origin.program, StartsWith("Nearfit "));
  EXPECT_EQ(request.origin.date.size(), 20U);
  const test::HtmlElement page = pageOf(request);
  EXPECT_EQ(test::elementsOf(page, "h1").front().text, "Fit report: Unnamed scene");
  EXPECT_THAT(textOfSection(page, "inputs"), HasSubstr("The scene was not saved as it is here"));
}

TEST(FitReport, AnEmptySceneGivesAValidPage) {
  const test::HtmlElement page = pageOf(requestOf(Scene(), 0.25));
  EXPECT_THAT(textOfSection(page, "summary"), HasSubstr("Nothing was judged"));
  EXPECT_THAT(textOfSection(page, "pairs"), HasSubstr("No pair is within the threshold."));
}

}  // namespace
}  // namespace nearfit::fit_report_test
