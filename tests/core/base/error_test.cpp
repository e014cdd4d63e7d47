#include "core/base/error.h"

#include <exception>
#include <stdexcept>

#include <gtest/gtest.h>

namespace nearfit::error_test {
namespace {

TEST(Error, OnlyCancelledIsCancelled) {
  EXPECT_TRUE(isCancelled(std::make_exception_ptr(Cancelled())));
  EXPECT_FALSE(isCancelled(std::make_exception_ptr(UsageError("here", "wrong"))));
  EXPECT_FALSE(isCancelled(std::make_exception_ptr(std::runtime_error("cancelled"))));
  EXPECT_FALSE(isCancelled(std::make_exception_ptr(1)));
  EXPECT_FALSE(isCancelled(nullptr));
}

}  // namespace
}  // namespace nearfit::error_test
