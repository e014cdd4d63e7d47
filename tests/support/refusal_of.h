#pragma once

#include <string>

#include "core/base/error.h"

namespace nearfit::test {

/// Message of the UsageError that a call throws; empty if it throws none.
template <typename Call>
std::string refusalOf(Call call) {
  try {
    call();
  } catch (const UsageError& e) {
    return e.what();
  }
  return "";
}

}  // namespace nearfit::test
