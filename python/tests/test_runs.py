"""Systems and runs: every number is the command's."""

import copy
import csv
import io
import multiprocessing
import os
import pickle
import threading
from decimal import Decimal

import numpy as np
import pytest

import percuss


def table(text):
    return list(csv.DictReader(io.StringIO(text)))


@pytest.mark.parametrize("name", list(percuss.systems))
@pytest.mark.parametrize("digits", [17, 25])
def test_digits_are_those_that_the_command_prints(command, name, digits):
    code, out, err = command("events", name, "--events", "12", "--digits", str(digits))
    assert code in (0, 1), err
    rows = table(out)
    run = percuss.systems[name].events(count=12, digits=digits)
    assert len(run) == len(rows)
    assert run.digits.time.tolist() == [row["time"] for row in rows]
    assert run.name.tolist() == [row["event"] for row in rows]
    assert run.mode.tolist() == [row["mode"] for row in rows]
    for place, state in enumerate(run.states):
        column = state if state in rows[0] else f"state.{state}"
        assert run.digits.state[:, place].tolist() == [row[column] for row in rows]


def test_a_horizon_and_a_stop_end_a_run_as_the_command_does(command):
    rows = table(command("events", "watched-ball", "--until", "3.5")[1])
    run = percuss.systems["watched-ball"].events(3.5)
    assert run.digits.time.tolist() == [row["time"] for row in rows]
    assert run.ending == rows[-1]["event"]
    rows = table(command("events", "relay-feedback", "--until", "90", "--max-events", "4")[1])
    run = percuss.systems["relay-feedback"].events(90, max_events=4)
    assert run.name.tolist() == [row["event"] for row in rows]
    assert run.ending == "stopped"


def test_arrays_are_the_nearest_to_the_digits_and_lie_in_their_enclosure():
    run = percuss.systems["rigid-impact-oscillator"].events(count=20, digits=25)
    assert run.time.flags.c_contiguous and run.state.flags.owndata is not None
    assert run.state.shape == (21, len(run.states))
    lower, upper = run.enclosure.time.T
    assert (lower <= run.time).all() and (run.time <= upper).all()
    for text, low, high in zip(run.digits.time, lower, upper):
        # The last digit may be rounded: the decimal lies within its half of the number.
        slack = abs(Decimal(str(text))) * Decimal("1e-24")
        assert Decimal(float(low)) - slack <= Decimal(str(text)) <= Decimal(float(high)) + slack
    # Two roundings of f64 and the proved bound.
    assert (upper - lower <= 8 * np.spacing(np.maximum(abs(run.time), 1))).all()


def test_a_ball_falls_as_it_must():
    ball = percuss.systems["bouncing-ball"](e=0.6).at(x=2.0, v=0.0)
    run = ball.events(24, digits=40)
    assert run.digits.time[1] == "1.414213562373095048801688724209698078570"
    assert run.ending == "accumulation" and run.is_decided
    earliest, latest = (Decimal(it) for it in run.accumulation)
    # A fall from 2 with g = 2 takes 2^(1/2), and each flight is 0.6 times the one before.
    limit = Decimal(2).sqrt() * (1 + 2 * Decimal("0.6") / Decimal("0.4"))
    assert abs(earliest - limit) < Decimal("1e-14") and earliest <= latest


def test_the_motion_between_events_is_the_closed_form():
    run = percuss.systems["bouncing-ball"].events(2.875)
    times = np.linspace(0, 1.5 - 1e-9, 57)
    x, v = run.sol(times)
    # A throw at 1.5 with g = 2: the bound is some roundings of numbers up to 2.25.
    assert abs(x - (1.5 * times - times**2)).max() < 9e-16
    assert abs(v - (1.5 - 2 * times)).max() < 9e-16
    assert run.sol(0.5).shape == (2,)
    after = run.sol(run.time)
    assert after.T.tolist() == run.state.tolist()
    with pytest.raises(ValueError, match="t = 4.5 is not accepted: the run goes from 0 to 2.875"):
        run.sol(4.5)


