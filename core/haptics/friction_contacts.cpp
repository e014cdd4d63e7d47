#include "core/haptics/friction_contacts.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/axes_across.h"

namespace nearfit {
namespace {

/// A contact cannot move in a direction if the active rows leave less than this part of its
/// response to a push.
constexpr double kBlocked = 1e-12;

/// Limits pushes to this multiple of the largest multiplier before the relaxation, times the coefficient: in
/// a jammed part each push would let the others grow without bound.
constexpr double kGrowth = 2.0;

/// Friction disks smaller than this count as zero [m]: their reciprocals would overflow.
constexpr double kNoRadius = 1e-100;

/// Max Newton steps for a push on the rim of its disk; some five reach rounding.
constexpr int kRimSteps = 20;
constexpr double kRimTolerance = 1e-15;

/// One contact during relaxation.
struct Local {
  std::size_t activeIndex = 0;
  std::array<ActiveRows::Split, 2> splits;
  /// Response of the slip to a push while all active rows hold: eigenvalues, the larger first, and the
  /// direction of that one. Zero where the contact is blocked.
  glm::dvec2 answer{0.0}, direction{1.0, 0.0};
};

ProgramVector tangentOf(const glm::dvec3& axis, const glm::dvec3& arm, const ArmMetric& metric) noexcept {
  const glm::dvec3 turn = metric.principalFromStep * glm::cross(arm, axis) / metric.gyration;
  ProgramVector tangent{axis.x, axis.y, axis.z, turn.x, turn.y, turn.z, 0.0, 0.0};
  for (const StepVector& direction : metric.locked) {
    ProgramVector locked{};
    std::copy(direction.begin(), direction.end(), locked.begin());
    tangent = along(tangent, -dot(tangent, locked), locked);
  }
  return tangent;
}

Local localOf(const ActiveRows& active, const FrictionContacts::Contact& contact) noexcept {
  Local out;
  while (active.id(out.activeIndex) != contact.row)
    ++out.activeIndex;
  double free = 0.0;
  for (std::size_t c = 0; c < 2; ++c) {
    out.splits[c] = active.split(contact.tangents[c]);
    free += dot(contact.tangents[c], contact.tangents[c]);
  }
  const double xx = out.splits[0].remainderSquared, yy = out.splits[1].remainderSquared;
  const double xy = dot(out.splits[0].remainder, out.splits[1].remainder);
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const double half = 0.5 * (xx + yy), spread = std::hypot(0.5 * (xx - yy), xy);
  out.direction = {std::cos(angle), std::sin(angle)};
  out.answer = {half + spread, half - spread};
  for (glm::length_t i = 0; i < 2; ++i)
    if (!(out.answer[i] > kBlocked * free)) out.answer[i] = 0.0;
  return out;
}

/// Rotates a vector into the frame of a unit direction, or back out of it.
glm::dvec2 into(const glm::dvec2& direction, const glm::dvec2& v) noexcept {
  return {glm::dot(direction, v), direction.x * v.y - direction.y * v.x};
}
glm::dvec2 outOf(const glm::dvec2& direction, const glm::dvec2& v) noexcept {
  return {direction.x * v.x - direction.y * v.y, direction.y * v.x + direction.x * v.y};
}

/// The push f of length `radius` with (answer + l) f = target for some l > 0; the slip left is -l f. Newton's
/// method on 1 / |f|, which is nearly linear in l (More and Sorensen 1983).
glm::dvec2 onRim(const glm::dvec2& answer, const glm::dvec2& target, double radius) noexcept {
  double l = 0.0;
  glm::dvec2 f = target / answer;
  for (int i = 0; i < kRimSteps; ++i) {
    const double length = glm::length(f);
    const double excess = length / radius - 1.0;
    if (excess <= kRimTolerance) break;
    l += excess * length * length / glm::dot(f, f / (answer + l));
    f = target / (answer + l);
  }
  return f * (radius / glm::length(f));
}

/// The push at which the point sticks, or slides against it, if nothing else changes.
/// @param radius  Of the friction disk [m].
glm::dvec2 locallySettled(const Local& local, const glm::dvec2& push, const glm::dvec2& slip,
                          double radius) noexcept {
  if (!(radius > kNoRadius)) return glm::dvec2(0.0);
  const glm::dvec2 old = into(local.direction, push), left = into(local.direction, slip);
  glm::dvec2 next = old;
  for (glm::length_t i = 0; i < 2; ++i)
    if (local.answer[i] > 0.0) next[i] -= left[i] / local.answer[i];
  if (glm::length(next) > radius) {
    if (local.answer.y > 0.0) {
      next = onRim(local.answer, local.answer * old - left, radius);
    } else if (local.answer.x > 0.0) {
      // Blocked in the second direction: the push there is limited to what the disk leaves.
      next.x = std::clamp(next.x, -radius, radius);
      const double rest = std::sqrt(std::max(0.0, radius * radius - next.x * next.x));
      next.y = std::clamp(next.y, -rest, rest);
    } else {
      next *= radius / glm::length(next);
    }
  }
  return outOf(local.direction, next);
}

}  // namespace

void FrictionContacts::scale(double factor) noexcept {
  for (std::size_t i = 0; i < size_; ++i)
    contacts_[i].push *= factor;
}

double FrictionContacts::largest() const noexcept {
  double out = 0.0;
  for (std::size_t i = 0; i < size_; ++i)
    out = std::max(out, glm::length(contacts_[i].push));
  return out;
}

ProgramVector FrictionContacts::effect() const noexcept {
  ProgramVector out{};
  for (std::size_t i = 0; i < size_; ++i) {
    out = along(out, contacts_[i].push.x, contacts_[i].tangents[0]);
    out = along(out, contacts_[i].push.y, contacts_[i].tangents[1]);
  }
  return out;
}

StepVector FrictionContacts::pushed(StepVector y) const noexcept {
  const ProgramVector push = effect();
  for (std::size_t k = 0; k < y.size(); ++k)
    y[k] += push[k];
  return y;
}

bool FrictionContacts::follow(const StepRows& rows, const ActiveRows& active, const glm::dvec3* arms,
                              const glm::dvec3* directions, const ArmMetric& metric) noexcept {
  const std::array<Contact, ActiveRows::kMax> old = contacts_;
  const auto oldEnd = old.begin() + static_cast<std::ptrdiff_t>(size_);
  std::size_t kept = 0;
  const auto isPushed = [](const Contact& contact) { return contact.push != glm::dvec2(0.0); };
  const auto pushedBefore = static_cast<std::size_t>(std::count_if(old.begin(), oldEnd, isPushed));
  gone_ = effect();
  size_ = 0;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const std::size_t row = active.id(i);
    if (row >= rows.size()) continue;  // The floor.
    Contact& contact = contacts_[size_++];
    const auto before = std::find_if(old.begin(), oldEnd, [row](const Contact& c) { return c.row == row; });
    if (before != oldEnd) {
      contact = *before;
      if (isPushed(contact)) ++kept;
      continue;
    }
    const StepVector a = rows.row(row);
    contact.row = row;
    contact.axes = axesAcross(directions != nullptr ? directions[row] : glm::dvec3(a[0], a[1], a[2]));
    contact.push = glm::dvec2(0.0);
    for (std::size_t c = 0; c < 2; ++c)
      contact.tangents[c] = tangentOf(contact.axes[c], arms[row], metric);
  }
  gone_ = along(gone_, -1.0, effect());
  return kept < pushedBefore;
}

