#!/usr/bin/env bash
# Makes three.min.js, uplot.min.js and uplot.min.css from the packages on npm. Needs node and npm.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cp "$here/three.js" "$work/"
cd "$work"
npm init -y >/dev/null
npm install --silent three@0.187.0 uplot@1.6.32 esbuild@0.28.2
node_modules/.bin/esbuild three.js --bundle --minify --format=iife --global-name=THREE --outfile="$here/three.min.js" \
  --banner:js="/*! three.js 0.187.0, Copyright 2010-2026 Three.js Authors, MIT licence, https://threejs.org */"
cp node_modules/three/LICENSE "$here/LICENSE-three"
cp node_modules/uplot/dist/uPlot.iife.min.js "$here/uplot.min.js"
cp node_modules/uplot/dist/uPlot.min.css "$here/uplot.min.css"
cp node_modules/uplot/LICENSE "$here/LICENSE-uplot"
