#pragma once

#include <cstddef>
#include <string>

namespace nearfit {

/// Throws UsageError when a name is empty, longer than so many bytes, or no printable UTF-8.
/// @param kind  Of what it is the name, for the message: "part".
void checkName(const char* kind, const std::string& name, std::size_t maxBytes);

}  // namespace nearfit
