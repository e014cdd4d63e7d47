#include "tests/bench/import_run.h"

#include <fstream>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "core/base/error.h"

namespace nearfit::bench {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DocumentCounts, shapes, instances, triangles, placedTriangles)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ImportRun, seconds, loadSeconds, isFromCache, counts, ownPeakBytes,
                                   importPeakBytes, besideImportBytes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OccRun, version, readSeconds, transferSeconds, meshSeconds, counts,
                                   peakBytes)

namespace {

/// /proc and getrusage() count in these.
constexpr std::uint64_t kKibibyte = 1024;

template <typename Run>
Run readRun(const std::string& text) {
  try {
    return nlohmann::json::parse(text).get<Run>();
  } catch (const nlohmann::json::exception& e) {
    throw Error("run of another program", e.what(), "run it by itself to see what it says");
  }
}

}  // namespace

std::string textOf(const ImportRun& run) {
  return nlohmann::json(run).dump() + "\n";
}

std::string textOf(const OccRun& run) {
  return nlohmann::json(run).dump() + "\n";
}

ImportRun readImportRun(const std::string& text) {
  return readRun<ImportRun>(text);
}

OccRun readOccRun(const std::string& text) {
  return readRun<OccRun>(text);
}

std::uint64_t peakResidentBytes() {
  std::ifstream status("/proc/self/status");
  for (std::string name; status >> name;) {
    std::uint64_t kibibytes = 0;
    if (name == "VmHWM:" && status >> kibibytes) return kKibibyte * kibibytes;
  }
  return 0;
}

std::uint64_t peakChildBytes() {
  ::rusage usage{};
  if (::getrusage(RUSAGE_CHILDREN, &usage) != 0) return 0;
  return kKibibyte * static_cast<std::uint64_t>(usage.ru_maxrss);
}

}  // namespace nearfit::bench
