import functools
import os
import signal
import threading
import time

import numpy as np
import pytest

import nearfit
from conftest import box, matrix_of, octahedron, random_rows

COLUMNS = ("offsets", "distances", "points_moving", "points_fixed", "normals", "parts", "features", "regions", "blocked",
           "marginal", "complete")


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in COLUMNS)


def nearest_on_triangle(point, triangle):
    """Nearest point of a triangle: the foot on its plane if inside, else the best of three sides."""
    a, b, c = triangle
    normal = np.cross(b - a, c - a)
    foot = point - normal * np.dot(point - a, normal) / np.dot(normal, normal)
    if all(np.dot(np.cross(q - p, foot - p), normal) >= 0 for p, q in ((a, b), (b, c), (c, a))):
        return foot
    feet = []
    for p, q in ((a, b), (b, c), (c, a)):
        share = np.clip(np.dot(point - p, q - p) / np.dot(q - p, q - p), 0, 1)
        feet.append(p + share * (q - p))
    return min(feet, key=lambda foot: np.linalg.norm(point - foot))


def segment_distance(p, q, r, s):
    """Distance of two segments: of each end to the other, and of the lines where both feet are inside."""
    u, v, w = q - p, s - r, p - r
    ends = [np.linalg.norm(x - (a + np.clip(np.dot(x - a, d) / np.dot(d, d), 0, 1) * d))
            for x, a, d in ((p, r, v), (q, r, v), (r, p, u), (s, p, u))]
    normal = np.cross(u, v)
    square = np.dot(normal, normal)
    if square > 1e-24:
        at, on = np.dot(np.cross(v, w), normal) / square, np.dot(np.cross(u, w), normal) / square
        if 0 <= at <= 1 and 0 <= on <= 1:
            ends.append(abs(np.dot(w, normal)) / np.sqrt(square))
    return min(ends)


def brute_distance(fixed, moving):
    """Min distance of two meshes that are apart, of all pairs of features. Meshes: vertices, triangles."""
    least = np.inf
    for (vertices, _), (others, triangles) in ((fixed, moving), (moving, fixed)):
        for point in vertices:
            for face in triangles:
                least = min(least, np.linalg.norm(point - nearest_on_triangle(point, others[face])))
    sides = [{tuple(sorted((f[i], f[(i + 1) % 3]))) for f in t.tolist() for i in range(3)} for _, t in (fixed, moving)]
    for a, b in sides[0]:
        for c, d in sides[1]:
            least = min(least, segment_distance(fixed[0][a], fixed[0][b], moving[0][c], moving[0][d]))
    return least


def placed(vertices, row):
    matrix = matrix_of(row)
    return vertices @ matrix[:3, :3].T + matrix[:3, 3]


def test_least_distances_are_those_of_all_pairs_of_features(two_bodies):
    rows = random_rows(30, 7, 0.02, away=0.05)
    block, (tip, faces) = box((0.04, 0.03, 0.02)), octahedron(0.015)
    expected = [brute_distance(block, (placed(tip, row), faces)) for row in rows]
    found = nearfit.distance(two_bodies, "Tip", rows)
    assert found == pytest.approx(expected, rel=1e-9)
    minima = nearfit.lmds(two_bodies, "Tip", rows, 0.2)
    assert len(minima) == 30 and minima.complete.all()
    # The least of the minima of two solids is their distance.
    assert [minima[i].distances[0] for i in range(30)] == pytest.approx(expected, rel=1e-9)


def test_minima_end_on_both_surfaces_along_their_normals(two_bodies):
    rows = random_rows(20, 8, 0.02, away=0.05)
    block, (tip, faces) = box((0.04, 0.03, 0.02)), octahedron(0.015)
    found = nearfit.lmds(two_bodies, "Tip", rows, 0.2)
    assert len(found.distances) >= 20
    for i, row in enumerate(rows):
        one = found[i]
        moved = placed(tip, row)
        for distance, moving, fixed, normal in zip(one.distances, one.points_moving, one.points_fixed, one.normals):
            on_tip = min(np.linalg.norm(moving - nearest_on_triangle(moving, moved[f])) for f in faces)
            on_block = min(np.linalg.norm(fixed - nearest_on_triangle(fixed, block[0][f])) for f in block[1])
            assert max(on_tip, on_block) < 1e-12
            assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-12)
            assert moving - fixed == pytest.approx(distance * normal, abs=1e-9)


