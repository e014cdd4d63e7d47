#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>

namespace nearfit {

/// The name that is wanted, or where it is taken the first free one with a number from 2 behind it, in place
/// of a number that it has; cut at a character's end to keep within the limit [bytes of UTF-8].
std::string freeName(const std::string& wanted, const std::unordered_set<std::string_view>& taken,
                     std::size_t maxBytes);

}  // namespace nearfit
