"""Dynamics of any system: every number is the command's."""

import csv
import io
import json

import numpy as np
import pytest

import percuss

RIGID = "rigid-impact-oscillator"


def numbers(text, *columns):
    rows = list(csv.DictReader(io.StringIO(text)))
    return np.array([[float(row[it]) for it in columns] for row in rows]), rows


def told(command, *words):
    code, out, err = command(*words)
    assert code == 0, err
    return json.loads(out)


@pytest.fixture()
def rigid():
    return percuss.systems[RIGID]


@pytest.mark.parametrize("section", ["strobe", "strobe:pi/2", "impact"])
def test_sections_have_the_bytes_of_the_command(command, rigid, section):
    words = ("--transient", "20", "--returns", "50", "--section", section)
    table, rows = numbers(command("poincare", RIGID, *words)[1], "time", *rigid.states)
    found = rigid.poincare(transient=20, returns=50, section=section)
    assert np.column_stack([found.time, found.state]).tobytes() == table.tobytes()
    assert found.mode.tolist() == [row["mode"] for row in rows]
    assert found.to_pandas().columns.tolist() == list(rows[0])[1:]


def test_every_other_return_is_that_of_the_command(command, rigid):
    words = ("--transient", "0", "--returns", "9", "--section", "impact", "--every", "2")
    table, _ = numbers(command("poincare", RIGID, *words)[1], *rigid.states)
    assert rigid.poincare(returns=9, section="impact", every=2).state.tobytes() == table.tobytes()


def test_a_motion_that_comes_to_rest_says_so():
    found = percuss.systems["bouncing-ball"].poincare(returns=10_000, section="impact")
    assert 0 < len(found) < 10_000
    assert "the run ends" in found.cause
    with pytest.raises(ValueError, match="the run ends"):
        percuss.systems["bouncing-ball"].lyapunov(returns=10_000, section="impact")


def test_exponents_are_those_of_the_command(command, rigid):
    known = told(command, "lyapunov", RIGID, "--transient", "50", "--returns", "400")
    found = rigid.lyapunov(transient=50, returns=400)

    def read(key):
        return [float("-inf") if it is None else it for it in known[key]]

    assert found.exponents.tolist() == read("exponents_per_return")
    assert found.per_time.tolist() == read("exponents_per_time")
    assert found.standard_error.tolist() == read("standard_error")
    assert found.mean_return_time == known["mean_return_time"]
    assert (found.batches, found.stationary) == (known["batches"], known["stationary"])
    assert found.drift == known["drift_per_return"] == {}


def test_drifts_have_names(command):
    words = ("--transient", "50", "--returns", "400")
    known = told(command, "lyapunov", "percussive-oscillator", *words)
    found = percuss.systems["percussive-oscillator"].lyapunov(transient=50, returns=400)
    assert found.drift == known["drift_per_return"] and "v" in found.drift
    assert found.drift_standard_error == known["drift_standard_error"]


def test_orbits_are_those_of_the_command(command):
    known = told(command, "orbit", "relay-feedback", "--section", "switch-up", "--period", "1")
    found = percuss.systems["relay-feedback"].orbit(1, section="switch-up")
    assert found.points.tolist() == [it["state"] for it in known["points"]]
    assert found.mode.tolist() == [it["mode"] for it in known["points"]]
    assert found.multipliers.tolist() == [complex(*it) for it in known["multipliers"]]
    assert (found.period, found.time, found.stable) == (1, known["time"], known["stable"])
    assert found.events == known["events"] and found.residual == known["residual"]
    with pytest.raises(ValueError, match="no orbit"):
        percuss.systems["bouncing-ball"].orbit(2, transient=10_000, section="impact")


def branches(found, known):
    assert found.values.tolist() == [it["parameter"] for it in known["branch"]]
    assert found.stable.tolist() == [it["stable"] for it in known["branch"]]
    multipliers = [[complex(*pair) for pair in it["multipliers"]] for it in known["branch"]]
    assert found.multipliers.tolist() == multipliers
    assert (found.period, found.complete) == (known["period"], known["complete"])
    keys = ("type", "value", "error", "period", "turns")
    listed = [tuple(it[key] for key in keys) for it in known["bifurcations"]]
    own = [(it.kind, it.value, it.error, it.period, it.turns) for it in found.bifurcations]
    assert own == listed
    return len(own)


def test_branches_of_a_system_are_those_of_the_command(command, rigid):
    words = ("--parameter", "A", "--from", "0.5", "--to", "0.9", "--period", "1")
    code, out, _ = command("continue", RIGID, *words, "--transient", "300")
    known = json.loads(out)
    found = rigid.continue_("A", 0.5, 0.9, period=1, transient=300)
    assert branches(found, known) > 0
    assert (code == 0) == found.complete
    assert found.points.tolist() == [it["points"][0]["state"] for it in known["branch"]]
    assert found.events == [it["events"] for it in known["branch"]]
    assert found.time.tolist() == [it["time"] for it in known["branch"]]
    assert [it.event for it in found.bifurcations] == [it["event"] for it in known["bifurcations"]]


