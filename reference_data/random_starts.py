"""Random systems whose start follows: some states stand there as expressions of others."""

import random_aimed as aimed
import random_exact
import random_mechanics as mechanics
import random_spectra as spectra
from system_text import Chance, Draft

BASES = (
    mechanics.si_impacts,
    mechanics.sticking,
    mechanics.chains,
    mechanics.stick_slip,
    mechanics.bilinear,
    spectra.slow_pairs,
    spectra.defective,
    aimed.near_ties,
    aimed.grazes,
    aimed.on_guards,
    random_exact.exact,
)


def following_starts(c: Chance) -> Draft:
    """A system of another kind from the very same start, written otherwise."""
    draft = c.one_of(*BASES)(c)
    order = sorted(draft.states, key=lambda _: c.between(0, 1))
    for place, name in enumerate(order[1:], 1):
        if place == 1 or c.happens(0.5):
            follow(c, draft, name, c.one_of(*order[:place]))
    return draft


def follow(c: Chance, draft: Draft, name: str, leader: str) -> None:
    """Lets a state follow another one, which may follow a third, without moving either.

    The leader's share is taken off again, so that the sum is the same number for any factor.
    """
    factor = c.one_of("", "-", "2*", "-3*", "1/2*")
    own, begun = (constant(draft, key, draft.start[key]) for key in (name, leader))
    draft.start[name] = f"{factor}{leader} - ({factor}{begun}) + {own}"


def constant(draft: Draft, state: str, value) -> str:
    """An expression without decimals for the start of a state."""
    if isinstance(value, str):
        return f"({value})"
    key = f"begun_{state}"
    draft.parameters[key] = value
    return key
