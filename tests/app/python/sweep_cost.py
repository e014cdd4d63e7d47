#!/usr/bin/env python3
"""Measures what a sweep is made of: time of a row, memory of a mesh with its hierarchy, bytes moved and written, and how the time
goes down from one worker to two, in one run. Writes a table, from which resources/docs/sweeps.md says what a large sweep costs.

    python3 tests/app/python/sweep_cost.py -o tests/app/results/sweep_cost.csv

Needs the package with its sweeps (pip install .[sweep]), and a machine where nothing else is at work.
"""

import argparse
import contextlib
import csv
import io
import multiprocessing
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import nearfit
from nearfit import _pieces, _sweep, _sweep_folder

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True  # The folder is the repository's.
sys.path.insert(0, str(ROOT / "resources" / "scripts" / "figure_sources"))
import heads  # noqa: E402

# The sweep that the page speaks of.
LARGE_PARTS, LARGE_POSES = 10_000, 100_000
# Parts stand on a grid, farther apart than their diameter, so that a pose is near a few of them: an assembly, not a heap.
SPACING, RADIUS, CUTOFF, THRESHOLD = 0.1, 0.04, 0.02, 0.005
SEED = 25


def sphere(triangles):
    """A mesh of about so many triangles, of latitudes and longitudes; its radius varies so that minima are not all alike."""
    rings = max(3, round((triangles / 4) ** 0.5))
    around = 2 * rings
    theta, phi = np.meshgrid(np.pi * np.arange(1, rings) / rings, 2 * np.pi * np.arange(around) / around, indexing="ij")
    radius = RADIUS * (1 + 0.1 * np.cos(5 * phi) * np.sin(theta) ** 2)
    ring = radius[..., None] * np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    vertices = np.concatenate([ring.reshape(-1, 3), [[0, 0, RADIUS], [0, 0, -RADIUS]]])
    top, bottom, faces = len(vertices) - 2, len(vertices) - 1, []
    for j in range(around):
        k = (j + 1) % around
        faces.append((top, j, k))
        last = (rings - 2) * around
        faces.append((bottom, last + k, last + j))
        for i in range(rings - 2):
            a, b = i * around, (i + 1) * around
            faces += [(a + j, b + j, b + k), (a + j, b + k, a + k)]
    return nearfit.Mesh(vertices, np.array(faces))


