#pragma once

#include <cstddef>
#include <string>

namespace nearfit {

/// Throws UsageError if a name is empty, longer than `maxBytes`, or not printable UTF-8.
/// @param kind  What the name belongs to, for the message: "part".
void checkName(const char* kind, const std::string& name, std::size_t maxBytes);

}  // namespace nearfit
