#!/usr/bin/env bash
# The library's tests, and its method on cases of percuss, held against the report that is kept.
set -euo pipefail
cd "$(dirname "$0")"
python -m pytest -p no:cacheprovider --percuss=mylib.adapters:solve --percuss-setup=experts \
    --percuss-kind=explicit --percuss-order=3 --percuss-rtol=1e-6 \
    --percuss-cases="small-b,table1-first-row,graze-*" \
    --percuss-known=known.txt --percuss-out=report "$@"
