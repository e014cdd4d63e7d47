#include "core/math/symmetric_eigen.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nearfit {

SymmetricEigen symmetricEigen(const glm::dmat3& matrix) noexcept {
  // Indexed a[row][column]; the columns of v accumulate the rotations.
  double a[3][3], v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      a[i][j] = matrix[std::max(i, j)][std::min(i, j)];
  }
  // Convergence is quadratic: a handful of sweeps clears the off-diagonal.
  constexpr int kMaxSweeps = 16;
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    const double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    const double on = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
    if (!(off > 1e-32 * on)) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0.0) continue;
        const double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        for (auto& row : a) {
          const double kp = row[p], kq = row[q];
          row[p] = c * kp - s * kq;
          row[q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
        }
        for (auto& row : v) {
          const double kp = row[p], kq = row[q];
          row[p] = c * kp - s * kq;
          row[q] = s * kp + c * kq;
        }
      }
    }
  }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] < a[j][j]; });
  SymmetricEigen result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int k = order[i];
    result.values[i] = a[k][k];
    result.vectors[i] = {v[0][k], v[1][k], v[2][k]};
  }
  return result;
}

}  // namespace nearfit
