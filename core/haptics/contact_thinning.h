#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/haptics/mass_metric.h"
#include "core/math/rigid_transform.h"
#include "core/proximity/contact_query.h"

namespace nearfit {

/// A contact with one of the bodies, in world coordinates.
struct BodyContact {
  ContactPair pair;
  std::uint32_t body = 0;  ///< Of the servo scene.
};

/// The most telling of thousands of contacts, as where a thread lies in its nut.
///
/// What a contact says to the proxy is a direction in the six dimensions of its motion. Of contacts that
/// agree in it to a fine grid the nearest counts most: a small step changes the distances of the others by
/// the same, to a tenth of the step. Memory is allocated once.
class ContactThinning {
 public:
  static constexpr std::size_t kMaxKept = 512;
  /// Contacts that can be taken in.
  static constexpr std::size_t kMaxTaken = 1U << 15;

  ContactThinning();

  void clear() noexcept { count_ = 0; }
  bool add(const BodyContact& contact) noexcept;

  struct Kept {
    std::size_t count = 0;
    double completeTo =
        0.0;  ///< Nothing nearer was left out but what says the same [m]; infinity: nothing was.
  };
  /// Writes all, when there are no more than fit, else the nearest of each direction, and of those the
  /// nearest; a part of the room is for the nearest of the others.
  /// @param centre              Centre of mass of the part in the world [m].
  /// @param principalFromWorld  Turns the world into the part's principal axes.
  Kept keep(const glm::dvec3& centre, const glm::dquat& principalFromWorld, const MassMetric& metric,
            std::span<BodyContact> out) noexcept;

 private:
  std::uint64_t cellOf(const ContactPair& pair, const glm::dvec3& centre,
                       const glm::dquat& principalFromWorld, const MassMetric& metric) const noexcept;

  std::vector<BodyContact> taken_;
  std::vector<std::uint64_t> cells_;
  std::vector<std::uint32_t> table_;  ///< Open addressing: index + 1 of a contact; 0 is free.
  std::size_t count_ = 0;
};

}  // namespace nearfit
