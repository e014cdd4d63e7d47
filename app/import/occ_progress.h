#pragma once

#include <memory>

#include "app/import/import_job.h"

class Message_ProgressRange;

namespace nearfit::importer {

/// Progress of OpenCASCADE's algorithms as that of a job, in stages.
class OccProgress {
 public:
  /// @param job  Kept by reference.
  explicit OccProgress(const ImportJob& job);
  ~OccProgress();
  OccProgress(const OccProgress&) = delete;
  OccProgress& operator=(const OccProgress&) = delete;

  /// The next stage, which brings the whole to `end` (0 to 1).
  Message_ProgressRange stageTo(double end);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Progress at the end of each stage: OpenCASCADE says nothing while it reads, which takes about as long as each of the
/// others.
constexpr double kReadEnd = 0.25, kTransferredEnd = 0.5, kMeshedEnd = 0.97;

/// Sets OpenCASCADE up: threads of its own number, and no messages on the terminal.
void setUpOcc();

}  // namespace nearfit::importer
