#!/usr/bin/env bash
# The README's transcript: the commands of a first use, and what they print.
# Usage: tools/first_use/transcript.sh [terrell]
set -uo pipefail
cd "$(dirname "$0")/../.."
terrell=$(realpath "${1:-target/release/terrell}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp assets/monkey.glb "$work"
cd "$work"
terrell() { "$terrell" "$@"; }
# A command as it is typed, and its first lines.
typed() {
    local lines=$1
    shift
    printf '$ %s\n' "$*"
    eval "$*" 2>&1 | head -n "$lines"
}
typed 9 terrell inspect monkey.glb
typed 9 terrell new monkey.glb --flyby
typed 14 terrell check monkey-flyby.yaml
typed 9 terrell render monkey-flyby.yaml --exposure 48 --out first
sed -i 's/speed: 0.5 c/speed: 1.5 c/' monkey-flyby.yaml
echo "(an editor: speed: 1.5 c)"
typed 20 terrell check monkey-flyby.yaml
sed -i 's/speed: 1.5 c/speed: 0.9 c/' monkey-flyby.yaml
echo "(an editor: speed: 0.9 c)"
echo '$ terrell render monkey-flyby.yaml --size 640x360'
"$terrell" render monkey-flyby.yaml --size 640x360 2>stopped &
sleep 8
# (In a script Ctrl-C would be ignored.)
kill -TERM $!
wait $!
printf '^C\n'
cat stopped
echo '$ terrell render monkey-flyby.yaml --size 640x360'
"$terrell" render monkey-flyby.yaml --size 640x360 2>went_on
sed -n '1,2p' went_on
echo ...
tail -n 2 went_on
