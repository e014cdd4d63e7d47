#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>

#include "core/haptics/mass_metric.h"
#include "core/math/rigid_transform.h"
#include "core/proximity/query/contact_query.h"

namespace nearfit {

/// A contact with one of the bodies, in world coordinates.
struct BodyContact {
  ContactPair pair;
  std::uint32_t body = 0;  ///< Index in ServoScene::bodies.
};

/// Selects the most informative of thousands of contacts, as between a thread and its nut.
///
/// A contact constrains one direction in the six dimensions of the part's motion. Of contacts whose
/// directions agree on a fine grid, the nearest counts most: a small step changes the distances of the others
/// by the same amount, to a tenth of the step. Allocates only in the constructor; real-time safe after it.
class ContactThinning {
 public:
  /// Max contacts that keep() writes.
  static constexpr std::size_t kMaxKept = 512;
  /// Max contacts that can be added.
  static constexpr std::size_t kMaxTaken = 1U << 15;

  ContactThinning();

  /// Starts a selection. Real-time safe.
  /// @param centre              Centre of mass of the part in the world [m].
  /// @param principalFromWorld  Rotates the world into the part's principal axes.
  void begin(const glm::dvec3& centre, const glm::dquat& principalFromWorld,
             const MassMetric& metric) noexcept;
  /// Adds a contact. Returns false if there is no room.
  bool add(const BodyContact& contact) noexcept;

  /// Result of keep().
  struct Kept {
    std::size_t count = 0;  ///< Contacts written.
    /// Every contact nearer than this was written, or one that agrees with it [m]; infinity if that
    /// holds for all.
    double completeTo = 0.0;
  };
  /// Writes all contacts if they fit. Otherwise writes the nearest contact of each direction, as many as fit,
  /// and in a reserved part of the room the nearest of the others. The order is arbitrary. Call begin()
  /// before the next add().
  /// @param out  At most kMaxKept entries are used.
  Kept keep(std::span<BodyContact> out) noexcept;

 private:
  std::uint64_t cellOf(const ContactPair& pair) const noexcept;
  /// Sorts contact `i`, the first that is not sorted yet, by its direction.
  void place(std::size_t i) noexcept;

  /// Slot of a hash table with open addressing.
  struct Slot {
    std::uint32_t selection = 0;  ///< Number of the selection that filled it; of others it is free.
    std::uint32_t contact = 0;
  };

  /// The nearest contact of each direction, then the others.
  std::vector<BodyContact> taken_;
  std::vector<std::uint64_t> cells_;  ///< Of the first `distinct_`.
  std::vector<Slot> table_;
  std::size_t count_ = 0, distinct_ = 0;
  std::uint32_t selection_ = 0;
  glm::dvec3 centre_{0.0};
  glm::dmat3 turnFromWorld_{1.0};  ///< Into the principal axes, divided by the gyrations about them [1/m].
};

}  // namespace nearfit
