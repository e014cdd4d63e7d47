#include "app/import/occ_progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_ProgressIndicator.hxx>
#include <Message_ProgressRange.hxx>
#include <Message_ProgressScope.hxx>
#include <OSD_Parallel.hxx>
#include <OSD_ThreadPool.hxx>

namespace nearfit::importer {
namespace {

/// More threads than this gain nothing: faces of a part are few, and each thread takes memory.
constexpr unsigned kMaxThreads = 8;

/// Processor time in which half of what is left of a stage is shown as done, if nothing else is known [s]: about what a
/// mesh of a million triangles takes.
constexpr double kHalfTime = 10.0;
/// Time between two reports: ten a second.
constexpr std::chrono::milliseconds kTick{100};

/// Processor time that all threads of this process have used [s].
double processorTime() noexcept {
  ::timespec time{};
  return ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time) == 0
             ? static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec)
             : 0.0;
}

class Indicator : public Message_ProgressIndicator {
 public:
  explicit Indicator(const ImportJob& job) : job_(job) {}
  void Show(const Message_ProgressScope& /*scope*/, const Standard_Boolean /*isForce*/) override {
    const std::lock_guard lock(mutex_);
    reached_ = GetPosition();
    reachedAt_ = processorTime();
    job_.progress(reached_);
    if (onShow_) onShow_();
  }
  void setOnShow(std::function<void()> onShow) {
    const std::lock_guard lock(mutex_);
    onShow_ = std::move(onShow);
  }
  /// Reports what the processor time since the last Show() stands for, on the way to `end`.
  void tick(double end) {
    const std::lock_guard lock(mutex_);
    const double left = std::max(end - reached_, 0.0);
    job_.progress(reached_ + left * (1.0 - std::exp2((reachedAt_ - processorTime()) / kHalfTime)));
  }

 private:
  const ImportJob& job_;
  std::mutex mutex_;
  std::function<void()> onShow_;
  double reached_ = 0.0, reachedAt_ = processorTime();
};

}  // namespace

struct OccProgress::Parts {
  explicit Parts(const ImportJob& job)
      : indicator(new Indicator(job)), scope(indicator->Start(), "import", 1.0) {}

  Handle(Indicator) indicator;
  Message_ProgressScope scope;
  double end = 0.0;
};

OccProgress::OccProgress(const ImportJob& job) : parts_(std::make_unique<Parts>(job)) {}

OccProgress::~OccProgress() = default;

Message_ProgressRange OccProgress::stageTo(double end) {
  const double step = end - parts_->end;
  parts_->end = end;
  return parts_->scope.Next(step);
}

struct OccProgress::Steady::Ticker {
  explicit Ticker(const OccProgress& progress)
      : indicator(progress.parts_->indicator),
        end(progress.parts_->end),
        thread([this](const std::stop_token& stop) { run(stop); }) {}

  void run(const std::stop_token& stop) const {
    std::mutex mutex;
    std::condition_variable_any pause;
    std::unique_lock lock(mutex);
    while (!pause.wait_for(lock, stop, kTick, [&stop] { return stop.stop_requested(); }))
      indicator->tick(end);
  }

  Handle(Indicator) indicator;
  double end;
  std::jthread thread;  ///< The last member: it uses the others.
};

OccProgress::Steady::Steady(OccProgress& progress) : ticker_(std::make_unique<Ticker>(progress)) {}

OccProgress::Steady::~Steady() = default;

OccProgress::Listening::Listening(OccProgress& progress, std::function<void()> onProgress)
    : progress_(progress) {
  progress_.parts_->indicator->setOnShow(std::move(onProgress));
}

OccProgress::Listening::~Listening() {
  progress_.parts_->indicator->setOnShow({});
}

StageEnds stageEndsOf(const ImportJob& job) {
  return job.tessellation.chord > 0.0 ? StageEnds{0.1, 0.2, 0.97} : StageEnds{0.25, 0.5, 0.97};
}

void setUpOcc() {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  // TBB looks at files of the system that the sandbox does not show.
  OSD_Parallel::SetUseOcctThreads(Standard_True);
  OSD_ThreadPool::DefaultPool(
      static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, kMaxThreads)));
}

}  // namespace nearfit::importer
