#include "app/python/arrays.h"

#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/math/finite.h"
#include "core/math/pose_matrix.h"
#include "core/scene/part.h"

namespace nearfit::python {
namespace {

namespace nb = nanobind;

constexpr std::size_t kMatrixNumbers = 16, kRowNumbers = 7;
constexpr const char* kPoseShapes =
    "give matrices (4, 4) or (k, 4, 4), or rows (7,) or (k, 7) of tx ty tz qw qx qy qz";

bool isDouble(const Py_buffer& buffer) noexcept {
  return buffer.format != nullptr && std::strcmp(buffer.format, "d") == 0;
}

std::string placeOf(std::size_t index, bool isOne) {
  return isOne ? "pose" : fmt::format("pose {}", index);
}

RigidTransform ofMatrix(std::span<const double, kMatrixNumbers> numbers, std::size_t index, bool isOne) {
  const std::optional<RigidTransform> pose = rigidOfMatrix(numbers);
  if (!pose) {
    throw UsageError(placeOf(index, isOne), "its matrix does not turn and shift only",
                     "give finite numbers, a rotation and a last row of 0 0 0 1");
  }
  return *pose;
}

RigidTransform ofRow(std::span<const double, kRowNumbers> n, std::size_t index, bool isOne) {
  const glm::dvec3 translation{n[0], n[1], n[2]};
  if (!isFinite(translation))
    throw UsageError(placeOf(index, isOne), "a number is not finite", "give finite numbers");
  try {
    return {checkedPose({{n[3], n[4], n[5], n[6]}, {}}).rotation, translation};
  } catch (const UsageError& e) {
    throw UsageError(placeOf(index, isOne), e.problem(), e.remedy());
  }
}

void writeMatrix(const RigidTransform& pose, std::vector<double>& numbers) {
  const glm::dmat4 matrix = pose.toMatrix();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      numbers.push_back(matrix[column][row]);
  }
}

}  // namespace

Doubles::Doubles(nb::handle object) {
  if (take(object)) return;
  converted_ = nb::module_::import_("numpy").attr("ascontiguousarray")(object, "float64");
  if (!take(converted_)) throw nb::type_error("an array of numbers is needed");
}

Doubles::~Doubles() {
  PyBuffer_Release(&buffer_);
}

bool Doubles::take(nb::handle object) {
  if (PyObject_GetBuffer(object.ptr(), &buffer_, PyBUF_FORMAT | PyBUF_C_CONTIGUOUS) != 0) {
    PyErr_Clear();
    buffer_ = {};
    return false;
  }
  if (isDouble(buffer_)) return true;
  PyBuffer_Release(&buffer_);
  buffer_ = {};
  return false;
}

std::span<const double> Doubles::values() const noexcept {
  return {static_cast<const double*>(buffer_.buf), static_cast<std::size_t>(buffer_.len) / sizeof(double)};
}

std::span<const Py_ssize_t> Doubles::shape() const noexcept {
  return {buffer_.shape, static_cast<std::size_t>(buffer_.ndim)};
}

std::vector<RigidTransform> posesOf(nb::handle object) {
  const Doubles numbers(object);
  const std::span<const Py_ssize_t> shape = numbers.shape();
  const std::span<const double> values = numbers.values();
  const bool areMatrices = (shape.size() == 2 || shape.size() == 3) && shape[shape.size() - 1] == 4 &&
                           shape[shape.size() - 2] == 4;
  const bool areRows =
      !areMatrices && (shape.size() == 1 || shape.size() == 2) && shape[shape.size() - 1] == 7;
  if (!areMatrices && !areRows)
    throw UsageError("poses", fmt::format("their shape is ({})", fmt::join(shape, ", ")), kPoseShapes);
  const std::size_t each = areMatrices ? kMatrixNumbers : kRowNumbers, count = values.size() / each;
  const bool isOne = shape.size() == (areMatrices ? 2U : 1U);
  std::vector<RigidTransform> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::span<const double> own = values.subspan(i * each, each);
    poses.push_back(areMatrices ? ofMatrix(own.first<kMatrixNumbers>(), i, isOne)
                                : ofRow(own.first<kRowNumbers>(), i, isOne));
  }
  return poses;
}

RigidTransform poseOf(nb::handle object) {
  const std::vector<RigidTransform> poses = posesOf(object);
  if (poses.size() != 1)
    throw UsageError("pose", fmt::format("there are {} poses", poses.size()), "give one");
  return poses.front();
}

Matrices matricesOf(std::span<const RigidTransform> poses) {
  std::vector<double> numbers;
  numbers.reserve(kMatrixNumbers * poses.size());
  for (const RigidTransform& pose : poses)
    writeMatrix(pose, numbers);
  return arrayOf<Matrices>(std::move(numbers), {poses.size(), 4, 4});
}

Table rowsOf(std::span<const RigidTransform> poses) {
  std::vector<double> numbers;
  numbers.reserve(kRowNumbers * poses.size());
  for (const auto& [q, t] : poses) {
    for (const double number : {t.x, t.y, t.z, q.w, q.x, q.y, q.z})
      numbers.push_back(number);
  }
  return arrayOf<Table>(std::move(numbers), {poses.size(), kRowNumbers});
}

Table matrixOf(const RigidTransform& pose) {
  std::vector<double> numbers;
  writeMatrix(pose, numbers);
  return arrayOf<Table>(std::move(numbers), {4, 4});
}

}  // namespace nearfit::python
