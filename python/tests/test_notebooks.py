"""The notebooks of `examples/notebooks`: what their text states is asserted in their cells."""

import pytest

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")

# Notebooks by name, with how many pictures each draws.
PICTURES = {
    "paper_in_ten_cells": 5,
    "rig_of_your_own": 3,
    "which_integrator": 1,
    "my_library_in_ci": 0,
}
# A notebook takes seconds; this only ends one that hangs.
LONGEST_CELL_S = 300


def read(repository, name):
    path = repository / "examples/notebooks" / f"{name}.ipynb"
    return nbformat.read(path, as_version=nbformat.NO_CONVERT)


def code(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def test_all_notebooks_are_known(repository):
    found = {path.stem for path in (repository / "examples/notebooks").glob("*.ipynb")}
    assert found == set(PICTURES)
    assert len(code(read(repository, "paper_in_ten_cells"))) == 10


@pytest.mark.parametrize("name", PICTURES)
def test_a_notebook_is_kept_without_outputs(repository, name):
    notebook = read(repository, name)
    nbformat.validate(notebook)
    assert [cell.source for cell in code(notebook) if cell.outputs or cell.execution_count] == []


@pytest.mark.parametrize("name", PICTURES)
def test_a_notebook_runs_and_draws(repository, tmp_path, name):
    pytest.importorskip("matplotlib")
    pytest.importorskip("pandas")
    pytest.importorskip("scipy")
    pytest.importorskip("ipykernel")
    notebook = read(repository, name)
    where = {"metadata": {"path": str(tmp_path)}}
    # What a cell raises, its assertions too, is raised here.
    nbclient.NotebookClient(notebook, timeout=LONGEST_CELL_S, resources=where).execute()
    outputs = [output for cell in code(notebook) for output in cell.outputs]
    drawn = [it for it in outputs if "image/png" in it.get("data", {})]
    assert len(drawn) == PICTURES[name]
    assert any("assert " in cell.source for cell in code(notebook))
