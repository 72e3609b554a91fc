#!/bin/sh
# gmsh's wheel links against a few X and OpenGL libraries even when it opens no window.
# Installs them where that is permitted; otherwise names the packages and stops.
# Usage: tools/system_libraries.sh PYTHON
set -eu
python=$1
packages="libglu1-mesa libxcursor1 libxft2 libxinerama1 libfontconfig1 libxrender1 libxext6 libgomp1"

loads() { "$python" -c 'import gmsh' >/dev/null 2>&1; }

loads && exit 0
if command -v apt-get >/dev/null 2>&1; then
    if [ "$(id -u)" = 0 ]; then as_root=""; elif sudo -n true 2>/dev/null; then as_root="sudo -n"; else as_root="no"; fi
    if [ "$as_root" != no ]; then
        export DEBIAN_FRONTEND=noninteractive
        $as_root apt-get update -qq >/dev/null && $as_root apt-get install -qq -y --no-install-recommends $packages >/dev/null || true
    fi
fi
loads && exit 0
reason=$("$python" -c 'import gmsh' 2>&1 | tail -n 1)
echo "gmsh cannot be loaded ($reason). Install its system libraries; on Debian or Ubuntu: apt-get install $packages" >&2
exit 1
