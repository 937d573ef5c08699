"""What the tests share: the command of the wheel, and the repository where there is one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]


@pytest.fixture(scope="session")
def command():
    """Runs the command that the wheel brings along, and gives its exit code, stdout and stderr."""

    def run(*words: str) -> tuple[int, str, str]:
        done = subprocess.run(
            [sys.executable, "-m", "percuss", *words], capture_output=True, text=True, check=False
        )
        return done.returncode, done.stdout, done.stderr

    return run


@pytest.fixture(scope="session")
def repository() -> Path:
    """The root of the repository, whose files some tests hold the package against."""
    root = Path(os.environ.get("PERCUSS_ROOT", Path(__file__).parents[2]))
    if not (root / "validation").is_dir():
        pytest.skip("only in a checkout of the repository")
    return root