@pytest.mark.parametrize("guess", [{}, {"p": 0.02, "y": 0.1}])
def test_branches_of_the_oscillator_are_those_of_the_command(command, guess):
    words = ("--parameter", "omega", "--from", "0.9", "--to", "0.8", "--period", "1")
    flags = [word for name, value in guess.items() for word in (f"--{name}", str(value))]
    code, out, err = command("continue", *words, *flags)
    if code != 0 and not json.loads(out)["branch"]:
        with pytest.raises(ValueError, match="no orbit|no step"):
            percuss.Oscillator(**guess).continue_("omega", 0.9, 0.8, period=1)
        return
    known = json.loads(out)
    found = percuss.Oscillator(**guess).continue_("omega", 0.9, 0.8, period=1)
    branches(found, known)
    assert found.points.tolist() == [it["point"] for it in known["branch"]]
    assert found.drift.tolist() == [it["drift_per_period"] for it in known["branch"]]


@pytest.mark.parametrize("reset", [False, True])
def test_diagrams_have_the_bytes_of_the_command(command, rigid, reset):
    words = ["--parameter", "frequency", "--from", "2.5", "--to", "2.8", "--steps", "5"]
    words += ["--transient", "60", "--returns", "4", *(["--reset"] if reset else [])]
    code, out, err = command("bifurcation", RIGID, *words)
    assert code == 0, err
    table, rows = numbers(out, "parameter", *rigid.states)
    grid = np.linspace(2.5, 2.8, 5)
    found = rigid.bifurcation("frequency", grid, transient=60, returns=4, reset=reset)
    assert np.column_stack([found.values[found.steps], found.points]).tobytes() == table.tobytes()
    assert found.mode.tolist() == [row["mode"] for row in rows]
    left_out = [why for why in found.left_out if why]
    assert (f"{len(left_out)} of 5 values are left out" in err) == bool(left_out)
    assert len(set(found.steps)) == 5 - len(left_out)


def test_basins_are_those_of_the_command(command, rigid, tmp_path):
    flags = ["--grid", "9x7", "--window=-1,0.5,-1,1", "--transient", "100"]
    path = tmp_path / "basins.npz"
    words = ("basins", RIGID, *flags, "--output", str(path), "--format", "json")
    known, stored = told(command, *words), np.load(path)
    found = rigid.basins((-1, 0.5), (-1, 1), grid=(9, 7), transient=100)
    across, up = found.axes
    assert found.labels.tobytes() == stored["labels"].tobytes()
    assert found.across.tobytes() == stored[across].tobytes()
    assert found.up.tobytes() == stored[up].tobytes()
    listed = [it for it in known["attractors"] if it["id"] >= 0]
    assert len(listed) == len(found.attractors) > 0
    for own, it in zip(found.attractors, listed):
        assert (own.kind, own.period, own.fraction) == (it["kind"], it["period"], it["fraction"])
        assert own.multipliers.tolist() == [complex(*pair) for pair in it["multipliers"]]
        assert own.points.tolist()[-len(it["points"]) :] == [at["state"] for at in it["points"]]
        assert own.drift == it["drift_per_return"]
    assert (found.inadmissible, found.ended) == (known["inadmissible"], known["ended"])
    assert found.unresolved == known["unresolved"]


def test_orbits_of_a_grid_are_those_of_the_command(command, rigid):
    flags = ["--period", "3", "--all", "--grid", "12x11", "--window=-1,0.1,-1,1"]
    known = told(command, "orbit", RIGID, *flags)["orbits"]
    found = rigid.orbits(3, (-1, 0.1), (-1, 1), grid=(12, 11))
    assert len(found) == len(known) > 0
    for own, it in zip(found, known):
        assert (own.period, own.time, own.stable) == (it["period"], it["time"], it["stable"])
        assert own.points.tolist() == [at["state"] for at in it["points"]]
        assert own.multipliers.tolist() == [complex(*pair) for pair in it["multipliers"]]
    assert percuss.systems["bouncing-ball"].orbits(1, (0, 1), (0, 1), grid=2, section="impact") == []


def test_attractors_in_other_axes_are_those_of_the_command(command, rigid):
    flags = ["--grid", "4x4", "--window=-1,1,-1,0.5", "--transient", "100", "--axes", "v,x"]
    known = told(command, "attractors", RIGID, *flags, "--format", "json")
    options = {"grid": 4, "transient": 100, "axes": ("v", "x")}
    found = rigid.attractors((-1, 1), (-1, 0.5), **options)
    assert [it.fraction for it in found] == [
        it["fraction"] for it in known["attractors"] if it["id"] >= 0
    ]


