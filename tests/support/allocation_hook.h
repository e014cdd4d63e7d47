#pragma once

#include <cstdint>

namespace nearfit::test {

/// Counts what the calling thread asks of the heap from here to the end of the thread, or to the matching
/// `stopCountingAllocations`. Counts operator new and delete; malloc, free and their kin too, except under
/// the address and thread sanitizers, which have taken those for themselves.
void startCountingAllocations() noexcept;
void stopCountingAllocations() noexcept;

/// Requests and releases (of anything but null) that were counted in all threads since the last reset.
std::uint64_t countedAllocations() noexcept;
void resetAllocationCount() noexcept;

}  // namespace nearfit::test
