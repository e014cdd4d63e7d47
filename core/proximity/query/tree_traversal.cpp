#include "core/proximity/query/tree_traversal.h"

#include "core/proximity/query/box_cull.h"
#include "core/proximity/query/leaf_pair.h"

namespace nearfit {
namespace {

using Node = NormalConeTree::Node;
using simd::Box;
using simd::Floats16;
using simd::Floats8;
using simd::Poses;
using simd::Triple;

constexpr std::uint32_t kWidth = NormalConeTree::kWidth;

/// A node to open against a bound of the other tree.
struct Opening {
  EntryPair pair;
  const Node *opened, *other;
  std::uint32_t otherLane;
  bool isScene;  ///< True if the node to open is the scene's.
};

NEARFIT_INLINE Opening take(TraversalWork& work) {
  Opening o;
  o.pair = work.waiting[--work.waitingCount];
  ++work.nodePairs;
  const EntryPair& p = o.pair;
  o.isScene = NormalConeTree::isLeaf(p.part) ||
              (!NormalConeTree::isLeaf(p.scene) && p.sceneSizeSquared >= p.partSizeSquared);
  const std::uint32_t otherAt = o.isScene ? p.partLane : p.sceneLane;
  o.opened = o.isScene ? work.scene + NormalConeTree::nodeIndex(p.scene)
                       : work.part + NormalConeTree::nodeIndex(p.part);
  o.other = (o.isScene ? work.part : work.scene) + otherAt / kWidth;
  o.otherLane = otherAt % kWidth;
  return o;
}

/// The bound against which a node is opened, in all lanes.
NEARFIT_INLINE Box<Floats8> otherOf(const Opening& o) {
  const Node& n = *o.other;
  const std::uint32_t lane = o.otherLane;
  const auto spread = [lane](const auto& v) __attribute__((always_inline)) {
    return Triple<Floats8>{Floats8{} + v[0][lane], Floats8{} + v[1][lane], Floats8{} + v[2][lane]};
  };
  return {spread(n.centre),
          spread(n.n),
          spread(n.u),
          spread(n.half),
          {Floats8{} + n.leastN[lane], Floats8{} + n.mostU[lane], Floats8{} + n.mostV[lane]}};
}

NEARFIT_INLINE Poses<Floats8> posesOf(const SinglePose& pose) {
  const auto& m = pose.columns();
  const auto column = [&m](std::size_t k) __attribute__((always_inline)) {
    return Triple<Floats8>{Floats8{} + m[k][0], Floats8{} + m[k][1], Floats8{} + m[k][2]};
  };
  return {column(0), column(1), column(2), column(3)};
}

/// Targets of an opener: minima or contacts, the same at all poses of the work's sweep, or near faces.
enum class Aim { Minima, SweptMinima, Contacts, SweptContacts, NearFaces };
constexpr bool isSwept(Aim aim) {
  return aim == Aim::SweptMinima || aim == Aim::SweptContacts;
}
constexpr bool isForContacts(Aim aim) {
  return aim == Aim::Contacts || aim == Aim::SweptContacts;
}

template <Aim kAim>
NEARFIT_INLINE simd::Lanes<Floats8> test(const TraversalWork& work, const Opening& o) {
  const Box<Floats8> own = simd::boxes(*o.opened);
  Box<Floats8> other = otherOf(o);
  simd::move(other, posesOf(o.isScene ? work.sceneFromPart : work.partFromScene));
  if constexpr (kAim == Aim::NearFaces) {
    return simd::cullByPlace(own, other, work.limits);
  } else if constexpr (isSwept(kAim)) {
    const simd::Sweeps<Floats8> sweep = simd::spread(o.isScene ? work.inScene : work.inPart);
    return simd::cull(own, other, work.limits, simd::swept(own, other, sweep, work.limits));
  } else {
    return simd::cull(own, other, work.limits, simd::still<Floats8>(work.limits));
  }
}

/// The lanes of the opened node that can form contacts with the other child.
NEARFIT_INLINE std::uint32_t contactLanes(const Opening& o) {
  const FeatureKind other = NormalConeTree::lowestKind(o.isScene ? o.pair.part : o.pair.scene);
  std::uint32_t lanes = 0;
  for (std::uint32_t lane = 0; lane < kWidth; ++lane)
    lanes |= (spansContact(NormalConeTree::lowestKind(o.opened->child[lane]), other) ? 1U : 0U) << lane;
  return lanes;
}

/// True if a child is a leaf but not a face.
NEARFIT_INLINE bool isPointOrEdge(std::uint32_t child) {
  return NormalConeTree::isLeaf(child) && NormalConeTree::leafKind(child) != FeatureKind::Face;
}

/// Keeps the lanes that survive: pairs of leaves, and pairs to open later.
template <Aim kAim>
NEARFIT_INLINE void keep(TraversalWork& work, const Opening& o, std::uint32_t lanes) {
  const EntryPair& p = o.pair;
  const std::uint32_t node = kWidth * NormalConeTree::nodeIndex(o.isScene ? p.scene : p.part);
  if constexpr (isForContacts(kAim)) lanes &= contactLanes(o);
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
    EntryPair e = p;
    const std::uint32_t child = o.opened->child[lane];
    if constexpr (kAim == Aim::NearFaces) {
      if (isPointOrEdge(child)) continue;
    }
    const float h0 = o.opened->half[0][lane], h1 = o.opened->half[1][lane], h2 = o.opened->half[2][lane];
    const float size = h0 * h0 + h1 * h1 + h2 * h2;
    (o.isScene ? e.scene : e.part) = child;
    (o.isScene ? e.sceneLane : e.partLane) = node + lane;
    (o.isScene ? e.sceneSizeSquared : e.partSizeSquared) = size;
    // Written to both lists: an unpredictable branch costs more.
    const bool isLeaves = NormalConeTree::isLeaf(e.scene) && NormalConeTree::isLeaf(e.part);
    // In a mesh of a million triangles the node is in no cache, and it will be opened soon.
    if (!NormalConeTree::isLeaf(child)) {
      const char* next = reinterpret_cast<const char*>((o.isScene ? work.scene : work.part) +
                                                       NormalConeTree::nodeIndex(child));
      for (std::size_t line = 0; line < sizeof(Node); line += 64)
        __builtin_prefetch(next + line);
    }
    work.waiting[work.waitingCount] = e;
    work.leaves[work.leafCount] = e;
    work.waitingCount += isLeaves ? 0 : 1;
    work.leafCount += isLeaves ? 1 : 0;
  }
}

NEARFIT_INLINE bool isBusy(const TraversalWork& work) {
  return work.waitingCount > 0 && work.leafCount < TraversalWork::kLeaves &&
         work.nodePairs < work.maxNodePairs;
}

NEARFIT_INLINE bool mayOpenTwo(const TraversalWork& work) {
  return work.waitingCount > 1 && work.waitingCount <= TraversalWork::kOpenTwo &&
         work.nodePairs < work.maxNodePairs;
}

template <Aim kAim>
void openPortable(TraversalWork& work) noexcept {
  while (isBusy(work)) {
    const Opening o = take(work);
    keep<kAim>(work, o, simd::notNegative(test<kAim>(work, o).value));
  }
}

#if defined(__x86_64__)
template <Aim kAim>
NEARFIT_AVX2 void openAvx2(TraversalWork& work) noexcept {
  while (isBusy(work)) {
    const Opening o = take(work);
    const auto alive = test<kAim>(work, o).value >= 0.0F;
    keep<kAim>(work, o,
               static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Floats8>(alive))));
  }
}

