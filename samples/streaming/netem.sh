#!/usr/bin/env bash
# Server and client in network namespaces of their own, with a bad network between them that Linux makes (tc netem).
# Needs root, iproute2 and the kernel's sch_netem; without them it says so and ends with 77.
#
#   samples/streaming/netem.sh [--build FOLDER] [--delay MS] [--jitter MS] [--loss PERCENT] [--rate MBIT]
#                              [-- CLIENT OPTION...]
#   --delay is of each way; SERVER_OPTIONS in the environment are the server's
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=build/release delay=50 jitter=10 loss=1 rate=
while (($#)); do
  case $1 in
  --build) build=$2 ;;
  --delay) delay=$2 ;;
  --jitter) jitter=$2 ;;
  --loss) loss=$2 ;;
  --rate) rate=$2 ;;
  --)
    shift
    break
    ;;
  *)
    sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
    exit 2
    ;;
  esac
  shift 2
done
leave() {
  echo "netem.sh: $1"
  exit 77
}
[[ $EUID == 0 ]] || leave "not root: no namespaces can be made"
for program in ip tc; do command -v "$program" >/dev/null || leave "no $program (Debian: iproute2)"; done

id=$$
here=gpgps$id there=gpgpc$id
serverId=
end() {
  [[ -z $serverId ]] || kill "$serverId" 2>/dev/null || true
  ip netns del "$here" 2>/dev/null || true
  ip netns del "$there" 2>/dev/null || true
}
trap end EXIT
ip netns add "$here" 2>/dev/null || leave "namespaces are not permitted here"
ip netns add "$there"
ip link add "gs$id" netns "$here" type veth peer name "gc$id" netns "$there" 2>/dev/null || leave "no veth pair can be made"
ip -n "$here" addr add 10.77.0.1/24 dev "gs$id"
ip -n "$there" addr add 10.77.0.2/24 dev "gc$id"
netem=(netem delay "${delay}ms" "${jitter}ms" loss "$loss%" limit 10000)
[[ -z $rate ]] || netem+=(rate "${rate}mbit")
for side in "$here gs$id" "$there gc$id"; do
  read -r namespace link <<<"$side"
  ip -n "$namespace" link set lo up
  ip -n "$namespace" link set "$link" up
  ip netns exec "$namespace" tc qdisc add dev "$link" root "${netem[@]}" || leave "the kernel has no netem"
done

# shellcheck disable=SC2086 # options, several of them
ip netns exec "$here" "$build/streaming_server" --listen 10.77.0.1 --port 4242 ${SERVER_OPTIONS:-} &
serverId=$!
sleep 1
code=0
ip netns exec "$there" "$build/streaming_client" --server 10.77.0.1 --port 4242 "$@" || code=$?
wait "$serverId" || code=1
serverId=
exit "$code"
