"""Pictures of scenes by PyVista or matplotlib, where these are installed; neither is needed for anything else."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy

from ._nearfit import Error, Lmds, Scene

if TYPE_CHECKING:
    from collections.abc import Mapping

# Equals kPartPalette (core/scene/part.h): distinguishable with the common forms of colour blindness.
_PALETTE = (
    (0.62, 0.69, 0.76),
    (0.90, 0.67, 0.36),
    (0.43, 0.68, 0.62),
    (0.80, 0.52, 0.56),
    (0.55, 0.60, 0.84),
    (0.72, 0.74, 0.42),
    (0.69, 0.50, 0.72),
    (0.53, 0.80, 0.90),
    (0.72, 0.56, 0.44),
    (0.86, 0.83, 0.58),
)
_MINIMA_COLOUR = (0.80, 0.10, 0.10)


def _placed(scene: Scene, poses: Mapping[str, Any] | None):
    """Yields name, vertices (n, 3) [m] in the world, triangles (m, 3) and colour of each part."""
    for number, name in enumerate(scene.parts):
        mesh = scene.mesh(name)
        pose = numpy.asarray(scene.pose(name) if poses is None or name not in poses else poses[name], dtype=float)
        if pose.shape != (4, 4):
            raise Error(f"poses: the shape of that of \"{name}\" is {pose.shape}: give a matrix (4, 4)")
        yield name, mesh.vertices @ pose[:3, :3].T + pose[:3, 3], mesh.triangles, _PALETTE[number % len(_PALETTE)]


def show(scene: Scene, lmds: Lmds | None = None, *, poses: Mapping[str, Any] | None = None, plotter: Any = None) -> Any:
    """Draws the parts of a scene with PyVista and returns the plotter; call its show() to open a window.

    lmds: minima to draw as segments, such as lmds(...)[0]. poses: by name of a part, (4, 4) world from part, where that is not
    the scene's. plotter: a pyvista.Plotter to add to. Raises Error where PyVista is not installed.
    """
    try:
        import pyvista
    except ImportError as missing:
        raise Error("show: PyVista is not installed: install it (pip install pyvista), or use plot()") from missing
    drawing = pyvista.Plotter() if plotter is None else plotter
    for name, vertices, triangles, colour in _placed(scene, poses):
        faces = numpy.column_stack([numpy.full(len(triangles), 3), triangles]).astype(numpy.int64)
        drawing.add_mesh(pyvista.PolyData(numpy.ascontiguousarray(vertices), faces.ravel()), color=colour, name=name)
    if lmds is not None and len(lmds.distances) > 0:
        ends = numpy.stack([lmds.points_fixed, lmds.points_moving], axis=1).reshape(-1, 3)
        drawing.add_lines(ends, color=_MINIMA_COLOUR, width=3)
    return drawing


def plot(scene: Scene, lmds: Lmds | None = None, *, poses: Mapping[str, Any] | None = None, axes: Any = None) -> Any:
    """Draws the parts of a scene with matplotlib and returns the three-dimensional axes.

    For small meshes: matplotlib sorts triangles, and knows no hidden surfaces. Arguments are those of show(); axes: of
    projection "3d", to add to. Raises Error where matplotlib is not installed.
    """
    try:
        from matplotlib import pyplot
        from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
    except ImportError as missing:
        raise Error("plot: matplotlib is not installed: install it (pip install matplotlib), or use show()") from missing
    drawing = pyplot.figure().add_subplot(projection="3d") if axes is None else axes
    corners = []
    for _, vertices, triangles, colour in _placed(scene, poses):
        drawing.add_collection3d(Poly3DCollection(vertices[triangles], facecolor=(*colour, 0.6), edgecolor=(0, 0, 0, 0.2)))
        corners.append(vertices)
    if lmds is not None and len(lmds.distances) > 0:
        segments = numpy.stack([lmds.points_fixed, lmds.points_moving], axis=1)
        drawing.add_collection3d(Line3DCollection(segments, colors=[_MINIMA_COLOUR]))
    if corners:
        every = numpy.concatenate(corners)
        low, high = every.min(axis=0), every.max(axis=0)
        middle, half = (low + high) / 2, max((high - low).max() / 2, numpy.finfo(float).tiny)
        drawing.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half),
                    zlim=(middle[2] - half, middle[2] + half), xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    return drawing
