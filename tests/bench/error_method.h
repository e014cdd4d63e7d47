#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/haptics/spring_law.h"
#include "core/proximity/lmd.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {

/// What a method says at a pose; in the scene's frame.
struct ContactAnswer {
  /// Points, direction and distance count; a method that knows no more leaves the rest as it is.
  std::vector<Lmd> minima;
  Wrench wrench;  ///< On the part, about the origin of its frame.

  void clear() {
    minima.clear();
    wrench = {};
  }
};

/// Two meshes, and what is asked of a method: all local minimum distances within the cutoff, and the wrench
/// of a spring on each. Of the shapes that the meshes stand for a method learns nothing.
struct ErrorScene {
  PreparedScene bodies;      ///< Meshes, hierarchies and the cutoff.
  SpringParameters springs;  ///< Its cutoff is that of the bodies.

  ErrorScene(TriangleMesh scene, TriangleMesh part, double cutoff);

  /// The wrench of minima as a spring law has it, about the origin of the part's frame.
  Wrench wrenchOf(std::span<const Lmd> minima, const RigidTransform& sceneFromPart) const noexcept;
};

/// One way to answer, exact or not. What it makes of the meshes it makes when it is made; that is not timed.
class ErrorMethod {
 public:
  ErrorMethod() = default;
  virtual ~ErrorMethod() = default;
  ErrorMethod(const ErrorMethod&) = delete;
  ErrorMethod& operator=(const ErrorMethod&) = delete;

  /// This call is what is timed: minima and wrench. `answer` is empty, and has room from the calls before.
  virtual void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) = 0;

  /// Work of another thread between two ticks; timed apart. Comes after each answer.
  virtual void workAside(const RigidTransform&) {}

  /// Memory of what it holds instead of the meshes' hierarchies [bytes]; 0 where it holds those.
  virtual std::size_t byteSize() const { return 0; }
};

/// A row of the table of methods. To add one, add a row to one of the functions below.
struct ErrorMethodEntry {
  std::string name, description;
  /// Poses of the way to a pose that are answered, untimed, before it: a jump lies before each way. One to
  /// warm the caches; more for what knows the way.
  std::size_t leadIn = 1;
  /// Whether its answers are exact for the meshes that it was given.
  bool isExact = false;
  std::function<std::unique_ptr<ErrorMethod>(const ErrorScene&)> make;
  /// Beyond so many triangles of both meshes it is not asked: it would take minutes a pose.
  std::size_t maxTriangles = std::numeric_limits<std::size_t>::max();
};

std::vector<ErrorMethodEntry> exactErrorMethods();
std::vector<ErrorMethodEntry> approximateErrorMethods();
std::vector<ErrorMethodEntry> fieldErrorMethods();
std::vector<ErrorMethodEntry> paperErrorMethods();
/// A spring at each pair of triangles within the cutoff. Not among allErrorMethods(): it sums other springs on purpose.
ErrorMethodEntry allPairsErrorMethod();
std::vector<ErrorMethodEntry> fclErrorMethods();  ///< Where the program is built with FCL.

/// All that this program is built with, the exact ones first.
std::vector<ErrorMethodEntry> allErrorMethods();

}  // namespace nearfit::bench