double FrictionContacts::relax(const ActiveRows& active, const StepVector& y, double coefficient,
                               double length, double share) noexcept {
  std::array<Local, ActiveRows::kMax> locals;
  std::array<glm::dvec2, ActiveRows::kMax> before;
  for (std::size_t i = 0; i < size_; ++i) {
    locals[i] = localOf(active, contacts_[i]);
    before[i] = contacts_[i].push;
  }
  ProgramVector z{};
  std::copy(y.begin(), y.end(), z.begin());
  ProgramVector multipliers{};
  double most = 0.0;
  for (std::size_t i = 0; i < active.size(); ++i)
    multipliers[i] = active.multiplier(i);
  for (std::size_t i = 0; i < size_; ++i)
    most = std::max(most, multipliers[locals[i].activeIndex]);
  // Remove the effect of pushes whose rows are no longer active.
  const ActiveRows::Split gone = active.split(gone_);
  z = along(z, -1.0, gone.remainder);
  multipliers = along(multipliers, 1.0, gone.r);
  const double largest = coefficient * kGrowth * most;

  double change = length;
  for (unsigned round = 0; round < kMaxRounds && change > kRounding * length; ++round) {
    change = 0.0;
    for (std::size_t i = 0; i < size_; ++i) {
      Contact& contact = contacts_[i];
      const Local& local = locals[i];
      const glm::dvec2 slip(dot(contact.tangents[0], z), dot(contact.tangents[1], z));
      const double radius = std::clamp(coefficient * multipliers[local.activeIndex], 0.0, largest);
      const glm::dvec2 next = locallySettled(local, contact.push, slip, radius);
      // Late rounds go half the way, since rounds that have not settled oscillate.
      const glm::dvec2 step = (2 * round < kMaxRounds ? 1.0 : 0.5) * (next - contact.push);
      contact.push += step;
      for (std::size_t c = 0; c < 2; ++c) {
        const double part = step[static_cast<glm::length_t>(c)];
        z = along(z, part, local.splits[c].remainder);
        multipliers = along(multipliers, -part, local.splits[c].r);
      }
      change = std::max(change, glm::length(step));
    }
  }
  double farthest = change;
  for (std::size_t i = 0; i < size_; ++i) {
    const glm::dvec2 way = contacts_[i].push - before[i];
    farthest = std::max(farthest, glm::length(way));
    contacts_[i].push = before[i] + share * way;
  }
  return farthest;
}

}  // namespace nearfit
