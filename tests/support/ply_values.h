#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace nearfit::test {

/// A binary little-endian PLY file as it is: the values of its vertices by property, and its triangles. Own code, so that
/// a file is not judged by the importer alone. Knows float, double, uchar and uint. Throws std::runtime_error.
struct PlyValues {
  std::vector<std::string> comments;
  std::map<std::string, std::vector<double>> vertex;
  std::vector<std::vector<std::size_t>> faces;
};

PlyValues readPlyValues(const std::filesystem::path& file);

}  // namespace nearfit::test
