#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/interleaved_run.h"

namespace nearfit::bench {

/// Something measured with a skip, or without it.
struct SkipSide {
  std::vector<double> seconds;
  std::size_t bytes = 0;               ///< Of what the skip makes less; 0 where that is no memory.
  std::vector<std::uint64_t> answers;  ///< Digests.
};

/// One skip in one place.
struct SkipRow {
  std::string skip, where, measure;  ///< By name, scene or mesh, and what is timed.
  std::string remark;                ///< What is not computed, in numbers; without commas.
  SkipSide with, without;

  bool isSame() const { return with.answers == without.answers && !with.answers.empty(); }
};

/// One way to answer questions that have numbers.
struct SkipWay {
  std::function<void(std::size_t question)> ask;  ///< Timed.
  std::function<std::uint64_t()> answer;          ///< A digest of what the last question gave; not timed.
};

/// Fills in times and answers: the two ways take turns of a block of questions each.
void takeTurns(SkipRow& row, std::size_t questions, const SkipWay& with, const SkipWay& without,
               const RunOptions& options);

std::string skipTableHeader();
std::string skipTableLine(const SkipRow& row);
std::string skipCsvHeader();
std::string skipCsvLine(const SkipRow& row);

/// Rows as another program sends them: all that is measured, in numbers that read back the same.
void writeSkipRows(std::ostream& out, std::span<const SkipRow> rows);
/// Throws Error where the text is none of those.
std::vector<SkipRow> readSkipRows(std::istream& in);

/// Throws Error for the first row whose answers are not the same, or that has none.
void checkSame(std::span<const SkipRow> rows);

}  // namespace nearfit::bench
