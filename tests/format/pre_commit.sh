#!/usr/bin/env bash
# A check before each commit, in seconds: the layout of all source, the links and code of the documentation, and the
# documentation tags of the headers. To use it:
#
#   ln -s ../../tests/format/pre_commit.sh .git/hooks/pre-commit
set -euo pipefail
cd "$(git rev-parse --show-toplevel)"
bash tests/format/format.sh
bash tests/abi/docs_test.sh include tests/abi docs
bash tests/abi/pages_test.sh include docs "${CC:-cc}" "${CXX:-c++}"