def test_the_motion_agrees_with_samples_of_the_command(command):
    rows = table(command("events", "buck-converter", "--until", "0.002", "--samples", "7")[1])
    run = percuss.systems["buck-converter"].events(0.002)
    times = [float(row["time"]) for row in rows]
    states = run.sol(times)
    for place, state in enumerate(run.states):
        exact = np.array([float(row[state]) for row in rows])
        # The closed forms have 106 bits; what is left is the rounding of the times to f64, over
        # which the states change at rates of up to 1e5.
        assert abs(states[place] - exact).max() < 1e-12 * max(1, abs(exact).max())


def test_f64_runs_have_the_same_events():
    for name in ("watched-impact-oscillator", "spheres-in-a-row", "two-state-switching"):
        fast = percuss.systems[name].simulate(count=8)
        exact = percuss.systems[name].events(count=8)
        assert fast.name.tolist() == exact.name.tolist()
        assert abs(fast.time - exact.time).max() < 1e-9
        with pytest.raises(AttributeError, match="no proved digits"):
            fast.digits


RIGID, RELAY, BALL = "rigid-impact-oscillator", "relay-feedback", "bouncing-ball"
MEASURED = [
    (RIGID, {"returns": 7}, None),
    (RIGID, {"returns": 5, "transient": 20}, "end"),
    (RIGID, {"returns": 5, "transient": 20, "every": 3}, "end"),
    (RIGID, {"returns": 4, "transient": 2, "section": "strobe:pi/2"}, "end"),
    (RIGID, {"returns": 4, "section": "strobe:-1", "every": 2}, "end"),
    (RIGID, {"count": 9, "transient": 20}, None),
    (RIGID, {"until": 60.0, "transient": 3, "section": "strobe"}, "end"),
    (RIGID, {"returns": 6, "transient": 4, "section": "impact", "every": 2}, None),
    (RIGID, {"count": 5, "transient": 10, "section": "impact"}, None),
    (RIGID, {"until": 60.0, "transient": 3, "section": "impact"}, "end"),
    (RIGID, {"until": 60.0, "transient": 1000, "section": "impact"}, "end"),
    (RELAY, {"returns": 3, "transient": 2, "section": "switch-up@down"}, None),
    (RELAY, {"returns": 3, "section": "switch-up", "max_time": 1.9}, "end"),
    (RELAY, {"count": 4, "transient": 3, "section": "switch-up", "every": 2}, None),
    (BALL, {"returns": 10_000, "section": "impact"}, "accumulation"),
    (BALL, {"until": 2.5, "transient": 10_000, "section": "impact"}, "end"),
    (BALL, {"count": 3, "transient": 10_000, "section": "impact"}, "accumulation"),
    ("percussive-oscillator", {"returns": 3, "transient": 5}, "end"),
    ("dry-friction-oscillator", {"returns": 2, "transient": 5, "section": "strobe:1"}, "end"),
]


@pytest.mark.parametrize(("name", "asked", "ending"), MEASURED)
def test_runs_in_returns_have_the_bytes_of_the_command(command, name, asked, ending):
    names = {"count": "events"}
    flags = [(f"--{names.get(it, it).replace('_', '-')}", f"{at}") for it, at in asked.items()]
    code, out, err = command("simulate", name, *["=".join(flag) for flag in flags])
    assert code == 0, err
    rows, system = table(out), percuss.systems[name]
    run = system.simulate(**asked)
    known = np.array([[float(row[it]) for it in ("time", *system.states)] for row in rows])
    assert np.column_stack([run.time, run.state]).tobytes() == known.tobytes()
    assert run.name.tolist() == [row["event"] for row in rows]
    assert run.mode.tolist() == [row["mode"] for row in rows]
    if ending is not None:
        assert run.ending == ending == rows[-1]["event"]
    assert (run.cause is None) == ("returns:" not in err)


def test_a_run_that_does_not_return_says_why():
    relay = percuss.systems[RELAY]
    run = relay.simulate(returns=3, section="switch-up", max_time=1.9)
    assert run.cause == "the motion does not return to the section"
    assert percuss.systems[RIGID].simulate(returns=2).cause is None


