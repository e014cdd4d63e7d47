#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "core/proximity/query/contact_areas.h"
#include "core/proximity/query/lmd_query.h"
#include "tests/bench/error_method.h"
#include "tests/bench/tracked_query.h"

namespace nearfit::bench {
namespace {

/// Poses that a list is given to arrive in after a jump: a search of several milliseconds.
constexpr std::size_t kTrackedLeadIn = 16;

class ExactCold : public ErrorMethod {
 public:
  explicit ExactCold(const ErrorScene& scene)
      : scene_(scene), scratch_(kQueryCapacity), lmds_(kQueryCapacity) {}

  void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) override {
    const PreparedScene& bodies = scene_.bodies;
    const LmdResult result =
        findLmds(bodies.sceneTree, bodies.partTree, sceneFromPart, bodies.cutoff, scratch_, lmds_);
    answer.minima.assign(lmds_.begin(), lmds_.begin() + static_cast<std::ptrdiff_t>(result.count));
    answer.wrench = scene_.wrenchOf(answer.minima, sceneFromPart);
  }

 private:
  const ErrorScene& scene_;
  LmdScratch scratch_;
  std::vector<Lmd> lmds_;
};

class ExactTracked : public ErrorMethod {
 public:
  explicit ExactTracked(const ErrorScene& scene) : scene_(scene), query_(scene.bodies) {}

  void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) override {
    const Answer found = query_.query(sceneFromPart);
    const std::span<const Lmd> lmds = query_.minima().first(found.count);
    answer.minima.assign(lmds.begin(), lmds.end());
    answer.wrench = scene_.wrenchOf(answer.minima, sceneFromPart);
  }
  void workAside(const RigidTransform& sceneFromPart) override { query_.workAside(sceneFromPart); }

 private:
  const ErrorScene& scene_;
  TrackedQuery query_;
};

/// Where facets make several minima of one area of contact, only the nearest counts: as the program has it.
class ExactGrouped : public ErrorMethod {
 public:
  explicit ExactGrouped(const ErrorScene& scene) : scene_(scene), query_(scene.bodies), scratch_(1) {}

  void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) override {
    const PreparedScene& bodies = scene_.bodies;
    const Answer found = query_.query(sceneFromPart);
    const std::span<const Lmd> lmds = query_.minima().first(found.count);
    answer.minima.assign(lmds.begin(), lmds.end());
    mergeAreas(bodies.sceneTree, bodies.partTree, sceneFromPart, bodies.cutoff, answer.minima, scratch_,
               std::numeric_limits<std::uint64_t>::max());
    std::erase_if(answer.minima, [](const Lmd& lmd) { return lmd.isMerged; });
    answer.wrench = scene_.wrenchOf(answer.minima, sceneFromPart);
  }
  void workAside(const RigidTransform& sceneFromPart) override { query_.workAside(sceneFromPart); }

 private:
  const ErrorScene& scene_;
  TrackedQuery query_;
  LmdScratch scratch_;
};

}  // namespace

ErrorScene::ErrorScene(TriangleMesh scene, TriangleMesh part, double cutoff)
    : bodies(BenchScene{"", std::move(scene), std::move(part), {}, {}}, 1.0) {
  bodies.cutoff = cutoff;
  springs.cutoff = cutoff;
  springs.stiffness = 1.0 / cutoff;  // A spring that is pressed all the way pushes with 1 N.
}

Wrench ErrorScene::wrenchOf(std::span<const Lmd> minima, const RigidTransform& sceneFromPart) const noexcept {
  return springWrench(minima, springs, sceneFromPart.translation, {});
}

std::vector<ErrorMethodEntry> exactErrorMethods() {
  return {
      {"exact cold", "all local minimum distances within the cutoff, from nothing", 1, true,
       [](const ErrorScene& scene) { return std::make_unique<ExactCold>(scene); }},
      {"exact tracked", "the same from lists that another thread renews; its time stands apart",
       kTrackedLeadIn, true, [](const ErrorScene& scene) { return std::make_unique<ExactTracked>(scene); }},
      {"exact grouped", "tracked; of the minima of an area of contact (mergeAreas) the nearest alone",
       kTrackedLeadIn, false, [](const ErrorScene& scene) { return std::make_unique<ExactGrouped>(scene); }}};
}

std::vector<ErrorMethodEntry> allErrorMethods() {
  std::vector<ErrorMethodEntry> all = exactErrorMethods();
  const auto append = [&all](std::vector<ErrorMethodEntry> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
  };
  append(approximateErrorMethods());
  append(fieldErrorMethods());
  append(paperErrorMethods());
#ifdef NEARFIT_BENCH_FCL
  append(fclErrorMethods());
#endif
  return all;
}

}  // namespace nearfit::bench