@pytest.mark.parametrize("mode", ["cold", "tracked"])
def test_numbers_are_those_of_the_command_line_to_the_last_bit(saved, cli, json_lines, tmp_path, mode):
    scene, _, block, tip = saved
    rows = random_rows(60, 9, 0.02, away=0.03)
    poses = tmp_path / "poses.csv"
    # repr() reads back as the same double.
    poses.write_text("".join(",".join(map(repr, row.tolist())) + "\n" for row in rows))
    lines = json_lines(cli("lmd", "--unit", "m", block, tip, "--cutoff", "0.03", "--poses", poses, "--mode", mode,
                           "--stiffness", "250"))
    found = nearfit.lmds(scene, "Tip", rows, 0.03, tracked=mode == "tracked")
    wrenches = nearfit.wrench(scene, "Tip", rows, 0.03, 250.0)
    overlaps = nearfit.overlap(scene, "Tip", rows)
    assert len(lines) == len(found) == 60
    assert sum(len(line["lmds"]) for line in lines) > 30
    for i, line in enumerate(lines):
        one = found[i]
        assert one.distances.tolist() == [m["distance"] for m in line["lmds"]]
        assert one.points_fixed.tolist() == [m["scene"] for m in line["lmds"]]
        assert one.points_moving.tolist() == [m["part"] for m in line["lmds"]]
        assert one.regions.tolist() == [m["region"] for m in line["lmds"]]
        assert one.blocked.tolist() == [m["blocked"] for m in line["lmds"]]
        assert [[("vertex", "edge", "face")[k] for k in pair] for pair in one.features] == [m["features"] for m in line["lmds"]]
        assert wrenches[i].tolist() == line["force"] + line["torque"]
        assert overlaps[i] == (line["overlap"] != "no")


def three_bodies():
    scene = nearfit.Scene()
    tip = nearfit.Mesh(*octahedron(0.015))
    scene.add(nearfit.Mesh(*box((0.04, 0.03, 0.02))), "Block", pose=(0.01, 0.002, 0, 0.5, 0.5, 0.5, 0.5))
    scene.add(tip, "Tip", pose=(0, 0, 0.2, 1, 0, 0, 0))
    scene.add(tip, "Other", pose=(0.05, 0, 0.01, 1, 0, 0, 0))
    return scene


def test_threads_and_tracking_change_no_bit():
    scene = three_bodies()
    rows = random_rows(600, 10, 0.03, away=0.03)
    one = nearfit.lmds(scene, "Tip", rows, 0.02, threads=1)
    assert len(one.distances) > 300 and set(one.parts) == {0, 1}
    assert one.part_names == ["Block", "Other"]
    for options in ({"threads": 2}, {"threads": 0}, {"tracked": True, "threads": 1}, {"tracked": True, "threads": 2}):
        assert same(nearfit.lmds(scene, "Tip", rows, 0.02, **options), one), options
    alone = [nearfit.lmds(scene, "Tip", row, 0.02) for row in rows[:40]]
    assert all(same(a, one[i]) for i, a in enumerate(alone))
    for ask in (lambda n: nearfit.distance(scene, "Tip", rows, threads=n), lambda n: nearfit.overlap(scene, "Tip", rows, threads=n),
                lambda n: nearfit.wrench(scene, "Tip", rows, 0.02, 100.0, threads=n)):
        assert ask(1).tobytes() == ask(2).tobytes() == ask(0).tobytes()


def test_minima_of_a_pose_are_nearest_first_and_index_like_a_list():
    scene = three_bodies()
    found = nearfit.lmds(scene, "Tip", random_rows(50, 11, 0.03, away=0.03), 0.05)
    for one in found:
        assert (np.diff(one.distances) >= 0).all()
    assert same(found[-1], found[49])
    assert not found.distances.flags.writeable
    with pytest.raises(IndexError):
        found[50]


