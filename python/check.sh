#!/usr/bin/env bash
# Builds the wheel of this machine, installs it into a fresh environment, and runs the tests of
# the package there. Needs Python 3.10 or later; what tests need comes from the package index.
#
#     python/check.sh [FOLDER]
#
# FOLDER (target/python by default) gets the environment and the wheel.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=${1:-target/python}
step() { printf '\n== %s (%ss)\n' "$*" "$SECONDS"; }

step "environment"
rm -rf "$folder"
"${PYTHON:-python3}" -m venv "$folder/venv"
bin=$folder/venv/bin
"$bin/pip" install --quiet --disable-pip-version-check 'maturin>=1.9,<2'

step "wheel"
# Beside a release build of the command a third of the packages is compiled anew, because what
# Python needs asks for more of five crates.
"$bin/maturin" build --release --locked --manifest-path python/Cargo.toml --out "$folder/dist" \
    --interpreter "$bin/python" --compatibility linux --quiet

step "installation"
wheel=$(ls "$folder"/dist/percuss-*.whl)
"$bin/pip" install --quiet --disable-pip-version-check "$wheel[test]"

step "tests"
# Outside python/, whose folder of sources has no native part.
root=$PWD
python=$(cd "$bin" && pwd)/python
cd "$folder"
PERCUSS_ROOT=$root "$python" -m pytest --quiet -p no:cacheprovider --rootdir "$root/python" \
    "$root/python/tests"

step "types"
"$python" -m mypy --config-file "$root/python/pyproject.toml" -p percuss
"$python" -m pyright --project "$root/python/pyproject.toml" --pythonpath "$python" \
    "$("$python" -c 'import percuss; print(*percuss.__path__)')"

step "done"
