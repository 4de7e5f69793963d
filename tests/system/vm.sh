#!/usr/bin/env bash
# System tests in a virtual machine. Usage: vm.sh BUILD_DIR [PATTERN...]. Exit 77: skipped, with the reason.
set -euo pipefail
exec python3 "$(dirname "$0")/vm/run.py" "$@"
