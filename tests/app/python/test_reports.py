import json
import sys

import numpy as np
import pytest

import nearfit
from conftest import box, octahedron


def cubes(gap):
    """Two unit cubes, the second beside the first by a gap [m]; negative: they overlap."""
    scene = nearfit.Scene()
    cube = nearfit.Mesh(*box((1, 1, 1)))
    scene.add(cube, "Post")
    scene.add(cube, "Cube", pose=(1 + gap, 0, 0, 1, 0, 0, 0))
    return scene


def test_clearance_finds_near_pairs_and_clashes():
    near = nearfit.clearance(cubes(0.25), 0.5)
    assert [f.pair for f in near] == [("Post", "Cube")]
    assert near[0].verdict == "near" and near[0].distance == pytest.approx(0.25, rel=1e-12)
    assert near[0].minima.shape[1] == 7 and near[0].minima[0, 0] == pytest.approx(0.25, rel=1e-12)
    assert near[0].volume is None and not near[0].forbidden
    clash = nearfit.clearance(cubes(-0.25), 0.5)[0]
    assert clash.verdict == "clash" and clash.forbidden and clash.distance == 0.0
    assert clash.volume == pytest.approx(0.25, rel=1e-9)
    assert clash.depth == pytest.approx(0.25, rel=1e-6)
    assert nearfit.clearance(cubes(0.75), 0.5) == []


def test_clearance_is_that_of_the_command_line_to_the_last_bit(saved, cli):
    scene, file, _, _ = saved
    scene.set_pose("Tip", (0.001, 0.002, 0.03, 0.5, 0.5, 0.5, 0.5))
    scene.save(file)
    said = json.loads(cli("clearance", file, "--all", "--threshold", "0.1", "--json").stdout)
    found = nearfit.clearance(scene, 0.1)
    assert len(found) == len(said["findings"]) == 1
    assert found[0].verdict == said["findings"][0]["verdict"]
    assert found[0].distance == said["findings"][0]["distance"]


def path_towards(scene, part, by, count=200):
    """Rows of a part that goes straight."""
    row = scene.pose_row(part)[0]
    rows = np.tile(row, (count, 1))
    rows[:, :3] += np.linspace(0, 1, count)[:, np.newaxis] * np.asarray(by)
    return rows


def test_a_part_that_is_led_stops_at_contact():
    scene = cubes(0.01)
    # The hand goes 20 mm: 10 mm into the other cube.
    record = nearfit.place(scene, "Cube", path_towards(scene, "Cube", (-0.02, 0, 0)), cutoff=0.05, margin=1e-4)
    assert len(record) == 200 and record.poses.shape == (200, 4, 4) and record.wrenches.shape == (200, 6)
    assert np.diff(record.times) == pytest.approx(1e-3)
    assert record.poses[-1, 0, 3] > 1.0 and record.handles[-1, 0] == pytest.approx(0.99, rel=1e-9)
    # Pushed back, and the scene stays as it was.
    assert record.wrenches[-1, 0] > 0
    assert scene.pose("Cube")[0, 3] == 1.01


def test_a_placement_is_that_of_the_command_line_to_the_last_bit(saved, cli, tmp_path):
    scene, file, _, _ = saved
    scene.set_pose("Tip", (0.003, 0, 0.03, 1, 0, 0, 0))
    scene.save(file)
    rows = path_towards(scene, "Tip", (0, 0.001, -0.012))
    poses, felt, own = tmp_path / "hand.csv", tmp_path / "felt.csv", tmp_path / "own.csv"
    poses.write_text("".join(",".join(map(repr, row.tolist())) + "\n" for row in rows))
    cli("place", file, "--part", "Tip", "--path", poses, "--fast", "--record", felt)
    record = nearfit.place(scene, "Tip", rows)
    record.write_csv(own)

    def read(name):
        lines = [line for line in name.read_text().splitlines() if not line.startswith("#")]
        return lines[0].split(","), [line.split(",") for line in lines[1:]]
    (header, theirs), (own_header, ours) = read(felt), read(own)
    assert header == own_header and len(theirs) == len(ours) == 200
    timed = {i for i, name in enumerate(header) if name.endswith("_us")}
    for a, b in zip(theirs, ours):
        assert [x for i, x in enumerate(a) if i not in timed] == [x for i, x in enumerate(b) if i not in timed]
    columns = [header.index("proxy_" + name) for name in ("tx", "ty", "tz", "qw", "qx", "qy", "qz")]
    assert record.proxies.tolist() == [[float(row[i]) for i in columns] for row in theirs]


