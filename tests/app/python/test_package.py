import pathlib
import re

import nearfit

ROOT = pathlib.Path(__file__).resolve().parents[3]


def test_the_version_is_that_of_the_sources():
    stated = re.search(r"project\(nearfit VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    assert nearfit.__version__ == stated


def test_every_public_name_is_documented_and_typed():
    folder = pathlib.Path(nearfit.__file__).parent
    stub = (folder / "_nearfit.pyi").read_text()
    assert (folder / "py.typed").exists()
    for name in nearfit.__all__:
        assert getattr(nearfit, name).__doc__, name
        if name != "__version__" and getattr(nearfit, name).__module__ == "nearfit._nearfit":
            assert re.search(rf"^(class|def) {name}\b", stub, re.MULTILINE), name


def test_the_module_needs_neither_qt_nor_vtk():
    module = next(pathlib.Path(nearfit.__file__).parent.glob("_nearfit*.so")).read_bytes()
    for library in (b"libQt5", b"libvtk", b"libTK", b"libusb"):
        assert library not in module
