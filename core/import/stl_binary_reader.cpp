// Uses OpenMesh, whose reader handles this dialect correctly once the length is checked; the format itself is
// single precision. Two things are hidden from it: facets that are not finite, because it orders vertices by
// comparisons that NaN breaks, and a count larger than the file, because it does not notice the end.
#include "core/import/stl_binary_reader.h"

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <istream>
#include <limits>
#include <streambuf>
#include <utility>

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

/// Size of the facet's normal, which precedes its corners.
constexpr std::size_t kNormalBytes = 12;

bool isFiniteFacet(const char* facet) {
  std::array<float, 9> coordinates;
  std::memcpy(coordinates.data(), facet + kNormalBytes, sizeof(coordinates));
  // NaN or infinity makes the sum of differences NaN.
  float sum = 0.0F;
  for (const float c : coordinates)
    sum += c - c;
  return sum == 0.0F;
}

/// Presents a binary STL file to OpenMesh: header, number of finite facets, finite facets. Copies nothing.
class FiniteFacets : public std::streambuf {
 public:
  FiniteFacets(std::span<const char> bytes, std::uint32_t facets)
      : position_(bytes.data() + kStlHeaderBytes), end_(position_ + std::size_t{facets} * kStlFacetBytes) {
    for (const char* facet = position_; facet != end_; facet += kStlFacetBytes) {
      finiteCount_ += isFiniteFacet(facet) ? 1U : 0U;
    }
    std::memcpy(header_.data() + header_.size() - sizeof(finiteCount_), &finiteCount_, sizeof(finiteCount_));
    setg(header_.data(), header_.data(), header_.data() + header_.size());
  }
  std::uint32_t finiteCount() const { return finiteCount_; }

 protected:
  int_type underflow() override {
    while (position_ != end_ && !isFiniteFacet(position_))
      position_ += kStlFacetBytes;
    const char* start = position_;
    while (position_ != end_ && isFiniteFacet(position_))
      position_ += kStlFacetBytes;
    if (start == position_) return traits_type::eof();
    // A stream buffer's get area is not const, but reading does not modify it.
    setg(const_cast<char*>(start), const_cast<char*>(start), const_cast<char*>(position_));
    return traits_type::to_int_type(*start);
  }

 private:
  std::array<char, kStlHeaderBytes> header_{};
  const char *position_, *end_;
  std::uint32_t finiteCount_ = 0;
};

/// Collects the output of an OpenMesh reader as plain polygons. OpenMesh's own importer would build a
/// halfedge mesh, which drops non-manifold faces.
class SoupImporter : public OpenMesh::IO::BaseImporter {
 public:
  /// @param onFaces  Called now and then with the number of faces so far; may throw.
  explicit SoupImporter(std::function<void(std::size_t faces)> onFaces) : onFaces_(std::move(onFaces)) {}

