#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "core/math/rigid_transform.h"

namespace nearfit::python {

inline bool isObject(PyObject* object) noexcept {
  return object != nullptr;
}

/// An argument that NumPy makes an array of; only its name in signatures is its own.
class ArrayLike : public nanobind::object {
  NB_OBJECT_DEFAULT(ArrayLike, object, "numpy.typing.ArrayLike", isObject)
};

/// Numbers of a Python object in double precision, row by row: without a copy where it holds them so. To be made and
/// destroyed with the interpreter's lock.
class Doubles {
 public:
  /// Throws what NumPy raises if the object is no array of numbers.
  explicit Doubles(nanobind::handle object);
  ~Doubles();
  Doubles(const Doubles&) = delete;
  Doubles& operator=(const Doubles&) = delete;

  std::span<const double> values() const noexcept;
  std::span<const Py_ssize_t> shape() const noexcept;

 private:
  bool take(nanobind::handle object);

  nanobind::object converted_;
  Py_buffer buffer_{};
};

/// Reads poses, world from part: matrices (4, 4) or (k, 4, 4), or rows (7,) or (k, 7) of tx ty tz [m], qw qx qy qz. A row is
/// taken as the command line takes it, to the last bit. Throws UsageError naming the pose if one is not finite or not
/// rigid, or the shape is another.
std::vector<RigidTransform> posesOf(nanobind::handle object);
/// The same for one pose.
RigidTransform poseOf(nanobind::handle object);

/// Arrays that Python gets. Read-only ones show memory of ours.
using Vector = nanobind::ndarray<nanobind::numpy, double, nanobind::ndim<1>>;
using Table = nanobind::ndarray<nanobind::numpy, double, nanobind::ndim<2>>;
using Matrices = nanobind::ndarray<nanobind::numpy, double, nanobind::ndim<3>>;
using Flags = nanobind::ndarray<nanobind::numpy, bool, nanobind::ndim<1>>;
template <class T>
using VectorView = nanobind::ndarray<nanobind::numpy, const T, nanobind::ndim<1>>;
template <class T>
using TableView = nanobind::ndarray<nanobind::numpy, const T, nanobind::ndim<2>>;

/// Gives a vector's memory to an array of that shape, without a copy. A property that returns one needs rv_policy::automatic:
/// by default its object would be kept as the owner, and the array has one.
template <class Array, class T>
Array arrayOf(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  // Where there is nothing, its place must still not be null.
  if (kept->capacity() == 0) kept->reserve(1);
  void* const data = kept->data();
  const nanobind::capsule owner(kept.get(), [](void* pointer) noexcept {
    const std::unique_ptr<std::vector<T>> gone(static_cast<std::vector<T>*>(pointer));
  });
  static_cast<void>(kept.release());
  return Array(data, shape, owner);
}

/// Shows memory that lives as long as `owner` as a read-only array.
template <class Array>
Array viewOf(const void* data, std::initializer_list<std::size_t> shape, nanobind::handle owner) {
  // Where there is nothing, its place must still not be null.
  static constexpr double kNothing = 0.0;
  return Array(data != nullptr ? data : &kNothing, shape, owner);
}

/// Poses as matrices (k, 4, 4), and as rows (k, 7).
Matrices matricesOf(std::span<const RigidTransform> poses);
Table rowsOf(std::span<const RigidTransform> poses);
/// One pose as a matrix (4, 4).
Table matrixOf(const RigidTransform& pose);

}  // namespace nearfit::python
