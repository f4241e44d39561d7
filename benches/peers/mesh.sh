#!/usr/bin/env bash
# Filling blocks with tetrahedra to a size, beside Gmsh and TetGen: the same blocks, one thread, one run, a table.
# Usage: benches/peers/mesh.sh [CELLS [SIZE_M]]. Needs cargo, a C++ compiler (for TetGen) and python3; installs Gmsh under target/.
set -euo pipefail
cd "$(dirname "$0")/../.."
cells="${1:-20}"
size="${2:-0.4}"
target="${CARGO_TARGET_DIR:-$PWD/target}"
venv="$target/peers-venv"
"$venv/bin/python" -c 'import gmsh, numpy' 2>/dev/null || {
  python3 -m venv "$venv"
  "$venv/bin/pip" install --quiet --disable-pip-version-check gmsh numpy
}
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
cargo build --locked --release --quiet -p ndda-io --features tetgen --example fill
{
  "$target/release/examples/fill" "$scratch" "$cells" "$size"
  "$venv/bin/python" benches/peers/mesh_gmsh.py "$scratch/blocks.obj" "$size"
} | awk -v cells="$cells" -v size="$size" '
  BEGIN { printf "%d Voronoi cells of a cube of 10 m, edges of %s m\n", cells, size
          printf "%-8s %10s %10s %12s %12s %12s\n", "program", "time [s]", "tets", "tets/s", "below 10°", "worst [°]" }
  { printf "%-8s %10s %10s %12.0f %11.3f%% %12s\n", $1, $2, $3, $3 / $2, 100 * $4 / $3, $5 }'
