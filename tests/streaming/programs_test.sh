#!/usr/bin/env bash
# programs_test.sh SERVER CLIENT FOLDER: both programs over loopback, with 5 % of datagrams lost and 100 ms of latency.
# Frames arrive, nothing is shown without a shade, both end by themselves, and what does not fit is refused.
set -euo pipefail
server=$1 client=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder"
serverId=
trap '[[ -z $serverId ]] || kill "$serverId" 2>/dev/null || true' EXIT

fail() {
  echo "$1"
  cat "$folder"/*.txt
  exit 1
}
start() {
  "$server" --port 0 --village 1 --atlas 512 --wait 60 --json "$folder/server.json" "$@" >"$folder/server.txt" 2>&1 &
  serverId=$!
  port=
  for ((i = 0; i < 300 && ${#port} == 0; ++i)); do
    sleep 0.1
    port=$(sed -n 's/^listening on port //p' "$folder/server.txt")
  done
  [[ -n $port ]] || fail "the server does not listen"
}
end() {
  wait "$serverId" || fail "the server ended with $?"
  serverId=
}
number() { sed -n "s/^ *\"$2\": \([0-9.]*\),\?$/\1/p" "$folder/$1.json"; }

start --rate 10 --sampling standard --out "$folder"
"$client" --port "$port" --village 1 --size 128x72 --display 15 --frames 20 --seconds 200 --latency 100 --jitter 10 --loss 5 --compare 20 \
  --json "$folder/client.json" --out "$folder" >"$folder/client.txt" 2>&1 || fail "the client ended with $?"
end
cat "$folder"/*.txt
[[ $(number client holes) == 0 ]] || fail "holes"
awk "BEGIN { exit !($(number client serverFrames) >= 20 && $(number client displays) >= 20) }" || fail "too few frames"
awk "BEGIN { exit !($(number client partsAskedForAgain) > 0 && $(number server partsSentAgain) > 0) }" ||
  fail "nothing was lost and asked for again"
for picture in display local worst worst_marked atlas; do
  [[ -s $folder/$picture.png ]] || fail "no $picture.png"
done

# Another scene is refused with a sentence, and the server ends when its client has left.
start
if "$client" --port "$port" --village 2 --size 128x72 >"$folder/other.txt" 2>&1; then fail "another scene was taken"; fi
grep -q "refused: the server has another scene" "$folder/other.txt" || fail "no reason"
end

code=0
"$server" --rate 1000 >"$folder/usage.txt" 2>&1 || code=$?
((code == 2)) || fail "wrong usage ended with $code"