def test_returns_are_those_of_the_section():
    """A run between returns and a section are made in two ways."""
    rigid = percuss.systems[RIGID]
    section = rigid.poincare(returns=9, transient=30, section="impact")
    run = rigid.simulate(returns=8, transient=31, section="impact")
    shown = (run.name == "impact") | (run.name == "")
    # Of 39 impacts each may grow what roundings of 1e-16 leave by some tenths of a decade.
    assert abs(run.time[shown] - section.time).max() < 1e-9
    assert abs(run.state[shown] - section.state).max() < 1e-9


def test_runs_in_returns_have_their_motion_and_their_derivatives():
    relay = percuss.systems[RELAY]
    run = relay.simulate(returns=2, section="switch-up")
    whole = relay.simulate(count=len(run) - 1)
    assert run.time.tobytes() == whole.time.tobytes()
    assert run.sol(1.0).tobytes() == whole.sol(1.0).tobytes()
    gradient, known = run.gradient("delta"), whole.gradient("delta")
    assert gradient.state.tobytes() == known.state.tobytes()
    # What is left out is differentiated through: rows are those of the whole run.
    late = relay.simulate(returns=1, transient=1, section="switch-up").gradient("delta")
    assert late.time.tobytes() == known.time[-3:].tobytes()


def test_iteration_gives_the_same_rows_and_its_ending():
    system = percuss.systems["bouncing-ball"]
    run, stream = system.events(24, digits=25), system.iterate(24, digits=25)
    rows = list(stream)
    assert [row.digits[0] for row in rows] == run.digits.time.tolist()
    assert [row.time for row in rows] == run.time.tolist()
    assert [row.digits[1] for row in rows] == run.digits.state.tolist()
    assert stream.ending == "accumulation"
    assert list(stream) == []


def test_an_endless_iteration_can_be_left():
    for _ in range(20):
        stream = percuss.systems["percussive-oscillator"].iterate()
        assert next(stream).name == ""
        del stream


def test_a_run_back_in_time_ends_where_it_began():
    oscillator = percuss.systems["watched-ball"]
    run = oscillator.events(-0.25, backward=True)
    assert run.time[-1] <= 0 and run.ending in ("end", "leaves-domain")
    assert run.sol(run.time[-1] / 2).shape == (len(run.states),)


def test_systems_are_changed_without_changing_others():
    ball = percuss.systems["bouncing-ball"]
    bouncy = ball(e=0.9)
    assert (ball.parameters["e"], bouncy.parameters["e"]) == (0.5, 0.9)
    high = bouncy.at("flight", t=1.0, x=4.0, v=0.0)
    assert high.parameters["e"] == 0.9
    assert high.events(count=1).time.tolist() == [1.0, 3.0]


def test_a_file_and_its_text_are_the_same_system(tmp_path, repository):
    path = repository / "validation/systems/newton-cradle.system.toml"
    by_path, by_text = percuss.System(path), percuss.System(path.read_text())
    assert by_path.name == by_text.name == "newton-cradle"
    assert by_path.events(5).digits.time.tolist() == by_text.events(5).digits.time.tolist()


def test_built_systems_are_the_systems_of_files():
    forced = percuss.build(
        "forced",
        states=["x", "v"],
        forcing=(1.25, 0.0),
        modes=[
            percuss.Mode(
                "on",
                A=[[0, 1], [-1, -0.1]],
                B=[[0, 0], [0.3, 0]],
                watch=[percuss.Watch("up", [1, 0, 0, 0, -0.25], "rising")],
                until=[percuss.Until("hit", "x > 3", reset=["v = -v"], next=[(None, "on")])],
            )
        ],
        start={"mode": "on", "x": 0, "v": 1.5},
    )
    written = percuss.build(
        "forced",
        states=["x", "v"],
        parameters={"d": 0.1, "a": 0.3, "level": 0.25},
        forcing=(1.25, 0.0),
        modes=[
            percuss.Mode(
                "on",
                ["x' = v", "v' = a*cos - x - d*v"],
                watch=[percuss.Watch("up", "x > level")],
                until=[percuss.Until("hit", "x > 3", reset=["v = -v"])],
            )
        ],
        start={"mode": "on", "x": 0, "v": 1.5},
    )
    one, other = forced.events(30), written.events(30)
    assert len(one) > 3 and one.digits.time.tolist() == other.digits.time.tolist()


