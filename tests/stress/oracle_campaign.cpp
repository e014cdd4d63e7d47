#include "tests/stress/oracle_campaign.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "core/math/mixed_bits.h"
#include "core/proximity/query/lmd_query.h"
#include "tests/stress/oracle_poses.h"
#include "tests/support/region_oracle.h"

namespace nearfit::stress {
namespace {

using test::OracleMinimum;

/// Agreement asked of points, as a fraction of the size; and how far brute force in double precision must be
/// from any condition's border to be believed by itself.
constexpr double kPointAgreement = 1e-9, kSure = 1e-8;

/// Regions that are tilted within the tolerance may be measured along either face's normal.
constexpr double kRegionAgreement = 1e-6;

/// Poses that go to exact arithmetic though nothing calls for it: one of so many.
constexpr std::size_t kSample = 250;

/// Poses of one pair at a time.
constexpr std::size_t kBlock = 100;

/// As a fraction of the larger body.
constexpr double kCutoff = 0.1;

/// FNV-1a, the same everywhere, mixed with the numbers (splitmix64).
std::uint64_t seedOf(std::uint64_t seed, const std::string& name, std::size_t number) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const char c : name)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  return mixedBits(hash + seed * 0x9E3779B97F4A7C15U + number * 0xD1B54A32D192ED03U);
}

}  // namespace

struct OraclePair::Case {
  std::uint64_t seed;
  std::size_t number;
  OraclePose pose;
  double cutoff;
};

OracleTally& OracleTally::operator+=(const OracleTally& other) {
  poses += other.poses;
  found += other.found;
  flagged += other.flagged;
  regions += other.regions;
  judged += other.judged;
  differing += other.differing;
  faults.insert(faults.end(), other.faults.begin(), other.faults.end());
  return *this;
}

OraclePair::OraclePair(const test::BodyPair& pair)
    : pair_(pair),
      sceneTree_(pair.scene),
      partTree_(pair.part),
      scene_(pair.scene),
      part_(pair.part),
      judge_(pair_),
      cutoff_(kCutoff * std::max(scene_.size(), part_.size())) {}

void OraclePair::run(std::uint64_t seed, std::size_t first, std::size_t end, OracleTally& tally) const {
  for (std::size_t number = first; number < end; ++number) {
    std::mt19937_64 random(seedOf(seed, pair_.name, number));
    const OraclePose pose = randomOraclePose(pair_, cutoff_, random);
    const bool isEasy = pose.kind == PoseKind::Random;
    check({seed, number, pose, isEasy ? cutoff_ : cutoffOf(pose.sceneFromPart, random())}, tally);
  }
}

/// A cutoff that ends at a minimum, or next to it, in one of four.
double OraclePair::cutoffOf(const RigidTransform& pose, std::uint64_t choice) const {
  if (choice % 4 != 0) return cutoff_;
  const std::vector<Lmd> lmds = found(pose, cutoff_);
  if (lmds.empty()) return cutoff_;
  const double at = lmds[choice / 4 % lmds.size()].distance;
  switch (choice / 1024 % 3) {
    case 0:
      return std::nextafter(at, 0.0);
    case 1:
      return at;
    default:
      return std::nextafter(at, std::numeric_limits<double>::infinity());
  }
}

std::vector<Lmd> OraclePair::found(const RigidTransform& pose, double cutoff) const {
  thread_local LmdScratch scratch;
  std::vector<Lmd> out(4096);
  const LmdResult result = findLmds(sceneTree_, partTree_, pose, cutoff, scratch, out);
  if (result.status != QueryStatus::Complete) throw std::runtime_error("a set was truncated");
  out.resize(result.count);
  return out;
}

