#!/usr/bin/env bash
# Runs a command of this project on a bare Debian of another release: in a minimal root made by debootstrap, with a fresh
# clone of the last commit and nothing else.  As root.
#   cmake/on_debian.sh bookworm|trixie 'COMMAND'
#   KEEP=folder    the root is made there, or taken from there, and kept; otherwise it is removed
set -euo pipefail
suite=$1 command=$2
top=$(cd "$(dirname "$0")/.." && pwd)
root=${KEEP:-$(mktemp -d)}
clean() { [ -n "${KEEP:-}" ] || rm -rf --one-file-system "$root"; }
trap clean EXIT

if [ ! -e "$root/etc/debian_version" ]; then
  command -v debootstrap >/dev/null || apt-get install -y -q debootstrap
  mirror=$(apt-get indextargets --format '$(REPO_URI) $(COMPONENT)' 'Created-By: Packages' | awk '$2 == "main" { print $1; exit }')
  script=/usr/share/debootstrap/scripts/$suite
  [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid    # a release newer than debootstrap
  debootstrap --variant=minbase --no-check-gpg "$suite" "$root" "${mirror:-http://deb.debian.org/debian}" "$script" >/dev/null
fi
cp /etc/resolv.conf "$root/etc"
rm -rf "$root/project"
git clone -q "$top" "$root/project"
ROOT=$root COMMAND=$command unshare --mount --fork bash -c '
  mount -t proc proc "$ROOT/proc"
  mount --rbind /dev "$ROOT/dev"
  exec chroot "$ROOT" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    bash -c "cd /project && $COMMAND"'
