import os
import shutil

import numpy as np
import pytest

import nearfit
from conftest import box, matrix_of, octahedron, random_rows


def test_a_mesh_keeps_what_it_is_built_of():
    vertices, triangles = box((1, 2, 3))
    mesh = nearfit.Mesh(vertices, triangles)
    assert mesh.vertices.shape == (8, 3) and mesh.vertices.dtype == np.float64
    assert mesh.triangles.shape == (12, 3) and mesh.triangles.dtype == np.uint32
    # Whatever the order: the same corners, and the same triangles by their corners.
    assert {tuple(v) for v in mesh.vertices} == {tuple(v) for v in vertices}
    corners = lambda v, t: sorted(sorted(map(tuple, v[face].tolist())) for face in np.asarray(t))
    assert corners(mesh.vertices, mesh.triangles) == corners(vertices, triangles)
    assert mesh.volume == pytest.approx(6.0, rel=1e-12)
    assert mesh.centre == pytest.approx(np.zeros(3), abs=1e-12)
    assert mesh.is_solid and mesh.warnings == [] and mesh.file == ""


def test_arrays_show_the_mesh_without_a_copy_and_outlive_it():
    mesh = nearfit.Mesh(*box((1, 1, 1)))
    vertices = mesh.vertices
    assert not vertices.flags.writeable
    assert np.shares_memory(vertices, mesh.vertices)
    before = vertices.copy()
    del mesh
    assert np.array_equal(vertices, before)


def test_fingerprints_tell_meshes_apart_by_content():
    one, same, other = (nearfit.Mesh(*box(size)) for size in ((1, 1, 1), (1, 1, 1), (1, 1, 1.0000001)))
    assert one.fingerprint == same.fingerprint != other.fingerprint
    assert len(one.fingerprint) == 64


def test_lists_integers_and_strided_arrays_are_taken():
    vertices, triangles = box((1, 1, 1))
    expected = nearfit.Mesh(vertices, triangles).fingerprint
    assert nearfit.Mesh(vertices.tolist(), triangles.tolist()).fingerprint == expected
    assert nearfit.Mesh(np.asfortranarray(vertices), triangles.astype(np.int32)).fingerprint == expected
    assert nearfit.Mesh(np.repeat(vertices, 2, axis=0)[::2], triangles).fingerprint == expected


@pytest.mark.parametrize("vertices, triangles, words", [
    (np.zeros((3, 2)), [[0, 1, 2]], "their shape is (3, 2)"),
    (np.eye(3), [[0, 1, 3]], "no index of a vertex"),
    (np.eye(3), [[0, 1, -1]], "no index of a vertex"),
    (np.eye(3), [[0, 1, 1.5]], "no index of a vertex"),
])
def test_what_is_no_mesh_is_refused(vertices, triangles, words):
    with pytest.raises(nearfit.Error) as error:
        nearfit.Mesh(vertices, triangles)
    assert words in str(error.value)


def test_parts_have_names_poses_and_meshes():
    scene = nearfit.Scene()
    mesh = nearfit.Mesh(*box((1, 1, 1)))
    row = random_rows(1, 1, 1.0)[0]
    assert scene.add(mesh, "Box", pose=matrix_of(row)) == "Box"
    assert scene.add(mesh, "Box", pose=row) != "Box"
    assert len(scene) == 2 and scene.parts[0] == "Box" and "Box" in scene and "Lid" not in scene
    assert scene.pose("Box") == pytest.approx(matrix_of(row), abs=1e-15)
    assert scene.pose_row(scene.parts[1]) == pytest.approx(row[np.newaxis], abs=1e-15)
    assert scene.mesh("Box").fingerprint == scene.mesh(scene.parts[1]).fingerprint
    scene.set_pose("Box", np.eye(4))
    assert np.array_equal(scene.pose("Box"), np.eye(4))
    scene.remove("Box")
    assert len(scene) == 1


def test_a_scene_says_which_parts_are_visible(tmp_path):
    scene = nearfit.Scene()
    mesh = nearfit.Mesh(*box((1, 1, 1)))
    scene.add(mesh, "Shown")
    scene.add(mesh, "Hidden", visible=False)
    assert scene.is_visible("Shown") is True and scene.is_visible("Hidden") is False
    scene.show("Hidden")
    scene.show("Shown", False)
    assert not scene.is_visible("Shown") and scene.is_visible("Hidden")
    scene.save(tmp_path / "fit.nearfit")
    opened = nearfit.Scene.open(tmp_path / "fit.nearfit")
    assert [opened.is_visible(name) for name in ("Shown", "Hidden")] == [False, True]
    with pytest.raises(nearfit.Error, match='there is no part "Lid"'):
        scene.is_visible("Lid")


