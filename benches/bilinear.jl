# The bilinear oscillator of bilinear.system.toml by DifferentialEquations.jl with callbacks, as
# python/benches/beside_solve_ivp.py runs it by SciPy:
#
#     julia --project=validation/programs/julia -e 'import Pkg; Pkg.instantiate()'
#     julia --project=validation/programs/julia benches/bilinear.jl
#
# Printed are microseconds per forcing period, the median of rounds after one that compiles, the
# number of events, and the time of the last, of as many periods as errors are compared over there.
# Written against version 6 of OrdinaryDiffEq and its documentation; it has not been run where it
# was written, because no Julia was in reach.

using OrdinaryDiffEq

const SIZE, DAMPING, STIFFNESS, GAP, OMEGA = 0.7, 0.05, 30.0, 1.2, 1.3
const PERIOD = 2 * pi / OMEGA
const PERIODS, SHORT, ROUNDS = 100, 10, 5

mutable struct Rig
    in_contact::Bool
    events::Vector{Float64}
end

function rates!(out, z, rig, t)
    spring = rig.in_contact ? STIFFNESS * (z[1] - GAP) : 0.0
    out[1] = z[2]
    out[2] = SIZE * cos(OMEGA * t) - 2 * DAMPING * z[2] - z[1] - spring
    nothing
end

function switch!(integrator, in_contact)
    integrator.p.in_contact == in_contact && return
    integrator.p.in_contact = in_contact
    push!(integrator.p.events, integrator.t)
end

crossing = ContinuousCallback(
    (z, t, integrator) -> z[1] - GAP,
    integrator -> switch!(integrator, true),
    integrator -> switch!(integrator, false);
    save_positions = (false, false),
)

function followed(method, tolerance, periods)
    rig = Rig(false, Float64[])
    problem = ODEProblem(rates!, [0.0, 0.0], (0.0, periods * PERIOD), rig)
    solution = solve(problem, method; callback = crossing, reltol = tolerance, abstol = tolerance,
                     dtmax = PERIOD / 8, saveat = PERIOD)
    rig.events, solution.u
end

middle(times) = sort(times)[div(length(times) + 1, 2)]

for (name, method) in (("Tsit5", Tsit5()), ("Vern9", Vern9())), tolerance in (1e-6, 1e-9, 1e-12)
    followed(method, tolerance, PERIODS)
    seconds = middle([@elapsed followed(method, tolerance, PERIODS) for _ in 1:ROUNDS])
    events, _ = followed(method, tolerance, SHORT)
    println(name, " ", tolerance, ": ", round(1e6 * seconds / PERIODS; digits = 2), " us/period, ",
            length(events), " events, the last at ", isempty(events) ? NaN : events[end])
end
