#include <iterator>
#include <utility>

#include "tests/bench/check_peer.h"
#include "tests/bench/query_method.h"

#ifdef NEARFIT_BENCH_FCL
#include <fcl/config.h>
#endif
#ifdef NEARFIT_BENCH_COAL
#include <coal/config.hh>
#endif

namespace nearfit::bench {
namespace {

template <typename Entry>
void append(std::vector<Entry>& all, std::vector<Entry> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

}  // namespace

PreparedScene::PreparedScene(BenchScene bodies, double cutoffFraction)
    : meshes(std::move(bodies)),
      sceneTree(searchedTree(meshes.scene)),
      partTree(searchedTree(meshes.part)),
      size(meshes.size()),
      cutoff(cutoffFraction * size) {}

std::vector<MethodEntry> allMethods() {
  std::vector<MethodEntry> all = nearfitMethods();
  append(all, paperMethods());
#ifdef NEARFIT_BENCH_FCL
  append(all, fclMethods());
#endif
#ifdef NEARFIT_BENCH_COAL
  append(all, coalMethods());
#endif
  return all;
}

std::vector<BuildEntry> allBuilds() {
  std::vector<BuildEntry> all = nearfitBuilds();
  append(all, nearfitCacheUses());
#ifdef NEARFIT_BENCH_FCL
  append(all, fclBuilds());
#endif
#ifdef NEARFIT_BENCH_COAL
  append(all, coalBuilds());
#endif
  return all;
}

std::vector<CheckPeer> checkPeers() {
  std::vector<CheckPeer> all;
#ifdef NEARFIT_BENCH_FCL
  all.push_back(fclCheckPeer());
#endif
#ifdef NEARFIT_BENCH_COAL
  all.push_back(coalCheckPeer());
  all.push_back(coalListsPeer());
#endif
  return all;
}

std::string peerDescription() {
#ifdef NEARFIT_BENCH_FCL
  std::string peers = "FCL " FCL_VERSION;
#else
  std::string peers = "not built with FCL";
#endif
#ifdef NEARFIT_BENCH_COAL
  return peers + ", Coal " COAL_VERSION;
#else
  return peers + ", not built with Coal";
#endif
}

}  // namespace nearfit::bench
