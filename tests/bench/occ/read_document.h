#pragma once

#include <filesystem>

#include "tests/bench/import_run.h"

class TopoDS_Shape;

namespace nearfit::bench {

/// Reads a STEP file with its names and colours, and meshes each of its shapes once, by the chord and angle that the
/// importer takes for it. Throws FileError.
OccRun readAndMesh(const std::filesystem::path& file);

/// Meshes a shape by the importer's default tolerances, in parallel. Coordinates are millimetres.
void meshByDefault(const TopoDS_Shape& shape);
/// Triangles of all faces that bound a shape, those of a meshed one.
std::size_t trianglesOf(const TopoDS_Shape& shape);

}  // namespace nearfit::bench
