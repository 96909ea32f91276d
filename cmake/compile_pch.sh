#!/bin/sh
# Runs a compiler for precompiled headers and deletes the previous ones first. Otherwise ccache would treat them as
# inputs, and no other build could reuse the cached results that depend on them.
for argument; do
  case $argument in
    *.gch) rm -f "$argument" ;;
  esac
done
exec "$@"
