#pragma once

#include <cstdint>

#include "core/mesh/triangle_mesh.h"

/// Deterministic closed meshes with the character of real ones: machine parts of long thin triangles and flat
/// faces, scans of small even ones. Manifold with outward faces, about the origin, in metres.
namespace nearfit::bench {

/// A spur gear about z from -0.5 to 0.5 with a round bore of radius 0.5, tip radius 2; 28 * 9 * teeth faces.
inline constexpr double kGearBoreRadius = 0.5, kGearLength = 1.0;
TriangleMesh gearMesh(std::uint32_t teeth);

/// A helical spring about z with closed ends: coil radius 1, wire radius 0.2.
/// 2 * around * (along + 1) faces.
TriangleMesh springMesh(std::uint32_t along, std::uint32_t around);

/// A body of revolution about z with a handle and a spout that run into it, as teapots are drawn: three
/// closed components that overlap. 5,632 faces.
TriangleMesh teapotMesh();

/// Journals, webs and offset pins along z, its large flat faces in annuli. 204 * around faces.
TriangleMesh crankshaftMesh(std::uint32_t around);

/// A sphere of even triangles, its vertices on it; 20 * frequency^2 faces. @param frequency  >= 1.
TriangleMesh geodesicSphereMesh(double radius, std::uint32_t frequency);

/// A sphere of even triangles whose radius varies smoothly, with lobes like limbs and relief like fur or
/// skin: the character of a scan. 20 * frequency^2 faces; same seed, same mesh.
TriangleMesh organicMesh(std::uint32_t frequency, std::uint64_t seed);

}  // namespace nearfit::bench
