"""Results as numbers and data sets of other libraries, and sweeps."""

from decimal import Decimal

import numpy as np
import pytest

import percuss


@pytest.fixture()
def run():
    return percuss.systems["rigid-impact-oscillator"].events(count=6, digits=40)


def test_digits_are_kept_by_mpmath(run):
    mpmath = pytest.importorskip("mpmath")
    found = run.digits_as("mpmath")
    assert found.state.shape == (7, 2) and isinstance(found.time[1], mpmath.mpf)
    with mpmath.workdps(60):
        text = mpmath.nstr(found.time[6], 40, strip_zeros=False)
    assert Decimal(text) == Decimal(str(run.digits.time[6]))


def test_balls_of_flint_hold_the_numbers(run):
    flint = pytest.importorskip("flint")
    found = run.digits_as("flint")
    more = percuss.systems["rigid-impact-oscillator"].events(count=6, digits=60)
    flint.ctx.prec = 300
    for ball, text in zip(found.time[1:], more.digits.time[1:]):
        assert ball.contains(flint.arb(str(text)).mid())
        assert float(ball.rad()) <= 1e-37 * abs(float(ball.mid()))


def test_kinds_that_are_not_known_are_told(run):
    assert run.digits_as("decimal").time[0] == Decimal(0)
    with pytest.raises(ValueError, match="kind = 'gmp'"):
        run.digits_as("gmp")
    with pytest.raises(AttributeError, match="f64"):
        percuss.systems["bouncing-ball"].simulate(count=1).digits_as("decimal")


def test_columns_of_returns_are_those_of_the_command():
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    text = """
        schema = 1
        name = "clocked"
        states = ["time", "labels"]
        forcing = { omega = 2, phi = 0 }
        [[mode]]
        name = "on"
        equations = ["time' = labels", "labels' = cos - time - labels"]
        [start]
        mode = "on"
        time = 0
        labels = 1
    """
    clocked = percuss.System(text)
    returns = clocked.poincare(returns=2)
    table = returns.to_pandas()
    assert list(table) == ["time", "mode", "state.time", "labels"]
    assert table["time"].to_list() == returns.time.tolist()
    found = returns.to_xarray()
    assert found["state.time"].values.tolist() == table["state.time"].to_list()
    assert found["mode"].values.tolist() == ["on", "on"]
    basins = clocked.basins((-1, 1), (-1, 1), grid=2, transient=60)
    assert set(basins.to_xarray().coords) == {"state.time", "state.labels"}


def test_data_sets_hold_the_arrays(run):
    pytest.importorskip("xarray")
    times = np.linspace(0, run.time[-1], 11)
    motion = run.to_xarray(times)
    assert motion["x"].values.tobytes() == run.sol(times)[0].tobytes()
    oscillator = percuss.Oscillator()
    basins = oscillator.basins((-1, 1), (-0.5, 0.5), grid=(6, 4), transient=50)
    labels = basins.to_xarray()["labels"]
    assert labels.dims == ("y", "p") and (labels.values == basins.labels).all()
    assert labels.sel(p=basins.p[2], y=basins.y[1]) == basins.labels[1, 2]
    diagram = oscillator.bifurcation("b", [0.1, 0.2], transient=5, periods=3).to_xarray()
    assert diagram["p"].sizes == {"point": 6} and diagram["b"].values[-1] == 0.2
    rig = percuss.systems["rigid-impact-oscillator"]
    found = rig.basins((-1, 0.1), (-1, 1), grid=3, transient=20).to_xarray()
    assert found["labels"].dims == ("v", "x")
    assert rig.bifurcation("A", [0.5, 0.6], returns=2).to_xarray()["x"].sizes == {"point": 4}


def test_branches_are_tables_and_data_sets():
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    buck = percuss.systems["buck-converter"].continue_(
        "Vin", 24, 25, section="clock", transient=200, period=1
    )
    table, found = buck.to_pandas(), buck.to_xarray()
    assert list(table) == ["Vin", *buck.states, "mode", "time", "stable"]
    assert table["stable"].to_list() == found["stable"].values.tolist() == buck.stable.tolist()
    assert table["v"].to_list() == found["v"].values.tolist() == buck.points[:, 0].tolist()
    assert found["multipliers"].values.tolist() == buck.multipliers.tolist()
    own = percuss.Oscillator().continue_("b", 0.1, 0.1001, period=1).to_pandas()
    assert list(own) == ["b", "p", "y", "q", "stable"]


