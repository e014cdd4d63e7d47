#include "core/report/html/clearance_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/html_document.h"
#include "tests/support/random_values.h"

namespace nearfit::clearance_plot_test {
namespace {

using ::testing::HasSubstr;

constexpr double kFar = std::numeric_limits<double>::infinity();

test::HtmlElement pageOf(const ClearancePlot& plot) {
  HtmlWriter html("Plot", "");
  html.add("h1", "Plot");
  putClearancePlot(plot, html);
  return test::htmlDocument(html.take());
}

/// Drawn curves: paths that are wider than those of axes.
std::vector<std::string> curvesOf(const test::HtmlElement& page) {
  std::vector<std::string> curves;
  for (const test::HtmlElement& path : test::elementsOf(page, "path"))
    if (path.attribute("stroke-width") == "1.5") curves.push_back(path.attribute("d"));
  return curves;
}

TEST(ClearancePlot, AThinnedCurveKeepsEachNarrowPlaceAndItsTime) {
  test::RandomValues random(9);
  std::vector<double> times, distances;
  for (int i = 0; i < 100'000; ++i) {
    times.push_back(0.001 * i);
    distances.push_back(random.in(1.0, 2.0));
  }
  for (const std::size_t narrow : {std::size_t{0}, std::size_t{31'415}, std::size_t{99'999}})
    distances[narrow] = 0.5;
  const std::vector<ClearancePlotPoint> points = thinnedCurve(times, distances);
  EXPECT_EQ(points.size(), kMaxPlotPoints);
  std::size_t found = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].distance == 0.5) ++found;
    ASSERT_TRUE(i == 0 || points[i].time > points[i - 1].time);
    const auto index = static_cast<std::size_t>(std::lround(points[i].time / 0.001));
    ASSERT_EQ(points[i].distance, distances[index]);
  }
  EXPECT_EQ(found, 3U);
}

TEST(ClearancePlot, FewPosesAreAllDrawn) {
  const std::vector<double> times{0, 1, 2}, distances{3, kFar, 1};
  const std::vector<ClearancePlotPoint> points = thinnedCurve(times, distances);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[2].time, 2.0);
  EXPECT_EQ(points[1].distance, kFar);
  EXPECT_TRUE(thinnedCurve({}, {}).empty());
}

TEST(ClearancePlot, TheNearestPartsAreDrawnInTheirOrder) {
  const std::vector<double> times{0, 1};
  std::vector<std::vector<double>> distances;
  ClearancePlot plot{times, {}, 100.0, {}};
  for (int i = 0; i < 20; ++i)
    distances.push_back({50.0, 40.0 - i});
  distances.push_back({kFar, kFar});
  for (const auto& curve : distances)
    plot.curves.push_back({fmt::format("part {}", plot.curves.size()), curve});
  const std::vector<PlotCurve> nearest = nearestCurves(plot);
  ASSERT_EQ(nearest.size(), kMaxPlotCurves);
  EXPECT_EQ(nearest.front().name, "part 19");
  EXPECT_EQ(nearest.back().name, "part 12");
  EXPECT_EQ(curvesOf(pageOf(plot)).size(), kMaxPlotCurves);
}

TEST(ClearancePlot, ACurveEndsWhereThePartIsFarAndGoesOnBehind) {
  const std::vector<double> times{0, 1, 2, 3, 4}, distances{0.1, 0.2, kFar, 0.2, 0.1};
  const auto curves = curvesOf(pageOf({times, {{"Post", distances}}, 1.0, {}}));
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_EQ(std::ranges::count(curves[0], 'M'), 2);
  EXPECT_EQ(std::ranges::count(curves[0], 'L'), 2);
}

TEST(ClearancePlot, PlacesAreInProportionToTimeAndDistance) {
  const std::vector<double> times{10, 11, 14}, distances{0.0, 0.2, 0.4};
  const auto curves = curvesOf(pageOf({times, {{"Post", distances}}, 1.0, {}}));
  ASSERT_EQ(curves.size(), 1U);
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  ASSERT_EQ(std::sscanf(curves[0].c_str(), "M%lf %lfL%lf %lfL%lf %lf", &x0, &y0, &x1, &y1, &x2, &y2), 6);
  EXPECT_NEAR((x1 - x0) / (x2 - x0), 0.25, 1e-3);
  EXPECT_NEAR((y0 - y1) / (y0 - y2), 0.5, 1e-3);
  EXPECT_LT(y2, y0) << "more is higher";
}

TEST(ClearancePlot, TheSeparationAndHostileNamesAreShownAsText) {
  const std::vector<double> times{0, 1}, distances{0.001, 0.002};
  const test::HtmlElement page =
      pageOf({times, {{"</text><script>\u202E" + std::string(300, 'x'), distances}}, 1.0, 5e-4});
  EXPECT_THAT(page.text, HasSubstr("certified separation 0.5 mm"));
  EXPECT_THAT(page.text, HasSubstr("</text><script>\\u{202e}xxx"));
  EXPECT_THAT(page.text, HasSubstr("…: at least 1 mm"));
}

/// The label was written over the curves of a path into a slot.
TEST(ClearancePlot, TheSeparationIsNamedAtTheEndWhereCurvesAreFarther) {
  const std::vector<double> times{0, 1, 2, 3}, in{0.01, 0.01, 0.001, 0.001}, out{0.001, 0.001, 0.01, 0.01};
  const auto anchorOfLabel = [&](const std::vector<double>& distances) {
    for (const test::HtmlElement& text :
         test::elementsOf(pageOf({times, {{"Post", distances}}, 1.0, 5e-4}), "text"))
      if (text.text.starts_with("certified separation")) return text.attribute("text-anchor");
    return std::string();
  };
  EXPECT_EQ(anchorOfLabel(in), "start");
  EXPECT_EQ(anchorOfLabel(out), "end");
}

TEST(ClearancePlot, NothingNearGivesAnEmptyPlot) {
  const std::vector<double> times{0, 1}, distances{kFar, kFar};
  EXPECT_TRUE(curvesOf(pageOf({times, {{"Post", distances}}, 1.0, {}})).empty());
  EXPECT_TRUE(curvesOf(pageOf({{}, {}, 1.0, {}})).empty());
}

}  // namespace
}  // namespace nearfit::clearance_plot_test
