#!/usr/bin/env bash
# Writes docs/guide/svg_support.md anew from what svg_support_test finds: tests/vector/svg_support.sh [BUILD FOLDER]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
GPGP_WRITE_SVG_SUPPORT=1 "${1:-build/release}/vector_import_test" --gtest_filter='SvgSupport.*' --gtest_brief=1
git --no-pager diff --stat -- docs/guide/svg_support.md