def test_sweeps_are_those_of_single_runs(tmp_path):
    axes = {"omega": np.linspace(0.9, 1.1, 3), "b": [0.1, 0.15]}
    found = percuss.Oscillator(p=0.01).sweep(
        "lyapunov", axes, transient=20, periods=50, out=tmp_path / "shards"
    )
    assert {name: len(values) for name, values in found.axes.items()} == {"omega": 3, "b": 2}
    for i, omega in enumerate(found.axes["omega"]):
        for k, b in enumerate(found.axes["b"]):
            alone = percuss.Oscillator(p=0.01, omega=omega, b=b)
            spectrum = alone.lyapunov(transient=20, periods=50)
            assert found["exponents_per_period"][i, k].tolist() == spectrum.exponents.tolist()
            assert found["drift_per_period"][i, k] == spectrum.drift


def test_sweeps_of_a_system_are_those_of_single_runs():
    rig = percuss.systems["rigid-impact-oscillator"](r=0.7).at(x=-0.5, v=0.1)
    axes = {"A": [0.5, 0.6], "r": [0.6, 0.7]}
    found = rig.sweep("lyapunov", axes, transient=20, returns=50)
    states = rig.sweep("bifurcation", axes, transient=20, returns=3, reset=True)["state"]
    for i, amplitude in enumerate(axes["A"]):
        for k, r in enumerate(axes["r"]):
            alone = rig(A=amplitude, r=r)
            exponents = alone.lyapunov(transient=20, returns=50).exponents
            assert found["exponents_per_return"][i, k].tolist() == exponents.tolist()
            points = alone.poincare(returns=3, transient=20).state
            assert states[i, k].tolist() == points.tolist()
    built = percuss.System(RIG).sweep("basins", {"mode": [0.5, 0.6]}, **GRID)
    assert built.axes["mode"].tolist() == [0.5, 0.6]
    assert built["labels"].shape == (2, 3, 3) and built["x"].shape == (3,)


# A parameter has the name of an array: its axis is stored under a longer one.
RIG = """
schema = 1
name = "rig"
states = ["x", "v"]
[parameters]
mode = 0.5
speed = 2.8
damping = 0.1
gap = 0.125
[forcing]
omega = "speed"
[[mode]]
name = "free"
equations = ["x' = v", "v' = -x - damping*v + mode*cos"]
[[mode.until]]
name = "impact"
guard = "x > gap"
reset = ["x = gap", "v = -v/2"]
[start]
mode = "free"
x = 0
v = 0
"""
GRID = {"grid": "3x3", "window": [-1, 0.1, -1, 1], "transient": 20}


@pytest.mark.parametrize("flags", [{"set": "A=1"}, {"start": "x.toml"}, {"periods": 3}])
def test_flags_that_a_system_has_already_are_told(flags):
    rig = percuss.systems["rigid-impact-oscillator"]
    with pytest.raises(ValueError, match=next(iter(flags))):
        rig.sweep("lyapunov", {"A": [0.5, 0.6]}, transient=1, returns=2, **flags)


def test_a_sweep_varies_the_parameter_of_its_verb():
    axes = {"b": [0.1, 0.15]}
    diagram = {"parameter": "omega", "from_": 1.0, "to": 1.1, "steps": 2, "transient": 5}
    found = percuss.Oscillator().sweep("bifurcation", axes, **diagram, periods=3)
    alone = percuss.Oscillator(b=0.15).bifurcation("omega", [1, 1.1], transient=5, periods=3)
    assert found["p"][1].ravel().tobytes() == alone.points[:, 0].tobytes()
    ends = {"parameter": "omega", "from_": 1.0, "to": 1.001, "period": 1}
    assert percuss.Oscillator().sweep("continue", axes, **ends).axes["b"].tolist() == axes["b"]


def test_sweeps_are_data_sets():
    pytest.importorskip("xarray")
    found = percuss.Oscillator().sweep("lyapunov", {"b": [0.1, 0.2]}, transient=5, periods=20)
    data = found.to_xarray()
    assert data["drift_per_period"].dims == ("b",)
    assert data["exponents_per_period"].shape == (2, 3)


@pytest.mark.parametrize(
    ("verb", "axes", "flags", "match"),
    [
        ("simulate", {"b": [0.1, 0.2]}, {}, "simulate"),
        ("lyapunov", {}, {}, "one or two"),
        ("lyapunov", {"z": [0.1, 0.2]}, {"transient": 1, "periods": 2}, "z"),
        ("lyapunov", {"b": [0.1, 0.2]}, {"no_such": 1}, "no-such"),
        ("lyapunov", {"b": [0.1, 0.2, 0.4]}, {}, "equal steps"),
        ("lyapunov", {"b": [0.1, 0.2]}, {"transient": float("nan")}, "finite"),
    ],
)
def test_plans_that_are_not_accepted_are_told(verb, axes, flags, match):
    with pytest.raises(ValueError, match=match):
        percuss.Oscillator().sweep(verb, axes, **flags)
