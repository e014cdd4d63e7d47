#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace nearfit {

/// Throws UsageError if a name is empty, longer than `maxBytes`, or not printable UTF-8.
/// @param kind  What the name belongs to, for the message: "part".
void checkName(const char* kind, const std::string& name, std::size_t maxBytes);

/// Names that are taken, for finding free ones.
class TakenNames {
 public:
  /// @param maxBytes  Max length of a name [bytes of UTF-8]; more than a number takes.
  explicit TakenNames(std::size_t maxBytes) : maxBytes_(maxBytes) {}

  void add(const std::string& name) { names_.insert(name); }
  /// Takes and returns `wanted`, or if it is taken, the first free name "wanted 2", "wanted 3", ... A number
  /// that `wanted` ends in is replaced. The stem is cut between characters to fit. Amortised O(log n): no
  /// numbered name is tried twice.
  std::string takeFree(const std::string& wanted);

 private:
  std::size_t maxBytes_;
  std::set<std::string> names_;
  /// Next number to try, by stem, cut to fit, and number of digits.
  std::map<std::pair<std::string, std::size_t>, std::size_t> next_;
};

}  // namespace nearfit
