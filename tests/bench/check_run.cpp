#include "tests/bench/check_run.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "tests/bench/bench_clock.h"
#include "tests/bench/import_run.h"
#include "tests/bench/instances.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench {
namespace {

/// How far distances of two libraries may be apart, as a fraction of the scene's diagonal.
constexpr double kCheckAgreement = 1e-9;
/// Max of touchTolerance() [m].
constexpr double kTouchingDistance = 1e-6;

/// Begins the peak of resident memory anew, where the system can.
void restartPeakResident() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

SceneCheckRequest checkRequestOf(const ManyPartsScene& scene, std::span<const PartGeometryPtr> geometries) {
  SceneCheckRequest request;
  request.threshold = scene.threshold;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ManyPartsPlace& place = scene.parts[i];
    request.parts.push_back({PartId{static_cast<std::uint32_t>(i + 1)},
                             {fmt::format("part {}", i + 1), std::nullopt},
                             geometries[place.mesh],
                             place.worldFromPart});
  }
  return request;
}

PeerIndices indicesOf(const PartPair& pair) {
  return {static_cast<std::uint32_t>(pair.part) - 1, static_cast<std::uint32_t>(pair.other) - 1};
}

void addOwn(const OwnCheck& check, CheckMethodRuns& runs) {
  runs.build.push_back(check.buildSeconds);
  runs.pairs.push_back(check.pairsSeconds);
  runs.whole.push_back(check.seconds());
  runs.residentPeak.push_back(static_cast<double>(check.residentPeak));
  runs.residentBefore = std::max(runs.residentBefore, static_cast<double>(check.residentBefore));
  runs.near = check.found.count(PairVerdict::Near);
  runs.touching = check.found.count(PairVerdict::Touching);
  runs.clashes = check.found.count(PairVerdict::Clash);
  runs.contained = check.found.count(PairVerdict::Contained);
}

void addPeer(const PeerCheck& check, const CheckAgreement& agreement, CheckMethodRuns& runs) {
  const bool isFirst = runs.whole.empty();
  runs.build.push_back(check.buildSeconds);
  runs.pairs.push_back(check.pairsSeconds);
  runs.whole.push_back(check.seconds());
  if (isFirst || check.measured < runs.measured) {
    runs.candidates = check.candidates;
    runs.measured = check.measured;
    runs.near = check.near.size();
    runs.listed = check.listed;
    runs.fullLists = check.fullLists;
    runs.clashes = static_cast<std::size_t>(std::ranges::count_if(check.near, &PeerPair::doMeet));
  }
  const bool isWorse =
      runs.agreement.holds && (!agreement.holds || agreement.worstDistance > runs.agreement.worstDistance);
  if (isFirst || isWorse) runs.agreement = agreement;
}

}  // namespace

OwnCheck measureOwnCheck(const ManyPartsScene& scene, bool measuresClashes) {
  OwnCheck result;
  result.residentBefore = residentBytes();
  restartPeakResident();
  std::vector<PartGeometryPtr> geometries;
  for (const TriangleMesh& mesh : scene.meshes)
    geometries.push_back(test::freshGeometryOf(mesh));
  SceneCheckRequest request = checkRequestOf(scene, geometries);
  if (!measuresClashes) {
    request.maxVolumeTriangles = 0;
    request.hasDepths = false;
  }
  const double start = secondsBy(BenchClock::Wall);
  prepareHierarchies(geometries);
  const double built = secondsBy(BenchClock::Wall);
  result.found = checkScene(request);
  const double end = secondsBy(BenchClock::Wall);
  result.buildSeconds = built - start;
  result.pairsSeconds = end - built;
  result.residentPeak = peakResidentBytes();
  return result;
}

CheckAgreement compareChecks(const SceneCheck& own, const PeerCheck& peer, const ManyPartsScene& scene) {
  const double tolerance = kCheckAgreement * scene.diagonal, surely = scene.threshold - tolerance;
  std::map<PeerIndices, const PeerPair*> theirs;
  for (const PeerPair& pair : peer.near)
    theirs.emplace(PeerIndices(pair.part, pair.other), &pair);
  CheckAgreement agreement;
  for (const PairFinding& finding : own.findings) {
    const auto found = theirs.find(indicesOf(finding.pair));
    const PeerPair* other = found == theirs.end() ? nullptr : found->second;
    if (other != nullptr) theirs.erase(found);
    if (finding.verdict == PairVerdict::Contained) continue;
    if (other == nullptr) {
      if (!peer.isCut() && finding.distance < surely) ++agreement.missing;
      continue;
    }
    ++agreement.compared;
    const double allowed = finding.verdict == PairVerdict::Touching ? kTouchingDistance : 0.0;
    const double differs = std::abs(finding.distance - other->distance) - allowed;
    agreement.worstDistance = std::max(agreement.worstDistance, differs);
    if (finding.verdict == PairVerdict::Clash && !other->doMeet) ++agreement.apart;
  }
  agreement.extra = static_cast<std::size_t>(
      std::ranges::count_if(theirs, [&](const auto& entry) { return entry.second->distance < surely; }));
  agreement.holds = agreement.worstDistance <= tolerance && agreement.missing == 0 && agreement.extra == 0 &&
                    agreement.apart == 0;
  return agreement;
}

std::vector<CheckMethodRuns> runChecks(const ManyPartsScene& scene, const std::vector<CheckPeer>& peers,
                                       const CheckRunOptions& options) {
  std::vector<CheckMethodRuns> runs(2 + peers.size());
  runs[0].method = "nearfit";
  runs[1].method = "nearfit-unmeasured";
  for (std::size_t i = 0; i < peers.size(); ++i)
    runs[2 + i].method = peers[i].name;
  for (std::size_t turn = 0; turn < options.repeats; ++turn) {
    const OwnCheck own = measureOwnCheck(scene, true);
    addOwn(own, runs[0]);
    addOwn(measureOwnCheck(scene, false), runs[1]);
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const PeerCheck check = peers[i].check(scene, options.maxPeerSeconds);
      addPeer(check, compareChecks(own.found, check, scene), runs[2 + i]);
    }
  }
  return runs;
}

}  // namespace nearfit::bench
