"""The package: its examples, its lasting memory, and what a call costs in it."""

import doctest
import gc
import importlib
import pkgutil
import re
import tracemalloc

import pytest

import percuss

MODULES = [it.name for it in pkgutil.iter_modules(percuss.__path__, "percuss.")]
PLAIN = [it for it in MODULES if not it.endswith(("__main__", "_percuss", "_program"))]


@pytest.mark.parametrize("name", ["percuss", *PLAIN])
def test_examples_give_what_they_show(name):
    pytest.importorskip("scipy")
    result = doctest.testmod(
        importlib.import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE
    )
    assert result.failed == 0


def test_enough_examples_are_run():
    finder = doctest.DocTestFinder(exclude_empty=True)
    tests = [
        it for name in ["percuss", *PLAIN] for it in finder.find(importlib.import_module(name))
    ]
    assert sum(len(it.examples) for it in tests) >= 30


@pytest.mark.parametrize("page", ["python/README.md", "docs/PYTHON.md"])
def test_pages_run_as_they_stand(repository, page, monkeypatch, tmp_path):
    pytest.importorskip("scipy")
    pytest.importorskip("pandas")
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    monkeypatch.chdir(tmp_path)
    text = (repository / page).read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.S)
    assert blocks
    names: dict[str, object] = {}
    for block in blocks:
        # Smaller than on the page, where a picture is to be looked at.
        exec(block.replace("grid=200", "grid=10"), names)


def test_types_are_marked_for_checkers(repository):
    assert (repository / "python/percuss/py.typed").exists()


def test_many_calls_leave_nothing_behind():
    ball = percuss.systems["bouncing-ball"]

    def calls(count):
        for _ in range(count):
            ball.simulate(1.0).time

    calls(2000)
    gc.collect()
    tracemalloc.start()
    calls(100)
    gc.collect()
    before = tracemalloc.get_traced_memory()[0]
    calls(10_000)
    gc.collect()
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    # A leak of one object a call would be 10000 times 16 bytes at the least.
    assert grown < 80_000
