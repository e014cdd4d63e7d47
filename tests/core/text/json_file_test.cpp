#include "core/text/json_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::json_file_test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

class JsonFile : public ::testing::Test {
 protected:
  nlohmann::json read(const std::string& text, const JsonLimits& limits = {}) const {
    return readJsonFile(folder_.write("file.json", text), limits);
  }
  /// The error that reading the text gives.
  FileError errorOf(const std::string& text, const JsonLimits& limits = {}) const {
    try {
      read(text, limits);
    } catch (const FileError& e) {
      return e;
    }
    ADD_FAILURE() << "no error";
    return {"", ""};
  }
  test::TemporaryFolder folder_;
};

TEST_F(JsonFile, ValidFileIsRead) {
  EXPECT_EQ(read("\xEF\xBB\xBF {\"a\": [1, 2.5, \"\xC3\xA4\"]}\n")["a"][1], 2.5);
}

TEST_F(JsonFile, SyntaxErrorIsToldByLineAndColumn) {
  EXPECT_THAT(errorOf("{\n  \"a\": 1,\n  \"b\" 2\n}").where(), EndsWith("file.json:3:7"));
  EXPECT_THAT(errorOf("").where(), EndsWith("file.json:1:1"));
  EXPECT_THAT(errorOf("[1, 2").problem(), HasSubstr("unexpected end of input"));
}

TEST_F(JsonFile, ColumnsCountCharactersAndNotBytes) {
  EXPECT_THAT(errorOf("[\"\xC3\xA4\xC3\xA4\xC3\xA4\" x]").where(), EndsWith("file.json:1:8"));
}