def test_threads_share_a_system():
    system, found = percuss.systems["rigid-impact-oscillator"], {}
    expected = system.events(count=40).digits.time.tolist()

    def run(n):
        found[n] = system.events(count=40).digits.time.tolist()

    threads = [threading.Thread(target=run, args=(n,)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(found[n] == expected for n in range(4))


def first_impact(height):
    return percuss.systems["bouncing-ball"].at(x=height, v=0.0).events(count=1).time[1]


def test_processes_share_the_work():
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert pool.map(first_impact, [4.0, 16.0, 36.0]) == [2.0, 4.0, 6.0]


def test_systems_and_oscillators_are_copied_and_pickled():
    changed = percuss.systems["bouncing-ball"](e=0.6).at("flight", x=4, v=0)
    oscillator = percuss.Oscillator(xi=0.1, p=0.2, y=0.1)
    for copied in (copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))):
        run, same = changed.events(count=5), copied(changed).events(count=5)
        assert np.array_equal(run.time, same.time) and np.array_equal(run.state, same.state)
        assert np.array_equal(
            oscillator.simulate(20).state, copied(oscillator).simulate(20).state
        )
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.map(impacts, [changed]) == [5]


def test_runs_and_gradients_are_pickled():
    relay = percuss.systems["relay-feedback"]
    measured = relay.simulate(returns=2, transient=5, section="switch-up", every=2)
    proved = percuss.systems["bouncing-ball"](e=0.75).at("flight", x=4, v=0).events(3, digits=25)
    for run in (measured, proved, relay.simulate(3)):
        same = pickle.loads(pickle.dumps(run))
        assert np.array_equal(run.time, same.time) and np.array_equal(run.state, same.state)
        assert run.ending == same.ending and np.array_equal(run.name, same.name)
    assert np.array_equal(pickle.loads(pickle.dumps(proved)).digits.time, proved.digits.time)
    gradient = proved.gradient(["e", "start.x"])
    assert np.array_equal(pickle.loads(pickle.dumps(gradient)).state, gradient.state)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert [len(it) for it in pool.map(run_of, [4.0])] == [2]


def run_of(height):
    return percuss.systems["bouncing-ball"].at(x=height, v=0.0).events(count=1)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_has_threads_of_its_own():
    expected = cells(0)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.map_async(cells, [0]).get(timeout=120) == [expected]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_prepares_solvers_that_its_parent_has_not():
    expected = times(0.125)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.map_async(times, [0.125, 0.25]).get(timeout=120)[0] == expected


def times(value):
    relay = percuss.systems["relay-feedback"](delta=value)
    returns = relay.poincare(returns=3, section="switch-down")
    stream = [row.time for row, _ in zip(relay.iterate(), range(3))]
    return [
        relay.events(count=4, digits=25).digits.time.tolist(),
        relay.simulate(count=4).time.tolist(),
        returns.time.tolist(),
        stream,
        percuss.Oscillator(b=value).events(count=3).time.tolist(),
    ]


def cells(_):
    basins = percuss.Oscillator(xi=0.1).basins((0, 1), (0, 1), grid=8, transient=40)
    return basins.labels.tolist()


def impacts(system):
    return len(system.events(count=5)) - 1


def test_an_enclosure_is_of_the_run_whatever_becomes_of_its_arrays():
    run = percuss.systems["bouncing-ball"].events(count=2)
    run.time[0] = 9
    low, high = run.enclosure.time[0]
    assert low <= 0 <= high


def test_tables_and_pictures():
    run = percuss.systems["bouncing-ball"].events(2.5)
    frame = run.to_pandas()
    assert frame.columns.tolist() == ["time", "event", "mode", "x", "v"]
    assert len(frame) == len(run)
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    assert run.plot().get_xlabel() == "time"
