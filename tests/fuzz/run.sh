#!/bin/bash
# Runs all harnesses for a share of the time each: jobs, and sites format by format.
# Usage: tests/fuzz/run.sh BUILD_FOLDER MINUTES [NAME...]; names are job, or folders of corpus/site.
# With RUNS=100000 each has so many runs instead. What was found lies in runs/fuzz/found, the corpus
# that grows from day to day in runs/fuzz/corpus. Ends with 1 when anything was found.
set -uo pipefail
build=$(cd "$1" && pwd)
minutes=$2
shift 2
cd "$(dirname "$0")/../.."
here=tests/fuzz
names=("$@")
((${#names[@]})) || names=(job $(cd $here/corpus/site && ls))
mkdir -p runs/fuzz/found
share=$((minutes * 60 / ${#names[@]}))
limit=(-max_total_time=$((share > 0 ? share : 1)))
[[ -n ${RUNS:-} ]] && limit=(-runs="$RUNS")
# Files are made and removed with each input: in memory where the machine has such a folder.
[[ -d /dev/shm && -z ${TMPDIR:-} ]] && export TMPDIR=/dev/shm
export LSAN_OPTIONS=suppressions=configs/sanitizers/lsan.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1

status=0
for name in "${names[@]}"; do
    harness=fuzz_site seeds=$here/corpus/site/$name
    [[ $name == job ]] && harness=fuzz_job seeds=$here/corpus/job
    grown=runs/fuzz/corpus/$name
    log=runs/fuzz/$name.log
    mkdir -p "$grown"
    "$build/$harness" "${limit[@]}" -timeout=20 -rss_limit_mb=3000 -max_len=4096 -print_final_stats=1 \
        -dict=$here/words.dict -artifact_prefix="runs/fuzz/found/$name-" \
        "$grown" "$seeds" >"$log" 2>&1
    code=$?
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    speed=$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")
    if ((code == 0)); then
        printf '%-13s %9s runs, %5s a second\n' "$name" "${runs:-?}" "${speed:-?}"
    else
        status=1
        what=$(grep -m1 -E '^SUMMARY|^==.*ERROR: |terminate called|runtime error' "$log")
        printf '%-13s FOUND: %s (%s)\n' "$name" "${what:-exit code $code}" "$log"
    fi
done
exit $status
