#!/usr/bin/env bash
# From a fresh Debian 12 to a first result: installs, builds build/lmp, collapses a colloidal cluster and compares its
# radius of gyration with reference curves.  Safe to run again; what is done is not done twice.
set -euo pipefail
cd "$(dirname "$0")"
cmake/prepare.sh lmp
examples/cluster/run.sh
