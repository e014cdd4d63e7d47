#pragma once

#include <chrono>
#include <thread>
#include <type_traits>

#include <nanobind/nanobind.h>

#include "core/base/error.h"
#include "core/base/progress.h"

namespace nearfit::python {

/// Asks the interpreter now and then if the user has interrupted work that runs without its lock.
class Interrupts {
 public:
  /// To be called with the interpreter's lock. The result refers to this.
  ProgressCallback callback() {
    return [this](double) { return goesOn(); };
  }

 private:
  /// Signals are the business of the thread that called; others go on until it says so.
  bool goesOn() {
    if (std::this_thread::get_id() != thread_) return true;
    // Soon enough for one who waits, and rare enough to cost nothing.
    constexpr std::chrono::milliseconds kLookEvery{50};
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < kLookEvery) return true;
    last_ = now;
    const nanobind::gil_scoped_acquire lock;
    return PyErr_CheckSignals() == 0;
  }

  std::thread::id thread_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Returns work(progress), called without the interpreter's lock. Throws what it throws; after an interrupt what Python's
/// handler of the signal raised.
template <class Work>
auto withoutLock(const Work& work) {
  Interrupts interrupts;
  const ProgressCallback progress = interrupts.callback();
  const auto raiseInterrupt = [] {
    if (PyErr_Occurred() != nullptr) throw nanobind::python_error();
  };
  const auto unlocked = [&] {
    const nanobind::gil_scoped_release release;
    return work(progress);
  };
  try {
    // The work may have ended before it took notice.
    if constexpr (std::is_void_v<decltype(work(progress))>) {
      unlocked();
      raiseInterrupt();
    } else {
      auto result = unlocked();
      raiseInterrupt();
      return result;
    }
  } catch (const Error&) {
    // An interrupt stops the work with Cancelled, or with what another thread threw meanwhile.
    raiseInterrupt();
    throw;
  }
}

}  // namespace nearfit::python
