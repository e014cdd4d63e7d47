#include "core/files/user_folders.h"

#include <optional>

#include <gtest/gtest.h>

#include "tests/support/scoped_variable.h"

namespace nearfit::user_folders_test {
namespace {

struct Kind {
  UserFiles kind;
  const char* variable;
  const char* inHome;
};
constexpr Kind kKinds[] = {{UserFiles::Cache, "XDG_CACHE_HOME", "/home/someone/.cache/nearfit"},
                           {UserFiles::Config, "XDG_CONFIG_HOME", "/home/someone/.config/nearfit"},
                           {UserFiles::Data, "XDG_DATA_HOME", "/home/someone/.local/share/nearfit"},
                           {UserFiles::State, "XDG_STATE_HOME", "/home/someone/.local/state/nearfit"}};

TEST(UserFolder, IsWhereItsVariableSaysElseBelowHome) {
  const test::ScopedVariable home("HOME", "/home/someone");
  for (const Kind& each : kKinds) {
    const test::ScopedVariable unset(each.variable, std::nullopt);
    EXPECT_EQ(userFolder(each.kind), each.inHome);
    const test::ScopedVariable set(each.variable, "/elsewhere");
    EXPECT_EQ(userFolder(each.kind), "/elsewhere/nearfit");
  }
}

TEST(UserFolder, RelativeAndEmptyPathsAreIgnored) {
  const test::ScopedVariable home("HOME", "/home/someone");
  for (const Kind& each : kKinds) {
    for (const char* path : {"", "relative", "./relative"}) {
      const test::ScopedVariable bad(each.variable, path);
      EXPECT_EQ(userFolder(each.kind), each.inHome) << path;
    }
  }
}

TEST(UserFolder, IsEmptyIfNoVariableHoldsAnAbsolutePath) {
  for (const Kind& each : kKinds) {
    const test::ScopedVariable bad(each.variable, "relative");
    const test::ScopedVariable noHome("HOME", std::nullopt);
    EXPECT_TRUE(userFolder(each.kind).empty());
    const test::ScopedVariable badHome("HOME", "home");
    EXPECT_TRUE(userFolder(each.kind).empty());
  }
}

}  // namespace
}  // namespace nearfit::user_folders_test