def test_answers_follow_changes_of_the_scene():
    scene = three_bodies()
    scene.remove("Other")
    scene.set_pose("Block", np.eye(4))
    up = (0, 0, 0.035, 1, 0, 0, 0)
    # Its lowest corner is at 0.02, the block's top at 0.01.
    assert nearfit.distance(scene, "Tip", up)[0] == pytest.approx(0.01, rel=1e-9)
    scene.set_pose("Block", (0, 0, -0.01, 1, 0, 0, 0))
    assert nearfit.distance(scene, "Tip", up)[0] == pytest.approx(0.02, rel=1e-9)
    scene.show("Block", False)
    assert nearfit.distance(scene, "Tip", up)[0] == np.inf
    scene.show("Block")
    scene.set_pose("Tip", (1, 1, 1, 1, 0, 0, 0))
    assert nearfit.distance(scene, "Tip", up)[0] == pytest.approx(0.02, rel=1e-9)


def memory():
    """Bytes that the process has in memory."""
    with open("/proc/self/statm") as numbers:
        return int(numbers.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_asking_about_each_part_keeps_memory_bounded():
    scene, tip = nearfit.Scene(), nearfit.Mesh(*octahedron(0.5))
    for i in range(32):
        scene.add(tip, f"P{i}", pose=(3 * i, 0, 0, 1, 0, 0, 0))
    before, expected = None, [10.0 - 2 * 0.5]
    for i, name in enumerate(scene.parts):
        # Above a neighbour: corner over corner.
        above = (3 * (i + 1 if i < 31 else 30), 0, 10, 1, 0, 0, 0)
        assert nearfit.distance(scene, name, above, threads=1) == pytest.approx(expected, rel=1e-12)
        if i == 11:
            before = memory()
    # Queries of a part hold some 20 MB: of these twenty, 400 MB.
    assert memory() - before < 150e6


def test_queries_of_many_parts_by_turns_are_those_of_each_alone():
    def made():
        scene, tip = nearfit.Scene(), nearfit.Mesh(*octahedron(0.5))
        for i in range(8):
            scene.add(tip, f"P{i}", pose=(1.5 * i, 0.1 * i, 0, 1, 0, 0, 0))
        return scene

    rows = random_rows(5, 15, 3.0, away=0.5)
    alone = {f"P{i}": nearfit.lmds(made(), f"P{i}", rows, 2.0) for i in range(8)}
    scene = made()
    for i in np.random.default_rng(16).integers(0, 8, 60):
        found = nearfit.lmds(scene, f"P{i}", rows, 2.0)
        assert same(found, alone[f"P{i}"])
        assert found.part_names == [f"P{k}" for k in range(8) if k != i]


def test_overlap_is_exact_where_bodies_touch():
    scene = nearfit.Scene()
    cube = nearfit.Mesh(*box((1, 1, 1)))
    scene.add(cube, "Fixed")
    scene.add(cube, "Moving", pose=(0, 0, 9, 1, 0, 0, 0))
    above = np.nextafter(1.0, 2.0)
    rows = [(0, 0, z, 1, 0, 0, 0) for z in (1.0, above, 0.5, 0.0)]
    assert nearfit.overlap(scene, "Moving", rows).tolist() == [True, False, True, True]
    assert nearfit.distance(scene, "Moving", rows)[[0, 2]].tolist() == [0.0, 0.0]


def test_matrices_and_rows_are_the_same_poses():
    scene = three_bodies()
    rows = random_rows(20, 12, 0.03, away=0.04)
    matrices = np.array([matrix_of(row) for row in rows])
    assert nearfit.distance(scene, "Tip", matrices) == pytest.approx(nearfit.distance(scene, "Tip", rows), rel=1e-9)
    assert len(nearfit.lmds(scene, "Tip", np.empty((0, 7)), 0.02)) == 0


@pytest.mark.parametrize("poses, cutoff, words", [
    (np.zeros((2, 3)), 0.01, "their shape is"),
    ((np.nan, 0, 0, 1, 0, 0, 0), 0.01, "not finite"),
    ([(0, 0, 0, 1, 0, 0, 0), (0, 0, 0, 2, 0, 0, 0)], 0.01, "pose 1"),
    (2 * np.eye(4), 0.01, "does not turn and shift only"),
    (np.eye(4), 0.0, "cutoff: 0 is out of range"),
    (np.eye(4), np.inf, "cutoff"),
])
def test_invalid_input_is_refused(poses, cutoff, words):
    with pytest.raises(nearfit.Error) as error:
        nearfit.lmds(three_bodies(), "Tip", poses, cutoff)
    assert words in str(error.value)


def test_an_unknown_part_or_law_is_refused():
    scene = three_bodies()
    with pytest.raises(nearfit.Error, match='there is no part "Lid"'):
        nearfit.lmds(scene, "Lid", np.eye(4), 0.01)
    with pytest.raises(nearfit.Error, match="linear or printed"):
        nearfit.wrench(scene, "Tip", np.eye(4), 0.01, 1.0, law="cubic")


def test_a_thread_runs_while_a_batch_does():
    scene = three_bodies()
    rows = random_rows(20_000, 13, 0.03, away=0.03)
    nearfit.distance(scene, "Tip", rows[:1])
    started, counted, ended = threading.Event(), [], threading.Event()

    def count():
        started.set()
        while not ended.is_set():
            counted.append(None)
            time.sleep(0)

    thread = threading.Thread(target=count)
    thread.start()
    started.wait()
    before = len(counted)
    nearfit.lmds(scene, "Tip", rows, 0.05, threads=1)
    during = len(counted) - before
    ended.set()
    thread.join()
    # With the lock held it would not have counted once: the switch is at the call's ends alone.
    assert during > 10


def test_an_interrupt_ends_a_batch():
    scene = three_bodies()
    rows = np.tile(random_rows(20_000, 14, 0.03, away=0.03), (40, 1))
    timer = threading.Timer(0.3, signal.raise_signal, (signal.SIGINT,))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        nearfit.lmds(scene, "Tip", rows, 0.05)
    timer.join()
    assert len(nearfit.lmds(scene, "Tip", rows[:3], 0.05)) == 3


def ball(rings, radius, is_hollow=False):
    """A ball of 4 * rings * (rings - 1) triangles; of a hollow one the surface faces inside."""
    polar, around = np.pi * np.arange(1, rings) / rings, np.pi * np.arange(2 * rings) / rings
    corners = np.stack([np.outer(np.sin(polar), np.cos(around)), np.outer(np.sin(polar), np.sin(around)),
                        np.outer(np.cos(polar), np.ones_like(around))], axis=-1).reshape(-1, 3)
    vertices = radius * np.vstack([[[0, 0, 1]], corners, [[0, 0, -1]]])
    at = lambda ring, side: 1 + ring * 2 * rings + side % (2 * rings)
    faces = []
    for side in range(2 * rings):
        faces += [[0, at(0, side), at(0, side + 1)], [len(vertices) - 1, at(rings - 2, side + 1), at(rings - 2, side)]]
        for ring in range(rings - 2):
            a, b, c, d = at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1)
            faces += [[a, b, c], [a, c, d]]
    return vertices, np.array(faces)[:, ::-1] if is_hollow else np.array(faces)


def test_an_interrupt_ends_few_poses_of_large_meshes():
    outer, inner = ball(80, 1.2), ball(80, 1.0, is_hollow=True)
    scene = nearfit.Scene()
    scene.add(nearfit.Mesh(np.vstack([outer[0], inner[0]]), np.vstack([outer[1], inner[1] + len(outer[0])])), "Shell")
    scene.add(nearfit.Mesh(*ball(81, 0.98)), "Ball", pose=(0, 0, 5, 1, 0, 0, 0))
    rows = random_rows(31, 17, 1e-3)
    # Built now: the poses alone are to be interrupted.
    nearfit.distance(scene, "Ball", rows[:1] + [0, 0, 5, 0, 0, 0, 0])
    finished, entered = [], threading.Event()

    class Poses:
        """Looked at within the call."""

        def __array__(self, *_, **__):
            entered.set()
            return rows

    def interrupt():
        entered.wait()
        signal.raise_signal(signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        # No line of Python runs between the end of a call and that of extend(): a call that ran to its end leaves its result.
        finished.extend(map(functools.partial(nearfit.lmds, scene, "Ball", threads=1), [Poses()], [0.2]))
    thread.join()
    assert finished == []
