#!/usr/bin/env bash
# Solves of a block's equations by ndda beside CHOLMOD's supernodal ones, one thread each, in one run on one machine.
# Needs a C compiler, python3 and SuiteSparse with METIS and a quick BLAS (Debian: libsuitesparse-dev, libopenblas-dev).
# NDDA_PEER_CELLS lists other cubes by the cells along their edges. Usage: benches/peers/cholmod.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
target="${CARGO_TARGET_DIR:-$PWD/target}/peers"
mkdir -p "$target"
if ! printf '#include <cholmod.h>\n' | "${CC:-cc}" -E -I/usr/include/suitesparse - >/dev/null 2>&1; then
  echo "no cholmod.h: install SuiteSparse (Debian: apt install libsuitesparse-dev libopenblas-dev)" >&2
  exit 1
fi
"${CC:-cc}" -O3 -march=native -I/usr/include/suitesparse benches/peers/cholmod.c -lcholmod -lm -o "$target/cholmod-solves"
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
cargo bench --locked --quiet -p ndda-solver --bench solve --no-run
ours="$(NDDA_PEER="$target" cargo bench --locked --quiet -p ndda-solver --bench solve)"
while read -r unknowns bytes rest; do
  peer="$("$target/cholmod-solves" "$target/$unknowns.matrix" "$bytes")"
  python3 - "$unknowns" "$bytes" "$rest" "$peer" <<'PYTHON'
import sys
unknowns, bytes_read = int(sys.argv[1]), int(sys.argv[2])
factor_ms, one, eight, dense, dense_eight = map(float, sys.argv[3].split())
amd, amd_eight, amd_ms, amd_bytes, metis, metis_eight, metis_ms, metis_bytes, gb_s = map(float, sys.argv[4].split())
print(f"{unknowns} unknowns: CHOLMOD {amd:.2f} µs (AMD), {metis:.2f} µs (METIS); ndda {one:.2f} µs, {one / min(amd, metis):.2f} of it; "
      f"{f'inverse {dense:.2f} µs, {dense_eight:.2f} of eight' if dense == dense else 'no inverse'}\n"
      f"    eight at once, per block: CHOLMOD {amd_eight:.2f} µs, {metis_eight:.2f} µs; ndda {eight:.2f} µs, "
      f"{eight / min(amd_eight, metis_eight):.2f} of it and {eight / one:.2f} of one alone\n"
      f"    L: CHOLMOD {amd_bytes / 1e6:.2f} MB, {metis_bytes / 1e6:.2f} MB; ndda {bytes_read / 1e6:.2f} MB, read at "
      f"{2e-3 * bytes_read / one:.1f} GB/s, {2e-3 * bytes_read / one / gb_s:.2f} of the {gb_s:.1f} GB/s of a bare read\n"
      f"    factor: CHOLMOD {amd_ms:.1f} ms, {metis_ms:.1f} ms; ndda {factor_ms:.1f} ms")
PYTHON
done <<<"$ours"
