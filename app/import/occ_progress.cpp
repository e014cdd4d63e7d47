#include "app/import/occ_progress.h"

#include <algorithm>
#include <thread>

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

class Indicator : public Message_ProgressIndicator {
 public:
  explicit Indicator(const ImportJob& job) : job_(job) {}
  void Show(const Message_ProgressScope& /*scope*/, const Standard_Boolean /*isForce*/) override {
    job_.progress(GetPosition());
  }

 private:
  const ImportJob& job_;
};

}  // namespace

struct OccProgress::Parts {
  explicit Parts(const ImportJob& job)
      : indicator(new Indicator(job)), scope(indicator->Start(), "import", 1.0) {}

  Handle(Message_ProgressIndicator) indicator;
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

void setUpOcc() {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  // TBB looks at files of the system that the sandbox does not show.
  OSD_Parallel::SetUseOcctThreads(Standard_True);
  OSD_ThreadPool::DefaultPool(
      static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, kMaxThreads)));
}

}  // namespace nearfit::importer
