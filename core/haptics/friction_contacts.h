#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/haptics/active_rows.h"
#include "core/haptics/step_rows.h"

namespace nearfit {

/// Maps pushes and their torques into the mass metric.
struct ArmMetric {
  glm::dmat3 principalFromStep{1.0};     ///< Rotates the axes of a[0..2] into the principal axes.
  glm::dvec3 gyration{1.0};              ///< About the principal axes [m].
  std::span<const StepVector> locked{};  ///< Orthonormal; pushes move nothing along these.
};

/// Contacts with friction: one for each active row, with its tangential push. Real-time safe.
class FrictionContacts {
 public:
  /// Max rounds over all contacts for one set of active rows.
  static constexpr unsigned kMaxRounds = 12;
  /// Changes below this fraction of the lengths involved count as rounding.
  static constexpr double kRounding = 1e-14;

  /// Friction at an active row.
  struct Contact {
    std::size_t row = 0;                      ///< Index in the StepRows.
    std::array<glm::dvec3, 2> axes{};         ///< Unit axes of the tangent plane, in the axes of a[0..2].
    std::array<ProgramVector, 2> tangents{};  ///< Steps made by unit pushes along them.
    glm::dvec2 push{0.0};                     ///< Along the axes [m].

    /// The push in the axes of a[0..2] [m].
    glm::dvec3 pushVector() const noexcept { return push.x * axes[0] + push.y * axes[1]; }
  };

  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  const Contact& operator[](std::size_t i) const noexcept { return contacts_[i]; }

  /// Multiplies all pushes by `factor`.
  void scale(double factor) noexcept;

  /// Length of the largest push [m]; 0 without contacts.
  double largest() const noexcept;

  /// The goal y plus the effect of all pushes.
  StepVector pushed(StepVector y) const noexcept;

  /// Adapts the contacts to the active rows: rows that are still active keep their pushes, new ones
  /// start at zero.
  /// @param arms        For each of the rows: from the centre of mass to the part's point, in the axes
  ///                    of a[0..2] [m].
  /// @param directions  For each of the rows: its direction, if that is not a[0..2]; else null.
  /// @return True if a push that was not zero is gone.
  bool follow(const StepRows& rows, const ActiveRows& active, const glm::dvec3* arms,
              const glm::dvec3* directions, const ArmMetric& metric) noexcept;

  /// Finds the pushes for fixed active rows, and changes the pushes by a share of the way to them.
  /// @param y            The program's step with the pushes so far [m].
  /// @param coefficient  Coulomb's; >= 0.
  /// @param length       Length scale of the problem [m].
  /// @param share        1 for the whole way, less if sweeps overshoot.
  /// @return How far a push may still be from its solution [m]: the largest change, in total or in
  ///         the last round.
  double relax(const ActiveRows& active, const StepVector& y, double coefficient, double length,
               double share) noexcept;

 private:
  ProgramVector effect() const noexcept;

  std::array<Contact, ActiveRows::kMax> contacts_;
  std::size_t size_ = 0;
  ProgramVector gone_{};  ///< Effect of the pushes that the last follow() dropped.
};

}  // namespace nearfit
