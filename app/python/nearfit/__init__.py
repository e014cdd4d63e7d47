"""Local minimum distances, exact overlaps, clearances and placements of rigid meshes.

Lengths are in metres, angles in radians. Poses are world from part: matrices (4, 4) or (k, 4, 4) by rows, or rows (7,) or
(k, 7) of tx ty tz [m], qw qx qy qz, which are taken to the last bit as nearfit-cli takes them. Arrays are NumPy's, float64
unless stated otherwise. What goes wrong raises nearfit.Error, in the words of the command line. The guide is
resources/docs/python.md of the sources.
"""

from ._nearfit import (
    Certification,
    Error,
    Finding,
    Lmds,
    Mesh,
    Placement,
    Scene,
    Verification,
    __version__,
    certify,
    clearance,
    distance,
    export,
    lmds,
    overlap,
    place,
    read_mesh,
    verify,
    wrench,
    write_path,
)
from ._sweep import SweepResult, open_sweep, sweep
from .pictures import plot, show

__all__ = [
    "Certification",
    "Error",
    "Finding",
    "Lmds",
    "Mesh",
    "Placement",
    "Scene",
    "SweepResult",
    "Verification",
    "__version__",
    "certify",
    "clearance",
    "distance",
    "export",
    "lmds",
    "open_sweep",
    "overlap",
    "place",
    "plot",
    "read_mesh",
    "show",
    "sweep",
    "verify",
    "wrench",
    "write_path",
]
