#include "core/report/clearance_histogram.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/report/clearance_colours.h"

namespace nearfit::clearance_histogram_test {
namespace {

const double kNone = std::nan("");

/// A surface with these areas and clearances at its samples.
MappedSurface surfaceWith(std::vector<double> areas, std::vector<double> distances) {
  auto surface = std::make_shared<SampledSurface>();
  surface->areas = std::move(areas);
  MappedSurface mapped;
  mapped.surface = std::move(surface);
  mapped.distances = std::move(distances);
  return mapped;
}

TEST(AreaByClearance, AreasMeanAndLeastAreThoseOfTheSamples) {
  const AreaByClearance areas(surfaceWith({1.0, 2.0, 4.0, 8.0, 16.0}, {0.5, -0.25, kNone, 0.0, 0.5}));
  EXPECT_EQ(areas.total(), 31.0);
  EXPECT_EQ(areas.within(), 27.0);
  EXPECT_EQ(areas.least(), -0.25);
  EXPECT_DOUBLE_EQ(areas.mean().value(), (0.5 * 17.0 - 0.25 * 2.0) / 27.0);
  EXPECT_EQ(areas.nearerThan(-1.0), 0.0);
  EXPECT_EQ(areas.nearerThan(0.0), 2.0);
  EXPECT_EQ(areas.nearerThan(0.5), 10.0) << "less, not the same";
  EXPECT_EQ(areas.nearerThan(0.6), 27.0);
  EXPECT_EQ(areas.inContact(), 8.0);
  EXPECT_EQ(areas.overlapping(), 2.0);
}

TEST(AreaByClearance, ContactIsToAMicrometreEitherWay) {
  const AreaByClearance areas(surfaceWith({1.0, 2.0, 4.0, 8.0}, {-1.1e-6, -1e-6, 1e-6, 1.1e-6}));
  EXPECT_EQ(areas.inContact(), 6.0);
  EXPECT_EQ(areas.overlapping(), 1.0);
}

TEST(AreaByClearance, WithNothingNearThereIsNoLeastAndNoMean) {
  const AreaByClearance areas(surfaceWith({1.0, 2.0}, {kNone, kNone}));
  EXPECT_FALSE(areas.least().has_value());
  EXPECT_FALSE(areas.mean().has_value());
  EXPECT_EQ(areas.within(), 0.0);
  EXPECT_EQ(areas.total(), 3.0);
}

TEST(ClearanceHistogram, EachAreaIsInOneBinAndTheRangeInTheLast) {
  const AreaByClearance areas(
      surfaceWith({1.0, 2.0, 4.0, 8.0, 16.0, 32.0}, {0.0, 0.24, 0.25, 0.99, 1.0, kNone}));
  const std::vector<ClearanceBin> bins = clearanceHistogram(areas, 1.0, 4);
  ASSERT_EQ(bins.size(), 4U);
  EXPECT_EQ(bins[0].from, 0.0);
  EXPECT_EQ(bins[3].to, 1.0);
  EXPECT_EQ(bins[0].area, 3.0);
  EXPECT_EQ(bins[1].area, 4.0);
  EXPECT_EQ(bins[2].area, 0.0);
  EXPECT_EQ(bins[3].area, 24.0);
}

TEST(ClearanceHistogram, OverlapsHaveBinsBelowZeroAndTheDeepestOneHoldsTheRest) {
  const AreaByClearance shallow(surfaceWith({1.0, 2.0, 4.0}, {-0.3, -0.1, 0.1}));
  const std::vector<ClearanceBin> bins = clearanceHistogram(shallow, 1.0, 4);
  ASSERT_EQ(bins.size(), 6U);
  EXPECT_EQ(bins[0].from, -0.5);
  EXPECT_EQ(bins[0].area, 1.0);
  EXPECT_EQ(bins[1].area, 2.0);
  EXPECT_EQ(bins[2].area, 4.0);
  const AreaByClearance deep(surfaceWith({1.0, 2.0}, {-90.0, 0.1}));
  const std::vector<ClearanceBin> few = clearanceHistogram(deep, 1.0, 4);
  ASSERT_EQ(few.size(), 8U);
  EXPECT_EQ(few[0].from, -1.0);
  EXPECT_EQ(few[0].area, 1.0);
}

TEST(ClearanceHistogram, TheTableEndsWithWhatIsBeyond) {
  const AreaByClearance areas(surfaceWith({1.0, 3.0}, {0.0, kNone}));
  const std::string text = histogramCsv(areas, 0.5);
  EXPECT_TRUE(text.starts_with("from [m],to [m],area [m^2],share\n0,0.0125,1,0.25\n")) << text;
  EXPECT_TRUE(text.ends_with("\n0.5,inf,3,0.75\n")) << text;
  EXPECT_EQ(std::ranges::count(text, '\n'), 42);
}

TEST(ClearanceColours, GoFromRedAtContactToBlueAndAreDarkInside) {
  const Colour contact = clearanceColour(0.0, 0.01), far = clearanceColour(0.01, 0.01);
  EXPECT_EQ(contact, kClearanceStops.front());
  EXPECT_EQ(clearanceColour(-0.5e-6, 0.01), contact) << "contact to rounding";
  EXPECT_FLOAT_EQ(far.r, kClearanceStops.back().r);
  EXPECT_FLOAT_EQ(far.g, kClearanceStops.back().g);
  EXPECT_FLOAT_EQ(far.b, kClearanceStops.back().b);
  EXPECT_EQ(clearanceColour(0.005, 0.01), kClearanceStops[5]);
  EXPECT_EQ(clearanceColour(-0.001, 0.01), kOverlapColour);
  EXPECT_GT(contact.r, contact.b);
  EXPECT_GT(far.b, far.r);
}

}  // namespace
}  // namespace nearfit::clearance_histogram_test
