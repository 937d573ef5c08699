"""What the instructions of a switch are spent on, from a profile by callgrind.

echo "run switches/critical-xi-1 20000" |
  valgrind --tool=callgrind --dump-instr=yes --compress-pos=no --compress-strings=no \
    --callgrind-out-file=target/profile.out target/release/percuss bench worker
python benches/stages.py target/release/percuss target/profile.out 20000

Every instruction is counted for the stage of the innermost inlined call that has one. Needs addr2line (binutils).
"""

import collections
import re
import subprocess
import sys

# A call belongs to a stage by its name or by its file, the first rule that fits; a chain by its
# innermost call.
STAGES = [
    ("certificate", re.compile(r"certif|stays_below|/certificate\.rs|/piecewise\.rs|/tangents\.rs")),
    ("time and angle", re.compile(r"after_with_forcing|instant_after|/instant\.rs")),
    ("guess", re.compile(r"hint|roughly_after|/slow_envelope\.rs|/contact_parts\.rs|/contact_ahead\.rs|guess\S* \S*/switch\.rs")),
    ("closed form", re.compile(r"evaluate|/flow/|/(remainders|complex)\.rs")),
    ("root", re.compile(r"/root\.rs|/roots\.rs|/series\.rs")),
]
JOINING = "joining"
SOLVER = re.compile(r"/src/(crossing|flow)/|/src/(run/switch|model/instant|numeric/(series|roots))\.rs")


def counts(profile, program):
    """Instructions by their address, without those of calls, which follow their line."""
    total, ours, called = collections.Counter(), False, False
    for line in open(profile):
        if line.startswith("ob="):
            ours = line.rstrip().endswith(program)
        elif line.startswith("calls="):
            called = True
        elif line.startswith("0x"):
            address, _, count = line.split()[:3]
            if ours and not called:
                total[int(address, 16)] += int(count)
            called = False
    return total


def chains(program, addresses):
    """The inlined calls at every address, from the innermost on, as `function file:line`."""
    asked = "\n".join(map(hex, addresses))
    command = ["addr2line", "-a", "-i", "-f", "-C", "-e", program]
    answer = subprocess.run(command, input=asked, capture_output=True, text=True, check=True).stdout
    for block in re.split(r"^0x", answer, flags=re.M)[1:]:
        address, *lines = block.splitlines()
        yield int(address, 16), [" ".join(pair) for pair in zip(lines[::2], lines[1::2])]


def stage(chain):
    for call in chain:
        for name, pattern in STAGES:
            if pattern.search(call):
                return name
    return JOINING


def main(program, profile, switches):
    total = counts(profile, program.rsplit("/", 1)[-1])
    spent = collections.Counter()
    for address, chain in chains(program, list(total)):
        if any(SOLVER.search(call) for call in chain):
            spent[stage(chain)] += total[address]
    for name, count in spent.most_common() + [("a switch", sum(spent.values()))]:
        print(f"{count / int(switches):7.0f}  {100 * count / sum(spent.values()):5.1f} %  {name}")


if __name__ == "__main__":
    main(*sys.argv[1:])
