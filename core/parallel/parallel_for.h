#pragma once

#include <cstddef>
#include <functional>

namespace nearfit {

/// Calls work(i) once for each i below `count`, in any order, on this thread and on helper threads. Returns
/// when all calls are done.
///
/// All loops of the process together, nested ones included, run at most (processors - 1) helper threads. The
/// first exception ends the loop early and is rethrown here.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace nearfit
