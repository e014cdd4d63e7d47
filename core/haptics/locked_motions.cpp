#include "core/haptics/locked_motions.h"

#include <cmath>

namespace nearfit {
namespace {

double product(const StepVector& a, const StepVector& b) noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += a[k] * b[k];
  return sum;
}

void addTimes(StepVector& y, double factor, const StepVector& direction) noexcept {
  for (std::size_t k = 0; k < y.size(); ++k)
    y[k] += factor * direction[k];
}

/// Gram-Schmidt is run so many times: twice keeps it orthogonal to rounding.
constexpr int kRounds = 2;

}  // namespace

void LockedMotions::lock(const StepVector& a, double b) noexcept {
  const double length = std::sqrt(product(a, a));
  if (count_ == kMax || !(length > 0.0)) return;
  StepVector direction = a;
  for (double& value : direction)
    value /= length;
  double amount = b / length;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < count_; ++i) {
      const double part = product(direction, directions_[i]);
      addTimes(direction, -part, directions_[i]);
      amount -= part * amounts_[i];
    }
  }
  const double left = std::sqrt(product(direction, direction));
  if (!(left > kDependence)) return;
  for (double& value : direction)
    value /= left;
  amount /= left;
  directions_[count_] = direction;
  amounts_[count_++] = amount;
  addTimes(correction_, amount, direction);
}

StepVector LockedMotions::freePart(StepVector y) const noexcept {
  for (int round = 0; round < kRounds; ++round) {
    for (const StepVector& direction : directions())
      addTimes(y, -product(y, direction), direction);
  }
  return y;
}

}  // namespace nearfit