def test_a_path_is_certified_and_the_certificate_verified(tmp_path, cli):
    scene = cubes(0.25)
    files = [tmp_path / name for name in ("fit.nearfit", "out.nfpath", "out.nfcert")]
    scene.save(files[0])
    nearfit.write_path(files[1], ["Cube"], path_towards(scene, "Cube", (0, 2, 0), 5), np.arange(5.0))
    found = nearfit.certify(files[1], files[0], files[2], separation=0.1)
    assert found and found.free and found.poses == 5 and found.pairs == 1 and found.time is None
    verified = nearfit.verify(files[2])
    assert verified and verified.scene_file_hashed and verified.path_file_checked and verified.stretches == found.stretches
    assert json.loads(cli("verify", files[2], "--json").stdout)["stretches"] == verified.stretches
    files[0].write_text(files[0].read_text() + "\n")
    refused = nearfit.verify(files[2])
    assert not refused and "its bytes differ" in refused.problem
    assert refused.problem in cli("verify", files[2], codes=(3,)).stdout


def test_a_path_that_meets_something_gets_no_certificate(tmp_path):
    scene = cubes(0.25)
    files = [tmp_path / name for name in ("fit.nearfit", "in.nfpath", "in.nfcert")]
    scene.save(files[0])
    nearfit.write_path(files[1], ["Cube"], path_towards(scene, "Cube", (-0.5, 0, 0), 5), np.arange(5.0))
    found = nearfit.certify(files[1], files[0], files[2], separation=0.1)
    assert not found and (found.part, found.other) == ("Cube", "Post")
    # The gap falls from 0.25 to 0.1 after 0.3 of the way, which takes 4 s.
    assert found.time == pytest.approx(1.2, abs=0.1)
    assert not files[2].exists()


def test_exports_are_those_of_the_command_line(saved, cli, tmp_path):
    scene, file, _, _ = saved
    for suffix in ("csv", "stl", "obj", "ply", "glb"):
        # The same name for both: some formats hold it.
        ours, theirs = tmp_path / "ours" / f"fit.{suffix}", tmp_path / "theirs" / f"fit.{suffix}"
        for made in (ours, theirs):
            made.parent.mkdir(exist_ok=True)
        assert nearfit.export(scene, ours) == []
        cli("export", file, theirs)
        assert ours.read_bytes() == theirs.read_bytes(), suffix
    nearfit.export(scene, tmp_path / "one.stl", parts=["Tip"])
    assert len(nearfit.read_mesh(tmp_path / "one.stl").triangles) == 8


def test_an_export_of_no_known_format_is_refused_with_the_same_words(saved, cli, tmp_path):
    scene, file, _, _ = saved
    with pytest.raises(nearfit.Error) as error:
        nearfit.export(scene, tmp_path / "fit.docx")
    assert str(error.value) in cli("export", file, tmp_path / "fit.docx", codes=(2,)).stderr
    with pytest.raises(nearfit.Error):
        nearfit.export(scene, file.parent / "fit.csv", parts=["Tip"])


def test_an_export_replaces_no_mesh_that_the_scene_needs(saved):
    scene, _, block, _ = saved
    with pytest.raises(nearfit.Error):
        nearfit.export(scene, block)
    assert len(nearfit.read_mesh(block, "m").vertices) == 8


@pytest.mark.parametrize("draw, library", [(nearfit.show, "pyvista"), (nearfit.plot, "matplotlib")])
def test_without_a_library_for_pictures_it_says_which(two_bodies, monkeypatch, draw, library):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(nearfit.Error, match=f"pip install {library}"):
        draw(two_bodies)
