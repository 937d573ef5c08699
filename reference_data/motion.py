"""The three phases in closed form: Eqs. (14), (15), (18) and (20) of the paper, corrected.

Every formula is written once, in the time `d` elapsed since the phase began, and is evaluated
alike on numbers (`arb`), on intervals (wide `arb` balls) and on Taylor series (`arb_series`).

A *guard* is negative inside its phase and ends the phase where it rises to zero. It is kept as
a slow part plus one harmonic of known amplitude: the slow part raised by that amplitude, its slow
envelope, bounds the guard over long times.
"""

from dataclasses import dataclass
from typing import Callable, NamedTuple

from flint import acb, arb

NO_CONTACT, CONTACT, PROGRESSION = "no-contact", "contact", "progression"


class Parameters(NamedTuple):
    """a, b, xi, omega, g, phi: f64 values taken exactly."""

    a: arb
    b: arb
    xi: arb
    omega: arb
    g: arb
    phi: arb


class State(NamedTuple):
    """Mass p, its velocity y and the slider top q, all relative to the slider bottom v."""

    p: arb
    y: arb
    q: arb
    v: arb


@dataclass
class Guard:
    """A guard, negative inside its phase. `zeros` derivatives, from the 0th, vanish on entry."""

    leads_to: str
    slow_part: Callable
    harmonic: Callable
    amplitude: arb
    zeros: int

    def value(self, d):
        return self.slow_part(d) + self.harmonic(d)


def trial_force(m: Parameters, state: State):
    """f = 2 xi y + q, the force that contact without progression would need."""
    return 2 * m.xi * state.y + state.q


def on_surface(m: Parameters, state: State, force=None) -> State:
    """Impose p = q + g and, where the trial force is known (0 or 1), 2 xi y + q = force.

    Both the carried value and the one the force implies enclose the truth, so their
    intersection does.
    """
    _, y, q, v = state
    if force is not None:
        y, q = y.intersection((force - q) / (2 * m.xi)), q.intersection(force - 2 * m.xi * y)
    return State(q + m.g, y, q, v)


class Motion:
    """One phase, entered at the forcing angle `angle` = omega tau + phi in `entry`."""

    phase: str
    guards: tuple

    def __init__(self, m: Parameters, angle: arb, entry: State):
        self.m, self.angle, self.entry = m, angle, entry
        self.sine, self.cosine = angle.sin(), angle.cos()

    def forcing(self, d):
        """(sin, cos) of omega tau + phi."""
        return (self.angle + self.m.omega * d).sin_cos()


class Ballistic(Motion):
    """The mass under F_ext and a constant `load`, which no contact and progression share."""

    load: int

    def velocity_slow_part(self, d):
        m = self.m
        return self.entry.y - m.a / m.omega * self.sine + (m.b + self.load) * d

    def velocity_harmonic(self, d):
        return self.m.a / self.m.omega * self.forcing(d)[0]

    def travel_slow_part(self, d):
        m = self.m
        mean_velocity = self.entry.y - m.a / m.omega * self.sine
        return mean_velocity * d + (m.b + self.load) / 2 * d * d + m.a / m.omega**2 * self.cosine

    def travel_harmonic(self, d):
        return -self.m.a / self.m.omega**2 * self.forcing(d)[1]

    def velocity(self, d):
        return self.velocity_slow_part(d) + self.velocity_harmonic(d)

    def travel(self, d):
        return self.travel_slow_part(d) + self.travel_harmonic(d)

    def decay(self, d):
        """exp(-d/(2 xi)), the creep of the unloaded or steadily loaded slider."""
        return (-d / (2 * self.m.xi)).exp()


class NoContact(Ballistic):
    """Eq. (14). The guard is the negative gap h = p - q - g."""

    phase, load = NO_CONTACT, 0

    def __init__(self, m, angle, entry, zeros):
        """`zeros`: 2 after separation (h = h' = 0), 1 on the surface with f < 0, otherwise 0."""
        super().__init__(m, angle, entry)
        self.guards = (Guard("impact", self.gap_slow_part, self.travel_harmonic, m.a / m.omega**2, zeros),)

    def gap_slow_part(self, d):
        return self.entry.p - self.m.g + self.travel_slow_part(d) - self.entry.q * self.decay(d)

    def state(self, d) -> State:
        e = self.entry
        return State(e.p + self.travel(d), self.velocity(d), e.q * self.decay(d), e.v)


