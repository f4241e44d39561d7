#!/usr/bin/env bash
# The label's record over random scenes: runs what has not run yet, keeps a line per scene in cases.csv beside this script, and
# prints the table of docs/verification/stability.md. Usage: docs/evidence/label/run.sh [SCENES].
set -euo pipefail
cd "$(dirname "$0")/../../.."
NDDA_CASES="${1:-2000}" NDDA_LABEL="$PWD/docs/evidence/label/cases.csv" \
  cargo test --workspace --features full --test metamorphic label -- --nocapture
