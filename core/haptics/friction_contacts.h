#pragma once

#include <array>
#include <cstddef>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/haptics/active_rows.h"
#include "core/haptics/step_rows.h"

namespace nearfit {

/// How arms lie in the mass metric.
struct ArmMetric {
  glm::dmat3 principalFromStep{1.0};
  glm::dvec3 gyration{1.0};  ///< [m]
};

/// The contacts that rub: one for each active row, with its tangential push.
class FrictionContacts {
 public:
  /// Rounds over all contacts for one set of active rows.
  static constexpr unsigned kMostRounds = 12;
  /// Changes below this fraction of the lengths in play are rounding.
  static constexpr double kRounding = 1e-14;

  struct Contact {
    std::size_t row = 0;
    std::array<glm::dvec3, 2> axes{};         ///< Of the tangent plane, in the axes of a[0..2].
    std::array<ProgramVector, 2> tangents{};  ///< What a push along them does, in the mass metric.
    glm::dvec2 push{0.0};                     ///< Along the axes [m].

    glm::dvec3 pushVector() const noexcept { return push.x * axes[0] + push.y * axes[1]; }
  };

  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  const Contact& operator[](std::size_t i) const noexcept { return contacts_[i]; }

  void scale(double factor) noexcept;

  /// Length of the greatest push [m].
  double largest() const noexcept;

  /// Adds what the pushes do to a goal.
  StepVector pushed(StepVector y) const noexcept;

  /// Follows the active rows: pushes of rows that are still active stay, new ones are zero.
  /// @param arms  Of each of the rows.
  /// Whether a push that was not zero is gone.
  bool follow(const StepRows& rows, const ActiveRows& active, const glm::dvec3* arms,
              const ArmMetric& metric) noexcept;

  /// Finds the pushes for the active rows as they are, and goes part of the way to them.
  /// @param y       The program's step with the pushes so far.
  /// @param length  In play [m].
  /// @param share   Of the way; 1 for all of it, less where sweeps overshoot.
  /// How far a push still is from where it should be: the most that one went in all, or in the last round
  /// [m].
  double relax(const ActiveRows& active, const StepVector& y, double coefficient, double length,
               double share) noexcept;

 private:
  ProgramVector effect() const noexcept;

  std::array<Contact, ActiveRows::kMost> contacts_;
  std::size_t size_ = 0;
  ProgramVector gone_{};  ///< Effect of pushes of rows that are not active any more.
};

}  // namespace nearfit
