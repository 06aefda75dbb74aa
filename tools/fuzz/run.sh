#!/usr/bin/env bash
# Fuzzes each target for so many seconds (60 unless said) from seeds of the repository, and says how many inputs were tried.
# Needs a nightly toolchain and cargo-fuzz: rustup toolchain install nightly; cargo install cargo-fuzz
# Usage: tools/fuzz/run.sh [seconds] [folder for inputs]
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-60}
work=${2:-tools/fuzz/corpus}
for target in manifest set gltf obj picture; do mkdir -p "$work/$target"; done
cp manifests/*.yaml tests/manifests/bad/*.yaml "$work/manifest"
printf 'observer.velocity=0 0 0.5 c\npicture.size=32 18\nbodies.0.material={ mirror: }\n' > "$work/set/seed"
find assets tests -size -60k \( -name '*.glb' -o -name '*.gltf' \) -exec cp {} "$work/gltf" \;
find tests -size -60k -name '*.obj' -exec cp {} "$work/obj" \;
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1\n%%%%%%%%\nnewmtl a\nKd 1 0 0\nNi 1.5\nmap_Kd -s 2 2 p.png\n' > "$work/obj/seed"
# The first byte chooses the kind: 48 is PNG, 49 JPEG.
for picture in $(find assets tests -name '*.png' -size -60k | head -n 20); do
    { printf 0; cat "$picture"; } > "$work/picture/$(basename "$picture")"
done
for picture in $(find assets tests -name '*.jpg' -size -60k | head -n 5); do
    { printf 1; cat "$picture"; } > "$work/picture/$(basename "$picture")"
done
failed=0
for target in manifest set gltf obj picture; do
    log=$(mktemp)
    cargo +nightly fuzz run --fuzz-dir tools/fuzz "$target" "$work/$target" -- \
        -max_total_time="$seconds" -rss_limit_mb=4096 -timeout=20 -max_len=65536 >"$log" 2>&1 || { failed=1; tail -n 40 "$log"; }
    echo "$target: $(grep -a -o 'Done [0-9]* runs in [0-9]* second' "$log" || echo "stopped, see above")"
    rm -f "$log"
done
exit $failed
