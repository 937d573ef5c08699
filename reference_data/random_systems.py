"""Random system files of many kinds, those among them that are hard to decide.

    python random_systems.py [--kind KIND]... [--each N] [--first N] --out DIR

Writes KIND-NUMBER.system.toml, with the time up to which it is to be run in its first line. The
same kind and number give the same file.
"""

import argparse
import random
from pathlib import Path

import random_aimed as aimed
import random_exact
import random_mechanics as mechanics
import random_spectra as spectra
import random_starts
from system_text import Chance, Draft

KINDS = {
    "si-quotients": mechanics.si_quotients,
    "si-impacts": mechanics.si_impacts,
    "slow-pairs": spectra.slow_pairs,
    "stiff-pairs": spectra.stiff_pairs,
    "defective": spectra.defective,
    "nearly-defective": spectra.nearly_defective,
    "near-resonance": spectra.near_resonance,
    "near-ties": aimed.near_ties,
    "grazes": aimed.grazes,
    "on-guards": aimed.on_guards,
    "chattering": mechanics.chattering,
    "sticking": mechanics.sticking,
    "beside-impacts": mechanics.beside_impacts,
    "chains": mechanics.chains,
    "stick-slip": mechanics.stick_slip,
    "relays": mechanics.relays,
    "decays": spectra.decays,
    "bilinear": mechanics.bilinear,
    "exact": random_exact.exact,
    "following-starts": random_starts.following_starts,
}


def draft(kind: str, number: int) -> Draft:
    return KINDS[kind](Chance(random.Random(f"{kind} {number}")))


def written(kind: str, number: int) -> tuple:
    """(text of the file, horizon)."""
    made = draft(kind, number)
    return f"# until = {made.until!r}\n{made.text(f'{kind}-{number}')}", made.until


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kind", action="append", choices=KINDS, metavar="KIND")
    parser.add_argument("--each", type=int, default=10, metavar="N")
    parser.add_argument("--first", type=int, default=0, metavar="N")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for kind in arguments.kind or KINDS:
        for number in range(arguments.first, arguments.first + arguments.each):
            path = arguments.out / f"{kind}-{number}.system.toml"
            path.write_text(written(kind, number)[0])


if __name__ == "__main__":
    main()
