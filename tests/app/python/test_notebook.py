import pathlib

import nbclient
import nbformat

NOTEBOOK = pathlib.Path(__file__).resolve().parents[3] / "resources" / "python" / "example.ipynb"


def test_the_example_runs_and_prints_what_it_shows(tmp_path):
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    # A cell that raises, as its assertions do, raises here.
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    printed = "".join(output.get("text", "") for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs)
    assert "nearfit.Lmds" in printed and "largest force" in printed


def test_the_example_is_kept_without_its_output():
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    assert all(not cell.outputs for cell in notebook.cells if cell.cell_type == "code")