def test_a_refused_change_leaves_a_scene_as_it_is():
    scene = nearfit.Scene()
    mesh = nearfit.Mesh(*box((1, 1, 1)))
    for i in range(5):
        scene.add(mesh, f"P{i}", pose=(3 * i, 0, 0, 1, 0, 0, 0), visible=i != 3)
    row = (0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0)
    state = lambda: ([(name, scene.is_visible(name), scene.pose_row(name).tolist()) for name in scene.parts],
                     nearfit.distance(scene, "P4", row).tolist())
    before = state()
    assert before[1] == pytest.approx([1.0], abs=1e-12)
    for change in (lambda: scene.add(mesh, ""), lambda: scene.add(mesh, "P5", density=-1.0),
                   lambda: scene.add(mesh, "P5", pose=2 * np.eye(4)), lambda: scene.remove("Lid"), lambda: scene.show("Lid")):
        with pytest.raises(nearfit.Error):
            change()
        assert state() == before
    # And one that is taken is seen by the next query.
    assert scene.add(mesh, "Roof", pose=(0, 0, 3.5, 1, 0, 0, 0)) == "Roof"
    assert nearfit.distance(scene, "P4", row) == pytest.approx([0.5], abs=1e-12)
    scene.show("Roof", False)
    assert nearfit.distance(scene, "P4", row) == pytest.approx([1.0], abs=1e-12)
    scene.show("Roof")
    assert nearfit.distance(scene, "P4", row) == pytest.approx([0.5], abs=1e-12)
    scene.remove("Roof")
    assert nearfit.distance(scene, "P4", row) == pytest.approx([1.0], abs=1e-12)
    assert state() == before


def test_many_parts_are_added_and_removed_one_by_one():
    scene = nearfit.Scene()
    mesh = nearfit.Mesh(*box((1, 1, 1)))
    names = [scene.add(mesh, f"P{i}", pose=(3 * i, 0, 0, 1, 0, 0, 0), visible=i % 3 > 0) for i in range(600)]
    assert names == [f"P{i}" for i in range(600)] == scene.parts
    for i in range(0, 600, 2):
        scene.remove(f"P{i}")
    assert scene.parts == [f"P{i}" for i in range(1, 600, 2)]
    assert all(scene.is_visible(f"P{i}") == (i % 3 > 0) and scene.pose_row(f"P{i}")[0, 0] == 3 * i for i in range(1, 600, 2))
    # P597 is hidden; P595 and P599 are the next ones, 1.5 m to either side of their faces.
    assert nearfit.distance(scene, "P1", (3 * 597, 0, 0, 1, 0, 0, 0)) == pytest.approx([5.0], abs=1e-9)


def test_a_file_name_that_is_not_utf8_is_told_and_kept(tmp_path):
    scene = nearfit.Scene()
    scene.add(nearfit.Mesh(*octahedron(0.015)), "Tip")
    nearfit.export(scene, tmp_path / "tip.stl", unit="mm")
    odd = os.path.join(tmp_path, os.fsdecode(b"\xff\xc3\xa9.stl"))
    with pytest.raises(nearfit.Error) as error:
        nearfit.read_mesh(odd)
    assert odd in str(error.value)
    shutil.copy(tmp_path / "tip.stl", odd)
    mesh = nearfit.read_mesh(odd)
    assert isinstance(mesh.file, str) and mesh.file == odd
    # In a name that is UTF-8 nothing is replaced.
    fine = str(tmp_path / "größe.stl")
    with pytest.raises(nearfit.Error) as error:
        nearfit.read_mesh(fine)
    assert fine in str(error.value)


def test_errors_name_parts_and_say_what_to_do():
    scene = nearfit.Scene()
    scene.add(nearfit.Mesh(*box((1, 1, 1))), "Box")
    assert issubclass(nearfit.Error, RuntimeError)
    for ask in (scene.pose, scene.mesh, scene.remove):
        with pytest.raises(nearfit.Error, match='there is no part "Lid".*its parts are Box'):
            ask("Lid")
    mirror = np.diag([1.0, 1.0, -1.0, 1.0])
    with pytest.raises(nearfit.Error, match="does not turn and shift only"):
        scene.set_pose("Box", mirror)
    with pytest.raises(nearfit.Error, match="their shape is"):
        scene.set_pose("Box", np.eye(3))
    assert np.array_equal(scene.pose("Box"), np.eye(4))


def test_a_missing_file_is_told_in_the_words_of_the_command_line(cli, tmp_path):
    missing = tmp_path / "none.stl"
    with pytest.raises(nearfit.Error) as error:
        nearfit.read_mesh(missing)
    said = cli("info", missing, "--unit", "mm", codes=(1,))
    assert str(error.value) in said.stderr


def test_a_saved_scene_is_read_back_to_the_bit(saved, two_bodies):
    scene = saved[0]
    assert scene.parts == two_bodies.parts
    for name in scene.parts:
        assert np.array_equal(scene.mesh(name).vertices, two_bodies.mesh(name).vertices)
        assert np.array_equal(scene.mesh(name).triangles, two_bodies.mesh(name).triangles)
        assert np.array_equal(scene.pose_row(name), two_bodies.pose_row(name))


def test_units_of_files_are_those_that_are_said(tmp_path):
    scene = nearfit.Scene()
    scene.add(nearfit.Mesh(*octahedron(0.015)), "Tip")
    nearfit.export(scene, tmp_path / "tip.stl", unit="mm")
    assert np.abs(nearfit.read_mesh(tmp_path / "tip.stl").vertices).max() == pytest.approx(0.015, rel=1e-6)
    assert np.abs(nearfit.read_mesh(tmp_path / "tip.stl", "m").vertices).max() == pytest.approx(15.0, rel=1e-6)
    with pytest.raises(nearfit.Error):
        nearfit.read_mesh(tmp_path / "tip.stl", "parsec")
