#pragma once

#include <optional>

#include "core/mesh/mesh_builder.h"
#include "core/mesh/triangle_mesh.h"
#include "tests/fuzz/byte_source.h"

namespace nearfit::fuzz {

constexpr std::size_t kMaxVertices = 24, kMaxTriangles = 48;

/// A few triangles, as the bytes say: a simple solid or nothing, its vertices moved, scaled, put on lines and planes
/// through others or within some roundings of them, its triangles taken away and others added. Corners may repeat.
/// Empty if there is no vertex.
PolygonSoup smallSoup(ByteSource& bytes);

/// The mesh that MeshBuilder makes of smallSoup(). None where it refuses it.
std::optional<TriangleMesh> smallMesh(ByteSource& bytes);

/// A finite pose, its quaternion unit: at random, of quarter turns, or turned a little off one.
RigidTransform smallPose(ByteSource& bytes);

/// Whether a mesh is within what resources/docs/accuracy.md promises for: its size, place and slivers.
bool isPromised(const TriangleMesh& mesh);
/// The same of two and a pose.
bool isPromised(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& sceneFromPart);

}  // namespace nearfit::fuzz
