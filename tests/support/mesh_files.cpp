#include "tests/support/mesh_files.h"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>

namespace nearfit::test {
namespace {

template <typename T>
void append(std::string& bytes, T value, ByteOrder order = ByteOrder::Little) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order == ByteOrder::Big) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

std::string plyHeader(const TriangleMesh& mesh, std::string_view format) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made by a test\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, mesh.vertices().size(), mesh.triangles().size());
}

}  // namespace

std::string stlBinary(const TriangleMesh& mesh, const std::string& header) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles().size()));
  for (const Triangle& t : mesh.triangles()) {
    bytes.append(12, '\0');
    for (const std::uint32_t v : t) {
      for (int i = 0; i < 3; ++i)
        append(bytes, static_cast<float>(mesh.vertices()[v][i]));
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string stlText(const TriangleMesh& mesh) {
  std::string text = "solid test\n";
  for (const Triangle& t : mesh.triangles()) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const std::uint32_t v : t) {
      const glm::dvec3& p = mesh.vertices()[v];
      text += fmt::format("  vertex {} {} {}\n", p.x, p.y, p.z);
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

std::string offText(const TriangleMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices().size(), mesh.triangles().size());
  for (const glm::dvec3& p : mesh.vertices())
    text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  for (const Triangle& t : mesh.triangles())
    text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

std::string plyText(const TriangleMesh& mesh) {
  std::string text = plyHeader(mesh, "ascii");
  for (const glm::dvec3& p : mesh.vertices())
    text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  for (const Triangle& t : mesh.triangles())
    text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

std::string plyBinary(const TriangleMesh& mesh, ByteOrder order) {
  std::string bytes = plyHeader(mesh, order == ByteOrder::Big ? "binary_big_endian" : "binary_little_endian");
  for (const glm::dvec3& p : mesh.vertices()) {
    for (int i = 0; i < 3; ++i)
      append(bytes, p[i], order);
  }
  for (const Triangle& t : mesh.triangles()) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t v : t)
      append(bytes, static_cast<std::int32_t>(v), order);
  }
  return bytes;
}

PolygonSoup soupOf(const TriangleMesh& mesh) {
  PolygonSoup soup;
  soup.vertices.assign(mesh.vertices().begin(), mesh.vertices().end());
  for (const Triangle& t : mesh.triangles()) {
    soup.corners.insert(soup.corners.end(), t.begin(), t.end());
    soup.closePolygon();
  }
  return soup;
}

}  // namespace nearfit::test
