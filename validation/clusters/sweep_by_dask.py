"""Computes the missing shards of a sweep by Dask, and merges them.

    python sweep_by_dask.py PLAN.toml DIR OUTPUT.npz [--scheduler tcp://host:8786] [--threads N]

Without --scheduler the workers are processes on this machine. A shard whose worker is lost goes to
another one. Needs `pip install "dask[distributed]"`, and `percuss` in the PATH of the workers.
"""

import argparse
import json
import subprocess

from dask.distributed import Client, LocalCluster


def percuss(step, plan, out, *more):
    return ["percuss", "sweep", step, "--plan", plan, "--out", out, *more]


def left(plan, out):
    """The numbers of the shards that are to be computed, and that of all."""
    command = percuss("status", plan, out, "--format", "json")
    state = json.loads(subprocess.run(command, stdout=subprocess.PIPE).stdout)
    damaged = [it["shard"] for it in state["damaged"]]
    return sorted(state["missing"] + state["running"] + damaged), state["shards"]


def compute(shard, shards, plan, out, threads):
    more = ["--shard", f"{shard}/{shards}", "--threads", str(threads), "--quiet"]
    subprocess.run(percuss("run", plan, out, *more), check=True)
    return shard


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plan")
    parser.add_argument("out")
    parser.add_argument("output")
    parser.add_argument("--scheduler")
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    address = given.scheduler or LocalCluster(threads_per_worker=1, dashboard_address=None)
    with Client(address) as client:
        shards, count = left(given.plan, given.out)
        rest = {"shards": count, "plan": given.plan, "out": given.out, "threads": given.threads}
        # A shard is no pure function: whether it is done is on the disk, not in Dask's memory.
        futures = client.map(compute, shards, pure=False, retries=3, **rest)
        client.gather(futures)
    subprocess.run(percuss("merge", given.plan, given.out, "--output", given.output), check=True)


if __name__ == "__main__":
    main()
