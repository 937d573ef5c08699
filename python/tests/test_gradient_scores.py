"""Scores of derivatives: the judgement is the command's."""

import copy
import json

import numpy as np
import pytest

import percuss


def ball(problem, forgets_time=False):
    """The bouncing ball in closed form, with the derivatives of its impacts by the chain rule."""
    (rule,) = problem.modes.values()
    (impact,) = rule.events
    t, z, gravity = 0.0, problem.state, -rule.c[1]
    slopes = [it.state for it in problem.by]
    events, times, states = [], [], []

    def flow(span):
        moved = np.array([z[0] + z[1] * span - gravity * span**2 / 2, z[1] - gravity * span])
        of_fall = np.array([span**2 / 2, span])
        along = np.array([[1.0, span], [0.0, 1.0]])
        modes = [it.modes[rule.name] for it in problem.by]
        return moved, [along @ s + of_fall * it.c[1] for s, it in zip(slopes, modes)]

    while True:
        span = (z[1] + np.sqrt(z[1] ** 2 + 2 * gravity * z[0])) / gravity
        if t + span > problem.horizon:
            break
        before, slopes = flow(span)
        t += span
        rate = problem.rates(rule.name, t, before)
        by_time = [0.0 if forgets_time else -s[0] / rate[0] for s in slopes]
        _, z = problem.after(impact, t, before)
        wide, after = problem.wide(t, before), problem.rates(rule.name, t, z)
        ends = []
        for s, dt, it in zip(slopes, by_time, problem.by):
            (reset,) = it.modes[rule.name].resets
            ends.append(impact.reset[:, :2] @ (s + rate * dt) + reset @ wide)
        slopes = [s - after * dt for s, dt in zip(ends, by_time)]
        events.append(percuss.Happened(t, impact.name, rule.name, z))
        times.append(by_time)
        states.append(ends)
    z, slopes = flow(problem.horizon - t)
    gradients = [
        percuss.Differentiated(it.wrt, [k[n] for k in times], [k[n] for k in states], slopes[n])
        for n, it in enumerate(problem.by)
    ]
    samples = np.repeat(z[None], len(problem.sample_times), axis=0)
    return percuss.Answer(events, samples, gradients=gradients)


def forgetful(problem):
    return ball(problem, forgets_time=True)


def test_right_derivatives_are_right_and_a_missing_term_is_named(command, tmp_path):
    report = percuss.score_gradients(ball, cases=["ball-dropped", "ball-first-impacts"])
    assert set(report.summary) == {"right"}, str(report)
    report.raise_for_failures()
    report = percuss.score_gradients(forgetful, cases="ball-dropped")
    assert {it.wrt for it in report.verdicts} == {"g", "e", "start.x", "start.v"}
    # By the height alone nothing but the times has a derivative.
    found = {(it.verdict, it.missing_term) for it in report.verdicts}
    assert found == {("missing-term", "no-time-derivative"), ("zero", None)}, str(report)
    with pytest.raises(percuss.ScoreFailure, match="8 of 8 derivatives:\nball-dropped by"):
        report.raise_for_failures()
    assert "no-time-derivative" in report._repr_html_()
    # The command says the same of the same files.
    from percuss._score import write

    write(tmp_path, problem := percuss.gradient_problem("ball-dropped"), forgetful(problem))
    words = ["--name", "own", "--tolerance", "1e-6", "--answers", str(tmp_path)]
    words += ["-c", "^ball-dropped$", "--out", str(tmp_path / "report")]
    code, _, err = command("score", *words)
    assert code in (0, 1), err
    told = json.loads((tmp_path / "report/report.json").read_text())["gradients"]
    alone = percuss.score_gradients(forgetful, cases="ball-dropped", rtol=1e-6).verdicts
    own = {it.wrt: (it.verdict, it.missing_term, it.why) for it in alone}
    assert own == {it["wrt"]: (it["verdict"], it["missing_term"], it["why"]) for it in told}


def differences(problem):
    """Forward differences of whole runs over a step of 1e-4, which is too long."""
    step, own, gradients = 1e-4, ball(problem), []
    for it in problem.by:
        other = copy.deepcopy(problem)
        other.state += step * it.state
        for name, mode in other.modes.items():
            mode.c[:] += step * it.modes[name].c
            for event, reset in zip(mode.events, it.modes[name].resets):
                event.reset[:] += step * reset
        moved = ball(other)
        pairs = list(zip(moved.events, own.events))
        times = [(a.time - b.time) / step for a, b in pairs]
        states = [(a.state - b.state) / step for a, b in pairs]
        end = (moved.samples[-1] - own.samples[-1]) / step
        gradients.append(percuss.Differentiated(it.wrt, times, states, end))
    own.gradients = gradients
    return own


def test_a_step_that_is_too_long_is_named_where_differences_are_declared():
    for declared in (True, False):
        report = percuss.score_gradients(differences, cases="ball-dropped", differences=declared)
        terms = {it.missing_term for it in report.failures}
        assert ("coarse-differences" in terms) == declared, str(report)


def test_what_is_no_answer_is_refused_with_its_reason():
    def silent(problem):
        raise RuntimeError(f"no idea of {problem.case}")

    (row, *_) = percuss.score_gradients(silent, cases="ball-dropped", rtol=1e-6).verdicts
    assert row.verdict == "refused" and "RuntimeError: no idea of ball-dropped" in row.why
    (row, *_) = percuss.score_gradients(lambda it: 3, cases="ball-dropped", name="own").verdicts
    assert row.verdict == "refused" and "int is no answer" in row.why


@pytest.mark.parametrize(
    "call, error, words",
    [
        (lambda: percuss.score_gradients(3), TypeError, "is no solver"),
        (lambda: percuss.score_gradients(ball, cases="nothing"), ValueError, "matches none of"),
        (lambda: percuss.score_gradients(ball, rtol=2.0), ValueError, "1e-16 to 0.1"),
        (lambda: percuss.score_gradients(ball, rtol=[1e-6, 1e-6]), ValueError, "each once"),
        (lambda: percuss.score_gradients(ball, name="a b"), ValueError, "is not accepted"),
        (lambda: percuss.gradient_problem("small-b"), KeyError, "is no case of derivatives"),
    ],
)
def test_bad_inputs_have_one_clear_line(call, error, words):
    with pytest.raises(error, match=words) as raised:
        call()
    assert "\n" not in str(raised.value)
