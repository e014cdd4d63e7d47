#pragma once

namespace nearfit {

/// Gives the calling thread the lowest priority of ordinary scheduling, from now on, so that it takes what time others
/// leave. Threads that it starts inherit it. No-op where the system refuses.
void lowerThreadPriority() noexcept;

}  // namespace nearfit
