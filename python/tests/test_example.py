"""The repository of a library that tests itself by percuss."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.fixture()
def check(repository, tmp_path):
    """Runs the example's own check, and gives its exit code and what it says."""
    pytest.importorskip("scipy")
    copy = tmp_path / "library"
    shutil.copytree(repository / "examples/library_ci", copy)
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"

    def run(*words):
        call = [str(copy / "check.sh"), "-q", *words]
        done = subprocess.run(
            call, capture_output=True, text=True, check=False, env={**os.environ, "PATH": path}
        )
        return done.returncode, done.stdout + done.stderr, copy

    return run


def test_a_library_passes_and_is_held_against_its_report(check):
    code, said, folder = check()
    assert code == 0, said
    shutil.copy(folder / "report/report.json", folder / "baseline.json")
    code, said, _ = check("--percuss-baseline=baseline.json")
    assert code == 0, said
    # One more than the library's own test and its ten cases.
    assert "12 passed" in said


def test_a_declared_shortcoming_that_does_not_show_fails(check):
    code, said, folder = check()
    assert code == 0, said
    (folder / "known.txt").write_text("small-b it is told so here\n", encoding="utf-8")
    code, said, _ = check()
    assert code == 1 and "XPASS(strict)" in said


def test_a_method_with_a_fault_is_told(check):
    _, _, folder = check()
    method = folder / "mylib/method.py"
    text = method.read_text(encoding="utf-8")
    assert "4 * k3) / 9" in text
    method.write_text(text.replace("4 * k3) / 9", "4.001 * k3) / 9"), encoding="utf-8")
    code, said, _ = check()
    assert code == 1 and "at 1e-6: fail" in said


def test_the_picture_of_a_derivative_is_drawn(repository, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "picture.svg"
    call = [sys.executable, str(repository / "examples/event_derivative.py"), str(picture)]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    drawn = picture.read_text(encoding="utf-8")
    # The page has the same derivative of the impact's time in its table.
    assert "dT/dh = 0.160" in drawn
    assert "0.15961737689352443" in (repository / "docs/GRADIENTS.md").read_text(encoding="utf-8")
