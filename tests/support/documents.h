#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/import/cad_document.h"
#include "core/scene/document_load.h"

/// CAD documents as an importer would deliver them.
namespace nearfit::test {

/// A shape of triangles, without faces.
CadShape shapeOf(const std::string& key, const TriangleMesh& mesh);

/// A box about the origin, [m]: each side a plane of its own, the last one red; as from exact surfaces.
CadShape boxShape(const std::string& key, const glm::dvec3& size);

/// A closed cylinder about z, [m]: one cylinder and two planes. The chord of its tessellation decides its segments.
CadShape cylinderShape(const std::string& key, double radius, double height,
                       const Tessellation& tessellation);

CadNode assemblyNode(const std::string& name, std::int32_t parent, const RigidTransform& parentFromNode = {});
CadNode instanceNode(const std::string& name, std::int32_t parent, std::int32_t shape,
                     const RigidTransform& parentFromNode = {});

/// A vise in 6 nodes: "vise" with "body" (box of 100 x 60 x 40 mm at its origin) and "jaws", 0.1 m along x, which hold
/// two instances of the pin (5 mm in radius, 30 mm high) at y = -0.02 and 0.02 m, the second one blue, and "screws",
/// which is empty.
CadDocument viseDocument(const Tessellation& tessellation = {});

/// Stands for the importer as long as it lives, in all threads: makes the document that a function returns, keeps the
/// shapes that are wanted, and counts.
class FakeImporter {
 public:
  using Make = std::function<CadDocument(const Tessellation& tessellation)>;
  explicit FakeImporter(Make make = viseDocument);

  int runs() const { return *runs_; }
  /// What each run was asked for.
  std::vector<DocumentOptions> asked() const;

 private:
  struct Log {
    std::mutex mutex;
    std::vector<DocumentOptions> asked;
  };
  std::shared_ptr<std::atomic<int>> runs_ = std::make_shared<std::atomic<int>>(0);
  std::shared_ptr<Log> log_ = std::make_shared<Log>();
  ScopedDocumentImporter importer_;
};

}  // namespace nearfit::test
