#!/bin/sh
# Runs a compiler that makes precompiled headers, without those that it made before: ccache would take them for used, and
# what it makes then, and all that is compiled with it, would be known to no other build.
for argument; do
  case $argument in
    *.gch) rm -f "$argument" ;;
  esac
done
exec "$@"
