#!/usr/bin/env bash
# Builds the image, drives the closed loop with a container a node, and drives the bag again outside of them.
#   docker/trial.sh [BASE]
# The engine is what `docker` talks to (DOCKER_HOST). What pip is told by the environment is told to the build, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
most=1100000000  # bytes that the image may have more than its base

BASE=${1:-debian:12-slim}
TRACKVIB_IMAGE=trackvib-trial
TRACKVIB_USER=$(id -u):$(id -g)
[ "$(id -u)" != 0 ] || TRACKVIB_USER=1000:1000
TRACKVIB_DATA=$(mktemp -d)
export BASE TRACKVIB_IMAGE TRACKVIB_USER TRACKVIB_DATA
chmod 777 "$TRACKVIB_DATA"
if docker compose version > /dev/null 2>&1; then compose=(docker compose); else compose=(docker-compose); fi
compose+=(-p trackvib-trial -f docker/compose.yaml)
health=(/opt/trackvib/trackvib exec -- python3 /opt/trackvib/docker/health.py)

clean_up() {
    "${compose[@]}" down > /dev/null 2>&1 || true
    rm -rf "$TRACKVIB_DATA"
}
trap clean_up EXIT
fail() { echo "trial: $*" >&2; exit 1; }
tools() {
    docker run --rm --entrypoint sh "$1" -c 'ls -d /usr/bin/c++ /usr/bin/*g++* /opt/trackvib/tests \
        /opt/trackvib/.trackvib/venv/bin/pytest /opt/trackvib/.trackvib/venv/lib/python3*/site-packages/pinocchio' \
        2> /dev/null || true
}
size() { docker image inspect -f '{{.Size}}' "$1"; }
healthy() { "${compose[@]}" exec -T "$1" "${health[@]}"; }
signal() {
    "${compose[@]}" exec -T "$1" sh -c "kill -$2 \$(grep -lx $1 /proc/[0-9]*/comm | cut -d/ -f3)"
}

arguments=()
for name in PIP_INDEX_URL PIP_EXTRA_INDEX_URL PIP_TRUSTED_HOST PIP_CERT http_proxy https_proxy no_proxy; do
    [ -z "${!name:-}" ] || arguments+=(--build-arg "$name")
done
docker buildx version > /dev/null 2>&1 || export DOCKER_BUILDKIT=0  # no newer builder is there
there=$(tools "$BASE")
began=$SECONDS
docker build --network host --build-arg BASE "${arguments[@]}" -f docker/Dockerfile -t "$TRACKVIB_IMAGE" .
echo "trial: built in $((SECONDS - began)) s, $(($(size "$TRACKVIB_IMAGE") / 1000000)) MB," \
    "of which $(($(size "$BASE") / 1000000)) MB are $BASE"
[ $(($(size "$TRACKVIB_IMAGE") - $(size "$BASE"))) -lt "$most" ] || fail "that is too large"
[ "$(docker run --rm --entrypoint id "$TRACKVIB_IMAGE" -u)" != 0 ] || fail "containers run as root"
[ "$(tools "$TRACKVIB_IMAGE")" = "$there" ] || fail "of no use in a container: $(tools "$TRACKVIB_IMAGE")"
"${compose[@]}" up -d --no-build road_excitation controller recorder
for node in road_excitation controller recorder; do
    healthy "$node" || fail "$node is not healthy"
done
# one that stands still is not
signal controller STOP
! healthy controller || fail "a controller that stands still is taken for healthy"
signal controller CONT
"${compose[@]}" up --no-build --abort-on-container-exit
"${compose[@]}" logs --no-color simulator | grep -F "answers: 10000 accepted" || fail "not every sample was answered"
./trackvib replay "$TRACKVIB_DATA"/bag_* --verify
