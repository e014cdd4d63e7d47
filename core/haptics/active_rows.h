#pragma once

#include <array>
#include <cstddef>

namespace nearfit {

/// A point of the program's seven unknowns [m]; the eighth number is zero and fills up a vector register.
using ProgramVector = std::array<double, 8>;

double dot(const ProgramVector& a, const ProgramVector& b) noexcept;

/// a + factor * b.
ProgramVector along(const ProgramVector& a, double factor, const ProgramVector& b) noexcept;

/// The inequalities n_i . z >= b_i that hold with equality: at most seven, with independent normals, their
/// multipliers, and the factors N = Q R of the matrix of normals.
///
/// Q is made by Gram and Schmidt's method, run twice over each column, which leaves it orthogonal to rounding
/// (Kahan's "twice is enough"; Parlett 1980, 6.9). Real-time safe.
class ActiveRows {
 public:
  static constexpr std::size_t kMost = 7;

  /// A normal counts as dependent when what it has of its own is a smaller part of it. Two rows at an angle
  /// e can be active together only where the violation of one is below e^2 times a multiplier, which is lost
  /// in the tolerance of rows from 1e-6 down; rounding of normals is 1e-16.
  static constexpr double kDependence = 1e-9;

  /// A vector n as N r + remainder, remainder orthogonal to all active normals.
  struct Split {
    std::array<double, kMost> r{};
    std::array<double, kMost> q{};  ///< Coordinates of N r in Q.
    ProgramVector remainder{};
    double remainderSquared = 0.0;
    bool isDependent = true;
  };

  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  std::size_t id(std::size_t i) const noexcept { return columns_[i].id; }
  double& multiplier(std::size_t i) noexcept { return multipliers_[i]; }
  double multiplier(std::size_t i) const noexcept { return multipliers_[i]; }
  bool holds(std::size_t id) const noexcept;

  Split split(const ProgramVector& n) const noexcept;

  /// @param split  Of n; not dependent, so that there is room.
  void add(std::size_t id, const ProgramVector& n, double b, double multiplier, const Split& split) noexcept;
  void remove(std::size_t i) noexcept;

  /// The point nearest to z0 at which all active rows are equalities; sets the multipliers, of any sign:
  /// z = z0 + N multipliers.
  ProgramVector project(const ProgramVector& z0) noexcept;

 private:
  struct Column {
    std::size_t id = 0;
    ProgramVector n{};
    double b = 0.0;
  };

  void setFactors(std::size_t i, const Split& split) noexcept;
  std::array<double, kMost> backSubstituted(std::array<double, kMost> q) const noexcept;
  void correct(ProgramVector& z) noexcept;

  std::array<Column, kMost> columns_;
  std::array<double, kMost> multipliers_{};
  std::array<ProgramVector, kMost> q_{};
  std::array<std::array<double, kMost>, kMost> r_{};  ///< r_[column][row]
  std::size_t size_ = 0;
};

}  // namespace nearfit
