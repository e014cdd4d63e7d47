#include "core/haptics/active_rows.h"

#include <cmath>

namespace nearfit {
namespace {

/// One pass is enough if at least this part of the squared length is left: the vector is then orthogonal to a
/// rounding or two.
constexpr double kOnceIsEnough = 0.5;

/// Dot product of each column with v; zero for unused columns.
template <class Matrix>
inline ProgramVector products(const Matrix& byRow, const ProgramVector& v) noexcept {
  ProgramVector out{};
  for (std::size_t k = 0; k < ActiveRows::kMax; ++k)
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] += byRow[k][i] * v[k];
  return out;
}

}  // namespace

void ActiveRows::clear() noexcept {
  size_ = 0;
  nByRow_ = {};
  qByRow_ = {};
}

bool ActiveRows::holds(std::size_t id) const noexcept {
  for (std::size_t i = 0; i < size_; ++i)
    if (ids_[i] == id) return true;
  return false;
}

ActiveRows::Split ActiveRows::split(const ProgramVector& n) const noexcept {
  Split out;
  out.remainder = n;
  const double squared = dot(n, n);
  out.remainderSquared = squared;
  for (int pass = 0; pass < 2 && size_ > 0; ++pass) {
    const ProgramVector part = products(qByRow_, out.remainder);
    for (std::size_t i = 0; i < size_; ++i)
      out.remainder = along(out.remainder, -part[i], q_[i]);
    out.q = along(out.q, 1.0, part);
    out.remainderSquared = dot(out.remainder, out.remainder);
    // Little was subtracted, so little of it was rounding.
    if (out.remainderSquared > kOnceIsEnough * squared) break;
  }
  out.r = backSubstituted(out.q);
  out.isDependent = size_ == kMax || out.remainderSquared <= kDependence * kDependence * squared;
  return out;
}

ProgramVector ActiveRows::backSubstituted(ProgramVector q) const noexcept {
  // A separate result: elements written into q would have to reach memory before the next vector read of q.
  ProgramVector out{};
  for (std::size_t i = size_; i-- > 0;) {
    out[i] = q[i] * inverseDiagonal_[i];
    q = along(q, -out[i], r_[i]);
  }
  return out;
}

void ActiveRows::setFactors(std::size_t i, const Split& split) noexcept {
  const double length = std::sqrt(split.remainderSquared);
  inverseDiagonal_[i] = 1.0 / length;
  q_[i] = along(ProgramVector{}, inverseDiagonal_[i], split.remainder);
  for (std::size_t k = 0; k < q_[i].size(); ++k)
    qByRow_[k][i] = q_[i][k];
  // The strict upper triangle of R, by columns and by rows; the rest is zero.
  r_[i] = {};
  rByRow_[i] = {};
  for (std::size_t k = 0; k < i; ++k)
    r_[i][k] = rByRow_[k][i] = split.q[k];
}

void ActiveRows::setColumn(std::size_t i, std::size_t id, const ProgramVector& n, double b) noexcept {
  ids_[i] = id;
  n_[i] = n;
  b_[i] = b;
  for (std::size_t k = 0; k < n.size(); ++k)
    nByRow_[k][i] = n[k];
}

void ActiveRows::add(std::size_t id, const ProgramVector& n, double b, double multiplier,
                     const Split& split) noexcept {
  setColumn(size_, id, n, b);
  multipliers_[size_] = multiplier;
  setFactors(size_, split);
  ++size_;
}

void ActiveRows::remove(std::size_t i) noexcept {
  const std::size_t last = size_ - 1;
  for (std::size_t k = i; k < last; ++k) {
    setColumn(k, ids_[k + 1], n_[k + 1], b_[k + 1]);
    multipliers_[k] = multipliers_[k + 1];
  }
  for (std::size_t k = 0; k < nByRow_.size(); ++k) {
    nByRow_[k][last] = 0.0;
    for (std::size_t c = i; c <= last; ++c)
      qByRow_[k][c] = 0.0;
  }
  // Later columns were orthogonal to the removed one too; without it their own components only grow.
  for (size_ = i; size_ < last; ++size_)
    setFactors(size_, split(n_[size_]));
}

void ActiveRows::correct(ProgramVector& z) noexcept {
  ProgramVector missing = along(b_, -1.0, products(nByRow_, z)), q{};
  for (std::size_t i = 0; i < size_; ++i) {
    q[i] = missing[i] * inverseDiagonal_[i];
    missing = along(missing, -q[i], rByRow_[i]);
  }
  for (std::size_t i = 0; i < size_; ++i)
    z = along(z, q[i], q_[i]);
  multipliers_ = along(multipliers_, 1.0, backSubstituted(q));
}

ProgramVector ActiveRows::project(const ProgramVector& z0) noexcept {
  multipliers_ = {};
  ProgramVector z = z0;
  correct(z);
  return z;
}

}  // namespace nearfit
