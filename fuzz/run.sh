#!/usr/bin/env bash
# Runs each fuzz target for a number of seconds (default 20): fuzz/run.sh [SECONDS [TARGET...]]
#
# Needs stable Rust and a C++ compiler, for libFuzzer, which is built from source; nothing is
# installed. What cargo-fuzz would do is written out: coverage comes from stable flags, and no
# sanitizer is used, as `unsafe` stands in three files alone, for memory and for two calls
# (CONTRIBUTING.md). `cargo fuzz run --sanitizer none` works as well, where it is installed.
#
# FUZZ_PROFILE (default release) is a profile of Cargo.toml; with smoke the targets are built on all
# processors and run at three quarters of the speed.
#
# FUZZ_SEED (default 1) makes two runs from the same corpus alike; 0 takes a random one.
#
# What the fuzzer learns stays in fuzz/corpus; an input that fails is written to fuzz/artifacts, and
# runs again as  fuzz/target/<host>/<profile>/<target> fuzz/artifacts/<target>/<file>
set -euo pipefail
cd "$(dirname "$0")"

seconds=${1:-20}
shift || true
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
    for file in fuzz_targets/*.rs; do
        targets+=("$(basename "$file" .rs)")
    done
fi

profile=${FUZZ_PROFILE:-release}
host=$(rustc -vV | sed -n 's/^host: //p')
coverage="--cfg fuzzing -Cpasses=sancov-module"
for option in level=4 inline-8bit-counters pc-table trace-compares; do
    coverage+=" -Cllvm-args=-sanitizer-coverage-$option"
done
# With --target the flags stay away from build scripts, which have no fuzzer to link with.
RUSTFLAGS=$coverage cargo build --quiet --profile "$profile" --target "$host" --target-dir target

for target in "${targets[@]}"; do
    mkdir -p "corpus/$target" "artifacts/$target"
    echo "fuzz: $target for $seconds s"
    log=$(mktemp)
    if "target/$host/$profile/$target" "corpus/$target" -artifact_prefix="artifacts/$target/" \
        -seed="${FUZZ_SEED:-1}" \
        -max_total_time="$seconds" -max_len=1024 -timeout=20 -rss_limit_mb=2048 \
        -print_final_stats=1 >"$log" 2>&1; then
        grep -E 'number_of_executed_units|average_exec_per_sec' "$log"
        rm -f "$log"
    else
        tail -n 60 "$log"
        rm -f "$log"
        echo "fuzz: $target failed; its input is in fuzz/artifacts/$target" >&2
        exit 1
    fi
done