@pytest.mark.parametrize(
    ("call", "error", "match"),
    [
        (lambda it: it.poincare(returns=0), ValueError, "returns from 1 on"),
        (lambda it: it.poincare(returns=1, section="no such"), ValueError, "EVENT@MODE"),
        (lambda it: it.poincare(returns=1, section="crash"), ValueError, "impact"),
        (lambda it: it.poincare(returns=1, section=1.0), TypeError, "a name is"),
        (lambda it: it.poincare(returns=1, every=0), ValueError, "every = 0"),
        (lambda it: it.poincare(returns=1, max_time=0), ValueError, "max_time = 0"),
        (lambda it: it.poincare(returns=1, progress=3), TypeError, "progress = 3"),
        (lambda it: it.orbit(0), ValueError, "period = 0"),
        (lambda it: it.lyapunov(returns=2**70), ValueError, "returns"),
        (lambda it: it.continue_("no", 0, 1, period=1), ValueError, "no"),
        (lambda it: it.continue_("frequency", float("nan"), 1, period=1), ValueError, "finite|NaN"),
        (lambda it: it.bifurcation("frequency", [1, 2, 4]), ValueError, "equal steps"),
        (lambda it: it.bifurcation("no", [1, 2]), ValueError, "no"),
        (lambda it: it.basins((0, 1), (0, 1), grid=0, transient=1), ValueError, "grid = 0"),
        (lambda it: it.orbits(1, (0, 1), (0, 1), grid=0), ValueError, "grid = 0"),
        (lambda it: it.orbits(0, (0, 1), (0, 1), grid=1), ValueError, "period = 0"),
        (lambda it: it.basins((1, 0), (0, 1), grid=2, transient=1), ValueError, "across = "),
        (lambda it: it.basins(0, (0, 1), grid=2, transient=1), ValueError, "two numbers"),
        (
            lambda it: it.basins((0, 1), (0, 1), grid=2, transient=1, axes=("x", "z")),
            ValueError,
            "two of x, v",
        ),
    ],
)
def test_bad_input_is_told(rigid, call, error, match):
    with pytest.raises(error, match=match):
        call(rigid)


def test_a_system_without_forcing_needs_an_event():
    with pytest.raises(ValueError, match="no strobe"):
        percuss.systems["bouncing-ball"].poincare(returns=1)


def test_calls_in_a_row_have_the_numbers_of_a_first_call():
    """What the solver keeps between calls changes no bit of what it finds."""

    def found(rigid, relay):
        section = rigid.poincare(transient=5, returns=40)
        exponents = rigid.lyapunov(transient=50, returns=100)
        orbit = relay.orbit(1, section="switch-up")
        arrays = section.state, section.time, exponents.exponents, orbit.points, orbit.multipliers
        return [it.tobytes() for it in arrays]

    both = percuss.systems[RIGID], percuss.systems["relay-feedback"]
    first = found(*both)
    assert found(*both) == first
    others = percuss.systems[RIGID], percuss.systems["relay-feedback"]
    others[0].basins((-1, 0.5), (-1, 1), grid=4, transient=50)
    assert found(*others) == first


def test_progress_comes_to_its_end(rigid):
    seen = []
    rigid.basins((-1, 0.5), (-1, 1), grid=30, transient=500, progress=lambda *it: seen.append(it))
    assert seen[-1] == (900, 900)
    assert all(a[0] <= b[0] for a, b in zip(seen, seen[1:]))
    percuss.Oscillator().lyapunov(periods=500, progress=lambda *it: seen.append(it))
    assert seen[-1] == (500, 500)


def test_an_exception_of_the_progress_ends_the_work(rigid):
    def stop(done, count):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        # Without an end this would take days.
        rigid.lyapunov(returns=900_000_000, progress=stop)


def test_a_bar_is_drawn_where_tqdm_is_installed(rigid, capsys):
    pytest.importorskip("tqdm")
    rigid.poincare(returns=50, progress=True)
    assert "50/50" in capsys.readouterr().err


def test_pictures(rigid):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    assert rigid.poincare(returns=20).plot().get_ylabel() == "v"
    assert rigid.bifurcation("frequency", [2.5, 2.6], returns=3).plot().get_xlabel() == "frequency"
    branch = rigid.continue_("A", 0.5, 0.6, period=1, transient=300)
    assert branch.plot().get_xlabel() == "A"
    basins = rigid.basins((-1, 0.5), (-1, 1), grid=5, transient=50)
    assert basins.plot().get_xlabel() == "x"
