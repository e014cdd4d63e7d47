#include "core/scene/name_pattern.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace nearfit::name_pattern_test {
namespace {

struct Match {
  const char *pattern, *name;
};

TEST(NamePattern, AStarStandsForAnyCharactersAndAQuestionMarkForOne) {
  constexpr const char* kUmlaut = "\xC3\xA4";
  for (const auto& [pattern, name] :
       {Match{"Peg", "Peg"}, Match{"*", ""}, Match{"*", "Peg"}, Match{"Peg*", "Peg"}, Match{"Peg*", "Peg 12"},
        Match{"*eg", "Peg eg"}, Match{"*a*b*c", "xaxbxbxc"}, Match{"P?g", "Peg"}, Match{"?", kUmlaut},
        Match{"*?", "Pe"}, Match{"**", "x"}, Match{"\\*", "*"}, Match{"a\\?b", "a?b"}, Match{"\\\\", "\\"},
        Match{"*\\**", "a*b"}})
    EXPECT_TRUE(matchesPattern(pattern, name)) << pattern << " " << name;
  for (const auto& [pattern, name] :
       {Match{"Peg", "peg"}, Match{"Peg", "Peg 2"}, Match{"Peg", ""}, Match{"?", ""}, Match{"?", "ab"},
        Match{"Peg*x", "Peg"}, Match{"*a*b", "ba"}, Match{"\\*", "x"}, Match{"a\\?b", "axb"},
        Match{"??", kUmlaut}})
    EXPECT_FALSE(matchesPattern(pattern, name)) << pattern << " " << name;
}

TEST(NamePattern, ManyStarsTakeNoExponentialTime) {
  std::string pattern;
  for (int i = 0; i < 100; ++i)
    pattern += "*a";
  EXPECT_FALSE(matchesPattern(pattern + "b", std::string(kMaxPatternBytes, 'a')));
}

TEST(NamePattern, ANameIsEscapedSoThatItStandsForItselfAlone) {
  for (const char* name : {"Peg", "a*b", "what?", "back\\slash", "*", "\\*"}) {
    EXPECT_TRUE(matchesPattern(patternOf(name), name)) << name;
    EXPECT_EQ(onlyNameOf(patternOf(name)), name);
  }
  EXPECT_FALSE(matchesPattern(patternOf("a*b"), "axb"));
  EXPECT_FALSE(onlyNameOf("Peg*"));
  EXPECT_FALSE(onlyNameOf("P?g"));
}

TEST(NamePattern, WhatIsNoPatternIsRefused) {
  for (const char* bad : {"", "a\\", "\\\\\\", "a\nb", "\xFF"})
    EXPECT_THROW(checkPattern(bad), UsageError) << bad;
  EXPECT_THROW(checkPattern(std::string(kMaxPatternBytes + 1, 'x')), UsageError);
  EXPECT_NO_THROW(checkPattern("\\\\"));
}

}  // namespace
}  // namespace nearfit::name_pattern_test
