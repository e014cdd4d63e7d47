#pragma once

#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/lmd.h"
#include "core/proximity/query/lmd_query.h"

namespace nearfit {

class NormalConeTree;

/// Minima whose directions differ by more than 30 degrees (this is its cosine) are of two areas: one spring for both
/// would push where only one of them does.
constexpr double kAreaCosine = 0.8660254037844386;
/// Between two minima of one area either surface is at most this part of the cutoff farther off than where the farther
/// of them has it. Facets of curved surfaces are off by their sagitta, which falls with the square of the edge length; a
/// spring gets weaker by no more than a twentieth of its max force over such a dent, which a hand hardly tells from
/// none.
constexpr double kAreaOpening = 0.05;

/// Work of mergeAreas() in units of MinimaAllowance (some 50 ns on a slow core): of one look at the gap, which is a ray
/// cast to each surface, and how many comparisons of two minima make one unit.
constexpr std::uint64_t kWorkOfGap = 48, kAreaComparisonsOfWork = 8;

/// Work by which mergeAreas() may exceed its allowance: of three looks, and of comparing.
constexpr std::uint64_t kMaxAreaExcess = 3 * kWorkOfGap + 1;

/// Result of mergeAreas().
struct AreaResult {
  std::uint32_t areas = 0;  ///< Minima that stand for an area, blocked ones not counted.
  std::uint64_t work = 0;   ///< Exceeds the allowance by kMaxAreaExcess at most.
  bool isComplete = true;   ///< False if the work was not enough: the farthest minima stand for themselves.
};

/// Sets `isMerged` of each minimum for which a nearer one stands, so that each area of contact keeps one.
///
/// Two minima i and j, d_i <= d_j, are of one area if their directions differ by at most 30 degrees, and if at three
/// places on the way from one to the other (a quarter, half, three quarters) both surfaces are within half of d_j and
/// kAreaOpening of the cutoff, so that the gap there is at most d_j and a tenth of the cutoff. They are looked up along
/// the mean direction, to either side of a way from middle to middle that bends as the directions do. From the nearest minimum on, each one joins a nearer one that stands for an area if the two are of one
/// area, or else stands for its own.
///
/// So contacts are never merged across a place, of those three, at which the gap opens by more than that or either
/// surface is missing, however near they are and however coarse the meshes; a slot narrower than the places are apart
/// may be missed. As meshes of smooth surfaces become finer, the minima that facets add to a contact come to be of its
/// area, and the force of its springs converges to that of the contact's one minimum.
///
/// @param scene, part    Hierarchies of the two meshes.
/// @param sceneFromPart  Pose at which the minima were found.
/// @param cutoff         [m]; finite, > 0. Minima at or beyond it are left as they are.
/// @param lmds           Nearest first, in the frame of the scene's mesh; blocked ones marked, which neither join nor
///                       stand for an area. `isMerged` of all is set anew.
/// @param scratch        Provides the instruction set only.
/// @param work           Allowance; beyond it the farthest minima stand for themselves.
/// Real-time safe. O(minima * areas) comparisons, and for each pair whose directions agree up to six ray casts.
/// Merges nothing if a hierarchy is empty or the pose is not finite. Source: Johnson & Willemsen 2003, 4.1 ("a single
/// point encapsulates that area of contact"); the rule is ours.
AreaResult mergeAreas(const NormalConeTree& scene, const NormalConeTree& part,
                      const RigidTransform& sceneFromPart, double cutoff, std::span<Lmd> lmds,
                      LmdScratch& scratch, std::uint64_t work) noexcept;

}  // namespace nearfit
