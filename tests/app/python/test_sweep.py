"""Sweeps: the same rows whatever computes them, and folders that are believed in nothing."""

import csv
import json
import logging
import os
import pathlib
import shutil
import signal
import subprocess
import sys

import distributed
import numpy as np
import pyarrow.parquet as pq
import pytest

import nearfit
from nearfit import _pieces, _sweep, _sweep_folder

CUTOFF, THRESHOLD = 1.5, 0.75
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 4, 5], [0, 5, 1],
                  [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])


def box(half):
    """A cube about the origin, of 12 triangles."""
    return nearfit.Mesh(half * CORNERS, FACES)


def moved(places):
    poses = np.tile(np.eye(4), (len(places), 1, 1))
    poses[:, :3, 3] = places
    return poses


def grid_scene(count):
    """Cubes of edge 1 m, 3 m apart in rows of 14, of five meshes that differ a little, and the width of the grid."""
    scene, meshes = nearfit.Scene(), [box(0.5 + 0.01 * i) for i in range(5)]
    for i in range(count):
        scene.add(meshes[i % 5], name=f"P{i}", pose=moved([[3 * (i % 14), 3 * (i // 14), 0]])[0])
    return scene


def random_poses(count, seed=1):
    """Rotated and moved through the lower rows of the grid: some near, some far, some in a cube."""
    random = np.random.default_rng(seed)
    poses = moved(random.uniform((-2, -2, -2), (16, 8, 2), (count, 3)))
    poses[:, :3, :3] = [np.linalg.qr(m)[0] for m in random.normal(size=(count, 3, 3))]
    poses[:, :3, 0] *= np.linalg.det(poses[:, :3, :3])[:, None]
    return poses


def run(scene, parts, poses, folder, client=None, **options):
    options = {"cutoff": CUTOFF, "threshold": THRESHOLD, "progress": False, **options}
    if client is None:
        options.setdefault("workers", 0)
    return nearfit.sweep(scene, parts, poses, client, folder=folder, **options)


@pytest.fixture(scope="module")
def cluster_client():
    # Starting its processes takes longer than the tests.
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1",
                                  silence_logs=logging.CRITICAL) as cluster, distributed.Client(cluster) as found:
        yield found


@pytest.fixture
def client(cluster_client):
    # One that was killed is started anew.
    cluster_client.wait_for_workers(2, timeout=60)
    return cluster_client


def same(one, other):
    """Equal to the last bit, signs of zeros included."""
    one, other = one.arrays(), other.arrays()
    assert one.keys() == other.keys()
    for name, values in one.items():
        theirs = other[name]
        if values.dtype == float:
            values, theirs = values.view(np.int64), theirs.view(np.int64)
        assert np.array_equal(values, theirs), name
    return True


def test_distances_minima_and_overlaps_are_those_of_cubes(tmp_path):
    scene = nearfit.Scene()
    scene.add(box(0.5), name="Fixed")
    scene.add(box(0.5), name="Moving", pose=moved([[9, 9, 9]])[0])
    places = np.array([[1.25, 0, 0], [0, -1.5, 0], [1.5, 1.5, 1.5], [0.75, 0.25, 0], [4, 0, 0], [1.375, 1.375, 0.125]])
    rows = run(scene, "Moving", moved(places), tmp_path / "out").arrays()
    gaps = np.linalg.norm(np.maximum(np.abs(places) - 1, 0), axis=1)
    expected = np.where(gaps > CUTOFF, np.inf, gaps)
    assert rows["distance"] == pytest.approx(expected, abs=1e-12)
    assert rows["overlap"].tolist() == (gaps == 0).tolist()
    # Minima tell nothing about bodies that overlap.
    apart = gaps > 0
    assert (rows["minima"] > 0)[apart].tolist() == (gaps < THRESHOLD)[apart].tolist()
    assert rows["pose"].tolist() == list(range(6)) and set(rows["part"]) == {"Moving"}


def test_a_hidden_part_is_in_nobodys_way_and_rows_are_those_of_the_scene_itself(tmp_path):
    scene, poses = grid_scene(9), random_poses(60, 3)
    scene.show("P2", False)
    rows = run(scene, ["P0", "P2"], poses, tmp_path / "out").arrays()
    for i, part in enumerate(["P0", "P2"]):
        own = slice(60 * i, 60 * (i + 1))
        assert np.array_equal(rows["distance"][own], nearfit.distance(scene, part, poses, cutoff=CUTOFF))
        assert np.array_equal(rows["overlap"][own], nearfit.overlap(scene, part, poses))
        found = nearfit.lmds(scene, part, poses, CUTOFF)
        assert rows["minima"][own].tolist() == [int((found[k].distances < THRESHOLD).sum()) for k in range(60)]


def test_a_variant_has_the_mesh_that_it_names(tmp_path):
    scene = nearfit.Scene()
    scene.add(box(0.5), name="Fixed")
    scene.add(box(0.5), name="Moving")
    variants = {"small": {}, "large": {"Fixed": box(0.75)}, "both": {"Fixed": box(0.75), "Moving": box(0.625)}}
    rows = run(scene, ["Moving"], moved([[2, 0, 0]]), tmp_path / "out", variants=variants).arrays()
    assert rows["variant"].tolist() == ["small", "large", "both"]
    assert rows["distance"] == pytest.approx([1.0, 0.75, 0.625], abs=1e-12)


def test_tolerances_move_parts_by_seed_within_their_size(tmp_path):
    scene = nearfit.Scene()
    scene.add(box(0.5), name="Fixed")
    scene.add(box(0.5), name="Moving")

    def distances(folder, seed):
        options = {"tolerances": {"Fixed": 0.01, "Moving": 0.02}, "draws": 40, "seed": seed, "measures": "distance"}
        return run(scene, ["Moving"], moved([[2, 0, 0]]), tmp_path / folder, **options).arrays()["distance"]

    first = distances("a", 7)
    # Between two cubes side by side only the shift along x counts.
    assert np.all(np.abs(first - 1) <= 0.03) and np.ptp(first) > 0.02 and len(set(first)) == 40
    assert np.array_equal(first, distances("b", 7)) and not np.array_equal(first, distances("c", 8))


@pytest.mark.parametrize("parts, poses", [(20, 100), pytest.param(200, 2000, marks=pytest.mark.full)])
def test_many_processes_of_which_one_is_killed_have_the_rows_of_one(tmp_path, client, parts, poses):
    scene, placed = grid_scene(parts), random_poses(poses)
    alone = run(scene, scene.parts, placed, tmp_path / "alone")
    killed = []

    def kill_one(done, total):
        if done > total / 3 and not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    many = run(scene, scene.parts, placed, tmp_path / "many", client, piece_poses=parts * poses // 50, progress=kill_one)
    assert killed and len(many) == parts * poses and len(many.pieces) >= 50 > len(alone.pieces)
    rows = alone.arrays()
    assert rows["overlap"].any() and np.isinf(rows["distance"]).any() and (rows["minima"] > 0).any()
    assert same(alone, many) and same(alone, nearfit.open_sweep(tmp_path / "many"))


def test_a_worker_gets_each_input_once(tmp_path, client, monkeypatch):
    sent = []

    def recorded(function, *arguments, real=client.run, **options):
        if function is _pieces.deliver:
            sent.extend((worker, name) for worker in options["workers"] for name in arguments[0])
        return real(function, *arguments, **options)

    monkeypatch.setattr(client, "run", recorded)
    scene = nearfit.Scene()
    # Meshes that no other test has: workers keep what they got.
    meshes = [box(0.25 + 0.01 * i) for i in range(5)]
    for i in range(15):
        scene.add(meshes[i % 5], name=f"P{i}", pose=moved([[3 * i, 0, 0]])[0])
    run(scene, scene.parts, random_poses(40, 2), tmp_path / "out", client, piece_poses=20)
    # Five meshes for fifteen parts, the poses and the specification.
    assert len(set(sent)) == len(sent) and {len([w for w, _ in sent if w == worker]) for worker, _ in sent} == {7}


def _hang(release):
    """Runs on a worker: from now on what it measures waits for a file."""
    import time

    from nearfit import _pieces

    def waiting(*arguments, real=_pieces.measure):
        while not os.path.exists(release):
            time.sleep(0.01)
        return real(*arguments)

    _pieces.measure = waiting


def test_a_worker_that_hangs_holds_up_nobody(tmp_path, client, monkeypatch):
    monkeypatch.setattr(_sweep, "MIN_LATE_SECONDS", 0.2)
    scene, poses, release = grid_scene(6), random_poses(50), tmp_path / "release"
    client.run(_hang, str(release), workers=[next(iter(client.nthreads()))])
    try:
        many = run(scene, scene.parts, poses, tmp_path / "many", client, piece_poses=10, piece_seconds=0.03)
        assert not release.exists()
    finally:
        release.touch()
    assert same(many, run(scene, scene.parts, poses, tmp_path / "alone"))


def test_a_slow_piece_ends_in_time_and_leaves_its_rest_to_others():
    scene = grid_scene(2)
    inputs = _sweep._Inputs(scene, ["P0"], random_poses(1000), None, None, 1, 0, ["overlap"], CUTOFF, THRESHOLD)
    store = _pieces.Store()
    store.put(inputs.blobs, 1 << 30)
    # Each look at the clock finds a second gone.
    ticks = iter(range(10**6))
    answer = _pieces.compute(inputs.sweep, 100, 1000, 5.0, store, clock=lambda: float(next(ticks)))
    assert 100 + _pieces.FIRST_BATCH <= answer["end"] <= 100 + 5 * _pieces.FIRST_BATCH


def test_a_store_keeps_to_its_bytes_and_takes_nothing_damaged():
    blobs = [_pieces.poses_blob(random_poses(10, seed)) for seed in range(5)]
    store = _pieces.Store()
    for blob in blobs:
        store.put({_pieces.digest(blob): ("poses", blob)}, 3 * len(blobs[0]))
        assert store.bytes() <= 3 * len(blobs[0])
    assert store.lacks([_pieces.digest(b) for b in blobs]) == [_pieces.digest(b) for b in blobs[:2]]
    with pytest.raises(nearfit.Error, match="damaged"):
        store.put({_pieces.digest(blobs[0]): ("poses", blobs[1])}, 1 << 20)
    with pytest.raises(_pieces.Forgotten):
        store.get(_pieces.digest(blobs[0]))
    assert np.array_equal(store.get(_pieces.digest(blobs[4])), random_poses(10, 4))


def test_bytes_of_a_store_are_those_of_what_it_keeps():
    blobs = {_pieces.digest(blob): ("poses", blob) for blob in (_pieces.poses_blob(random_poses(n + 1, n)) for n in range(9))}
    store = _pieces.Store()
    # Again and again, in another order, with what is there already, and making some of them poses.
    for i, limit in enumerate((1 << 20, 4000, 1 << 20, 3000, 5000, 2000)):
        names = np.random.default_rng(i).permutation(list(blobs))[:4]
        store.put({name: blobs[name] for name in names}, limit)
        store.get(names[0])
        kept = set(blobs) - set(store.lacks(list(blobs)))
        assert kept >= set(names) and store.bytes() == sum(len(blobs[name][1]) for name in kept)
    assert len(kept) < len(blobs)


def test_meshes_that_no_worker_could_keep_are_refused(tmp_path):
    with pytest.raises(nearfit.Error, match="store_bytes"):
        run(grid_scene(3), "P0", random_poses(100), tmp_path / "out", store_bytes=1000)


def test_inputs_that_drive_each_other_out_still_get_their_turn(tmp_path, client):
    scene, poses = grid_scene(3), random_poses(20, 4)
    variants = {str(i): {"P1": box(0.3 + 0.01 * i), "P2": box(0.4 + 0.01 * i)} for i in range(6)}
    inputs = _sweep._Inputs(scene, ["P0"], poses, variants, None, 1, 0, ["distance"], CUTOFF, THRESHOLD)
    room = sum(len(blob) for _, blob in inputs.needed(0).values())
    options = {"variants": variants, "measures": "distance", "piece_poses": 5}
    many = run(scene, "P0", poses, tmp_path / "many", client, store_bytes=room, **options)
    assert same(many, run(scene, "P0", poses, tmp_path / "alone", **options))


def test_variants_that_together_exceed_the_store_are_swept_here_too(tmp_path, monkeypatch):
    # Giving a piece what it lacked alone drove out its other inputs, endlessly.
    scene = nearfit.Scene()
    scene.add(box(0.5), name="Fixed")
    scene.add(box(0.5), name="Moving", pose=moved([[9, 9, 9]])[0])
    halves = [(0.25 + 0.125 * i, 0.3125 + 0.125 * i) for i in range(3)]
    variants = {str(i): {"Fixed": box(fixed), "Moving": box(moving)} for i, (fixed, moving) in enumerate(halves)}
    poses = moved([[1.5, 0, 0]])
    inputs = _sweep._Inputs(scene, ["Moving"], poses, variants, None, 1, 0, ["distance"], CUTOFF, THRESHOLD)
    needed = inputs.needed(0).values()
    room = sum(len(blob) for _, blob in needed) + int(1.4 * max(len(blob) for kind, blob in needed if kind == "mesh"))
    calls = []

    def counted(*arguments, real=_pieces.compute):
        calls.append(arguments)
        assert len(calls) < 20, "pieces lack inputs again and again"
        return real(*arguments)

    monkeypatch.setattr(_pieces, "compute", counted)
    rows = run(scene, "Moving", poses, tmp_path / "out", variants=variants, measures="distance", store_bytes=room).arrays()
    assert rows["distance"] == pytest.approx([1.5 - fixed - moving for fixed, moving in halves], abs=1e-12)


def test_parts_of_one_mesh_are_packed_once(monkeypatch):
    blobs = []

    def counted(mesh, real=_pieces.mesh_blob):
        blobs.append(mesh)
        return real(mesh)

    monkeypatch.setattr(_pieces, "mesh_blob", counted)
    inputs = _sweep._Inputs(grid_scene(15), ["P0"], random_poses(3), None, None, 1, 0, ["overlap"], CUTOFF, THRESHOLD)
    assert len(blobs) == 5 and len({mesh for _, mesh, *_ in inputs.spec["scene"]}) == 5


def test_making_a_sweep_ready_asks_no_query(monkeypatch):
    # A query builds the hierarchies of the whole scene in the caller.
    def asked(*_, **__):
        raise AssertionError("a query was asked")

    scene = grid_scene(6)
    scene.show("P4", False)
    for name in ("lmds", "distance", "overlap", "wrench", "clearance"):
        monkeypatch.setattr(nearfit, name, asked)
    inputs = _sweep._Inputs(scene, ["P0"], random_poses(3), None, None, 1, 0, ["overlap"], CUTOFF, THRESHOLD)
    assert [(name, is_visible) for name, *_, is_visible in inputs.spec["scene"]] == [(f"P{i}", i != 4) for i in range(6)]


def bowl(rings, sides):
    """A bowl of 0.2 m walls whose hollow has a radius of 1 m, open above, of many small faces: minima and flat regions."""
    angles = np.concatenate((np.linspace(0.02, np.pi / 2, rings), np.linspace(np.pi / 2, 0.02, rings)))
    radii = np.repeat([1.0, 1.2], rings)
    around = 2 * np.pi * np.arange(sides) / sides
    corners = np.stack([np.outer(radii * np.sin(angles), np.cos(around)), np.outer(radii * np.sin(angles), np.sin(around)),
                        np.repeat(-radii * np.cos(angles), sides).reshape(-1, sides)], axis=-1).reshape(-1, 3)
    faces = []
    for ring in range(2 * rings):
        for side in range(sides):
            a, b = ring * sides + side, ring * sides + (side + 1) % sides
            c, d = (np.array([a, b]) + sides) % len(corners)
            faces += [[a, c, b], [b, c, d]]
    return nearfit.Mesh(corners, faces)


def counts_below(scene, part, poses, threshold):
    """Minima below a threshold of all within the cutoff, counted pose by pose."""
    found = nearfit.lmds(scene, part, poses, CUTOFF)
    return [int((found[k].distances < threshold).sum()) for k in range(len(poses))]


@pytest.mark.parametrize("threshold", [0.0, 1e-7, 0.02, 0.1, 0.25, CUTOFF])
def test_minima_are_searched_no_farther_than_their_number_needs(tmp_path, monkeypatch, threshold):
    scene = grid_scene(9)
    scene.add(bowl(10, 24), name="Bowl", pose=moved([[3, 3, -2]])[0])
    # Face over face of P1 at the threshold, to the last bits: a flat region.
    plates = moved([[3, 0, 1.01 + (threshold or 0.1) * factor] for factor in (0.5, 1 - 1e-12, 1, 1 + 1e-12, 1.5, 2, 2 + 1e-12)])
    poses = np.concatenate((random_poses(60, 5), plates, moved(np.random.default_rng(6).uniform(-0.3, 0.3, (20, 3)) + [3, 3, -2])))
    expected = counts_below(scene, "P0", poses, threshold)
    assert (sum(expected) > 5) == (threshold > 1e-6)
    reached = []

    def asked(scene, part, poses, cutoff, real=nearfit.lmds, **options):
        reached.append(cutoff)
        return real(scene, part, poses, cutoff, **options)

    monkeypatch.setattr(nearfit, "lmds", asked)
    rows = run(scene, "P0", poses, tmp_path / "out", measures="minima", threshold=threshold).arrays()
    assert rows["minima"].tolist() == expected
    assert set(reached) == {min(CUTOFF, 2 * threshold) or CUTOFF}


class Stop(Exception):
    pass


def stopped_sweep(folder, scene, poses):
    """A sweep in pieces of 20 rows that was stopped behind the middle; returns the rows that it has."""
    def stop(done, total):
        if done > total / 2:
            raise Stop

    with pytest.raises(Stop):
        run(scene, scene.parts, poses, folder, piece_poses=20, progress=stop)
    return sum(end - begin for begin, end in map(_sweep_folder.range_of, os.listdir(folder / "pieces")))


@pytest.fixture
def computed(monkeypatch):
    """Ranges of rows that this process computes."""
    ranges = []

    def counted(sweep, begin, *arguments, real=_pieces.compute):
        answer = real(sweep, begin, *arguments)
        if "end" in answer:
            ranges.append((begin, answer["end"]))
        return answer

    monkeypatch.setattr(_pieces, "compute", counted)
    return ranges


def test_a_stopped_sweep_goes_on_where_it_stopped(tmp_path, computed):
    scene, poses = grid_scene(6), random_poses(50)
    there = stopped_sweep(tmp_path / "out", scene, poses)
    assert 150 < there < 300
    with pytest.raises(nearfit.Error, match=f"{300 - there} of 300 rows are missing"):
        nearfit.open_sweep(tmp_path / "out")
    computed.clear()
    resumed = run(scene, scene.parts, poses, tmp_path / "out")
    assert sum(end - begin for begin, end in computed) == 300 - there
    computed.clear()
    assert same(resumed, run(scene, scene.parts, poses, tmp_path / "out")) and computed == []
    assert same(resumed, run(scene, scene.parts, poses, tmp_path / "anew"))


def test_a_changed_input_is_refused_with_what_differs(tmp_path):
    scene, poses = grid_scene(4), random_poses(10)
    run(scene, ["P0", "P1"], poses, tmp_path / "out", tolerances={"P0": 0.5})
    before = sorted(os.listdir(tmp_path / "out" / "pieces"))

    def refused(match, scene=scene, parts=("P0", "P1"), poses=poses, **options):
        options = {"tolerances": {"P0": 0.5}, **options}
        with pytest.raises(nearfit.Error, match=match) as raised:
            run(scene, list(parts), poses, tmp_path / "out", **options)
        assert "belongs to another sweep" in str(raised.value) and "choose another folder" in str(raised.value)

    refused("threshold was 0.75 and is 0.5", threshold=0.5)
    refused("cutoff", cutoff=2.0)
    refused("seed was 0 and is 3", seed=3)
    refused("tolerances.P0 was 0.5 and is 0.25", tolerances={"P0": 0.25})
    refused("parts", parts=["P1", "P0"])
    refused("measures", measures=["overlap"])
    changed = poses.copy()
    changed[9, 0, 3] = np.nextafter(changed[9, 0, 3], 99)
    refused("poses", poses=changed)
    refused("variants", variants={"nominal": {"P2": box(0.25)}})
    other = grid_scene(4)
    other.set_pose("P3", moved([[1, 2, 3]])[0])
    refused(r"scene\[P3\]", scene=other)
    refused("scene", scene=grid_scene(5))
    assert sorted(os.listdir(tmp_path / "out" / "pieces")) == before


def test_what_is_not_whole_or_of_another_sweep_is_computed_anew(tmp_path, computed, capsys):
    scene, poses = grid_scene(3), random_poses(40)
    good = run(scene, scene.parts, poses, tmp_path / "out", piece_poses=20)
    rows = good.arrays()
    other = run(scene, scene.parts, poses, tmp_path / "other", piece_poses=20, threshold=0.5)
    folder = tmp_path / "out" / "pieces"
    half, flipped, foreign, linked, cut, bomb = (folder / _sweep_folder.piece_name(*piece) for piece in good.pieces)
    half.write_bytes(half.read_bytes()[:200])
    data = bytearray(flipped.read_bytes())
    data[60] ^= 1
    flipped.write_bytes(data)
    foreign.write_bytes((tmp_path / "other" / "pieces" / foreign.name).read_bytes())
    aside = tmp_path / "aside"
    linked.rename(aside)
    linked.symlink_to(aside)
    cut.write_bytes(b"")
    table = pq.read_table(bomb)
    pq.write_table(table.slice(0, 10), bomb)
    (folder / ".writing-1-x.parquet").write_bytes(b"half")
    (folder / _sweep_folder.piece_name(0, 10**14)).write_bytes(b"PAR1")
    (folder / "notes.txt").write_text("mine")
    with pytest.raises(nearfit.Error, match="run the sweep again"):
        nearfit.open_sweep(tmp_path / "out")
    computed.clear()
    again = run(scene, scene.parts, poses, tmp_path / "out", piece_poses=20, progress=True)
    assert sum(end - begin for begin, end in computed) == 120
    assert "computed anew" in capsys.readouterr().err
    assert sorted(os.listdir(folder)) == sorted([*(_sweep_folder.piece_name(*piece) for piece in again.pieces), "notes.txt"])
    for name, values in again.arrays().items():
        assert np.array_equal(values, rows[name])
    assert len(other) == 120 and aside.exists()


NAME_FILES = {"a dictionary": {"use_dictionary": ["variant", "part"]}, "plain": {"use_dictionary": False},
              "prefixes": {"use_dictionary": False, "column_encoding": {"part": "DELTA_BYTE_ARRAY"}}}


@pytest.mark.parametrize("kind", NAME_FILES)
def test_a_long_name_in_each_row_is_refused_before_it_is_unpacked(tmp_path, kind):
    import pyarrow as pa

    scene, count = grid_scene(2), 2000
    good = run(scene, "P0", random_poses(count), tmp_path / "out", measures="overlap", piece_poses=count)
    (piece,) = good.pieces
    path = tmp_path / "out" / "pieces" / _sweep_folder.piece_name(*piece)
    table = pq.read_table(path)
    long = pa.array(["n" * 20000] * count)
    pq.write_table(table.set_column(table.schema.names.index("part"), table.schema.field("part"), long), path, compression="zstd",
                   **NAME_FILES[kind])
    assert path.stat().st_size < 1 << 20
    # A pool of its own, since a pool's peak never falls.
    usual, pool = pa.default_memory_pool(), pa.proxy_memory_pool(pa.default_memory_pool())
    pa.set_memory_pool(pool)
    try:
        with _sweep_folder.SweepFolder(tmp_path / "out", nearfit.Error) as folder:
            with pytest.raises(ValueError, match="column part|cannot be read"):
                folder.read_piece(good.sweep, good.spec, *piece)
    finally:
        pa.set_memory_pool(usual)
    # Pages of the file unpacked, but not a name for each row.
    assert 0 < pool.max_memory() < 20000 * count


def test_no_piece_has_more_rows_than_memory_holds(tmp_path, monkeypatch):
    monkeypatch.setattr(_sweep, "MAX_PIECE_ROWS", 30)
    monkeypatch.setattr(_pieces, "MAX_PIECE_ROWS", 30)
    good = run(grid_scene(2), "P0", random_poses(100), tmp_path / "out", piece_poses=1000)
    assert len(good) == 100 and max(end - begin for begin, end in good.pieces) == 30
    monkeypatch.setattr(_pieces, "MAX_PIECE_ROWS", 29)
    with pytest.raises(nearfit.Error, match="30 rows, more than a piece can have"):
        nearfit.open_sweep(tmp_path / "out")


def test_a_folder_in_the_place_of_a_piece_is_told(tmp_path):
    scene, poses = grid_scene(2), random_poses(5)
    (piece,) = run(scene, "P0", poses, tmp_path / "out").pieces
    path = tmp_path / "out" / "pieces" / _sweep_folder.piece_name(*piece)
    path.unlink()
    path.mkdir()
    (path.parent / ".writing-1-x").mkdir()
    with pytest.raises(nearfit.Error, match="cannot be removed: Is a directory; remove it"):
        run(scene, "P0", poses, tmp_path / "out")
    path.rmdir()
    assert len(run(scene, "P0", poses, tmp_path / "out")) == 5


def test_a_manifest_that_was_changed_is_refused(tmp_path):
    scene, poses = grid_scene(2), random_poses(5)
    run(scene, "P0", poses, tmp_path / "out")
    path = tmp_path / "out" / "manifest.json"
    whole = json.loads(path.read_text())

    def refused(text):
        path.write_text(text)
        with pytest.raises(nearfit.Error, match="manifest.json"):
            nearfit.open_sweep(tmp_path / "out")
        with pytest.raises(nearfit.Error, match="manifest.json"):
            run(scene, "P0", poses, tmp_path / "out")

    refused("")
    refused("[" * 100000)
    refused("[]")
    refused('{"nearfit_sweep": 1}')
    refused(json.dumps({**whole, "nearfit_sweep": 2}))
    refused(json.dumps({**whole, "spec": {**whole["spec"], "count": 10**12}}))
    for spec in (None, [], {}, {**whole["spec"], "parts": []}, {**whole["spec"], "parts": ["P" * 2000]},
                 {**whole["spec"], "draws": "1"}):
        refused(json.dumps({**whole, "spec": spec, "sweep": _pieces.digest(_pieces.canonical(spec))}))
    path.unlink()
    with pytest.raises(nearfit.Error, match="no manifest.json"):
        run(scene, "P0", poses, tmp_path / "out")


def test_a_file_is_written_whole_or_not_at_all(tmp_path, monkeypatch):
    _sweep_folder.write_file(tmp_path / "file", b"old")

    def fail(*_):
        raise OSError(28, "No space left on device")

    for call in ("fsync", "rename"):
        with monkeypatch.context() as patch:
            patch.setattr(os, call, fail)
            with pytest.raises(OSError):
                _sweep_folder.write_file(tmp_path / "file", b"new")
        assert os.listdir(tmp_path) == ["file"] and (tmp_path / "file").read_bytes() == b"old"


def test_two_sweeps_do_not_write_to_one_folder(tmp_path):
    scene, poses, told = grid_scene(2), random_poses(5), []

    def second(*_):
        if not told:
            with pytest.raises(nearfit.Error, match="another sweep writes there") as raised:
                run(scene, "P0", poses, tmp_path / "out")
            told.append(raised)

    run(scene, "P0", poses, tmp_path / "out", progress=second)
    assert told


@pytest.mark.parametrize("options, match", [
    ({"parts": []}, "at least one part"), ({"parts": ["P0", "P0"]}, "twice"), ({"parts": ["None"]}, "no part \"None\""),
    ({"cutoff": 0}, "cutoff"), ({"cutoff": float("nan")}, "cutoff"), ({"threshold": -1}, "threshold"),
    ({"threshold": 2.0}, "more than the cutoff"), ({"measures": ["depth"]}, "measures"), ({"measures": []}, "measures"),
    ({"draws": 2}, "without tolerances"), ({"tolerances": {"None": 1}}, "no part"), ({"tolerances": {"P0": -1}}, "tolerance of P0"),
    ({"tolerances": {"P0": 1}, "draws": 0}, "draws"), ({"poses": np.zeros((3, 6))}, r"\(k, 4, 4\)"),
    ({"poses": np.zeros((0, 4, 4))}, "at least one pose"), ({"poses": np.zeros((1, 4, 4))}, "pose 0 is no rigid transform"),
    ({"poses": [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 2, 0, 0, 0]]}, "pose 1 is no rigid transform"),
    ({"poses": [[0, 0, 0, 1.0015, 0, 0, 0]]}, "pose 0 is no rigid transform"),
    ({"poses": moved([[0, 0, 0], [0, 0, 2e9]])}, "pose 1 is no rigid transform"), ({"variants": {"v" * 2000: {}}}, "1024 bytes"),
    ({"variants": {"\udcff": {}}}, "UTF-8"),
    ({"poses": {"P1": np.eye(4)[None]}}, "each of the parts"), ({"variants": {}}, "variants"),
    ({"variants": {"v": {"None": None}}}, "no part"), ({"piece_poses": 0}, "piece_poses"), ({"piece_seconds": 0}, "piece_seconds"),
    ({"workers": -1}, "workers")])
def test_what_makes_no_sense_is_told_before_anything_is_written(tmp_path, options, match):
    options = {"parts": ["P0"], "poses": random_poses(3), **options}
    with pytest.raises(nearfit.Error, match=match):
        run(grid_scene(2), options.pop("parts"), options.pop("poses"), tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


def write_scene(folder):
    lines = [f"v {x} {y} {z}" for x, y, z in 0.5 * CORNERS] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in FACES]
    (folder / "cube.obj").write_text("\n".join(lines) + "\n")
    scene = nearfit.Scene()
    mesh = nearfit.read_mesh(str(folder / "cube.obj"), unit="m")
    scene.add(mesh, name="Fixed")
    scene.add(mesh, name="Moving", pose=moved([[3, 0, 0]])[0])
    scene.save(str(folder / "cubes.nearfit"))
    return str(folder / "cubes.nearfit")


def main(*arguments):
    return subprocess.run([sys.executable, "-m", "nearfit.sweep", *map(str, arguments)], capture_output=True, text=True, timeout=120)


def test_the_module_sweeps_a_scene_file(tmp_path):
    scene = write_scene(tmp_path)
    (tmp_path / "poses.csv").write_text("# cubes\ntx,ty,tz,qw,qx,qy,qz\n1.25,0,0,1,0,0,0\n\n0,1.5,0,0,0,0,1\n0.5,0,0,1,0,0,0\n")
    np.save(tmp_path / "poses.npy", moved([[1.25, 0, 0], [0, 1.5, 0], [0.5, 0, 0]]))
    (tmp_path / "link.csv").symlink_to("poses.csv")
    for file in ("poses.csv", "poses.npy", "link.csv"):
        shutil.rmtree(tmp_path / file[-3:], ignore_errors=True)
        done = main(scene, "--parts", "Moving", "--poses", tmp_path / file, "--threshold", 0.3, "--cutoff", 1, "-o",
                    tmp_path / file[-3:], "--workers", 0, "--quiet")
        assert (done.returncode, done.stderr) == (0, "") and done.stdout.startswith("3 rows in 1 pieces: ")
        rows = nearfit.open_sweep(tmp_path / file[-3:]).arrays()
        assert rows["distance"] == pytest.approx([0.25, 0.5, 0.0], abs=1e-12)
        assert rows["overlap"].tolist() == [False, False, True]


def test_the_module_tells_what_is_wrong_in_a_line(tmp_path):
    scene = write_scene(tmp_path)
    good = tmp_path / "poses.npy"
    np.save(good, moved([[2, 0, 0]]))
    (tmp_path / "six.csv").write_text("1,2,3,1,0,0\n")
    (tmp_path / "words.csv").write_text("header\n1,2,3,1,0,0,0\nmore words\n")
    (tmp_path / "long.csv").write_text("1,2,3,2,0,0,0\n")
    (tmp_path / "nan.csv").write_text("1,2,nan,1,0,0,0\n")
    (tmp_path / "empty.csv").write_text("# nothing\n")
    np.save(tmp_path / "objects.npy", np.array([{}, []], dtype=object))
    np.save(tmp_path / "flat.npy", np.zeros(16))
    for name, head in {"token.npy": b"{'descr': (\n", "indent.npy": b"{'descr': '<f8'}\n  x\n y\n"}.items():
        (tmp_path / name).write_bytes(b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head)
    os.mkfifo(tmp_path / "pipe.csv")

    def expect(code, match, *arguments, poses=good):
        done = main(scene, "--poses", poses, "--threshold", 0.1, "--cutoff", 1, "-o", tmp_path / "out", "--workers", 0, *arguments)
        assert done.returncode == code and done.stdout == ""
        assert done.stderr.startswith("nearfit-cli: ") and done.stderr.count("\n") == 1 and match in done.stderr
        assert not (tmp_path / "out").exists()

    expect(2, "name at least one part")
    expect(2, "invalid int value", "--part", "Moving", "--draws", "few")
    expect(2, "NAME=D", "--part", "Moving", "--tolerance", "Moving")
    expect(1, "no part \"None\"", "--part", "None")
    for file, match in {"six.csv": "line 1: it has 6 numbers", "words.csv": "line 3", "long.csv": "quaternion",
                        "nan.csv": "not finite", "empty.csv": "no pose", "objects.npy": "allow_pickle", "flat.npy": "(16,)",
                        "token.npy": "cannot be read",
                        "indent.npy": "cannot be read", "pipe.csv": "not a file", "none.csv": "No such file"}.items():
        expect(1, match, "--part", "Moving", poses=tmp_path / file)


def test_a_scheduler_that_cannot_be_used_is_told_in_a_line(tmp_path):
    scene = write_scene(tmp_path)
    np.save(tmp_path / "poses.npy", moved([[2, 0, 0]]))
    done = main(scene, "--poses", tmp_path / "poses.npy", "--threshold", 0.1, "--cutoff", 1, "-o", tmp_path / "out", "--part", "Moving",
                "--scheduler", "foo://x")
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr.startswith("nearfit-cli: --scheduler foo://x: ") and done.stderr.count("\n") == 1
    assert "tcp://HOST:8786" in done.stderr


def test_calling_the_module_is_calling_the_function():
    import importlib

    module = importlib.import_module("nearfit.sweep")
    assert callable(module) and module.sweep is _sweep.sweep
    assert pathlib.Path(module.__file__).name == "sweep.py"


@pytest.mark.full
def test_the_table_of_costs_has_its_head_and_what_the_page_names(tmp_path):
    script, out = pathlib.Path(__file__).with_name("sweep_cost.py"), tmp_path / "cost.csv"
    done = subprocess.run([sys.executable, script, "-o", out, "--parts", "8", "--swept", "2", "--poses", "100", "--triangles", "200",
                           "--memory-triangles", "20000", "--rounds", "1", "--allow-busy"], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    lines = out.read_text().splitlines()
    assert [line for line in lines if line.startswith("# revision: ")] and [line for line in lines if line.startswith("# processor: ")]
    rows = {row[0]: float(row[1]) for row in csv.reader(line for line in lines if not line.startswith("#")) if row[0] != "quantity"}
    for name in ("row of all measures", "mesh and hierarchy in memory", "mesh moved", "row written", "two workers over one"):
        assert rows[name] > 0
    assert rows["large: rows"] == 1e9
