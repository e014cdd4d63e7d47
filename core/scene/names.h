#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>

namespace nearfit {

/// Throws UsageError if a name is empty, longer than `maxBytes`, or not printable UTF-8.
/// @param kind  What the name belongs to, for the message: "part".
void checkName(const char* kind, const std::string& name, std::size_t maxBytes);

/// Returns `wanted`, or if it is taken, the first free name "wanted 2", "wanted 3", ... A number that
/// `wanted` ends in is replaced. The stem is cut between characters to fit `maxBytes` [bytes of UTF-8].
std::string freeName(const std::string& wanted, const std::unordered_set<std::string_view>& taken,
                     std::size_t maxBytes);

}  // namespace nearfit
