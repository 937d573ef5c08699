"""torchdiffeq's odeint_event, with its derivatives by autograd, run by percuss.

`dopri5-default` is the documentation's `odeint_event` and its example of a bouncing ball: the event
function has all guards, so that torchdiffeq looks for the first change of any sign, and a state
whose guard is zero where a stretch begins is moved by 1e-7, as the example moves its ball. A last
guard is zero at the horizon, because `odeint_event` has none. `dopri5` is what an expert adds:

- There is one guard: the largest, each with the sign that makes it negative where the run begins.
  What crosses in a direction that does not count is passed over.
- Steps are at most an eighth of a forcing period and of a turn, because signs are compared at the
  ends of steps.
- A guard that is zero where a mode begins has to go further than the tolerance hides.
- What follows an event is told by the first derivative that is not zero.
- The coefficients of guards are states that stay as they are, because `odeint_event` has the
  derivative by the state in the event function and by nothing else there. Errors are measured
  without them.

Derivatives of both are by backpropagation through the steps, those of `dopri5-adjoint-default` by
`odeint_adjoint` as `odeint_interface`. Each stretch from event to event is differentiated by
torchdiffeq; stretches and resets are joined by the chain rule, as autograd joins them.
"""

import numpy as np
from percuss_program import Failure, chained, serve, unavailable

try:
    import torch
    import torchdiffeq
    from torchdiffeq import odeint, odeint_adjoint, odeint_event
except ImportError as why:
    unavailable(str(why))

torch.set_num_threads(1)
torch.set_default_dtype(torch.float64)

# By how much the example moves a ball that lies on the ground.
LIFT = 1e-7


class Field(torch.nn.Module):
    """A mode's equations and guards, whose coefficients are parameters. With `widened` the state
    has those of the guards and the angle's behind its own."""

    def __init__(self, course, widened):
        super().__init__()
        system, mode = course.system, course.system.modes[course.mode]
        self.size, self.widened, self.meter = len(course.z), widened, course.meter
        wanted = bool(course.run.get("gradients"))
        for name, value in (
            ("matrix", mode.wide[: self.size]), ("omega", system.omega), ("phi", system.phi)
        ):
            value = torch.as_tensor(np.array(value, dtype=float))
            setattr(self, name, torch.nn.Parameter(value, requires_grad=wanted))
        rows = np.array([event.row for event in mode.events]).reshape(-1, self.size + 3)
        self.rows = torch.tensor(rows, requires_grad=wanted)

    def leaves(self):
        return [self.matrix, self.omega, self.phi, self.rows]

    def wide(self, t, z, omega, phi):
        theta = omega * t + phi
        angle = torch.stack([torch.cos(theta), torch.sin(theta), torch.ones_like(t)])
        return torch.cat([z[: self.size], angle])

    def start(self, z):
        """The state where a stretch begins."""
        if not self.widened:
            return z
        more = [self.omega.reshape(1), self.phi.reshape(1), self.rows.reshape(-1)]
        return torch.cat([z, *more])

    def guards(self, t, z):
        rows, omega, phi = self.rows, self.omega, self.phi
        if self.widened:
            omega, phi, *_ = z[self.size :]
            rows = z[self.size + 2 :].reshape(rows.shape)
        return rows @ self.wide(t, z, omega, phi)

    def forward(self, t, z):
        self.meter.call()
        rates = self.matrix @ self.wide(t, z, self.omega, self.phi)
        return torch.cat([rates, torch.zeros(len(z) - self.size)]) if self.widened else rates


def plain(field, end):
    """All guards, and what is left of the time."""
    return lambda t, z: torch.cat([field.guards(t, z), (end - t).reshape(1)])


def oriented(field, end, course, zeros):
    """The guards, positive where the run begins."""
    hidden, signs, stays = course.known_guards(zeros)
    events = course.system.modes[course.mode].events
    now = course.system.wide(course.t, course.z)
    for place, (order, _) in zeros.items():
        if order is not None:
            # torchdiffeq places an event within the absolute tolerance.
            hidden[place] = max(hidden[place], 2 * abs(events[place].row @ now))
    ways, hidden, stays = (torch.as_tensor(it) for it in (signs, hidden, stays))

    def guards(t, z):
        values = ways * field.guards(t, z) + hidden
        return torch.cat([values.where(~stays, torch.ones(())), (end - t).reshape(1)])

    return guards, signs


def off_zero(course):
    """The state, moved as the example moves it where a guard is zero."""
    z = np.array(course.z)
    for event in course.system.modes[course.mode].events:
        value, row = event.row @ course.system.wide(course.t, z), event.row[: len(z)]
        if abs(value) < LIFT and row @ row > 0:
            z -= row * (value + LIFT) / (row @ row)
    return z


