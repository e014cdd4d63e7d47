#pragma once

#include <array>
#include <cstddef>

namespace nearfit {

/// A point of the program's seven unknowns [m], or a number for each of up to seven active rows; the eighth
/// is zero and fills up vector registers.
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

/// The inequalities n_i . z >= b_i that hold with equality: at most seven, with independent normals, their
/// multipliers, and the factors N = Q R of the matrix of normals.
///
/// Q is made by Gram and Schmidt's method, run twice where a column is nearly dependent, which leaves it
/// orthogonal to rounding (Giraud, Langou, Rozloznik and van den Eshof 2005). Matrices are kept by columns
/// and by rows, so that each product runs in vectors. Real-time safe.
class ActiveRows {
 public:
  static constexpr std::size_t kMost = 7;

  /// A normal counts as dependent when what it has of its own is a smaller part of it. Two rows at an angle
  /// e can be active together only where the violation of one is below e^2 times a multiplier, which is lost
  /// in the tolerance of rows from 1e-6 down; rounding of normals is 1e-16.
  static constexpr double kDependence = 1e-9;

  /// A vector n as N r + remainder, remainder orthogonal to all active normals.
  struct Split {
    ProgramVector r{};
    ProgramVector q{};  ///< Coordinates of N r in Q.
    ProgramVector remainder{};
    double remainderSquared = 0.0;
    bool isDependent = true;
  };

  void clear() noexcept;
  std::size_t size() const noexcept { return size_; }
  std::size_t id(std::size_t i) const noexcept { return ids_[i]; }
  double& multiplier(std::size_t i) noexcept { return multipliers_[i]; }
  double multiplier(std::size_t i) const noexcept { return multipliers_[i]; }
  bool holds(std::size_t id) const noexcept;

  Split split(const ProgramVector& n) const noexcept;

  /// @param split  Of n; not dependent, so that there is room.
  void add(std::size_t id, const ProgramVector& n, double b, double multiplier, const Split& split) noexcept;
  void remove(std::size_t i) noexcept;

  /// The point nearest to z0 at which all active rows are equalities, to some roundings of the lengths there;
  /// sets the multipliers, of any sign: z = z0 + N multipliers.
  ProgramVector project(const ProgramVector& z0) noexcept;

  /// Takes from z and the multipliers what rounding left of the equalities.
  void correct(ProgramVector& z) noexcept;

 private:
  using Matrix = std::array<ProgramVector, 8>;

  void setFactors(std::size_t i, const Split& split) noexcept;
  void setColumn(std::size_t i, std::size_t id, const ProgramVector& n, double b) noexcept;
  ProgramVector backSubstituted(ProgramVector q) const noexcept;

  std::array<std::size_t, kMost> ids_{};
  ProgramVector b_{}, multipliers_{}, inverseDiagonal_{};
  Matrix n_{}, nByRow_{}, q_{}, qByRow_{}, r_{}, rByRow_{};  ///< First index: column, or row.
  std::size_t size_ = 0;
};

}  // namespace nearfit
