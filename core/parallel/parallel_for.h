#pragma once

#include <cstddef>
#include <functional>

namespace nearfit {

/// Calls work(i) once for each i below `count`, in any order, on this thread and on helper threads. Returns
/// when all calls are done.
///
/// All loops of the process together, nested ones included, run at most (processors - 1) helper threads, less one for each
/// ReservedProcessor. The first exception ends the loop early and is rethrown here.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& work);

/// Leaves one processor to others while it lives, such as to a servo that the system does not let go first: loops run one
/// helper thread less. Helpers that are too many leave after the call that they are in. Thread-safe.
class ReservedProcessor {
 public:
  ReservedProcessor() noexcept;
  ~ReservedProcessor();
  ReservedProcessor(const ReservedProcessor&) = delete;
  ReservedProcessor& operator=(const ReservedProcessor&) = delete;
};

}  // namespace nearfit
