#pragma once

#include <cstdint>

namespace nearfit {

/// Priorities below that of a thread that answers the user.
enum class ThreadPriority : std::uint8_t {
  Background,  ///< The user waits for the result, and the window answers meanwhile.
  Lowest,      ///< Takes what time others leave.
};

/// Lowers the priority of the calling thread to this one, from now on; never raises it. Threads and processes that it
/// starts inherit it. No-op where the system refuses.
void lowerThreadPriority(ThreadPriority priority) noexcept;

}  // namespace nearfit
