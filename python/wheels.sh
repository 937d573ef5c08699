#!/usr/bin/env bash
# Builds the wheels that this system can build, and the source distribution.
#
#     python/wheels.sh [FOLDER]
#
# FOLDER (target/wheels by default) gets them. On Linux there are two, for x86-64 and for aarch64
# with glibc 2.17 or later: zig links them, so that the machine's own library does not matter.
# Elsewhere the wheel is the machine's. Each is for CPython 3.10 and later; where python3.14t is
# installed there is one more, for CPython 3.14 with free threads.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=${1:-target/wheels}
step() { printf '\n== %s (%ss)\n' "$*" "$SECONDS"; }

step "environment"
venv=$folder/venv
rm -rf "$folder"
"${PYTHON:-python3}" -m venv "$venv"
bin=$venv/bin
[ -d "$bin" ] || bin=$venv/Scripts
"$bin/python" -m pip install --quiet --disable-pip-version-check 'maturin[zig]>=1.9,<2'
PATH=$(cd "$bin" && pwd):$PATH

build() {
    maturin build --release --locked --manifest-path python/Cargo.toml --out "$folder" \
        --quiet "$@"
}

if [ "$(uname -s)" = Linux ]; then
    for architecture in x86_64 aarch64; do
        step "wheel for $architecture"
        target=$architecture-unknown-linux-gnu
        rustup target add "$target"
        build --target "$target" --zig --compatibility manylinux_2_17
    done
else
    step "wheel"
    build
fi

if command -v python3.14t >/dev/null; then
    step "wheel for free threads"
    build --interpreter "$(command -v python3.14t)"
fi

step "source distribution"
maturin sdist --manifest-path python/Cargo.toml --out "$folder"

rm -rf "$venv"
ls -l "$folder"
