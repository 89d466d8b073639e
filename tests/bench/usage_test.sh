#!/bin/sh
# usage_test.sh PROGRAM... : each prints its usage for --help and ends with 0; an unknown option is named, and ends with 2.
for program in "$@"; do
  "$program" --help | grep -q "$(basename "$program")" || { echo "$program --help: no usage"; exit 1; }
  said=$("$program" --no-such-option 2>&1 >/dev/null)
  code=$?
  case $code$said in
  2*"'--no-such-option' is no option"*) ;;
  *) echo "$program --no-such-option: $code, $said"; exit 1 ;;
  esac
done
