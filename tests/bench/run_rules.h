#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>

namespace nearfit::bench {

/// What the options shared by all commands say of a run; set once, before a command runs.
struct RunRules {
  /// As typed, for the heads of results.
  std::string command;
  /// Keep results even though other programs are at work; they then say so in their first line.
  bool allowsBusy = false;
};

/// The rules of this process. Not thread-safe.
RunRules& runRules();

/// Time that all processors have spent so far [clock ticks].
struct ProcessorTimes {
  double busy = 0.0, all = 0.0;
};

/// From the first line of /proc/stat. What a hypervisor took for others counts as busy. Zeros if it is not
/// such a line.
ProcessorTimes readProcessorTimes(std::istream& stat);

/// Processors that were at work on average between two readings, of `processors` in all.
double processorsAtWork(const ProcessorTimes& before, const ProcessorTimes& after, double processors);

/// Processors that other programs keep at work: watches for half a second, in which this one sleeps.
double othersAtWork();

/// True from a quarter of a processor on: an idle desktop takes less, a build or a test more.
bool isBusy(double processorsAtWork);

/// True if the file would lie among the sources, where results are committed; not for what is under build/.
bool isForCommit(const std::filesystem::path& file, const std::filesystem::path& sources);

/// Throws Error where results for `file` could not be repeated although they are for commit: the program was
/// built from uncommitted sources, or other programs are at work and `allowsBusy` is not set. An empty file is
/// for the screen, and always right.
void checkRepeatable(const std::filesystem::path& file, const std::filesystem::path& sources,
                     std::string_view revision, double atWork, bool allowsBusy);

}  // namespace nearfit::bench
