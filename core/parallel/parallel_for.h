#pragma once

#include <cstddef>
#include <functional>

namespace nearfit {

/// Calls work(i) once for each i below `count`, in any order, on this thread and on as many others as the
/// machine has processors for. Calls within calls share these: the process never has more threads at such
/// work than processors, besides those that started it. Returns when all is done. The first exception ends
/// the work early and is thrown here.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace nearfit
