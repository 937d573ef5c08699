"""Bad inputs: Python's own exceptions, each with one line that says what is accepted."""

import math

import pytest

import percuss

NAN, INF = math.nan, math.inf
BALL = percuss.systems["bouncing-ball"]
SYSTEM = """schema = 1
name = "ball"
states = ["x", "v"]
[[mode]]
name = "flight"
equations = ["x' = v", "v' = -10"]
[[mode.until]]
name = "impact"
guard = "x < 0"
reset = ["v = -v/2"]
"""


def built(**changes):
    mode = percuss.Mode("on", A=[[0, 1], [0, 0]], c=[0, -1])
    options = {"states": ["x", "v"], "modes": [mode], **changes}
    return percuss.build("own", **options)


def mode(**options):
    return built(modes=[percuss.Mode("on", **options)])


BAD = [
    (lambda: percuss.System("no/such.system.toml"), FileNotFoundError, "such.system.toml"),
    (lambda: percuss.System("\n"), ValueError, "schema"),
    (lambda: percuss.System(7), TypeError, "int is no system"),
    (lambda: percuss.System(SYSTEM.replace('= v"', '= w"')), ValueError, "text:6: w is not known"),
    (lambda: percuss.System(SYSTEM + "odd = 1\n"), ValueError, "odd"),
    (
        lambda: percuss.System(SYSTEM.replace("schema = 1", "schema = 9")),
        ValueError,
        "text:1: the schema",
    ),
    (lambda: percuss.System(SYSTEM).events(1.0), ValueError, "no start"),
    (lambda: percuss.systems["no-such"], KeyError, "no system"),
    (lambda: percuss.systems["bouncing-bal"], KeyError, "bouncing-ball"),
    (lambda: percuss.systems[3], KeyError, "no system"),
    (lambda: BALL(f=1.0), ValueError, "no parameter"),
    (lambda: BALL(e="much"), TypeError, "e = 'much'"),
    (lambda: BALL(e=None), TypeError, "e = None"),
    (lambda: BALL(e=NAN), ValueError, "finite"),
    (lambda: BALL(e=10**400), ValueError, "e is not accepted"),
    (lambda: BALL.at("falling", x=1, v=0), ValueError, "falling"),
    (lambda: BALL.at(x=1), ValueError, "v"),
    (lambda: BALL.at(x=1, v=0, w=0), ValueError, "w"),
    (lambda: BALL.at(x=INF, v=0), ValueError, "x: a finite number"),
    (lambda: BALL.at(3, x=1, v=0), TypeError, "a name is"),
    (lambda: BALL.events(), TypeError, "one of until and count"),
    (lambda: BALL.events(1.0, count=2), TypeError, "one of until and count"),
    (lambda: BALL.events(NAN), ValueError, "until"),
    (lambda: BALL.events(-1.0), ValueError, "at or after the start"),
    (lambda: BALL.events("soon"), TypeError, "until = 'soon'"),
    (lambda: BALL.events(count=0), ValueError, "count = 0"),
    (lambda: BALL.events(count=2.5), TypeError, "an integer is"),
    (lambda: BALL.events(count=True), TypeError, "an integer is"),
    (lambda: BALL.events(count=-3), ValueError, "count = -3"),
    (lambda: BALL.events(1.0, digits=0), ValueError, "digits = 0"),
    (lambda: BALL.events(1.0, digits=301), ValueError, "1 to 300"),
    (lambda: BALL.events(1.0, max_bits=64), ValueError, "106 to 3392"),
    (lambda: BALL.events(1.0, max_events=0), ValueError, "max_events = 0"),
    (lambda: BALL.iterate(1.0, count=2), TypeError, "exclude each other"),
    (lambda: BALL.events(1.0).sol(2.0), ValueError, "the run goes from 0 to 1"),
    (lambda: BALL.events(1.0).sol(NAN), ValueError, "t = NaN"),
    (lambda: BALL.events(1.0).sol([[0.5]]), ValueError, "dimensions"),
    (lambda: BALL.events(1.0).sol(0.5 + 1j), TypeError, "complex"),
    (lambda: BALL.simulate(), TypeError, "one of until, count and returns"),
    (lambda: BALL.simulate(count=2, returns=3), TypeError, "one of until, count and returns"),
    (lambda: BALL.simulate(returns=3), ValueError, "is not forced"),
    (lambda: BALL.simulate(returns=0, section="impact"), ValueError, "returns = 0"),
    (lambda: BALL.simulate(returns=3, section="crash"), ValueError, "impact"),
    (lambda: BALL.simulate(returns=3, section="strobe"), ValueError, "strobe"),
    (lambda: BALL.simulate(returns=3, section="no such"), ValueError, "EVENT@MODE"),
    (lambda: BALL.simulate(returns=3, section=1.0), TypeError, "a name is"),
    (lambda: BALL.simulate(1.0, transient=-1), ValueError, "transient = -1"),
    (lambda: BALL.simulate(returns=10**10, section="impact"), ValueError, "at most 1000000000"),
    (lambda: BALL.simulate(1.0, section="impact"), ValueError, "no effect here"),
    (lambda: BALL.simulate(1.0, every=2), ValueError, "every = 2 has no effect"),
    (lambda: BALL.simulate(1.0, max_time=2), ValueError, "max_time = 2 has no effect"),
    (
        lambda: BALL.simulate(returns=3, section="impact", backward=True),
        ValueError,
        "back in time",
    ),
    (
        lambda: percuss.systems["rigid-impact-oscillator"].simulate(1.0, transient=9),
        ValueError,
        "the end of transient = 9 at",
    ),
    (lambda: BALL.simulate(1.0).enclosure, AttributeError, "no bounds"),
    (lambda: built(states=[]), ValueError, "shape"),
    (lambda: mode(A=[[1, 0]]), ValueError, "shape"),
    (lambda: mode(A=[[NAN, 0], [0, 0]]), ValueError, "finite"),
    (lambda: mode(), TypeError, "no motion"),
    (
        lambda: mode(equations=["x' = v", "v' = 0"], c=[0, 1]),
        TypeError,
        "equations or with matrices",
    ),
    (lambda: mode(c=[0, 1], until=[percuss.Until("up", [1, 2])]), ValueError, "a row of shape"),
    (lambda: mode(c=[0, 1], until=[percuss.Until("up", "x = 1")]), ValueError, "a condition"),
    (lambda: mode(c=[0, 1], until=[percuss.Until("up", "x > 1", next="off")]), ValueError, "off"),
    (lambda: percuss.System(""), ValueError, "path is empty"),
    (lambda: mode(A="ab"), ValueError, "an array of numbers is"),
    (lambda: mode(c=[0, 1], until="up"), TypeError, "a list of Until is"),
    (lambda: mode(c=[0, 1], watch=[3]), TypeError, "a list of Watch is"),
    (lambda: mode(c=[0, 1], B=[[0, 0], [1, 0]]), ValueError, "without forcing"),
    (lambda: built(modes={"a": 1}), TypeError, "a list of Mode is"),
    (lambda: built(forcing=(1,)), ValueError, "two numbers"),
    (
        lambda: percuss.systems["rigid-impact-oscillator"].bifurcation("A", [NAN, 1], returns=1),
        ValueError,
        "finite numbers",
    ),
    (
        lambda: percuss.Oscillator().sweep("basins", {"b": [0.1]}, grid=(2,), transient=1),
        ValueError,
        "'2' for '--grid",
    ),
    (lambda: percuss.Oscillator().sweep("lyapunov", {"b": [0.1]}, progress=True), TypeError, "out"),
    (lambda: percuss.Oscillator(xi=-1), ValueError, "1e-8 <= xi"),
    (lambda: percuss.Oscillator(xi="light"), TypeError, "xi = 'light'"),
    (lambda: percuss.Oscillator(q=0.0, p=1.0), ValueError, "p <= q"),
    (lambda: percuss.Oscillator(phase="resting"), ValueError, "resting"),
    (lambda: percuss.Oscillator(cycle=2**60), ValueError, "cycle"),
    (lambda: percuss.Oscillator(z=1), TypeError, "z"),
    (lambda: percuss.Oscillator().simulate(), TypeError, "one of until, count and periods"),
    (lambda: percuss.Oscillator().simulate(-1.0), ValueError, "until"),
    (lambda: percuss.Oscillator().poincare(periods=0), ValueError, "periods from 1 on"),
    (lambda: percuss.Oscillator().poincare(periods=1, section=NAN), ValueError, "section"),
    (lambda: percuss.Oscillator().orbit(0), ValueError, "period = 0"),
    (
        lambda: percuss.Oscillator().bifurcation("q", [0, 1], periods=1, transient=0),
        ValueError,
        "q",
    ),
    (
        lambda: percuss.Oscillator().bifurcation("b", [0, 1, 3], periods=1, transient=0),
        ValueError,
        "equal steps",
    ),
    (
        lambda: percuss.Oscillator().basins((1, -1), (-1, 1), grid=2, transient=1),
        ValueError,
        "p = -1",
    ),
    (
        lambda: percuss.Oscillator().basins(1, (-1, 1), grid=2, transient=1),
        ValueError,
        "two numbers",
    ),
    (lambda: percuss.score(3), TypeError, "no solver"),
    (lambda: percuss.score(lambda it: it, cases="no-such-*"), ValueError, "matches none"),
    (lambda: percuss.score(lambda it: it, rtol=NAN, cases="small-b"), ValueError, "1e-16 to 0.1"),
    (lambda: percuss.score(lambda it: it, rtol="1e-6", cases="small-b"), TypeError, "rtol"),
    (lambda: percuss.score(lambda it: it, name="Ä", cases="small-b"), ValueError, "name"),
    (lambda: percuss.score(lambda it: it, kind="magic", cases="small-b"), ValueError, "magic"),
    (lambda: percuss.score(lambda it: it, name=1, cases="small-b"), TypeError, "name = 1"),
    (lambda: percuss.score(lambda it: it, order=-1, cases="small-b"), ValueError, "order = -1"),
    (lambda: percuss.score(lambda it: it, stepping=None, cases="small-b"), TypeError, "stepping"),
    (lambda: percuss.score(lambda it: it, stepping="fixed", cases="small-b"), ValueError, "order"),
    (lambda: percuss.score(lambda a, b, c: a, setup="odd", cases="small-b"), ValueError, "odd"),
    (lambda: percuss.score(lambda it: it, method="RK45", cases="small-b"), TypeError, "method"),
    (lambda: percuss.score(lambda it: it, setup="odd", cases="small-b"), ValueError, "odd"),
    (
        lambda: percuss.score(lambda it: it, baseline=__file__, cases="small-b"),
        ValueError,
        "a report.json is",
    ),
    (
        lambda: percuss.score(lambda it: it, out=f"{__file__}/report", cases="small-b"),
        NotADirectoryError,
        "report",
    ),
    (lambda: percuss.problem("no-such"), KeyError, "no case"),
]


@pytest.mark.parametrize(("call", "kind", "told"), BAD, ids=range(len(BAD)))
def test_bad_input_is_told_in_one_line(call, kind, told):
    with pytest.raises(kind) as failure:
        call()
    text = str(failure.value)
    assert told in text
    assert "\n" not in text and len(text) < 400
    assert type(failure.value) is kind or isinstance(failure.value, OSError)
