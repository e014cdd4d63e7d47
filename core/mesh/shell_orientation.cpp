#include "core/mesh/shell_orientation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace nearfit {
namespace {

/// Max number of closed components that are compared pairwise.
constexpr std::size_t kMaxComparedPieces = 5000;

/// A component with less volume than this fraction of the mesh's diagonal cubed is a sheet and has no inside:
/// its volume is rounding.
constexpr double kMinVolume = 1e-14;

struct Piece {
  bool isShell = true;  ///< Closed, oriented, and has a volume.
  bool isTurned = false;
  double volume6 = 0.0;  ///< Six times the signed volume.
  Aabb box;
};

/// Component of each triangle, numbered by first triangle; `count` receives the number of components.
std::vector<std::uint32_t> piecesOfTriangles(const TriangleMesh& mesh, std::uint32_t& count) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> piece(mesh.triangles().size(), kNone), open;
  count = 0;
  for (std::uint32_t first = 0; first < piece.size(); ++first) {
    if (piece[first] != kNone) continue;
    piece[first] = count;
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t triangle = open.back();
      open.pop_back();
      for (const std::uint32_t edge : mesh.edgesOfTriangle(triangle)) {
        // A non-manifold edge may have very many faces: only its first face visits the others.
        const auto faces = mesh.facesOfEdge(edge);
        if (faces.size() > 2 && faces[0] != triangle) {
          if (piece[faces[0]] == kNone) {
            piece[faces[0]] = count;
            open.push_back(faces[0]);
          }
          continue;
        }
        for (const std::uint32_t face : faces) {
          if (piece[face] != kNone) continue;
          piece[face] = count;
          open.push_back(face);
        }
      }
    }
    ++count;
  }
  return piece;
}

std::vector<Piece> measure(const TriangleMesh& mesh, const std::vector<std::uint32_t>& pieceOf,
                           std::uint32_t count) {
  std::vector<Piece> pieces(count);
  const glm::dvec3 centre = mesh.bounds().centre();
  for (std::uint32_t i = 0; i < pieceOf.size(); ++i) {
    Piece& piece = pieces[pieceOf[i]];
    const Triangle& t = mesh.triangles()[i];
    const glm::dvec3 a = mesh.vertices()[t[0]], b = mesh.vertices()[t[1]], c = mesh.vertices()[t[2]];
    piece.volume6 += glm::dot(a - centre, glm::cross(b - centre, c - centre));
    for (const glm::dvec3& p : {a, b, c})
      piece.box.add(p);
    for (const std::uint32_t edge : mesh.edgesOfTriangle(i)) {
      piece.isShell = piece.isShell && mesh.isEdgeConsistent(edge);
    }
  }
  const double diagonal = mesh.bounds().diagonal();
  const double least = kMinVolume * diagonal * diagonal * diagonal;
  for (Piece& piece : pieces)
    piece.isShell = piece.isShell && std::abs(piece.volume6) > least;
  return pieces;
}

bool contains(const Aabb& outer, const Aabb& inner) {
  return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
         glm::all(glm::greaterThanEqual(outer.upper, inner.upper));
}

/// If most of the volume is inside out, the whole mesh is, including its cavities.
void turnAllIfInsideOut(std::vector<Piece>& shells) {
  double sum = 0.0;
  for (const Piece& shell : shells)
    sum += shell.isShell ? shell.volume6 : 0.0;
  for (Piece& shell : shells)
    shell.isTurned = shell.isShell && sum < 0.0;
}

void turnThoseThatAreNoCavities(std::vector<Piece>& pieces) {
  if (std::ranges::count(pieces, true, &Piece::isShell) > static_cast<std::ptrdiff_t>(kMaxComparedPieces))
    return;
  for (Piece& piece : pieces) {
    const double volume = piece.isTurned ? -piece.volume6 : piece.volume6;
    if (!piece.isShell || volume >= 0.0) continue;
    const bool isCavity = std::ranges::any_of(pieces, [&](const Piece& other) {
      return &other != &piece && other.isShell && contains(other.box, piece.box);
    });
    if (!isCavity) piece.isTurned = !piece.isTurned;
  }
}

}  // namespace

OrientedShells orientShells(const TriangleMesh& mesh) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> pieceOf = piecesOfTriangles(mesh, count);
  std::vector<Piece> pieces = measure(mesh, pieceOf, count);
  turnAllIfInsideOut(pieces);
  turnThoseThatAreNoCavities(pieces);

  OrientedShells result{{mesh.triangles().begin(), mesh.triangles().end()}, 0, 0};
  for (std::uint32_t i = 0; i < pieceOf.size(); ++i) {
    if (pieces[pieceOf[i]].isTurned) std::swap(result.triangles[i][1], result.triangles[i][2]);
  }
  for (const Piece& piece : pieces) {
    result.closedPieces += piece.isShell ? 1 : 0;
    result.turnedPieces += piece.isTurned ? 1 : 0;
  }
  return result;
}

}  // namespace nearfit
