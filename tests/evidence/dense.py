"""Solids of flat faces whose faces are cut finely and unevenly: the meshes that a CAD system or a scanner writes."""

import numpy as np


class Solid:
    """A closed mesh of vertices [m] and triangles, anticlockwise from outside."""

    def __init__(self, vertices, triangles):
        self.vertices = np.array(vertices, float)
        self.triangles = np.array(triangles, int)

    def quartered(self, times):
        """Each triangle is cut into four, so many times over."""
        solid = self
        for _ in range(times):
            solid = solid._quartered()
        return solid

    def _quartered(self):
        corners = self.triangles
        ends = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
        edges, place = np.unique(ends, axis=0, return_inverse=True)
        middles = 0.5 * (self.vertices[edges[:, 0]] + self.vertices[edges[:, 1]])
        ab, bc, ca = (place + len(self.vertices)).reshape(3, -1)
        a, b, c = corners.T
        cut = [np.column_stack(t) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        return Solid(np.concatenate([self.vertices, middles]), np.concatenate(cut))

    def cut_to(self, count, seed):
        """Edges drawn at random are cut at random places until there are so many triangles: two more for each cut.

        The same on every machine, and the solid stays the same but for rounding.
        """
        random = np.random.default_rng(seed)
        vertices = list(self.vertices)
        triangles = [tuple(t) for t in self.triangles]
        beside = {}
        for i, t in enumerate(triangles):
            for k in range(3):
                beside[t[k], t[(k + 1) % 3]] = i

        def put(i, t):
            triangles[i] = t
            for k in range(3):
                beside[t[k], t[(k + 1) % 3]] = i

        while len(triangles) < count:
            t = triangles[random.integers(len(triangles))]
            k = random.integers(3)
            a, b = t[k], t[(k + 1) % 3]
            share = random.uniform(0.3, 0.7)
            new = len(vertices)
            vertices.append((1 - share) * vertices[a] + share * vertices[b])
            for start, end in ((a, b), (b, a)):
                i = beside.pop((start, end))
                third = next(v for v in triangles[i] if v not in (a, b))
                triangles.append(())
                put(i, (start, new, third))
                put(len(triangles) - 1, (new, end, third))
        return Solid(vertices, triangles)

    def write(self, file):
        """As OBJ, each coordinate to its last bit."""
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in self.vertices.tolist()]
        lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in self.triangles.tolist()]
        file.write_text("\n".join(lines) + "\n")


def _square(half_x, half_y, z):
    return [(-half_x, -half_y, z), (half_x, -half_y, z), (half_x, half_y, z), (-half_x, half_y, z)]


def _between(low, high):
    """The band between two rings of four vertices, given by their first ones."""
    triangles = []
    for i in range(4):
        j = (i + 1) % 4
        triangles += [(low + i, low + j, high + j), (low + i, high + j, high + i)]
    return triangles


def box(size_x, size_y, size_z):
    """A box about the origin."""
    x, y, z = 0.5 * size_x, 0.5 * size_y, 0.5 * size_z
    return Solid(_square(x, y, -z) + _square(x, y, z),
                 [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7)] + _between(0, 4))


def chamfered_peg(width, height, chamfer):
    """A square peg from z = 0 up, with a chamfer around its lower end."""
    half = 0.5 * width
    return Solid(_square(half - chamfer, half - chamfer, 0.0) + _square(half, half, chamfer) + _square(half, half, height),
                 [(0, 2, 1), (0, 3, 2), (8, 9, 10), (8, 10, 11)] + _between(0, 4) + _between(4, 8))


def tray(size, thickness, hole, chamfer):
    """A square plate from z = 0 up with a square hole through it, whose upper rim has a chamfer."""
    outer, inner = 0.5 * size, 0.5 * hole
    wide = inner + chamfer
    rings = [_square(outer, outer, 0.0), _square(outer, outer, thickness), _square(inner, inner, 0.0),
             _square(inner, inner, thickness - chamfer), _square(wide, wide, thickness)]
    triangles = (_between(0, 4) + _between(2 * 4, 0) + _between(4, 4 * 4) + _between(3 * 4, 2 * 4)
                 + _between(4 * 4, 3 * 4))
    return Solid(sum(rings, []), triangles)
