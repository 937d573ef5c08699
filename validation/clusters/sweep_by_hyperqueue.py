"""Computes the shards of a sweep by HyperQueue's library, with a server and a worker of its own.

    python sweep_by_hyperqueue.py PLAN.toml DIR

For one machine, where the program `hq` is not installed; hyperqueue.sh is for clusters. Needs
`pip install hyperqueue`, and `percuss` in the PATH.
"""

import json
import os
import shutil
import subprocess
import sys

from hyperqueue import Client, Job
from hyperqueue.cluster import LocalCluster, WorkerConfig


def main():
    plan, out = (os.path.abspath(path) for path in sys.argv[1:3])
    program = shutil.which("percuss")
    command = [program, "sweep", "status", "--plan", plan, "--out", out, "--format", "json"]
    shards = json.loads(subprocess.run(command, stdout=subprocess.PIPE).stdout)["shards"]
    with LocalCluster() as cluster:
        cluster.start_worker(WorkerConfig(cores=os.cpu_count()))
        client = cluster.client()
        job = Job()
        for shard in range(shards):
            # The library starts single tasks, so the index that an array has is set here.
            job.program(
                [program, "sweep", "run", "--plan", plan, "--out", out, "--threads", "1"],
                env={"HQ_TASK_ID": str(shard), "PATH": os.environ["PATH"]},
            )
        client.wait_for_jobs([client.submit(job)])


if __name__ == "__main__":
    main()
