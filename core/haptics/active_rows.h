#pragma once

#include <array>
#include <cstddef>

namespace nearfit {

/// Point in the program's seven unknowns [m], or one number for each of up to seven active rows. The eighth
/// entry is zero and fills vector registers.
using ProgramVector = std::array<double, 8>;

inline double dot(const ProgramVector& a, const ProgramVector& b) noexcept {
  return ((a[0] * b[0] + a[4] * b[4]) + (a[2] * b[2] + a[6] * b[6])) +
         ((a[1] * b[1] + a[5] * b[5]) + (a[3] * b[3] + a[7] * b[7]));
}

/// a + factor * b.
inline ProgramVector along(const ProgramVector& a, double factor, const ProgramVector& b) noexcept {
  ProgramVector out;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = a[k] + factor * b[k];
  return out;
}

/// The inequalities n_i . z >= b_i that hold with equality (at most seven, with independent normals), their
/// multipliers, and the factors N = Q R of the matrix of normals.
///
/// Q comes from Gram-Schmidt, run twice where a column is nearly dependent, which keeps it orthogonal to
/// rounding (Giraud, Langou, Rozloznik and van den Eshof 2005). Matrices are stored by columns and by rows,
/// so that every product vectorises. Real-time safe.
class ActiveRows {
 public:
  /// Max number of active rows.
  static constexpr std::size_t kMax = 7;

  /// A normal counts as dependent if its component orthogonal to the active normals is smaller than
  /// this fraction of it. Two rows at an angle e can be active together only if the violation of one is
  /// below e^2 times a multiplier; for e below 1e-6 that is lost in the tolerance of rows. Normals are
  /// rounded to 1e-16.
  static constexpr double kDependence = 1e-9;

  /// Decomposition of a vector n into N r + remainder, with the remainder orthogonal to all active normals.
  struct Split {
    ProgramVector r{};
    ProgramVector q{};  ///< Coordinates of N r in Q.
    ProgramVector remainder{};
    double remainderSquared = 0.0;  ///< Squared length.
    bool isDependent = true;        ///< n is dependent, or all rows are in use.
  };

  void clear() noexcept;
  std::size_t size() const noexcept { return size_; }
  /// Id that active row i was added with; i < size().
  std::size_t id(std::size_t i) const noexcept { return ids_[i]; }
  /// Multiplier of active row i; i < size().
  double& multiplier(std::size_t i) noexcept { return multipliers_[i]; }
  double multiplier(std::size_t i) const noexcept { return multipliers_[i]; }
  /// True if the row with this id is active.
  bool holds(std::size_t id) const noexcept;

  /// Splits n by the active normals.
  Split split(const ProgramVector& n) const noexcept;

  /// Adds the row n . z >= b.
  /// @param split  split(n); must not be dependent.
  void add(std::size_t id, const ProgramVector& n, double b, double multiplier, const Split& split) noexcept;
  /// Removes active row i; later rows move down by one.
  void remove(std::size_t i) noexcept;

  /// Nearest point to z0 at which all active rows are equalities, to a few roundings of the lengths there.
  /// Sets the multipliers, of either sign: z = z0 + N multipliers.
  ProgramVector project(const ProgramVector& z0) noexcept;

  /// Removes the rounding error left in the equalities from z and the multipliers.
  void correct(ProgramVector& z) noexcept;

 private:
  using Matrix = std::array<ProgramVector, 8>;

  void setFactors(std::size_t i, const Split& split) noexcept;
  void setColumn(std::size_t i, std::size_t id, const ProgramVector& n, double b) noexcept;
  ProgramVector backSubstituted(ProgramVector q) const noexcept;

  std::array<std::size_t, kMax> ids_{};
  ProgramVector b_{}, multipliers_{}, inverseDiagonal_{};
  Matrix n_{}, nByRow_{}, q_{}, qByRow_{}, r_{}, rByRow_{};  ///< First index: column, or row for ByRow.
  std::size_t size_ = 0;
};

}  // namespace nearfit
