#!/usr/bin/env bash
# Runs the studies of error against time and keeps here what they find: every case (study.csv), the time to each error
# (time_to_error.csv), the pictures; then writes the tables of docs/guide/error-and-time.md. It goes on where it was interrupted.
# Usage: docs/evidence/error_time/run.sh [STUDY ...]
set -euo pipefail
cd "$(dirname "$0")/../../.."
kept=docs/evidence/error_time
studies=("$@")
((${#studies[@]})) || studies=(sliding_45 collision bounce bar_impact cantilever stack column cradle twist bars shaken)
cargo build --locked --release --quiet -p ndda-cli
for study in "${studies[@]}"; do
  "${CARGO_TARGET_DIR:-target}/release/ndda" study "scenes/studies/$study.ron" --quiet
  mkdir -p "$kept/$study"
  for file in study.csv time_to_error.csv error_time.svg error_dofs.svg stages.svg; do
    cp "out/${study}_study/$file" "$kept/$study/"
  done
done
python3 docs/evidence/error_and_time.py
