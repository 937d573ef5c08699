# OrdinaryDiffEq.jl with its callbacks, run by percuss. Written against version 6 and its
# documentation, and reviewed; it has not been run where it was written, because no Julia was in
# reach.
#
# `METHOD-default` is the documentation's bouncing ball: a VectorContinuousCallback whose effect
# ends the run, the tolerances, and nothing else. `METHOD` is what an expert adds:
#
# - Steps are at most an eighth of a forcing period and of a turn. Within a step the library looks
#   at ten points of its interpolant by itself.
# - `rootfind = SciMLBase.RightRootFind`: the state is on the far side of the root.
# - A guard that is zero where a mode begins counts from when it has moved away by more than the
#   tolerance hides.
#
# What follows an event is told by the signs of conditions. The version of each package is part of
# every result: it is what `Pkg.instantiate()` has put into Manifest.toml.

import JSON
using OrdinaryDiffEq
import Pkg

const SciMLBase = OrdinaryDiffEq.SciMLBase
const MAX_STEP_PERIODS = 0.125
const MAX_SIMULTANEOUS_EVENTS = 64
const INSTANT_TOLERANCE = 8 * eps()
const HIDDEN_TOLERANCES = 0.1
const METHODS = Dict(
    "tsit5" => (Tsit5, "Tsitouras 5(4)", "explicit", 5),
    "vern9" => (Vern9, "Verner 9(8)", "explicit", 9),
    "rodas5p" => (Rodas5P, "Rosenbrock 5(4)", "implicit", 5),
)

row(list) = Float64[it for it in list]
rows(list) = permutedims(reduce(hcat, row.(list)))

struct Event
    guard::Vector{Float64}
    sign::Int
    reset::Union{Nothing, Matrix{Float64}}
    successors::Vector{Any}
end

struct Mode
    a::Matrix{Float64}
    b::Matrix{Float64}
    c::Vector{Float64}
    events::Vector{Event}
end

function Event(wire::AbstractDict)
    sign = Dict("rising" => 1, "falling" => -1, "both" => 0)[wire["direction"]]
    reset = wire["reset"] === nothing ? nothing : rows(wire["reset"])
    Event(row(wire["guard"]), sign, reset, wire["successors"])
end

Mode(wire::AbstractDict) = Mode(rows(wire["A"]), rows(wire["B"]), row(wire["c"]), Event.(wire["events"]))

ends(event) = !isempty(event.successors)

mutable struct Course
    run::Any
    modes::Vector{Mode}
    t::Float64
    mode::Int
    z::Vector{Float64}
    events::Vector{Any}
    sampled::Vector{Vector{Float64}}
    ended::Union{Nothing, String}
    crowd::Int
    rhs::Int
    deadline::Float64
end

function Course(run)
    modes = Mode.(run["system"]["modes"])
    z = row(run["state"])
    course = Course(run, modes, 0.0, run["mode"] + 1, z, [], [], nothing, 0, 0,
                    time() + run["limits"]["wall_s"])
    foreach(_ -> push!(course.sampled, copy(z)), due(course, 0.0))
    course
end

theta(course, t) = course.run["system"]["omega"] * t + course.run["system"]["phi"]
wide(course, t, z) = [z; cos(theta(course, t)); sin(theta(course, t)); 1.0]

due(course, until) =
    filter(<=(until), row(course.run["samples"])[(length(course.sampled) + 1):end])

struct GaveUp <: Exception
    why::String
end

function rates!(out, z, course, t)
    course.rhs += 1
    course.rhs > course.run["limits"]["calls"] && throw(GaveUp("too many calls"))
    course.rhs % 4096 == 0 && time() > course.deadline && throw(GaveUp("the time is over"))
    mode = course.modes[course.mode]
    angle = theta(course, t)
    out .= mode.a * z .+ mode.c .+ mode.b * [cos(angle), sin(angle)]
end

# Reports an event and the state after it. `before` is the state before its reset; of an event that
# is only counted it is the state itself.
function report(course, t, place, mode, z, before = z)
    length(course.events) < course.run["limits"]["events"] || throw(GaveUp("too many events"))
    push!(course.events,
          Dict("time" => t, "event" => place - 1, "mode" => mode - 1, "before" => copy(before),
               "state" => copy(z)))
end

