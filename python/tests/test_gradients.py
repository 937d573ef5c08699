"""Derivatives through events: every number is the command's."""

import csv
import io

import numpy as np
import pytest

import percuss


def asked(name):
    """The names by which a system is differentiated: its parameters and its start."""
    system = percuss.systems[name]
    return [*system.parameters, *(f"start.{state}" for state in system.states)]


def cells(rows, name, column, side=("",)):
    return [row[column] for row in rows if row["wrt"] == name and row["side"] in side]


@pytest.mark.parametrize(
    "name", ["bouncing-ball", "two-state-switching", "rigid-impact-oscillator"]
)
@pytest.mark.parametrize("digits", [17, 25])
def test_digits_are_those_that_the_command_prints(command, name, digits):
    names = asked(name)
    words = ("--events", "5", "--wrt", ",".join(names), "--digits", str(digits))
    code, out, err = command("gradient", name, *words)
    assert code in (0, 1), err
    rows = list(csv.DictReader(io.StringIO(out)))
    run = percuss.systems[name].events(count=5, digits=digits)
    found = run.gradient(names)
    table = {("", ""): found, ("-", "-+"): found.below, ("+", "-+"): found.above}
    seen = 0
    for row in rows:
        n, k = int(row["n"]), names.index(row["wrt"])
        part = table[row["side"], str(found.side[n, k])]
        assert part.digits.time[n, k] == row["dtime"]
        assert (part.reason[n, k] == "") == (row["dtime"] != "")
        assert np.isnan(part.time[n, k]) == (row["dtime"] == "")
        for place, column in enumerate(run.columns):
            assert part.digits.state[n, k, place] == row[f"d{column}"]
        seen += 1
    assert seen == len(found.to_pandas()) >= len(run) * len(names)
    assert found.to_pandas().columns.tolist() == list(rows[0])


def test_a_run_to_a_time_ends_with_derivatives_at_that_time(command):
    words = ("--until", "2.5", "--wrt", "g,e")
    rows = list(csv.DictReader(io.StringIO(command("gradient", "bouncing-ball", *words)[1])))
    found = percuss.systems["bouncing-ball"].events(2.5).gradient(["g", "e"])
    assert found.digits.state[:, 0, 1].tolist() == cells(rows, "g", "dv")
    assert rows[-1]["event"] == "end" and found.time[-1].tolist() == [0, 0]


def test_arrays_are_next_to_the_digits_and_runs_in_f64_agree():
    ball = percuss.systems["bouncing-ball"](e=0.6)
    proved, plain = ball.events(count=6).gradient("e"), ball.simulate(count=6).gradient("e")
    assert proved.state.shape == (7, 1, 2) and proved.time.flags.c_contiguous
    assert proved.time[:, 0].tolist() == [float(it) for it in proved.digits.time[:, 0]]
    # Roundings of numbers up to 10 over six events.
    assert abs(proved.state - plain.state).max() < 1e-14
    with pytest.raises(AttributeError, match="no proved digits"):
        plain.digits


def test_sides_and_reasons_are_told():
    run = percuss.systems["bouncing-ball"].events(count=1)
    found = run.gradient(["start.v", "start.x"])
    assert found.side[1].tolist() == ["", "-+"]
    assert np.isnan(found.time[1, 1]) and "two sides" in str(found.reason[1, 1])
    assert str(found.below.reason[1, 1]) == "the run has other events on that side"
    assert found.above.digits.time[1].tolist() == ["1.0000000000000000", "0.66666666666666667"]
    assert "some of which have none" in repr(found)


@pytest.mark.parametrize(
    ("wrt", "error", "match"),
    [
        ([], TypeError, "one name or more"),
        ([1], TypeError, "one name or more"),
        (["g", "g"], ValueError, "once"),
        ("no-such", ValueError, "no-such"),
        ("start.z", ValueError, "start.z"),
    ],
)
def test_names_that_are_not_accepted_are_told(wrt, error, match):
    run = percuss.systems["bouncing-ball"].events(count=1)
    with pytest.raises(error, match=match):
        run.gradient(wrt)


def test_a_run_back_in_time_has_none():
    run = percuss.systems["bouncing-ball"].events(-1, backward=True)
    with pytest.raises(ValueError, match="a run forward"):
        run.gradient("g")
