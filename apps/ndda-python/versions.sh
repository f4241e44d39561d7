#!/usr/bin/env bash
# Installs the wheel in an empty environment of every Python from 3.10 on that is there, and runs the tests and the notebook beside the peers.
# Usage: apps/ndda-python/versions.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
target="${CARGO_TARGET_DIR:-$PWD/target}"
tools="$target/python-tools"
[[ -x "$tools/bin/maturin" ]] || { python3 -m venv "$tools" && "$tools/bin/python" -m pip install --quiet 'maturin>=1.9,<2'; }
rm -rf "$target/wheels"
"$tools/bin/maturin" build --release --locked --manifest-path apps/ndda-python/Cargo.toml --target-dir "$target" --out "$target/wheels"

# The newest of each minor version, of pyenv and of the path.
interpreters() {
  local minor found
  for minor in 10 11 12 13 14 15; do
    found="$(ls -d "$HOME"/.pyenv/versions/3."$minor".*/bin/python 2>/dev/null | sort -V | tail -n 1 || true)"
    found="${found:-$(command -v "python3.$minor" || true)}"
    [[ -z "$found" ]] || "$found" -c 'import ensurepip, venv' 2>/dev/null && echo "$found"
  done
}

for interpreter in $(interpreters); do
  venv="$(mktemp -d)"
  "$interpreter" -m venv "$venv"
  "$venv/bin/python" -m pip install --quiet --disable-pip-version-check "$target"/wheels/ndda-*.whl 'pytest>=8,<10'
  "$venv/bin/python" --version
  # States are compared with those of the program, scene by scene.
  if [[ -z "${NDDA:-}" ]]; then
    cargo build --release --locked
    export NDDA="$target/release/ndda" NDDA_LONGEST_S=2
  fi
  passed="$(cd "$venv" && bin/python -m pytest -q --doctest-modules --pyargs ndda "$OLDPWD/apps/ndda-python/tests" | tee -a /dev/stderr | grep -oE '[0-9]+ passed' | grep -oE '[0-9]+')"
  # As cargo says it, for .ci/nightly.
  echo "test result: ok. $passed passed"
  rm -rf "$venv"
done

venv="$target/peers-venv"
[[ -x "$venv/bin/python" ]] || python3 -m venv "$venv"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check 'mujoco==4.0.0' nbclient ipykernel pandas matplotlib
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps "$target"/wheels/ndda-*.whl
JUPYTER_PATH="$venv/share/jupyter" "$venv/bin/python" apps/ndda-python/run_notebooks.py benches/peers/beside.ipynb
