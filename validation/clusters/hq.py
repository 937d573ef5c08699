"""Does by HyperQueue's library what hyperqueue.sh asks of the program `hq`.

    python hq.py submit --wait --array 0-3,7 --stdout none --stderr FILE [--cpus=N] \\
        -- PROGRAM [ARGUMENT ...]

PyPI's package has the library alone, so check.sh runs the recipe with this in the place of `hq`, and
with a server and a worker of its own. Needs `pip install hyperqueue`.
"""

import argparse
import os
import sys

from hyperqueue import Client, Job
from hyperqueue.cluster import LocalCluster, WorkerConfig
from hyperqueue.ffi.protocol import ResourceRequest


def numbers(array):
    """The numbers of an array such as 0-3,7."""
    for part in array.split(","):
        first, _, last = part.partition("-")
        yield from range(int(first), int(last or first) + 1)


def main():
    words = sys.argv[1:]
    end = words.index("--")
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("step", choices=["submit"])
    parser.add_argument("--wait", action="store_true", required=True)
    parser.add_argument("--array", required=True)
    parser.add_argument("--stdout", choices=["none"])
    parser.add_argument("--stderr", required=True)
    parser.add_argument("--cpus", type=int, default=1)
    given = parser.parse_args(words[:end])
    job = Job(default_workdir=os.getcwd(), default_env={"PATH": os.environ["PATH"]})
    for number in numbers(given.array):
        command = ["env", f"HQ_TASK_ID={number}", *words[end + 1 :]]
        # The library numbers its tasks by itself.
        stderr = given.stderr.replace("%{TASK_ID}", str(number))
        resources = ResourceRequest(cpus=given.cpus)
        job.program(command, stdout=None, stderr=stderr, resources=resources)
    with LocalCluster() as cluster:
        cluster.start_worker(WorkerConfig(cores=os.cpu_count()))
        client = cluster.client()
        client.wait_for_jobs([client.submit(job)])


if __name__ == "__main__":
    main()
