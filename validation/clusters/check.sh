#!/usr/bin/env bash
# Sets up cluster engines on this machine, computes one sweep by each, and compares the merged bytes
# with those of a single run.
#
#   check.sh [slurm] [dask] [ray] [hyperqueue] [mpi]     (all where none is named)
#
# Debian or Ubuntu, root (it installs packages and starts daemons of its own, which it ends). Takes
# the program from the environment variable PERCUSS, else builds it; the plan from PLAN, else
# plan.toml beside this file. With plans of many and few shards the seconds that it prints tell what
# an engine adds to each.
set -euo pipefail
[ "$(id -u)" -eq 0 ] || exec sudo --preserve-env env "PATH=$PATH" "$0" "$@"
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
engines=("$@")
[ ${#engines[@]} -gt 0 ] || engines=(slurm dask ray hyperqueue mpi)

if [ -z "${PERCUSS:-}" ]; then
    cargo build --release --locked --manifest-path "$root/Cargo.toml" --bin percuss
    PERCUSS=${CARGO_TARGET_DIR:-$root/target}/release/percuss
fi
work=$(mktemp -d)
# Ends the process that a file names.
stop() {
    pid=$(cat "$1")
    rm "$1"
    kill "$pid" 2>/dev/null || return 0
    # It writes its state before it ends.
    for _ in $(seq 50); do
        kill -0 "$pid" 2>/dev/null || return 0
        sleep 0.2
    done
    kill -9 "$pid" 2>/dev/null || true
}
end() {
    for file in "$work"/*.pid; do
        [ -e "$file" ] && stop "$file"
    done
    rm -rf "$work" || true
}
trap end EXIT
trap 'exit 143' TERM
trap 'exit 130' INT

mkdir "$work/bin"
ln -s "$PERCUSS" "$work/bin/percuss"
export PATH="$work/bin:$PATH"
plan=$(realpath "${PLAN:-$here/plan.toml}")
cd "$work"
cp "$plan" plan.toml
# What the engines leave goes with the folder.
export TMPDIR=$work RAY_TMPDIR=$work

install() {
    dpkg -s "$@" >/dev/null 2>&1 && return
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

# Python's packages, in an environment of their own.
python_packages() {
    install python3-venv
    [ -d "$work/venv" ] || python3 -m venv "$work/venv"
    "$work/venv/bin/pip" install --quiet --disable-pip-version-check "$@"
}

compare() {
    cmp single.npz "$1.npz"
    percuss sweep status --plan plan.toml --out "$1" --format table | tail -n +2 | head -1
    echo "$1: the merged bytes are those of a single run"
}

slurm() {
    install slurm-wlm munge
    host=$(hostname -s)
    mkdir -p slurm.d/state slurm.d/spool munge.d
    head -c 1024 /dev/urandom >munge.d/key
    chown -R munge: munge.d
    chmod 755 "$work"
    chmod 700 munge.d
    chmod 400 munge.d/key
    runuser -u munge -- munged --force --key-file="$work/munge.d/key" \
        --socket="$work/munge.d/socket" --pid-file="$work/munge.d/munged.pid" \
        --log-file="$work/munge.d/log" --seed-file="$work/munge.d/seed"
    ln -s "$work/munge.d/munged.pid" munged.pid
    chmod 711 munge.d
    cat >slurm.conf <<CONF
ClusterName=percuss
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.d/socket
StateSaveLocation=$work/slurm.d/state
SlurmdSpoolDir=$work/slurm.d/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurm.d/slurmctld.log
SlurmdLogFile=$work/slurm.d/slurmd.log
SlurmctldPort=16817
SlurmdPort=16818
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=p Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF=$work/slurm.conf
    slurmctld
    sleep 2
    slurmd
    sleep 3
    begun=$SECONDS
    "$here/slurm.sh" plan.toml slurm slurm.npz --chdir="$work"
    for _ in $(seq 600); do
        [ -z "$(squeue --noheader)" ] && break
        sleep 1
    done
    echo "slurm: $((SECONDS - begun)) s from the submission to the end"
    cat slurm/log/merge.txt
    compare slurm
}

dask() {
    python_packages "dask[distributed]"
    begun=$SECONDS
    "$work/venv/bin/python" "$here/sweep_by_dask.py" plan.toml dask dask.npz
    echo "dask: $((SECONDS - begun)) s from the start of its workers to the end"
    compare dask
    lose_worker
}

# Kills one of two Dask workers with the shard that it computes: the scheduler gives that to the
# other.
lose_worker() {
    sed 's/^periods = .*/periods = 10000/' "$here/plan.toml" >long.toml
    percuss sweep run --plan long.toml --out undisturbed
    percuss sweep merge --plan long.toml --out undisturbed --output undisturbed.npz
    scheduler=tcp://127.0.0.1:18786
    "$work/venv/bin/dask" scheduler --host 127.0.0.1 --port 18786 --no-dashboard \
        >scheduler.txt 2>&1 &
    echo $! >scheduler.pid
    for worker in 1 2; do
        # In a process group of its own, which its tasks are in too.
        setsid "$work/venv/bin/dask" worker "$scheduler" --nthreads 1 --no-nanny --no-dashboard \
            >"worker$worker.txt" 2>&1 &
        echo $! >"worker$worker.pid"
    done
    "$work/venv/bin/python" "$here/sweep_by_dask.py" long.toml lost lost.npz \
        --scheduler "$scheduler" &
    client=$!
    echo "$client" >client.pid
    # Two locks are two shards that are being computed.
    until [ "$(find lost -name '*.lock' 2>/dev/null | wc -l)" -eq 2 ]; do
        kill -0 "$client" || { echo "dask: the sweep ended before a worker was lost" >&2; exit 1; }
        sleep 0.05
    done
    kill -9 -- "-$(cat worker1.pid)"
    rm worker1.pid
    wait "$client"
    rm client.pid
    # The worker first: without a scheduler it does not end.
    stop worker2.pid
    stop scheduler.pid
    cmp undisturbed.npz lost.npz
    echo "dask: one of two workers was killed, and the other has computed its shard"
}

ray() {
    python_packages ray
    begun=$SECONDS
    "$work/venv/bin/python" "$here/sweep_by_ray.py" plan.toml ray ray.npz
    echo "ray: $((SECONDS - begun)) s from the start of its workers to the end"
    compare ray
}

hyperqueue() {
    python_packages hyperqueue
    # In the place of the program, which the package lacks.
    printf '#!/bin/sh\nexec "%s" "%s" "$@"\n' "$work/venv/bin/python" "$here/hq.py" >bin/hq
    chmod +x bin/hq
    # A shard that is there already leaves an array with a gap.
    HQ_TASK_ID=1 percuss sweep run --plan plan.toml --out hyperqueue
    begun=$SECONDS
    "$here/hyperqueue.sh" plan.toml hyperqueue hyperqueue.npz --cpus=1
    echo "hyperqueue: $((SECONDS - begun)) s from the start of its worker to the end"
    compare hyperqueue
}

mpi() {
    install openmpi-bin
    begun=$SECONDS
    mpirun --allow-run-as-root --oversubscribe -n 4 \
        percuss sweep run --plan plan.toml --out mpi --threads 1
    echo "mpi: $((SECONDS - begun)) s from the start of its ranks to the end"
    percuss sweep merge --plan plan.toml --out mpi --output mpi.npz
    compare mpi
}

percuss sweep run --plan plan.toml --out single
percuss sweep merge --plan plan.toml --out single --output single.npz
for engine in "${engines[@]}"; do
    printf '== %s (%ss)\n' "$engine" "$SECONDS"
    "$engine"
done