class Progression(Ballistic):
    """Eqs. (18) and (20). The guard is 1 - f, which has the sign of -v'."""

    phase, load = PROGRESSION, -1

    def __init__(self, m, angle, entry, zeros):
        """`zeros`: 1 where the phase begins by f rising to 1, 0 after an impact with f > 1."""
        super().__init__(m, angle, entry)
        amplitude = 2 * m.xi * m.a / m.omega
        self.guards = (Guard(CONTACT, self.deficit_slow_part, self.deficit_harmonic, amplitude, zeros),)

    def deficit_slow_part(self, d):
        return (1 - self.entry.q) * self.decay(d) - 2 * self.m.xi * self.velocity_slow_part(d)

    def deficit_harmonic(self, d):
        return -2 * self.m.xi * self.velocity_harmonic(d)

    def state(self, d) -> State:
        e = self.entry
        q = 1 + (e.q - 1) * self.decay(d)
        # v' = y - q' integrates to the mass's travel less the slider's compression.
        return State(q + self.m.g, self.velocity(d), q, e.v + self.travel(d) - (q - e.q))


class Contact(Motion):
    """Eq. (15) for any damping: the forced response plus a free motion in the basis (C, S).

    C and S solve u'' + 2 xi u' + u = 0 with C(0) = 1, C'(0) = 0, S(0) = 0, S'(0) = 1, so that
    C' = -S and S' = C - 2 xi S; only they depend on which side of critical damping xi lies.
    """

    phase = CONTACT

    def __init__(self, m, angle, entry, force=None):
        """`force`: the trial force where it is known on entry to be 0 or 1."""
        super().__init__(m, angle, entry)
        self.response = m.a / acb(1 - m.omega**2, 2 * m.xi * m.omega)
        forced = self.response * acb(self.cosine, self.sine)
        self.free_q = entry.q - m.b - forced.real
        self.free_y = entry.y + m.omega * forced.imag
        amplitude = abs(self.response) * (1 + (2 * m.xi * m.omega) ** 2).sqrt()
        self.guards = (
            Guard(PROGRESSION, self.excess_slow_part, self.excess_harmonic, amplitude, int(force == 1)),
            Guard(NO_CONTACT, self.release_slow_part, self.release_harmonic, amplitude, int(force == 0)),
        )

    def basis(self, d):
        xi = self.m.xi
        if xi == 1:
            decay = (-d).exp()
            return decay * (1 + d), decay * d
        if xi < 1:
            nu = (1 - xi * xi).sqrt()
            decay, (sine, cosine) = (-xi * d).exp(), (nu * d).sin_cos()
            return decay * (cosine + xi / nu * sine), decay * sine / nu
        kappa = (xi * xi - 1).sqrt()
        slow, fast = ((kappa - xi) * d).exp(), (-(kappa + xi) * d).exp()
        sine = (slow - fast) / (2 * kappa)
        return (slow + fast) / 2 + xi * sine, sine

    def free(self, d):
        c, s = self.basis(d)
        return self.free_q * c + self.free_y * s, self.free_y * (c - 2 * self.m.xi * s) - self.free_q * s

    def forced(self, d):
        sine, cosine = self.forcing(d)
        real, imaginary = self.response.real, self.response.imag
        return real * cosine - imaginary * sine, -self.m.omega * (real * sine + imaginary * cosine)

    def excess_slow_part(self, d):
        """The slow part of f - 1."""
        q, y = self.free(d)
        return 2 * self.m.xi * y + q + (self.m.b - 1)

    def excess_harmonic(self, d):
        q, y = self.forced(d)
        return 2 * self.m.xi * y + q

    def release_slow_part(self, d):
        """The slow part of -f."""
        return -1 - self.excess_slow_part(d)

    def release_harmonic(self, d):
        return -self.excess_harmonic(d)

    def state(self, d) -> State:
        (free_q, free_y), (forced_q, forced_y) = self.free(d), self.forced(d)
        q = self.m.b + free_q + forced_q
        return State(q + self.m.g, free_y + forced_y, q, self.entry.v)
