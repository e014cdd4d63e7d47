#include "core/files/zip_file.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/zip_entries.h"

namespace nearfit::zip_file_test {
namespace {

TEST(ZipFile, EntriesAreReadBack) {
  // Longer than what is compressed at once, and not all of one kind.
  std::string large;
  for (int i = 0; i < 100'000; ++i)
    large += std::to_string(i * 7919 % 10'007) + ' ';
  ZipFile zip;
  zip.begin("a.txt");
  zip.write("one ");
  zip.write("two");
  zip.begin("empty");
  zip.begin("folder/large");
  zip.write(large);
  const std::string bytes = zip.finish();
  const auto entries = test::zipEntries(bytes);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries.at("a.txt"), "one two");
  EXPECT_EQ(entries.at("empty"), "");
  EXPECT_EQ(entries.at("folder/large"), large);
  EXPECT_LT(bytes.size(), large.size());
}

TEST(ZipFile, EqualContentsMakeEqualFiles) {
  const auto make = [] {
    ZipFile zip;
    zip.begin("a");
    zip.write("content");
    return zip.finish();
  };
  EXPECT_EQ(make(), make());
}

}  // namespace
}  // namespace nearfit::zip_file_test
