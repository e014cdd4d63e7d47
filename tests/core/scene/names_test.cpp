#include "core/scene/names.h"

#include <gtest/gtest.h>

#include "tests/support/allocation_hook.h"

namespace nearfit::names_test {
namespace {

/// Requests and releases of memory for each of `count` free names, on average. A try takes one at least where the name
/// has more bytes than a string holds in itself.
template <class TakeAll>
std::uint64_t allocationsPerName(std::uint64_t count, TakeAll takeAll) {
  test::resetAllocationCount();
  test::startCountingAllocations();
  takeAll();
  test::stopCountingAllocations();
  return test::countedAllocations() / count;
}
/// Enough for the numbers of five digits, each with a stem of its own; to try all numbers takes thousands.
constexpr std::uint64_t kMaxAllocations = 100;

TEST(TakenNames, AFreeNameIsTakenAsItIs) {
  TakenNames names(20);
  EXPECT_EQ(names.takeFree("Peg"), "Peg");
  EXPECT_EQ(names.takeFree("Peg 7"), "Peg 7");
}

TEST(TakenNames, ATakenNameGetsTheFirstFreeNumber) {
  TakenNames names(20);
  for (const char* name : {"Peg", "Peg 2", "Peg 4", "Peg 10"})
    names.add(name);
  EXPECT_EQ(names.takeFree("Peg"), "Peg 3");
  EXPECT_EQ(names.takeFree("Peg 2"), "Peg 5") << "its own number goes";
  for (const char* name : {"Peg 6", "Peg 7", "Peg 8", "Peg 9", "Peg 11"})
    EXPECT_EQ(names.takeFree("Peg"), name);
}

TEST(TakenNames, AStemIsCutBetweenCharactersToFitItsNumber) {
  TakenNames names(6);
  EXPECT_EQ(names.takeFree("abcd\xC3\xA9"), "abcd\xC3\xA9");
  EXPECT_EQ(names.takeFree("abcd\xC3\xA9"), "abcd 2");
  for (int i = 3; i < 10; ++i)
    names.takeFree("abcd\xC3\xA9");
  EXPECT_EQ(names.takeFree("abcd\xC3\xA9"), "abc 10");
}

// Each once tried all numbers from 2 on.
TEST(TakenNames, ThousandsOfEqualNamesTakeOneTryEach) {
  constexpr std::size_t kCount = 20'000;
  const std::string wanted = "Connecting rod of the pump";
  TakenNames names(200);
  const std::uint64_t each = allocationsPerName(kCount, [&] {
    for (std::size_t i = 1; i < kCount; ++i)
      names.takeFree(wanted);
  });
  EXPECT_EQ(names.takeFree(wanted), wanted + " 20000");
  EXPECT_LE(each, kMaxAllocations);
}

TEST(TakenNames, SoDoNamesThatAreEqualOnceTheyAreCut) {
  constexpr int kCount = 50'000;
  TakenNames names(200);
  const auto longName = [](int i) { return std::string(195, 'a') + std::to_string(10'000 + i); };
  for (int i = 0; i < kCount; ++i)
    names.add(longName(i));
  const std::uint64_t each = allocationsPerName(kCount, [&] {
    for (int i = 0; i + 1 < kCount; ++i)
      names.takeFree(longName(i));
  });
  // The longer the number, the fewer stems differ: 500 get 8 numbers of one digit each, 50 get 90 of two, 5 get
  // 900 of three, one gets 9,000 of four; together 22,000.
  EXPECT_EQ(names.takeFree(longName(kCount - 1)), std::string(194, 'a') + " 37999");
  EXPECT_LE(each, kMaxAllocations);
}

}  // namespace
}  // namespace nearfit::names_test