# Goes through an event that ends its mode.
function pass(course, t, place, z)
    if course.run["backward"]
        course.t, course.z, course.ended = t, z, "leaves-domain"
        return
    end
    event = course.modes[course.mode].events[place]
    before = z
    z = event.reset === nothing ? before : event.reset * wide(course, t, before)
    after = wide(course, t, z)
    holds(it) = it["when"] === nothing || sum(row(it["when"]) .* after) > 0
    follows = first(Iterators.filter(holds, event.successors))["mode"] + 1
    report(course, t, place, follows, z, before)
    course.crowd = t - course.t <= INSTANT_TOLERANCE * t ? course.crowd + 1 : 1
    course.t, course.mode, course.z = t, follows, z
    course.crowd >= MAX_SIMULTANEOUS_EVENTS && (course.ended = "no-progress")
end

# Runs to the first event that ends the mode, or to the horizon.
function stretch(course, method, is_default)
    mode = course.modes[course.mode]
    span, found = course.run["span"], Ref(0)
    tolerance = course.run["tolerance"]["relative"]
    at_entry = wide(course, course.t, course.z)
    moved = [abs(sum(event.guard .* at_entry)) > HIDDEN_TOLERANCES * tolerance
             for event in mode.events]
    function condition(out, z, t, _)
        w = wide(course, t, z)
        for (n, event) in enumerate(mode.events)
            value = sum(event.guard .* w)
            moved[n] |= abs(value) > HIDDEN_TOLERANCES * tolerance
            out[n] = is_default || moved[n] ? value : -1e-300
        end
    end
    function crossed(way)
        function (integrator, place)
            event = mode.events[place]
            event.sign in (0, way) || return
            if ends(event)
                found[] = place
                terminate!(integrator)
            else
                report(course, integrator.t, place, course.mode, integrator.u)
            end
        end
    end
    side = is_default ? SciMLBase.LeftRootFind : SciMLBase.RightRootFind
    callback = VectorContinuousCallback(condition, crossed(1), crossed(-1), length(mode.events);
                                        rootfind = side, save_positions = (false, false))
    times = filter(<(span), due(course, span))
    problem = ODEProblem(rates!, course.z, (course.t, span), course)
    options = Dict{Symbol, Any}(:reltol => tolerance, :abstol => tolerance, :saveat => times)
    isempty(mode.events) || (options[:callback] = callback)
    if !is_default
        turn = something(course.run["times"]["turn"], Inf)
        options[:dtmax] = MAX_STEP_PERIODS * min(course.run["times"]["period"], turn)
        options[:maxiters] = 10^7
    end
    solver = init(problem, method(); options...)
    solve!(solver)
    SciMLBase.successful_retcode(solver.sol) || error(string(solver.sol.retcode))
    for (t, z) in zip(solver.sol.t, solver.sol.u)
        t in times && t < (found[] == 0 ? Inf : solver.t) && push!(course.sampled, copy(z))
    end
    if found[] == 0
        course.t, course.z = span, copy(solver.u)
    else
        pass(course, solver.t, found[], copy(solver.u))
    end
end

function make(course)
    setup = course.run["setup"]
    name = replace(setup, "-default" => "")
    span = course.run["span"]
    while course.ended === nothing && span - course.t > 2 * INSTANT_TOLERANCE * span
        stretch(course, METHODS[name][1], setup != name)
    end
end

function answer(run)
    course = Course(run)
    try
        began = time_ns()
        make(course)
        took = time_ns() - began
        if course.ended === nothing
            foreach(_ -> push!(course.sampled, course.z), due(course, Inf))
        end
        all(isfinite, course.z) || error("a state is not finite")
        ended_at = course.ended === nothing ? run["span"] : course.t
        Dict("run" => Dict("events" => course.events, "samples" => course.sampled,
                           "end" => course.z, "ended" => something(course.ended, "horizon"),
                           "ended_at" => ended_at, "work" => Dict("rhs" => course.rhs),
                           "own_ns" => took))
    catch why
        why isa GaveUp ? Dict("gave_up" => why.why) : Dict("failure" => sprint(showerror, why))
    end
end

version_of(name) = string(only(filter(it -> it.name == name, collect(values(Pkg.dependencies())))).version)

function serve()
    setups = [Dict("name" => name * suffix, "method" => it[2], "class" => it[3], "order" => it[4],
                   "events" => "library", "dense_output" => true, "stepping" => "adaptive")
              for (name, it) in METHODS for suffix in ("", "-default")]
    for line in eachline(stdin)
        request = JSON.parse(line)
        said = if request["ask"] == "capabilities"
            Dict("capabilities" => Dict("library" => "OrdinaryDiffEq", "setups" => setups,
                                        "version" => version_of("OrdinaryDiffEq"),
                                        "language" => "Julia $VERSION"))
        elseif request["ask"] == "run"
            answer(request["run"])
        else
            Dict("ready" => true)
        end
        println(JSON.json(merge(said, Dict("percuss_protocol" => 1, "id" => request["id"]))))
        flush(stdout)
    end
end

serve()