def grid(parts, mesh):
    scene, side = nearfit.Scene(), int(np.ceil(parts ** (1 / 3)))
    for i in range(parts):
        pose = np.eye(4)
        pose[:3, 3] = SPACING * np.array([i % side, i // side % side, i // side**2])
        scene.add(mesh, name=f"P{i}", pose=pose)
    return scene, side


def poses_within(count, side):
    random = np.random.default_rng(SEED)
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, :3, 3] = random.uniform(0, SPACING * side, (count, 3))
    rotations = np.array([np.linalg.qr(m)[0] for m in random.normal(size=(count, 3, 3))])
    rotations[:, :, 0] *= np.linalg.det(rotations)[:, None]
    poses[:, :3, :3] = rotations
    return poses


def resident():
    """Memory of this process [bytes]."""
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def print_memory(triangles):
    """In a process of its own: bytes that a mesh with its hierarchy takes once it was asked."""
    warm, _ = grid(2, sphere(100))
    nearfit.distance(warm, "P0", np.eye(4)[None], cutoff=CUTOFF, threads=1)
    before = resident()
    scene, _ = grid(2, sphere(triangles))
    nearfit.lmds(scene, "P0", np.eye(4)[None], CUTOFF, threads=1)
    print(resident() - before, len(scene.mesh("P0").triangles))


def best(function, repeats):
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        function()
        times.append(time.perf_counter() - begin)
    return min(times)


class Table:
    def __init__(self):
        self.rows = []

    def add(self, quantity, value, unit):
        self.rows.append((quantity, f"{value:.6g}", unit))
        print(f"{quantity}: {value:.6g} {unit}", file=sys.stderr)


def measure_rows(table, scene, poses):
    seconds = {}
    for measures in (["distance"], ["minima"], ["overlap"], list(_pieces.MEASURES)):
        spec = {"measures": measures, "cutoff": CUTOFF, "threshold": THRESHOLD}
        _pieces.measure(scene, "P0", poses[:16], spec)
        seconds[len(measures) > 1] = best(lambda: _pieces.measure(scene, "P0", poses, spec), 3) / len(poses)
        table.add("row of all measures" if len(measures) > 1 else f"row of {measures[0]}", 1e6 * seconds[len(measures) > 1], "us")
    return seconds[True]


def measure_bytes(table, options, scene, poses):
    mesh = scene.mesh("P0")
    triangles = len(mesh.triangles)
    table.add("triangles of a part", triangles, "")
    table.add("mesh moved", len(_pieces.mesh_blob(mesh)) / triangles, "bytes a triangle")
    table.add("poses moved", len(_pieces.poses_blob(poses)) / len(poses), "bytes a pose")
    said = subprocess.run([sys.executable, __file__, "--memory", str(options.memory_triangles)], capture_output=True, text=True,
                          check=True).stdout.split()
    table.add("mesh and hierarchy in memory", int(said[0]) / int(said[1]), "bytes a triangle")
    return len(_pieces.mesh_blob(mesh)), int(said[0]) / int(said[1]) * triangles


def measure_pieces(table, folder, scene, poses):
    """(bytes, seconds) of a row and of a piece beyond its rows."""
    result = nearfit.sweep(scene, ["P0", "P1"], poses, workers=0, cutoff=CUTOFF, threshold=THRESHOLD, folder=folder / "bytes",
                           progress=False)
    written = sum(f.stat().st_size for f in (folder / "bytes" / "pieces").iterdir())
    table.add("row written", written / len(result), "bytes")
    seconds = best(lambda: _sweep_folder.write_file(folder / "piece", bytes(1 << 20)), 5)
    table.add("piece of 1 MiB written and synced", 1e3 * seconds, "ms")
    return written / len(result)


def measure_workers(table, options, folder, scene, poses):
    """Sweeps by one worker and by two take turns, so that whatever else happens meets both."""
    with contextlib.ExitStack() as started:
        clients = {}
        for workers in (1, 2):
            begin = time.perf_counter()
            clients[workers] = started.enter_context(_sweep.local_client(workers))
            table.add(f"start of {workers} worker{'s' if workers > 1 else ''}", time.perf_counter() - begin, "s")
        times, rows = sweep_times(options, folder, scene, poses, clients)
    table.add("rows of the sweeps below", rows, "")
    for workers, seconds in times.items():
        table.add(f"sweep by {workers} worker{'s' if workers > 1 else ''}, median", statistics.median(seconds), "s")
    table.add("two workers over one", statistics.median(a / b for a, b in zip(times[1], times[2])), "times as fast, median")


def sweep_times(options, folder, scene, poses, clients):
    """({workers: [s]}, number of rows)"""
    times, rows = {1: [], 2: []}, None
    # The first round is not counted: workers get the meshes in it.
    for turn in range(options.rounds + 1):
        for workers, client in clients.items():
            begin = time.perf_counter()
            result = nearfit.sweep(scene, scene.parts[:options.swept], poses, client, cutoff=CUTOFF, threshold=THRESHOLD,
                                   folder=folder / f"{workers}-{turn}", piece_seconds=options.piece_seconds, progress=False)
            if turn > 0:
                times[workers].append(time.perf_counter() - begin)
            table_of = result.table()
            if rows is not None and not table_of.equals(rows):
                sys.exit("sweep_cost: sweeps differ in their rows")
            rows = table_of
    return times, len(rows)


def measure_alone(queue, ready, parts, options):
    """In a process of its own: the rows of these parts, without a sweep. Puts the time that they take [s]."""
    scene, side = grid(options.parts, sphere(options.triangles))
    poses = poses_within(options.poses, side)
    spec = {"measures": list(_pieces.MEASURES), "cutoff": CUTOFF, "threshold": THRESHOLD}
    for part in parts:
        _pieces.measure(scene, part, poses[:16], spec)
    ready.wait()
    begin = time.perf_counter()
    for part in parts:
        _pieces.measure(scene, part, poses, spec)
    queue.put(time.perf_counter() - begin)


def measure_processors(table, options, parts):
    """How many times as fast two processes are as one that share the rows of the sweeps: what the machine allows."""
    context, times = multiprocessing.get_context("spawn"), {1: [], 2: []}
    for _ in range(options.rounds):
        for count in times:
            queue, ready = context.Queue(), context.Barrier(count)
            processes = [context.Process(target=measure_alone, args=(queue, ready, parts[i::count], options)) for i in range(count)]
            for process in processes:
                process.start()
            times[count].append(max(queue.get(timeout=300) for _ in processes))
            for process in processes:
                process.join()
    table.add("the same rows without a sweep, one process", statistics.median(times[1]), "s")
    table.add("two processes over one without a sweep", statistics.median(a / b for a, b in zip(times[1], times[2])),
              "times as fast, median")


def extrapolate(table, row_seconds, row_bytes, mesh_bytes, mesh_memory):
    rows = LARGE_PARTS * LARGE_POSES
    table.add("large: rows", rows, "")
    table.add("large: time of processors", rows * row_seconds / 3600, "h")
    table.add("large: pieces", max(rows * row_seconds / _sweep.PIECE_SECONDS, rows / _sweep.MAX_PIECE_ROWS), "")
    table.add("large: results", rows * row_bytes / 1e9, "GB")
    table.add("large: moved to each worker", (LARGE_PARTS * mesh_bytes + 128 * LARGE_POSES) / 1e9, "GB")
    table.add("large: memory of each worker", (LARGE_PARTS * mesh_memory + 128 * LARGE_POSES) / 1e9, "GB")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--out", type=pathlib.Path, help="table to write; default: to stdout")
    parser.add_argument("--parts", type=int, default=200, help="parts of the scene (%(default)s)")
    parser.add_argument("--swept", type=int, default=10, help="of these are swept (%(default)s)")
    parser.add_argument("--poses", type=int, default=2000, help="(%(default)s)")
    parser.add_argument("--triangles", type=int, default=5000, help="of a part (%(default)s)")
    parser.add_argument("--memory-triangles", type=int, default=200_000, help="of the mesh whose memory is measured (%(default)s)")
    parser.add_argument("--piece-seconds", type=float, default=0.5, help="of a sweep of seconds; 5 s suit hours (%(default)s)")
    parser.add_argument("--rounds", type=int, default=5, help="sweeps by one worker and by two (%(default)s)")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release", help="names the compiler (%(default)s)")
    parser.add_argument("--allow-busy", action="store_true", help="keep results though other programs are at work")
    parser.add_argument("--memory", type=int, help=argparse.SUPPRESS)
    return parser.parse_args()


def main():
    options = arguments()
    if options.memory is not None:
        print_memory(options.memory)
        return
    head = heads.head_or_exit("sweep_cost", options.out, ROOT, options.build, options.allow_busy)
    table = Table()
    scene, side = grid(options.parts, sphere(options.triangles))
    poses = poses_within(options.poses, side)
    table.add("parts of the scene", options.parts, "")
    table.add("cutoff", 1e3 * CUTOFF, "mm")
    row_seconds = measure_rows(table, scene, poses)
    mesh_bytes, mesh_memory = measure_bytes(table, options, scene, poses)
    with tempfile.TemporaryDirectory(prefix="sweep_cost.") as name:
        row_bytes = measure_pieces(table, pathlib.Path(name), scene, poses)
        measure_workers(table, options, pathlib.Path(name), scene, poses)
    measure_processors(table, options, scene.parts[:options.swept])
    extrapolate(table, row_seconds, row_bytes, mesh_bytes, mesh_memory)
    text = io.StringIO()
    text.write("".join(f"# {line}\n" for line in head))
    csv.writer(text, lineterminator="\n").writerows([("quantity", "value", "unit"), *table.rows])
    if options.out is None:
        sys.stdout.write(text.getvalue())
    else:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(text.getvalue())


if __name__ == "__main__":
    main()
