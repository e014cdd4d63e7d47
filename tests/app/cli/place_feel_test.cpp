#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/haptics/device_limits.h"
#include "tests/app/cli/place_fixture.h"

namespace nearfit::test::place_feel_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using PlaceFeel = PlaceFixture;

TEST_F(PlaceFeel, OptionsOfTheFeelCountForThisRunAlone) {
  const std::string before = readBytes(file("fit.nearfit"));
  const auto peakWith = [&](std::vector<std::string> options) {
    options.insert(options.end(), {"--fast", "--json"});
    const ProcessResult result = placeCone(options);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    return std::pair(json["mode"].get<std::string>(), json["peak_force"].get<double>());
  };
  const double deepest = heightAt(kTicks - 1), felt = 0.1 - deepest;
  const auto [mode, peak] = peakWith({"--stiffness", "20"});
  EXPECT_EQ(mode, "spring");
  EXPECT_NEAR(peak, 20.0 * felt, 1e-9);
  // As printed, the force is most where height and compression are equal, at half the cutoff.
  const auto [printedMode, printedPeak] = peakWith({"--mode", "printed", "--stiffness", "1000"});
  EXPECT_EQ(printedMode, "printed");
  EXPECT_NEAR(printedPeak, 1000.0 * 0.05 * 0.05, 1e-3);
  EXPECT_NEAR(peakWith({}).second, 50.0 * felt, 1e-9);
  EXPECT_EQ(readBytes(file("fit.nearfit")), before);
}

TEST_F(PlaceFeel, OptionsOfTheFeelThatMakeNoSenseAreRefused) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--mode", "soft"}, "--mode"},
      {{"--margin", "0.2"}, "--margin: 0.2 m is greater than the cutoff, 0.1 m"},
      {{"--scale", "1e4"}, "--scale: 10000 is out of range"},
      {{"--lock", "up"}, "--lock: \"up\" is not a list of axes"},
  };
  for (const auto& [options, problem] : wrong) {
    std::vector<std::string> arguments = options;
    arguments.insert(arguments.end(), {"--fast", "--record", "out.csv"});
    const ProcessResult result = placeCone(arguments);
    EXPECT_EQ(result.exitCode, 2) << problem;
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
    EXPECT_FALSE(std::filesystem::exists(file("out.csv")));
  }
}

TEST_F(PlaceFeel, TheSummaryTellsTheModeAndItsNumbers) {
  EXPECT_THAT(placeCone({"--fast"}).out,
              AllOf(HasSubstr("mode        spring, 50 N/m and 0 N s/m within 0.1 m\n"),
                    HasSubstr("J given to the hand\n"), Not(HasSubstr("coupling"))));
  EXPECT_THAT(placeCone({"--fast", "--mode", "printed"}).out, HasSubstr("printed, 50 N/m^2 and"));
  EXPECT_THAT(placeCone({"--fast", "--mode", "proxy", "--margin", "0.002", "--friction", "0.25"}).out,
              AllOf(HasSubstr("mode        proxy, margin 0.002 m, friction 0.25\n"),
                    HasSubstr("\ncoupling    "), HasSubstr(" per tick, "), HasSubstr("\nproxy       p50 ")));
  EXPECT_THAT(placeCone({"--fast", "--one-per-area"}).out,
              AllOf(HasSubstr("within 0.1 m, one spring for each area of contact\n"),
                    HasSubstr("areas       max 1 at once\n"), Not(HasSubstr("held "))));
  EXPECT_THAT(placeCone({"--fast", "--stiffness", "1e5"}).out,
              HasSubstr("\nheld        springs stiffer than"));
  const auto springs = nlohmann::json::parse(placeCone({"--fast", "--json"}).out);
  EXPECT_EQ(springs["springs"]["held_ticks"].get<int>(), 0);
  EXPECT_FALSE(springs["springs"]["one_per_area"].get<bool>());
  EXPECT_TRUE(springs["proxy"].is_null());
  EXPECT_TRUE(springs["max_energy_to_hand"].is_number());
  const auto proxy = nlohmann::json::parse(placeCone({"--fast", "--json", "--mode", "proxy"}).out)["proxy"];
  // Colgate's bound at 1 kHz, from the damping of a device of which nothing else is known.
  const auto& coupling = proxy["coupling"];
  EXPECT_NEAR(coupling["stiffness_bound"].get<double>(),
              2000.0 * (DeviceLimits{}.damping - coupling["damping"].get<double>()), 1e-9);
  EXPECT_NEAR(coupling["rotational_stiffness_bound"].get<double>(),
              2000.0 * (DeviceLimits{}.rotationalDamping - coupling["rotational_damping"].get<double>()),
              1e-9);
  EXPECT_LE(coupling["stiffness"], coupling["stiffness_bound"]);
  for (const char* key :
       {"coupling", "max_sub_steps", "shortened_steps", "refused_steps", "released_ticks", "proxy_us"}) {
    EXPECT_TRUE(proxy.contains(key)) << key;
  }
}

}  // namespace
}  // namespace nearfit::test::place_feel_test
