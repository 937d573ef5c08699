"""The oscillator: every number is the command's."""

import csv
import io
import json

import numpy as np
import pytest

import percuss

FLAGS = ("--a", "0.31", "--b", "0.12", "--p", "0.1", "--y", "-0.2")


@pytest.fixture()
def oscillator():
    return percuss.Oscillator(a=0.31, b=0.12, p=0.1, y=-0.2)


def numbers(text, *columns):
    rows = list(csv.DictReader(io.StringIO(text)))
    return np.array([[float(row[it]) for it in columns] for row in rows]), rows


@pytest.mark.parametrize(
    ("options", "flags"),
    [
        ({"until": 50.0}, ("--until", "50")),
        ({"count": 30}, ("--events", "30")),
        ({"periods": 12}, ("--periods", "12")),
    ],
)
def test_runs_in_f64_have_the_bytes_of_the_command(command, oscillator, options, flags):
    code, out, err = command("simulate", *flags, *FLAGS)
    assert code == 0, err
    table, rows = numbers(out, "tau", "p", "y", "q", "v")
    run = oscillator.simulate(**options)
    assert np.column_stack([run.time, run.state]).tobytes() == table.tobytes()
    assert run.phase.tolist() == [row["phase"] for row in rows]


def test_proved_events_are_those_of_the_system(command):
    rows = list(
        csv.DictReader(io.StringIO(command("events", "percussive-oscillator", "--events", "9")[1]))
    )
    run = percuss.Oscillator().events(count=9)
    assert run.digits.time.tolist() == [row["time"] for row in rows]
    fast = percuss.Oscillator().simulate(count=9)
    # Growth of an error over nine events of this chaotic motion is below 1e4.
    assert abs(fast.time - run.time).max() < 1e-11


def test_events_from_a_start_on_the_slider():
    oscillator = percuss.Oscillator(p=0.5, y=-0.01, phase="contact")
    run, fast = oscillator.events(count=4), oscillator.simulate(count=4)
    assert run.mode.tolist() == fast.phase.tolist()
    assert abs(fast.time - run.time).max() < 1e-11


def test_sections_have_the_bytes_of_the_command(command, oscillator):
    out = command("poincare", "--transient", "20", "--periods", "50", *FLAGS)[1]
    table, _ = numbers(out, "p", "y", "q", "v")
    section = oscillator.poincare(transient=20, periods=50)
    assert section.points.tobytes() == table.tobytes()


def test_exponents_are_those_of_the_command(command, oscillator):
    told = json.loads(command("lyapunov", "--transient", "50", "--periods", "400", *FLAGS)[1])
    found = oscillator.lyapunov(transient=50, periods=400)

    def read(key):
        return [float("-inf") if it is None else it for it in told[key]]

    assert found.exponents.tolist() == read("exponents_per_period")
    assert found.drift == told["drift_per_period"]
    assert found.drift_standard_error == told["drift_standard_error"]


def test_orbits_are_those_of_the_command(command):
    told = json.loads(command("orbit", "--period", "1", "--all", "--omega", "0.9")[1])["orbits"]
    found = percuss.Oscillator(omega=0.9).orbits(1)
    assert [it.points.tolist() for it in found] == [it["points"] for it in told]
    assert percuss.Oscillator(omega=0.9).orbit(1).points.tolist() == told[0]["points"]


def test_diagrams_have_the_bytes_of_the_command(command):
    words = ["--parameter", "b", "--from", "0.1", "--to", "0.2", "--steps", "6"]
    out = command("bifurcation", *words, "--transient", "50", "--periods", "5")[1]
    table, _ = numbers(out, "p", "y", "q")
    values, _ = numbers(out, "parameter")
    values_of = np.linspace(0.1, 0.2, 6)
    found = percuss.Oscillator().bifurcation("b", values_of, transient=50, periods=5)
    assert found.points.tobytes() == table.tobytes()
    assert found.values[found.steps].tolist() == values[:, 0].tolist()


def test_basins_are_those_of_the_command(command, tmp_path):
    flags = ["--grid", "12x10", "--window=-1,1,-1,1", "--transient", "200"]
    path = tmp_path / "basins.npz"
    told = json.loads(command("basins", *flags, "--output", str(path), "--format", "json")[1])
    found = percuss.Oscillator().basins((-1, 1), (-1, 1), grid=(12, 10), transient=200)
    stored = np.load(path)
    labels = next(stored[name] for name in stored.files if "label" in name)
    assert found.labels.tolist() == labels.tolist()
    listed = [it for it in told["attractors"] if it["id"] >= 0]
    assert [it.fraction for it in found.attractors] == [it["fraction"] for it in listed]
    assert [it.kind for it in found.attractors] == [it["kind"] for it in listed]


def test_pictures():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    oscillator = percuss.Oscillator()
    assert oscillator.poincare(periods=20).plot().get_ylabel() == "y"
    basins = oscillator.basins((-1, 1), (-1, 1), grid=6, transient=50)
    assert basins.plot().get_xlabel() == "p"
