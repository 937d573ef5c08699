"""Exact events of systems with impacts, friction and switches, and ODE solvers held against them.

Examples
--------
An event with proved digits, and the motion between events:

>>> import percuss
>>> run = percuss.systems["bouncing-ball"](e=0.6).events(until=24, digits=25)
>>> print(run.digits.time[2], run.ending)
2.399999999999999966693309 accumulation
>>> run.sol(1.0)
array([ 0.5, -0.5])

Which start leads where:

>>> basins = percuss.Oscillator().basins((-1, 1), (-1, 1), grid=8, transient=100)
>>> basins.labels.shape
(8, 8)

A verdict on an integrator:

>>> from scipy.integrate import solve_ivp
>>> report = percuss.score(solve_ivp, method="DOP853", rtol=1e-6, cases="small-b")
>>> report.summary["error"]
0
"""

from importlib.metadata import version as _version

from percuss._build import Mode, Until, Watch, build
from percuss._gradient import Derivatives, Gradient
from percuss._gradient_score import (
    GradientReport,
    Verdict,
    gradient_case_names,
    gradient_problem,
    score_gradients,
)
from percuss._oscillator import Oscillator, Simulation
from percuss._problem import (
    Answer,
    Differentiated,
    EventRule,
    Happened,
    ModeRates,
    ModeRule,
    Problem,
    Rates,
    Successor,
)
from percuss._report import Report, ScoreFailure
from percuss._results import Attractor, Basins, Bifurcation, Lyapunov, Orbit, Section
from percuss._returns import (
    Branch,
    BranchBifurcation,
    ReturnAttractor,
    ReturnBasins,
    ReturnDiagram,
    ReturnExponents,
    ReturnOrbit,
    Returns,
)
from percuss._run import Digits, Enclosure, Run, Sol, Stream
from percuss._score import case_names, problem, score
from percuss._sweep import Sweep
from percuss._system import System, Systems, systems

__version__ = _version("percuss")

__all__ = [
    "Answer",
    "Attractor",
    "Basins",
    "Bifurcation",
    "Branch",
    "BranchBifurcation",
    "Derivatives",
    "Differentiated",
    "Digits",
    "Enclosure",
    "EventRule",
    "Gradient",
    "GradientReport",
    "Happened",
    "Lyapunov",
    "Mode",
    "ModeRates",
    "ModeRule",
    "Orbit",
    "Oscillator",
    "Problem",
    "Rates",
    "Report",
    "ReturnAttractor",
    "ReturnBasins",
    "ReturnDiagram",
    "ReturnExponents",
    "ReturnOrbit",
    "Returns",
    "Run",
    "ScoreFailure",
    "Section",
    "Simulation",
    "Sol",
    "Stream",
    "Successor",
    "Sweep",
    "System",
    "Systems",
    "Until",
    "Verdict",
    "Watch",
    "build",
    "case_names",
    "gradient_case_names",
    "gradient_problem",
    "problem",
    "score",
    "score_gradients",
    "systems",
]
