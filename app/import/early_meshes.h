#pragma once

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "app/import/shape_mesher.h"
#include "core/import/cad_document.h"

class TopoDS_Shape;

namespace nearfit::importer {

struct Body;

/// Meshes solids on threads of its own while OpenCASCADE, on one thread, makes those that follow in the file. The result
/// does not depend on what is meshed here: it is what meshBody() returns later.
///
/// Only solids of one shell and few faces are taken, so that finish() usually waits briefly. No two threads write to the
/// same faces, edges or vertices:
///  - A solid that shares some with one added before it is left out.
///  - One that is made later shares none with it, even if both name the same shell or face in the file: OpenCASCADE's
///    StepToTopoDS_Builder keeps what it made in a map of its own for each solid and each model of open shells. Only where
///    read.step.nonmanifold is on do they share one; then nothing may be added.
///  - Nothing heals a solid that was added: STEPControl_ActorRead binds it to its entity, where it is found, after its
///    healing.
/// Tests hold the OpenCASCADE at hand to this.
class EarlyMeshes {
 public:
  /// Max faces of a solid: usually some tenths of a second on one thread. Larger ones are better meshed by all threads.
  static constexpr std::size_t kMaxFaces = 150;
  /// Max threads: meshing takes about twice as long as making the solids.
  static constexpr std::size_t kMaxThreads = 3;

  struct Mesh {
    CadShape shape;                  ///< Without colours of faces.
    std::vector<const void*> faces;  ///< MeshRequest::faces.
  };

  /// @param like  How to mesh; its body, colours, faces and threads are ignored.
  /// @param threads  Of its own; 0: nothing is meshed here.
  EarlyMeshes(const MeshRequest& like, std::size_t threads);
  ~EarlyMeshes();
  EarlyMeshes(const EarlyMeshes&) = delete;
  EarlyMeshes& operator=(const EarlyMeshes&) = delete;

  /// Adds a solid whose faces nothing changes any more. It is meshed once another one has been added: the last one of a
  /// file would only keep finish() waiting. Not thread-safe.
  void add(const TopoDS_Shape& solid);

  /// Bodies meshed so far. Thread-safe.
  std::size_t meshedCount() const;

  /// Waits for what is being meshed and ends the threads. Solids that have not been begun are left to the caller.
  void finish();

  /// After finish(): the mesh of a body, given once; std::nullopt if it was not meshed, or is not placed as the solid was.
  std::optional<Mesh> take(const Body& body);

 private:
  struct Job;

  bool isNew(const TopoDS_Shape& solid);
  void work();
  void meshOne(Job& job) const;
  void end();

  std::unique_ptr<const MeshRequest> like_;
  std::unordered_set<const void*> known_;  ///< Faces and edges of all bodies added.
  std::unique_ptr<Job> last_;              ///< Not to be meshed yet.

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::unique_ptr<Job>> jobs_;         ///< Guarded by the mutex until finish(), as are these:
  std::size_t begun_ = 0, done_ = 0;               ///< Of the jobs, from the first.
  bool isEnding_ = false;                          ///< No further one is begun.
  std::unordered_map<const void*, Job*> byShell_;  ///< After finish().
  std::vector<std::jthread> threads_;              ///< The last member: they use the others.
};

}  // namespace nearfit::importer
