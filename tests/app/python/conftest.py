"""Fixtures of the tests of the Python package. NEARFIT_CLI names the nearfit-cli of the same sources."""

import json
import os
import subprocess

import numpy as np
import pytest

import nearfit


def box(size, centre=(0.0, 0.0, 0.0)):
    """Vertices (8, 3) [m] and triangles (12, 3) of a box, outside out."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    triangles = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                          [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    return corners * np.asarray(size) + np.asarray(centre), triangles


def octahedron(radius):
    """A body with vertices, edges and faces in all directions."""
    vertices = radius * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    triangles = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    return vertices, triangles


def random_rows(count, seed, spread, away=0.0):
    """Poses as rows (count, 7): turned at will, `away` above the origin give or take the spread."""
    random = np.random.default_rng(seed)
    turns = random.normal(size=(count, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    return np.hstack([random.uniform(-spread, spread, (count, 3)) + [0, 0, away], turns])


def matrix_of(row):
    """(4, 4) of a row (7,): the formula of the textbooks, by hand."""
    x, y, z, w, i, j, k = row
    matrix = np.eye(4)
    matrix[:3, :3] = [[1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w)],
                      [2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w)],
                      [2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j)]]
    matrix[:3, 3] = [x, y, z]
    return matrix


@pytest.fixture
def cli():
    """Runs nearfit-cli with arguments and returns what it prints; the exit code must be among `codes`."""
    program = os.environ.get("NEARFIT_CLI", "")
    assert os.access(program, os.X_OK), "NEARFIT_CLI must name the nearfit-cli to compare with"

    def run(*arguments, codes=(0,)):
        said = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=120)
        assert said.returncode in codes, said.stderr
        return said
    return run


@pytest.fixture
def json_lines():
    return lambda said: [json.loads(line) for line in said.stdout.splitlines()]


@pytest.fixture
def two_bodies():
    """A scene of a box at the origin and an octahedron that moves, with their file names for the command line."""
    scene = nearfit.Scene()
    scene.add(nearfit.Mesh(*box((0.04, 0.03, 0.02))), "Block")
    scene.add(nearfit.Mesh(*octahedron(0.015)), "Tip", pose=(0, 0, 0.2, 1, 0, 0, 0))
    return scene


@pytest.fixture
def saved(two_bodies, tmp_path):
    """The same, saved: the scene read again, its file, and the files of block and tip."""
    file = tmp_path / "fit.nearfit"
    two_bodies.save(file)
    scene = nearfit.Scene.open(file)
    return scene, file, scene.mesh("Block").file, scene.mesh("Tip").file