TEST_F(JsonFile, MessageShowsNoControlCharactersAndStaysShort) {
  const std::string problem = errorOf("\"\x1B[31m" + std::string(10'000, 'x')).problem();
  EXPECT_EQ(problem.find('\x1B'), std::string::npos);
  EXPECT_LT(problem.size(), 800U);
}

TEST_F(JsonFile, TextThatIsNotUtf8IsRefused) {
  EXPECT_THAT(errorOf("[\"\xFF\"]").problem(), HasSubstr("UTF-8"));
}

TEST_F(JsonFile, NumberThatNoDoubleHoldsIsRefused) {
  EXPECT_THAT(errorOf("[1e999]").problem(), HasSubstr("1e999"));
}

TEST_F(JsonFile, DeepNestingIsRefused) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_NO_THROW(read(nested(JsonLimits().maxDepth)));
  EXPECT_THAT(errorOf(nested(JsonLimits().maxDepth + 2)).problem(), HasSubstr("nested deeper"));
  EXPECT_THAT(errorOf(std::string(1'000'000, '[')).problem(), HasSubstr("nested deeper"));
}

TEST_F(JsonFile, TooManyValuesOrBytesAreRefused) {
  EXPECT_THAT(errorOf("[1,2,3,4,5,6,7,8,9]", {.maxValues = 5}).problem(), HasSubstr("more than 5 values"));
  EXPECT_THAT(errorOf("[1,2,3,4,5,6,7,8,9]", {.maxBytes = 18}).problem(), HasSubstr("larger than 18 bytes"));
  EXPECT_NO_THROW(read("[1,2,3,4,5,6,7,8,9]", {.maxBytes = 19}));
}

/// An object of `count` members, each with this value.
std::string objectOf(std::size_t count, const std::string& value) {
  std::string text = "{";
  for (std::size_t i = 0; i < count; ++i)
    text += (i == 0 ? "\"k" : ",\"k") + std::to_string(i) + "\":" + value;
  return text + "}";
}

// The end of each object once took a look at all members of its parent: 1.8e11 of them here, at some
// 100 ns where keys come in no order. That is five hours, and the suite's timeout is ten minutes.
TEST_F(JsonFile, HundredsOfThousandsOfObjectsInOneAreRead) {
  constexpr std::size_t kCount = 600'000, kStride = 7919;  // The stride is prime to the count.
  std::string text = "{";
  for (std::size_t i = 0; i < kCount; ++i)
    text += (i == 0 ? "\"k" : ",\"k") + std::to_string(i * kStride % kCount) + "\":{}";
  const nlohmann::json json = read(text + "}", {.maxBytes = 64U << 20U, .maxValues = 3 * kCount + 2});
  EXPECT_EQ(json.size(), kCount);
  EXPECT_EQ(json.at("k599999"), nlohmann::json::object());
}

TEST_F(JsonFile, MillionsOfKeysAreRefusedByTheirNumber) {
  EXPECT_THAT(errorOf(objectOf(2'000'000, "1"), {.maxBytes = 64U << 20U}).problem(),
              HasSubstr("more than 1000000 values"));
}

TEST_F(JsonFile, EveryKindOfValueIsKeptWithItsType) {
  const nlohmann::json json = read(R"({"z":[null,true,-1,2,0.5,"s",[],{}],"a":{"b":[[1],[{"c":2}]]}})");
  EXPECT_EQ(json, nlohmann::json::parse(R"({"a":{"b":[[1],[{"c":2}]]},"z":[null,true,-1,2,0.5,"s",[],{}]})"));
  EXPECT_TRUE(json["z"][2].is_number_integer());
  EXPECT_TRUE(json["z"][3].is_number_unsigned());
  EXPECT_TRUE(json["z"][4].is_number_float());
  EXPECT_EQ(read("7"), 7);
}

TEST_F(JsonFile, KeySaidTwiceIsRefusedButNotInTwoObjects) {
  EXPECT_THAT(errorOf(R"({"a": {"b": 1, "c": {"b": 2}, "b": 3}})").problem(), HasSubstr("\"b\" twice"));
  EXPECT_NO_THROW(read(R"([{"b": 1}, {"b": 2, "c": {"b": 3}}])"));
}

TEST_F(JsonFile, MissingFileFolderAndDeviceAreRefused) {
  EXPECT_THROW(readJsonFile(folder_.path() / "none.json"), FileError);
  EXPECT_THROW(readJsonFile(folder_.path()), FileError);
  EXPECT_THROW(readJsonFile("/dev/zero"), FileError);
}

TEST_F(JsonFile, FieldsNameTheirPath) {
  const std::filesystem::path file = "s.nearfit";
  const nlohmann::json json =
      nlohmann::json::parse(R"({"parts": [{}, {"position": [0, "x"], "name": "a\u0000b"}]})");
  const JsonField part = JsonField(json, file).at("parts").at(1);
  const auto whatOf = [](auto read) -> std::string {
    try {
      read();
    } catch (const FileError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_EQ(whatOf([&] { part.at("position").at(1).number(); }),
            "s.nearfit: parts[1].position[1]: it is of type string, but a number is expected");
  EXPECT_EQ(whatOf([&] { part.at("quaternion"); }), "s.nearfit: parts[1].quaternion: it is missing");
  EXPECT_EQ(whatOf([&] { part.at("name").text(9); }), "s.nearfit: parts[1].name: it holds a NUL character");
  EXPECT_EQ(whatOf([&] { part.at("name").text(2); }), "s.nearfit: parts[1].name: it is longer than 2 bytes");
  EXPECT_EQ(whatOf([&] { part.at("position").at("x"); }),
            "s.nearfit: parts[1].position: it is of type array, but an object is expected");
  EXPECT_EQ(whatOf([&] { part.size(); }),
            "s.nearfit: parts[1]: it is of type object, but an array is expected");
  EXPECT_EQ(whatOf([&] { part.at("position").at(0).numberWithin(1, 2); }),
            "s.nearfit: parts[1].position[0]: 0 is out of range; give a value from 1 to 2");
  EXPECT_EQ(whatOf([&] { part.at("name").isTrue(); }),
            "s.nearfit: parts[1].name: it is of type string, but true or false is expected");
}

}  // namespace
}  // namespace nearfit::json_file_test
