#pragma once

#include <functional>
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

  /// While it exists, progress of the present stage grows with the processor time that is used, more slowly the more
  /// has been used: OpenCASCADE says nothing while it reads an IGES file, builds the entities of a STEP file, or meshes
  /// one face, each of which takes minutes if there is much of it. A process that hangs uses none, and one that loops is
  /// ended by its limit of it.
  class Steady {
   public:
    /// @param progress  Outlives it. Nothing else may call stageTo() meanwhile.
    explicit Steady(OccProgress& progress);
    ~Steady();
    Steady(const Steady&) = delete;
    Steady& operator=(const Steady&) = delete;

   private:
    struct Ticker;
    std::unique_ptr<Ticker> ticker_;
  };

  /// While it exists, a function is called each time that OpenCASCADE reports progress, in the thread that does.
  class Listening {
   public:
    /// @param progress  Outlives it.
    /// @param onProgress  Must not throw.
    Listening(OccProgress& progress, std::function<void()> onProgress);
    ~Listening();
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;

   private:
    OccProgress& progress_;
  };

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Progress at the end of each stage.
struct StageEnds {
  double read, transferred, meshed;
};
/// Reading takes about as long as each of the others, unless a tessellation is asked for: that is mostly a fine one, and
/// meshing takes most of the time.
StageEnds stageEndsOf(const ImportJob& job);

/// Sets OpenCASCADE up: threads of its own number, and no messages on the terminal.
void setUpOcc();

}  // namespace nearfit::importer
