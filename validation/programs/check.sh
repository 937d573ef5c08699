#!/usr/bin/env bash
# Runs programs in five languages on six cases at 1e-6: SciPy, SUNDIALS CVODE, CVODES and ARKODE,
# Boost.Odeint, deSolve and Octave. One that is not installed is a failure; what each gets wrong
# stands in shortcomings.toml, and anything else is one too.
#
# Debian or Ubuntu, root (it installs packages). Takes the program from the environment variable
# PERCUSS, else builds it. Flags are handed on to `percuss validate`, as `--out DIR`.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
packages=(python3-venv gcc g++ make libsundials-dev libcjson-dev libboost-dev r-cran-desolve
    r-cran-jsonlite octave)
# Octave's other set-ups take minutes.
engines='^((scipy|cvodes?|arkode|odeint|desolve)(-|$)|octave$|octave-ode23-default$)'
cases='^(ball-geometric|friction-unequal|latched-start-at-tick|rigid-start-inward|spheres-one-after-another|height-crossed-twice)$'

if ! dpkg -s "${packages[@]}" >/dev/null 2>&1; then
    [ "$(id -u)" -eq 0 ] || as_root=sudo
    ${as_root:-} apt-get update -qq
    ${as_root:-} env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
        --no-install-recommends "${packages[@]}" >/dev/null
fi
# Of Python's packages those alone that are run here.
[ -d "$here/.venv" ] || python3 -m venv "$here/.venv"
grep -E '^(numpy|scipy)==' "$here/python/requirements.txt" |
    "$here/.venv/bin/pip" install --quiet --disable-pip-version-check --requirement /dev/stdin
"$here/setup" c cpp r octave

if [ -z "${PERCUSS:-}" ]; then
    cargo build --release --locked --manifest-path "$root/Cargo.toml" --bin percuss
    PERCUSS=${CARGO_TARGET_DIR:-$root/target}/release/percuss
fi
"$PERCUSS" validate --require --tolerance 1e-6 --programs "$here/programs.toml" \
    --engine "$engines" --case "$cases" "$@"