  PolygonSoup takeSoup() { return std::move(soup_); }

  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f& point) override {
    soup_.vertices.emplace_back(point[0], point[1], point[2]);
    return OpenMesh::VertexHandle(static_cast<int>(soup_.vertices.size() - 1));
  }
  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3d& point) override {
    soup_.vertices.emplace_back(point[0], point[1], point[2]);
    return OpenMesh::VertexHandle(static_cast<int>(soup_.vertices.size() - 1));
  }
  OpenMesh::VertexHandle add_vertex() override { return add_vertex(OpenMesh::Vec3d(0.0)); }
  void set_point(OpenMesh::VertexHandle vertex, const OpenMesh::Vec3f& point) override {
    soup_.vertices[static_cast<std::size_t>(vertex.idx())] = {point[0], point[1], point[2]};
  }
  OpenMesh::FaceHandle add_face(const VHandles& corners) override {
    for (const OpenMesh::VertexHandle v : corners)
      soup_.corners.push_back(static_cast<std::uint32_t>(v.idx()));
    soup_.closePolygon();
    constexpr std::size_t kReportFaces = 1 << 14;
    if (soup_.polygonCount() % kReportFaces == 0) onFaces_(soup_.polygonCount());
    return OpenMesh::FaceHandle(static_cast<int>(soup_.polygonCount() - 1));
  }
  std::size_t n_vertices() const override { return soup_.vertices.size(); }
  std::size_t n_faces() const override { return soup_.polygonCount(); }
  std::size_t n_edges() const override { return 0; }

  // Attributes and halfedges: a soup keeps none.
  OpenMesh::HalfedgeHandle add_edge(OpenMesh::VertexHandle, OpenMesh::VertexHandle) override {
    return OpenMesh::HalfedgeHandle();
  }
  OpenMesh::FaceHandle add_face(OpenMesh::HalfedgeHandle) override { return OpenMesh::FaceHandle(); }
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle,
                          const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle,
                          const std::vector<OpenMesh::Vec3f>&) override {}
  void set_face_texindex(OpenMesh::FaceHandle, int) override {}
  void set_halfedge(OpenMesh::VertexHandle, OpenMesh::HalfedgeHandle) override {}
  void set_normal(OpenMesh::VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(OpenMesh::VertexHandle, const OpenMesh::Vec3d&) override {}
  void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3d&) override {}
  void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec4f&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4f&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4f&) override {}
  void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec2f&) override {}
  void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec2f&) override {}
  void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec3f&) override {}
  void set_status(OpenMesh::VertexHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_status(OpenMesh::HalfedgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_status(OpenMesh::EdgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_status(OpenMesh::FaceHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_next(OpenMesh::HalfedgeHandle, OpenMesh::HalfedgeHandle) override {}
  void set_face(OpenMesh::HalfedgeHandle, OpenMesh::FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void add_texture_information(int, std::string) override {}

 private:
  std::function<void(std::size_t faces)> onFaces_;
  PolygonSoup soup_;
};

void addPolygon(PolygonSoup& soup, std::uint32_t vertex, std::size_t times) {
  for (std::size_t i = 0; i < times; ++i) {
    soup.corners.insert(soup.corners.end(), 3, vertex);
    soup.closePolygon();
  }
}

/// Adds facets that OpenMesh did not deliver, so that they are counted and reported.
void addUndelivered(PolygonSoup& soup, std::size_t nonFinite, std::size_t degenerate) {
  if (degenerate > 0) addPolygon(soup, 0, degenerate);
  if (nonFinite == 0) return;
  soup.vertices.emplace_back(std::numeric_limits<double>::quiet_NaN());
  addPolygon(soup, static_cast<std::uint32_t>(soup.vertices.size() - 1), nonFinite);
}

}  // namespace

std::uint32_t stlFacetCount(std::span<const char> bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kStlHeaderBytes - sizeof(count), sizeof(count));
  return count;
}

ReaderResult readStlBinary(const ReaderInput& input) {
  if (input.bytes.size() < kStlHeaderBytes) {
    throw FileError(
        input.name,
        fmt::format("it has {} bytes, fewer than the header of a binary STL file", input.bytes.size()),
        "it is cut off or not an STL file: export or copy it again");
  }
  const std::uint32_t facets = stlFacetCount(input.bytes);
  const std::uint64_t expected = kStlHeaderBytes + std::uint64_t{facets} * kStlFacetBytes;
  if (input.bytes.size() < expected) {
    throw FileError(
        fmt::format("{}: byte {}", input.name, input.bytes.size()),
        fmt::format("the file ends here, but its header declares {} triangles, which take {} bytes", facets,
                    expected),
        "it is cut off or not an STL file: export or copy it again");
  }
  FiniteFacets buffer(input.bytes, facets);
  std::istream stream(&buffer);
  SoupImporter importer([&](std::size_t done) { input.report(static_cast<double>(done) / facets); });
  OpenMesh::IO::Options options = OpenMesh::IO::Options::Binary;
  OpenMesh::IO::STLReader().read(stream, importer, options);

  ReaderResult result{importer.takeSoup(), {}};
  const std::size_t delivered = result.soup.polygonCount();
  addUndelivered(result.soup, facets - buffer.finiteCount(), buffer.finiteCount() - delivered);
  if (input.bytes.size() > expected) {
    result.warnings.push_back(fmt::format("{} bytes after the last of {} triangles were ignored.",
                                          input.bytes.size() - expected, facets));
  }
  return result;
}

}  // namespace nearfit
