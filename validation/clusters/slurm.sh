#!/bin/sh
# Submits the missing shards of a sweep as a Slurm job array, and the job that merges them.
#
#   slurm.sh PLAN.toml DIR OUTPUT.npz [options of sbatch, such as --cpus-per-task=4 --time=2:00:00]
#
# Submitted again, it computes what an earlier array has left. DIR is on a file system that all
# nodes share. The plan has no `first`: the array's indices are the shards' numbers.
set -eu
plan=$1 out=$2 output=$3
shift 3
mkdir -p "$out/log"
states=$(percuss sweep status --plan "$plan" --out "$out" --format table) || [ $? -eq 1 ]
left=$(echo "$states" | awk '($1 == "missing" || $1 == "damaged") && $3 { print $3 }' | paste -sd, -)
after=""
if [ -n "$left" ]; then
    array=$(sbatch --parsable --job-name=sweep --output="$out/log/%a.txt" --array="$left" "$@" <<JOB
#!/bin/sh
exec percuss sweep run --plan "$plan" --out "$out" --threads "\${SLURM_CPUS_PER_TASK:-1}"
JOB
    )
    after="--dependency=afterok:$array --kill-on-invalid-dep=yes"
    echo "array $array computes shards $left"
fi
# The dependency is no word or two.
# shellcheck disable=SC2086
merge=$(sbatch --parsable --job-name=merge --output="$out/log/merge.txt" $after "$@" <<JOB
#!/bin/sh
exec percuss sweep merge --plan "$plan" --out "$out" --output "$output" --threads 1
JOB
)
echo "job $merge merges them into $output"
