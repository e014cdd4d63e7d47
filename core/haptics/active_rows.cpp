#include "core/haptics/active_rows.h"

#include <cmath>

namespace nearfit {

double dot(const ProgramVector& a, const ProgramVector& b) noexcept {
  // In halves, as vectors are added up.
  ProgramVector sum;
  for (std::size_t k = 0; k < 8; ++k)
    sum[k] = a[k] * b[k];
  for (std::size_t k = 0; k < 4; ++k)
    sum[k] += sum[k + 4];
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

ProgramVector along(const ProgramVector& a, double factor, const ProgramVector& b) noexcept {
  ProgramVector out;
  for (std::size_t k = 0; k < 8; ++k)
    out[k] = a[k] + factor * b[k];
  return out;
}

bool ActiveRows::holds(std::size_t id) const noexcept {
  for (std::size_t i = 0; i < size_; ++i)
    if (columns_[i].id == id) return true;
  return false;
}

ActiveRows::Split ActiveRows::split(const ProgramVector& n) const noexcept {
  Split out;
  out.remainder = n;
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t i = 0; i < size_; ++i) {
      const double part = dot(q_[i], out.remainder);
      out.q[i] += part;
      out.remainder = along(out.remainder, -part, q_[i]);
    }
  out.r = backSubstituted(out.q);
  out.remainderSquared = dot(out.remainder, out.remainder);
  out.isDependent = size_ == kMost || out.remainderSquared <= kDependence * kDependence * dot(n, n);
  return out;
}

std::array<double, ActiveRows::kMost> ActiveRows::backSubstituted(
    std::array<double, kMost> q) const noexcept {
  for (std::size_t i = size_; i-- > 0;) {
    q[i] /= r_[i][i];
    for (std::size_t k = 0; k < i; ++k)
      q[k] -= r_[i][k] * q[i];
  }
  return q;
}

void ActiveRows::setFactors(std::size_t i, const Split& split) noexcept {
  const double length = std::sqrt(split.remainderSquared);
  q_[i] = along(ProgramVector{}, 1.0 / length, split.remainder);
  r_[i] = split.q;
  r_[i][i] = length;
}

void ActiveRows::add(std::size_t id, const ProgramVector& n, double b, double multiplier,
                     const Split& split) noexcept {
  columns_[size_] = {id, n, b};
  multipliers_[size_] = multiplier;
  setFactors(size_, split);
  ++size_;
}

void ActiveRows::remove(std::size_t i) noexcept {
  const std::size_t old = size_;
  for (std::size_t k = i + 1; k < old; ++k) {
    columns_[k - 1] = columns_[k];
    multipliers_[k - 1] = multipliers_[k];
  }
  // Columns after it lose one that they were made orthogonal to; what they have of their own only grows.
  for (size_ = i; size_ + 1 < old; ++size_)
    setFactors(size_, split(columns_[size_].n));
}

void ActiveRows::correct(ProgramVector& z) noexcept {
  std::array<double, kMost> q{};
  for (std::size_t i = 0; i < size_; ++i) {
    double missing = columns_[i].b - dot(columns_[i].n, z);
    for (std::size_t k = 0; k < i; ++k)
      missing -= r_[i][k] * q[k];
    q[i] = missing / r_[i][i];
  }
  for (std::size_t i = 0; i < size_; ++i)
    z = along(z, q[i], q_[i]);
  const std::array<double, kMost> change = backSubstituted(q);
  for (std::size_t i = 0; i < size_; ++i)
    multipliers_[i] += change[i];
}

ProgramVector ActiveRows::project(const ProgramVector& z0) noexcept {
  multipliers_.fill(0.0);
  ProgramVector z = z0;
  // Once more for what rounding left, where z0 is far away.
  for (int pass = 0; pass < 2; ++pass)
    correct(z);
  return z;
}

}  // namespace nearfit
