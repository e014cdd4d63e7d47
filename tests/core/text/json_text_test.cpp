#include "core/text/json_text.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace nearfit::json_text_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonText, PlainArraysStandOnOneLineAndTheRestIsIndented) {
  const Json value = {{"name", "Peg \"2\""},
                      {"empty", Json::array()},
                      {"none", Json::object()},
                      {"parts", {{{"position", {1.5, 0, -2e-9}}}, {{"moving", nullptr}}}}};
  EXPECT_EQ(prettyJson(value),
            "{\n"
            "  \"name\": \"Peg \\\"2\\\"\",\n"
            "  \"empty\": [],\n"
            "  \"none\": {},\n"
            "  \"parts\": [\n"
            "    {\n"
            "      \"position\": [1.5, 0, -2e-09]\n"
            "    },\n"
            "    {\n"
            "      \"moving\": null\n"
            "    }\n"
            "  ]\n"
            "}\n");
}

TEST(JsonText, EveryDoubleReadsBackTheSame) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 20'000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const Json json = {{"numbers", {value, std::nextafter(1.0, 2.0)}}};
    const double read = Json::parse(prettyJson(json))["numbers"][0].get<double>();
    ASSERT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(value));
  }
}

TEST(JsonText, FloatsAreSaidShortAndReadBackTheSame) {
  EXPECT_EQ(prettyJson(Json(shortestDouble(0.62F))), "0.62\n");
  std::mt19937 random(4);
  for (int i = 0; i < 20'000; ++i) {
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(static_cast<float>(shortestDouble(value)), value);
  }
}

}  // namespace
}  // namespace nearfit::json_text_test