def pushed(field, begin, end, place_of_mode):
    """The derivatives along a stretch, by autograd from where it ends."""
    leaves = [*begin, *field.leaves()]
    outputs = [end[0], *end[1][: field.size]]

    def push(by, times, states):
        found = np.zeros((len(by), len(outputs)))
        for k, output in enumerate(outputs):
            if not output.requires_grad:
                continue
            more = {"retain_graph": True, "allow_unused": True}
            slopes = torch.autograd.grad(output, leaves, **more)
            slopes = [0.0 if it is None else it.numpy() for it in slopes]
            for n, rates in enumerate(by):
                coefficients = rates.matrices[place_of_mode], rates.omega, rates.phi
                changes = times[n], states[n], *coefficients, rates.rows[place_of_mode]
                found[n, k] = sum(np.sum(a * b) for a, b in zip(slopes, changes))
        return found[:, 0], found[:, 1:]

    return push


def stretch(course, is_default, interface, zeros):
    """Runs to the first event, which is returned with what is known of it, or to the horizon."""
    field = Field(course, widened=not is_default)
    wanted = bool(course.run.get("gradients"))
    z0 = off_zero(course) if is_default else course.z
    begin = [torch.tensor(it, requires_grad=wanted) for it in (course.t, z0)]
    end = torch.tensor(course.span)
    if is_default:
        guards, signs = plain(field, end), None
        largest = guards
    else:
        guards, signs = oriented(field, end, course, zeros)
        largest = lambda t, z: torch.min(guards(t, z)).reshape(1)
    tolerance = course.run["tolerance"]
    options = {"rtol": tolerance["relative"], "atol": tolerance["absolute"], "method": "dopri5"}
    if not is_default:
        norm = lambda z: torch.sqrt(torch.mean(z[: field.size] ** 2))
        options["options"] = {"max_step": course.longest_step(), "norm": norm}
    with torch.set_grad_enabled(wanted):
        t, states = odeint_event(
            field,
            field.start(begin[1]),
            begin[0],
            event_fn=largest,
            odeint_interface=interface,
            **options,
        )
        z = states[-1]
    course.trail.append(pushed(field, begin, (t, z), course.mode))
    with torch.no_grad():
        place = int(torch.argmin(torch.abs(guards(t, z))))
    t, z = float(t.detach()), z.detach().numpy()[: field.size].copy()
    sample(course, field, begin, min(t, course.span), options)
    if place == len(field.rows):
        course.t, course.z = course.span, z
        return None, {}
    return take(course, place, t, z, signs)


def sample(course, field, begin, until, options):
    """The states at the samples' times in a stretch, by a run of its own."""
    due = course.pending()
    due = due[due < until]
    if not len(due):
        return
    with torch.no_grad():
        times = torch.cat([begin[0].detach().reshape(1), torch.as_tensor(due)])
        states = odeint(field, field.start(begin[1]), times, **options)[1:, : field.size]
    course.sample(due, dict(zip(due, states.numpy())).get)


def take(course, place, t, z, signs):
    """Takes over what torchdiffeq has found."""
    if signs is not None:
        place = course.that_counts(place, -signs[place])
    event = course.system.modes[course.mode].events[place]
    if not course.t <= t <= course.span:
        raise Failure(f"an event is put at {t}, between {course.t} and {course.span}")
    if event.ends:
        course.pass_event(t, place, z, course.system.switch_plainly if signs is None else None)
        return place, {}
    if signs is None or event.sign in (0, -signs[place]):
        course.report(t, place, course.mode, z)
    course.t, course.z = t, z
    return None, course.crossed(place)


def make(setup, course):
    interface = odeint_adjoint if "adjoint" in setup else odeint
    if setup.endswith("-default"):
        while course.goes_on():
            stretch(course, True, interface, {})
    else:
        course.by_experts(lambda zeros: stretch(course, False, interface, zeros))


def gradients(setup, course):
    return chained(course)


def setups():
    for name in ("dopri5", "dopri5-default", "dopri5-adjoint-default"):
        yield {
            "name": name,
            "method": "Runge-Kutta 5(4) of Dormand and Prince",
            "class": "explicit",
            "order": 5,
            "events": "library",
            "dense_output": True,
            "stepping": "adaptive",
            "gradients": True,
        }


if __name__ == "__main__":
    serve("torchdiffeq", torchdiffeq.__version__, list(setups()), make, gradients)
