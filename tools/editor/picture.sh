#!/usr/bin/env bash
# Makes the README's picture of a manifest in an editor. Needs node, npm, python3 and chromium.
# Usage: tools/editor/picture.sh OUT.png
set -euo pipefail
out=$(realpath -m "$1")
cd "$(dirname "$0")"
site=$(mktemp -d)
trap 'rm -rf "$site"; kill "${server:-0}" 2>/dev/null || true' EXIT
cp package.json page.js "$site"
(cd "$site" && npm install --silent && node node_modules/esbuild/install.js)
bundle() { (cd "$site" && npx esbuild "$1" --bundle --format="$3" --outfile="$2" --loader:.ttf=dataurl --log-level=error); }
cp page.js "$site/source.js"
rm "$site/page.js"
bundle source.js page.js esm
bundle node_modules/monaco-yaml/yaml.worker.js yaml.worker.js iife
bundle node_modules/monaco-editor/esm/vs/editor/editor.worker.js editor.worker.js iife
cp index.html manifest.yaml "$site"
cp ../../manifests/terrell.schema.json "$site/schema.json"
(cd "$site" && exec python3 -m http.server 8731 >/dev/null 2>&1) &
server=$!
sleep 1
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=900,640 --virtual-time-budget=20000 \
    --screenshot="$out" "http://localhost:8731/index.html?at=14,5" 2>/dev/null