/// Two bounds side by side.
NEARFIT_INLINE Floats16 join(const Floats8& a, const Floats8& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
NEARFIT_INLINE Triple<Floats16> join(const Triple<Floats8>& a, const Triple<Floats8>& b) {
  return {join(a.x, b.x), join(a.y, b.y), join(a.z, b.z)};
}
NEARFIT_INLINE Box<Floats16> join(const Box<Floats8>& a, const Box<Floats8>& b) {
  return {join(a.centre, b.centre),
          join(a.n, b.n),
          join(a.u, b.u),
          join(a.half, b.half),
          {join(a.limits.leastN, b.limits.leastN), join(a.limits.mostU, b.limits.mostU),
           join(a.limits.mostV, b.limits.mostV)}};
}

NEARFIT_INLINE Poses<Floats16> join(const Poses<Floats8>& a, const Poses<Floats8>& b) {
  return {join(a.x, b.x), join(a.y, b.y), join(a.z, b.z), join(a.translation, b.translation)};
}

NEARFIT_INLINE simd::Sweeps<Floats16> join(const simd::Sweeps<Floats8>& a, const simd::Sweeps<Floats8>& b) {
  return {join(a.shift, b.shift), join(a.spin, b.spin), join(a.about, b.about),
          join(a.spinLength, b.spinLength)};
}
template <Aim kAim>
NEARFIT_AVX512 void openAvx512(TraversalWork& work) noexcept {
  // Indexed by whether the first node to open is the scene's, then the second.
  const Poses<Floats8> ofPart = posesOf(work.partFromScene), ofScene = posesOf(work.sceneFromPart);
  const Poses<Floats16> poses[2][2] = {{join(ofPart, ofPart), join(ofPart, ofScene)},
                                       {join(ofScene, ofPart), join(ofScene, ofScene)}};
  const simd::Sweeps<Floats8> inPart = simd::spread(work.inPart), inScene = simd::spread(work.inScene);
  const simd::Sweeps<Floats16> sweeps[2][2] = {{join(inPart, inPart), join(inPart, inScene)},
                                               {join(inScene, inPart), join(inScene, inScene)}};
  while (isBusy(work)) {
    const Opening first = take(work);
    const bool isTwo = mayOpenTwo(work);
    const Opening second = isTwo ? take(work) : first;
    Box<Floats16> other = join(otherOf(first), otherOf(second));
    simd::move(other, poses[first.isScene ? 1 : 0][second.isScene ? 1 : 0]);
    const Box<Floats16> own = join(simd::boxes(*first.opened), simd::boxes(*second.opened));
    simd::Lanes<Floats16> margin;
    if constexpr (kAim == Aim::NearFaces) {
      margin = simd::cullByPlace(own, other, work.limits);
    } else if constexpr (isSwept(kAim)) {
      const simd::Sweeps<Floats16>& sweep = sweeps[first.isScene ? 1 : 0][second.isScene ? 1 : 0];
      margin = simd::cull(own, other, work.limits, simd::swept(own, other, sweep, work.limits));
    } else {
      margin = simd::cull(own, other, work.limits, simd::still<Floats16>(work.limits));
    }
    const auto bits = static_cast<std::uint32_t>(__builtin_ia32_cvtd2mask512(margin.value >= 0.0F));
    keep<kAim>(work, first, bits & 0xFFU);
    if (isTwo) keep<kAim>(work, second, bits >> 8 & 0xFFU);
  }
}
#endif

template <Aim kAim>
Opener openerFor(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return openAvx512<kAim>;
  if (level == SimdLevel::Avx2) return openAvx2<kAim>;
#endif
  static_cast<void>(level);
  return openPortable<kAim>;
}

}  // namespace

Opener opener(SimdLevel level) noexcept {
  return openerFor<Aim::Minima>(level);
}
Opener sweptOpener(SimdLevel level) noexcept {
  return openerFor<Aim::SweptMinima>(level);
}
Opener contactOpener(SimdLevel level) noexcept {
  return openerFor<Aim::Contacts>(level);
}
Opener sweptContactOpener(SimdLevel level) noexcept {
  return openerFor<Aim::SweptContacts>(level);
}
Opener nearOpener(SimdLevel level) noexcept {
  return openerFor<Aim::NearFaces>(level);
}

}  // namespace nearfit
