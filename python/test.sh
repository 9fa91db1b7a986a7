#!/usr/bin/env bash
# The Python package as its users have it: a wheel, installed in a fresh environment, tested there.
# With --check only whether this machine can do that.
set -euo pipefail
cd "$(dirname "$0")"

python=${PYTHON:-python3}
if ! "$python" -c 'import sys, ensurepip, venv; sys.exit(sys.version_info < (3, 10))'; then
    echo "The Python package cannot be tested: $python (3.10 or later) with venv and pip is missing" >&2
    echo "(on Debian: apt-get install python3-venv python3-pip; PYTHON=... names another one)." >&2
    exit 1
fi
[ "${1:-}" = --check ] && exit

SECONDS=0
done_with() { echo "python/test.sh: $1, $SECONDS s so far"; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
export PATH="$folder/venv/bin:$PATH" PIP_DISABLE_PIP_VERSION_CHECK=1
pip install --quiet 'maturin>=1.9,<2'
# Profile, target folder and features of the workspace's tests: what they compiled is not compiled again, and only the
# extension module and its bindings are left.
maturin build --quiet --profile dev --features as-tested --out "$folder/wheels"
done_with "wheel built"
pip install --quiet --no-compile "$(echo "$folder"/wheels/*.whl)[test]"
done_with "environment made"
tests=$PWD
cd "$folder"
python -m pytest --quiet -p no:cacheprovider -c "$tests/pyproject.toml" "$tests/tests" --durations=5
done_with "tests run"
