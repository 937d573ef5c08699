"""Drake's Simulator with witness functions, run by percuss.

`METHOD-default` is a system with a witness function for each event, whose handler ends the run,
the accuracy, and nothing else; `runge_kutta3` is Drake's own default. `METHOD` is what an expert
adds:

- Steps are at most an eighth of a forcing period and of a turn, because witnesses are looked at at
  the ends of steps.
- A guard that is zero where a mode begins has the sign that it has just after it, until it has
  moved away by more than the tolerance hides.
- Whether an event follows at once, and which mode, is told by the first derivative that is not
  zero.

Drake has one accuracy, relative and absolute together. An event's time is isolated to a window
that follows from it, and is the window's end.
"""

from importlib.metadata import version

from percuss_program import in_pairs, serve, unavailable

try:
    from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
    from pydrake.systems.framework import (
        EventStatus,
        LeafSystem,
        UnrestrictedUpdateEvent,
        WitnessFunctionDirection,
    )
except ImportError as why:
    unavailable(str(why))

METHODS = {
    "runge_kutta3": ("Bogacki-Shampine 3(2)", "explicit", 3),
    "runge_kutta5": ("Dormand-Prince 5(4)", "explicit", 5),
    "radau3": ("Radau IIA of order 3", "implicit", 3),
}
DIRECTIONS = {
    1: WitnessFunctionDirection.kNegativeThenNonNegative,
    -1: WitnessFunctionDirection.kPositiveThenNonPositive,
    0: WitnessFunctionDirection.kCrossesZero,
}
DEFAULT_MAX_STEP = 0.1


class ModeSystem(LeafSystem):
    """A mode up to its first event."""

    def __init__(self, course, zeros):
        super().__init__()
        self.course, self.found = course, None
        self.DeclareContinuousState(len(course.z))
        events = course.system.modes[course.mode].events
        self.witnesses = [
            self.witness(place, event, course.guard(place, zeros))
            for place, event in enumerate(events)
        ]

    def witness(self, place, event, guard):
        def happened(context, _event, _state):
            if self.found is None:
                self.found = (context.get_time(), place, state_of(context))
            return EventStatus.ReachedTermination(self, "an event")

        value = lambda context: guard(context.get_time(), state_of(context))
        update = UnrestrictedUpdateEvent(happened)
        return self.MakeWitnessFunction(f"event{place}", DIRECTIONS[event.sign], value, update)

    def DoGetWitnessFunctions(self, context):
        return self.witnesses

    def DoCalcTimeDerivatives(self, context, derivatives):
        course = self.course
        course.meter.call()
        rates = course.system.rates(course.mode, context.get_time(), state_of(context))
        derivatives.get_mutable_vector().SetFromVector(rates)


def state_of(context):
    return context.get_continuous_state_vector().CopyToVector()


def stretch(course, name, zeros, is_default):
    """Runs to the first event, or to the horizon."""
    system = ModeSystem(course, zeros)
    simulator = Simulator(system)
    longest = DEFAULT_MAX_STEP if is_default else course.longest_step()
    integrator = ResetIntegratorFromFlags(simulator, name, longest)
    accuracy = course.run["tolerance"]["relative"]
    integrator.set_target_accuracy(accuracy)
    context = simulator.get_mutable_context()
    context.SetAccuracy(accuracy)
    context.SetTime(course.t)
    context.SetContinuousState(course.z)
    simulator.Initialize()
    for t in [t for t in course.pending() if t < course.span] + [course.span]:
        simulator.AdvanceTo(t)
        if system.found:
            break
        if t < course.span:
            course.sample([t], lambda _: state_of(context))
    course.meter.steps += integrator.get_num_steps_taken()
    if system.found is None:
        course.t, course.z = course.span, state_of(context)
        return None, {}
    t, place, z = system.found
    if course.system.modes[course.mode].events[place].ends:
        switch = course.system.switch_plainly if is_default else None
        course.pass_event(t, place, z, switch)
        return place, {}
    course.report(t, place, course.mode, z)
    course.t, course.z = t, z
    return None, course.crossed(place)


def make(setup, course):
    name = setup.removesuffix("-default")
    if setup == name:
        course.by_experts(lambda zeros: stretch(course, name, zeros, False))
    else:
        while course.goes_on():
            stretch(course, name, {}, True)


if __name__ == "__main__":
    serve("drake", version("drake"), in_pairs(METHODS), make)
