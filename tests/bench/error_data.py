"""Rows of `nearfit-bench error`, and what follows from them: fronts, orders, times to an error."""

import csv
import pathlib
import sys
from dataclasses import dataclass

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "resources" / "scripts" / "figure_sources"))
import fronts  # noqa: E402

# Column, what it is called, its unit, the order that facets leave it.
QUANTITIES = {
    "distance": ("distance_rms_m", "distance", "m", 2),
    "position": ("position_rms_m", "position", "m", 1),
    "direction": ("direction_rms", "direction", "rad", 1),
    "force": ("force_rms", "force", "N", 1),
    "torque": ("torque_rms_m", "torque", "N m", 1),
}
COARSE = 4  # Finer than this, errors follow their order.
FLOOR, MARGIN = fronts.FLOOR, fronts.MARGIN  # An error at the floor on every mesh has no order: the mesh is the solid there.


@dataclass
class Table:
    comments: list
    rows: list

    @property
    def pays_for_all_threads(self):
        return all("aside_us" in row for row in self.rows)

    @property
    def pairs(self):
        return list(dict.fromkeys(r["pair"] for r in self.rows))

    @property
    def methods(self):
        return list(dict.fromkeys(r["method"] for r in self.rows))

    def of(self, pair, method):
        """Coarsest first."""
        rows = [r for r in self.rows if r["pair"] == pair and r["method"] == method]
        return sorted(rows, key=lambda r: r["fineness"])


# Grouping drops minima: what it leaves is no exact set, though it was measured under that name.
NAMES = {"exact grouped": "grouped"}


def read(file):
    lines = file.read_text().splitlines()
    rows = []
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        rows.append({k: v if k in ("pair", "method") else float(v) for k, v in row.items()})
        rows[-1]["method"] = NAMES.get(row["method"], row["method"])
        # Time of all threads; older files do not say what is done beside an answer.
        aside = rows[-1].get("aside_us", 0.0)
        rows[-1]["paid_us"], rows[-1]["paid_p99_us"] = rows[-1]["p50_us"] + aside, rows[-1]["p99_us"] + aside
    return Table([line[2:] for line in lines if line.startswith("#")], rows)


def error(row, quantity):
    """NaN where a method found nothing."""
    value = row[QUANTITIES[quantity][0]]
    return max(value, FLOOR) if np.isfinite(value) else np.nan


def front(rows, quantity):
    """Rows of all methods that programs use, on all meshes, that none beats; fastest first."""
    return [p[3] for p in fronts.front([(r["paid_us"], error(r, quantity), r["method"], r) for r in rows])]


def time_to(rows, quantity, target):
    """Least time of all threads with an error of at most that [us]; None when no mesh will do."""
    times = [r["paid_us"] for r in rows if error(r, quantity) <= target]
    return min(times) if times else None


def order(rows, quantity):
    """Slope of error over edge length, in logarithms; None where the error is rounding, or none is left."""
    rows = [r for r in rows if r["fineness"] >= COARSE]
    errors = np.array([error(r, quantity) for r in rows])
    if len(rows) < 3 or not np.all(np.isfinite(errors)) or errors.max() <= FLOOR:
        return None
    return float(np.polyfit(np.log([r["edge_m"] for r in rows]), np.log(errors), 1)[0])


def is_exact(method):
    return method.startswith("exact")
