#!/bin/sh
# Computes the missing shards of a sweep by HyperQueue, and merges them.
#
#   hyperqueue.sh PLAN.toml DIR OUTPUT.npz [options of hq submit, such as --cpus=4]
#
# A server is running (hq server start), and workers, or an allocation queue that starts them
# (hq alloc add slurm --time-limit 1h -- --partition=NAME). The plan has no `first`.
set -eu
plan=$1 out=$2 output=$3
shift 3
mkdir -p "$out/log"
states=$(percuss sweep status --plan "$plan" --out "$out" --format table) || [ $? -eq 1 ]
left=$(echo "$states" | awk '($1 == "missing" || $1 == "damaged") && $3 { print $3 }' | paste -sd, -)
if [ -n "$left" ]; then
    # HyperQueue says in HQ_CPUS which processors a task has.
    # shellcheck disable=SC2016
    hq submit --wait --array "$left" --stdout none --stderr "$out/log/%{TASK_ID}.txt" "$@" -- sh -c \
        'exec percuss sweep run --plan "$1" --out "$2" --threads "$(echo "$HQ_CPUS" | tr , "\n" | wc -l)"' \
        sweep "$plan" "$out"
fi
percuss sweep merge --plan "$plan" --out "$out" --output "$output"
