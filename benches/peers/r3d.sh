#!/usr/bin/env bash
# The nodal forces of two tetrahedra by ndda beside their shared volume by the C library r3d, in one run on one machine.
# Needs a C compiler and git; R3D_DIR names a checkout of github.com/devonmpowell/r3d to use instead of a fresh one.
# Usage: benches/peers/r3d.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
target="${CARGO_TARGET_DIR:-$PWD/target}/peers"
mkdir -p "$target"
r3d="${R3D_DIR:-$target/r3d}"
if [[ ! -d "$r3d" ]]; then
  git clone --quiet https://github.com/devonmpowell/r3d "$r3d"
  git -C "$r3d" checkout --quiet 58dfbfb
fi
mkdir -p "$target/include"
sed 's/@R3D_MAX_VERTS@/512/; s/@SHIFT_POLY@/0/' "$r3d/config/r3d-config.h.in" >"$target/include/r3d-config.h"
"${CC:-cc}" -O3 -march=native -I"$target/include" -I"$r3d/src" benches/peers/r3d.c "$r3d/src/r3d.c" -lm -o "$target/r3d-pairs"
cargo bench --locked --quiet -p ndda-contact --bench kernel --no-run
for round in 1 2 3; do
  peer="$("$target/r3d-pairs")"
  ours="$(cargo bench --locked --quiet -p ndda-contact --bench kernel -- --quick '1024 pairs' 2>&1)"
  python3 - "$peer" "$ours" <<'PYTHON'
import json, re, sys
peer = json.loads(sys.argv[1])
ns = {"ns": 1.0, "µs": 1e3, "ms": 1e6}
def of(name):
    value, unit = re.search(re.escape(name) + r"\s+time:\s+\[\S+ \S+ (\S+) (\S+)", sys.argv[2]).groups()
    return float(value) * ns[unit] / 1024
forces, volume = of("tet_pair/nodal forces of 1024 pairs"), of("overlap/shared volume of 1024 pairs")
print(f"r3d volume {peer['ns_per_pair']:.0f} ns; ndda volume {volume:.0f} ns ({volume / peer['ns_per_pair']:.2f} of it), "
      f"ndda nodal forces {forces:.0f} ns ({forces / peer['ns_per_pair']:.2f} of it)")
PYTHON
done
