"""Computes the missing shards of a sweep by Ray, and merges them.

    python sweep_by_ray.py PLAN.toml DIR OUTPUT.npz [--address auto] [--threads N]

Without --address the workers are processes on this machine. A shard whose worker is lost goes to
another one. Needs `pip install ray`, and `percuss` in the PATH of the workers.
"""

import argparse
import json
import os
import subprocess

import ray


def percuss(step, plan, out, *more):
    return ["percuss", "sweep", step, "--plan", plan, "--out", out, *more]


def left(plan, out):
    """The numbers of the shards that are to be computed, and that of all."""
    command = percuss("status", plan, out, "--format", "json")
    state = json.loads(subprocess.run(command, stdout=subprocess.PIPE).stdout)
    damaged = [it["shard"] for it in state["damaged"]]
    return sorted(state["missing"] + state["running"] + damaged), state["shards"]


@ray.remote(max_retries=3, retry_exceptions=True)
def compute(shard, shards, plan, out, threads):
    more = ["--shard", f"{shard}/{shards}", "--threads", str(threads), "--quiet"]
    subprocess.run(percuss("run", plan, out, *more), check=True)
    return shard


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plan")
    parser.add_argument("out")
    parser.add_argument("output")
    parser.add_argument("--address")
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    # Workers have folders of their own.
    plan, out = os.path.abspath(given.plan), os.path.abspath(given.out)
    ray.init(address=given.address, include_dashboard=False, log_to_driver=False)
    task = compute.options(num_cpus=given.threads)
    shards, count = left(plan, out)
    ray.get([task.remote(shard, count, plan, out, given.threads) for shard in shards])
    ray.shutdown()
    subprocess.run(percuss("merge", plan, out, "--output", given.output), check=True)


if __name__ == "__main__":
    main()
