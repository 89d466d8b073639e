#!/usr/bin/env bash
# The Unity package's scripts and its sample compile without warnings against declarations of what they use of Unity, reach the
# plugin, and have its structs as C has them (unity_test.cpp says the sizes).
#
#   scripts_test.sh MCS MONO FOLDER STUBS PLUGIN_DIR STUB_DIR SCRATCH_DIR     (FOLDER has package and sample)
set -euo pipefail
mcs=$1 mono=$2 folder=$3 stubs=$4 plugin=$5 stub=$6 scratch=$7
mkdir -p "$scratch"
"$mcs" -warnaserror -out:"$scratch/scripts.exe" "$folder"/package/Runtime/*.cs "$folder"/sample/*.cs "$stubs"
sizes=$(LD_LIBRARY_PATH=$plugin "$mono" "$scratch/scripts.exe")
[[ $sizes == "28 48 32 48" ]] || { echo "FAILED: C# has structs of $sizes bytes" >&2; exit 1; }
LD_LIBRARY_PATH=$stub "$mono" "$scratch/scripts.exe" >/dev/null # says what does not hold
echo "structs of $sizes bytes"