/// With brute force in double precision, and nothing near a border.
bool OraclePair::agrees(const std::vector<Lmd>& found, const RigidTransform& pose, double cutoff) const {
  const double size = scene_.size() + part_.size(), tolerance = kPointAgreement * size;
  const auto isSame = [tolerance](const Lmd& f, const OracleMinimum& e) {
    return glm::distance(f.scenePoint, e.scenePoint) <= tolerance &&
           glm::distance(f.partPoint, e.partPoint) <= tolerance;
  };
  const auto isPlain = [](const Lmd& f) { return !f.isRegion && !f.isMarginal; };
  if (!std::all_of(found.begin(), found.end(), isPlain)) return false;
  const std::vector<OracleMinimum> expected =
      bruteForceMinima(scene_, part_, pose, cutoff + tolerance, 2.0 * kSure);
  if (expected.size() != found.size()) return false;
  return std::all_of(expected.begin(), expected.end(), [&](const OracleMinimum& e) {
    return e.slack > kSure && e.distance < cutoff - tolerance && e.distance > kSure * size &&
           std::count_if(found.begin(), found.end(), [&](auto& f) { return isSame(f, e); }) == 1;
  });
}

/// Brute force measures regions as well; what is nothing but rounding wide, near or within the cutoff is left
/// to the exact minima at its rim.
std::vector<std::string> OraclePair::regionFaults(const std::vector<Lmd>& found, const RigidTransform& pose,
                                                  double cutoff) const {
  const double size = scene_.size() + part_.size(), tolerance = kRegionAgreement * size;
  const std::vector<test::OracleRegion> regions = bruteForceRegions(scene_, part_, pose, cutoff);
  const auto isSame = [&](const Lmd& f, const test::OracleRegion& r) {
    return f.isRegion && f.extent.dimension == r.dimension &&
           glm::distance(f.scenePoint, r.centroid) <= tolerance &&
           std::abs(f.extent.measure - r.measure) <= tolerance * (r.dimension == 2 ? size : 1.0) &&
           std::abs(f.distance - r.least) <= kPointAgreement * size;
  };
  std::vector<std::string> faults;
  for (const Lmd& f : found) {
    const bool isSure = f.isRegion && !f.isMarginal && f.distance > tolerance;
    if (isSure && std::none_of(regions.begin(), regions.end(), [&](auto& r) { return isSame(f, r); })) {
      faults.push_back(fmt::format("region of dimension {}, measure {:.17g}, that brute force has not: {}",
                                   f.extent.dimension, f.extent.measure, test::describe(f)));
    }
  }
  return faults;
}

void OraclePair::check(const Case& at, OracleTally& tally) const {
  const RigidTransform& pose = at.pose.sceneFromPart;
  const std::vector<Lmd> lmds = found(pose, at.cutoff);
  ++tally.poses;
  tally.found += lmds.size();
  for (const Lmd& f : lmds) {
    tally.flagged += f.isMarginal ? 1 : 0;
    tally.regions += f.isRegion ? 1 : 0;
  }
  const bool isSame = agrees(lmds, pose, at.cutoff);
  if (isSame && at.number % kSample != 0) return;
  ++tally.judged;
  tally.differing += isSame ? 0 : 1;
  test::ExactTally counts;
  for (const std::string& fault : judge_.faults(lmds, judge_.minimaAt(pose, at.cutoff), at.cutoff, counts)) {
    tally.faults.push_back(fmt::format("--seed {} --pairs {} --first {} --poses 1: {}, cutoff {:.17g}: {}",
                                       at.seed, pair_.name, at.number, test::describe(pose), at.cutoff,
                                       fault));
  }
}

OracleTally runOracleCampaign(const std::vector<test::BodyPair>& pairs, const OracleRange& range,
                              unsigned threads, const std::function<void(const OracleTally&)>& onBlock) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  OracleTally sum;
  const std::size_t blocks = (range.count + kBlock - 1) / kBlock;
  const auto work = [&] {
    // Exact numbers are not shared between threads.
    const std::vector<OraclePair> own(pairs.begin(), pairs.end());
    for (std::size_t i = next++; i < blocks * own.size(); i = next++) {
      const std::size_t from = range.first + i / own.size() * kBlock;
      OracleTally tally;
      own[i % own.size()].run(range.seed, from, std::min(range.first + range.count, from + kBlock), tally);
      const std::lock_guard lock(mutex);
      sum += tally;
      if (onBlock) onBlock(sum);
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < threads; ++i)
    others.emplace_back(work);
  work();
  others.clear();
  return sum;
}

}  // namespace nearfit::stress
