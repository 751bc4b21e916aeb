#!/usr/bin/env bash
# Makes a Debian 12 base image without a registry of images: docker/base.sh NAME, as root, with debootstrap installed.
# It knows the certificate authorities of this machine. MIRROR names another mirror of Debian.
set -euo pipefail
name=${1:?usage: docker/base.sh NAME}
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
chmod 755 "$root"
debootstrap --variant=minbase --include=ca-certificates bookworm "$root" ${MIRROR:+"$MIRROR"}
cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
# as the slim images of Debian are
rm -rf "$root"/var/cache/apt/archives/*.deb "$root"/var/lib/apt/lists/* "$root"/usr/share/{doc,man,locale}/*
tar -C "$root" -c . | docker import - "$name"
