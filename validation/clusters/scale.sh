#!/usr/bin/env bash
# Measures what sweeps cost, for the section "Scale" of docs/SWEEPS.md: time and bytes a shard, the
# cost of starting a task, the memory of a merge, strong and weak scaling to the cores there are,
# and how even shards are.
#
#   scale.sh      (Debian: apt-get install time)
#
# Takes the program from the environment variable PERCUSS, else builds it. On a quiet machine.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
if [ -z "${PERCUSS:-}" ]; then
    cargo build --release --locked --manifest-path "$root/Cargo.toml" --bin percuss
    PERCUSS=${CARGO_TARGET_DIR:-$root/target}/release/percuss
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# plan FILE SHARDS STEPS_OMEGA STEPS_B PERIODS
plan() {
    cat >"$1" <<PLAN
[sweep]
verb = "lyapunov"
shards = $2
[fixed]
transient = 100
periods = $5
[[axis]]
parameter = "omega"
from = 0.2
to = 3.0
steps = $3
[[axis]]
parameter = "b"
from = 0.005
to = 0.5
steps = $4
PLAN
}

# Seconds and kibibytes of a command, the least of three runs; none may leave what the next skips.
measured() {
    for _ in 1 2 3; do
        rm -rf "${clean:-none}"
        /usr/bin/time -f "%e %M" -o time.txt "$@" >/dev/null
        cat time.txt
    done | sort -n | head -1
}

echo "cores: $(nproc); $("$PERCUSS" --version)"

echo "== shards of one plan of 10000 points: shards, seconds (all, one thread), bytes of all files"
for shards in 1 10 100 1000; do
    plan plan.toml $shards 100 100 100
    clean=out
    read -r seconds _ < <(measured "$PERCUSS" sweep run --plan plan.toml --out out --threads 1)
    echo "$shards $seconds $(cat out/*.shard | wc -c)"
done

echo "== a task that finds its shard finished: points, seconds, KiB"
for side in 32 100 316 1000; do
    plan plan.toml 2 $side $side 1
    clean=none
    "$PERCUSS" sweep run --plan plan.toml --out "out$side"
    echo "$((side * side)) $(measured "$PERCUSS" sweep run --plan plan.toml --out "out$side" --shard 0/2)"
done

echo "== merge: points, seconds, KiB"
for side in 32 100 316 1000; do
    plan plan.toml 2 $side $side 1
    echo "$((side * side)) $(measured "$PERCUSS" sweep merge --plan plan.toml --out "out$side" --output m.npz)"
done

echo "== strong scaling, 10000 points: tasks of one thread at once, seconds"
plan plan.toml 16 100 100 500
for tasks in $(seq "$(nproc)"); do
    rm -rf out
    begun=$(date +%s.%N)
    for _ in $(seq "$tasks"); do
        "$PERCUSS" sweep run --plan plan.toml --out out --threads 1 &
    done
    wait
    echo "$tasks $(echo "$(date +%s.%N) - $begun" | bc)"
done

echo "== weak scaling, 5000 points a task: tasks of one thread at once, seconds"
for tasks in $(seq "$(nproc)"); do
    plan plan.toml $((8 * tasks)) $((50 * tasks)) 100 500
    rm -rf out
    begun=$(date +%s.%N)
    for _ in $(seq "$tasks"); do
        "$PERCUSS" sweep run --plan plan.toml --out out --threads 1 &
    done
    wait
    echo "$tasks $(echo "$(date +%s.%N) - $begun" | bc)"
done

# Processor seconds of all shards, the longest shard over the mean, bytes of all files.
# even PLAN SHARDS
even() {
    rm -rf out
    for shard in $(seq 0 $(($2 - 1))); do
        /usr/bin/time -f %U "$PERCUSS" sweep run --plan "$1" --out out --shard "$shard/$2" \
            --threads 1 --quiet 2>&1
    done | awk '{ all += $1; if ($1 > most) most = $1 } END { print all, most * NR / all }'
    cat out/*.shard | wc -c
}

echo "== basins of 2 x 1000 x 1000 starts: processor seconds, longest of 8 shards over the mean, bytes"
cat >plan.toml <<PLAN
[sweep]
verb = "basins"
shards = 8
[fixed]
xi = 0.1
grid = "1000x1000"
window = [-1.0, 1.0, -1.0, 1.0]
transient = 60
[[axis]]
parameter = "omega"
from = 0.8
to = 1.0
steps = 2
PLAN
even plan.toml 8
/usr/bin/time -f "merge: %U s of processor time, %M KiB" \
    "$PERCUSS" sweep merge --plan plan.toml --out out --output m.npz 2>&1

echo "== the drift map over omega and b: processor seconds, longest of 16 shards over the mean, bytes"
even "$root/docs/sweeps/omega-b.toml" 16
