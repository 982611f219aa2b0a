#!/bin/sh
# Checks beyond the tests: scripts/check.sh [CHECK...], all of them if none is named.
#   format   C++ and TypeScript are as their formatters leave them
#   gcc      everything compiles without a warning with g++
#   clang    the rooms and their tests with clang++ (the coroutines of Debian's Boost are for g++),
#            several files as one
#   tidy     clang-tidy finds nothing
#   address  the tests of every room under the address and undefined-behaviour sanitizers
#   threads  the same under the thread sanitizer
#   fuzz     half a minute of every reader finds nothing
# Installs what is missing. Two hours on two cores; each check leaves its build in build/.
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh test python web check
[ $# -gt 0 ] || set -- format gcc clang tidy address threads fuzz

# build PRESET: configures and builds it.
build() {
  cmake --preset "$1" >/dev/null
  cmake --build --preset "$1"
}

# Under a sanitizer the unit tests of every room run. Those of the program, of the house and of the
# shipped models' scores would run the same code at many times its cost.
not_rooms='^(Cli|Web|Clients|Package|Docs|House|Python|ShippedModels)\.'

for check; do
  echo "== $check"
  case $check in
    format)
      python3 tests/house/rules.py style .
      scripts/build_web.sh
      (cd web && ../scripts/npm.sh run --silent check)
      ;;
    gcc)
      cmake --preset dev -DPCEDNET_PYTHON_MODULE=ON >/dev/null
      build dev
      ;;
    clang)
      cmake --preset clang >/dev/null
      cmake --build --preset clang --target rooms
      ;;
    tidy)
      cmake --preset clang >/dev/null
      run-clang-tidy-14 -p build/clang -quiet -j "$(nproc)" '/src/.*\.c(pp|xx)$' \
        >build/clang-tidy.log 2>/dev/null || { grep -E 'warning:|error:' build/clang-tidy.log; exit 1; }
      ;;
    address)
      build sanitize
      # One test leaves no file to open, where the sanitizer needs some to look at an object's type.
      ctest --preset sanitize -j "$(nproc)" -E "$not_rooms|^JournalTest.StaysAsItIsWhereItCannotBeRead$"
      ;;
    threads)
      build threads
      # setarch: the thread sanitizer of GCC 12 cannot place its memory where addresses are spread wide.
      setarch "$(uname -m)" -R ctest --preset threads -j "$(nproc)" -E "$not_rooms"
      ;;
    fuzz)
      build release
      scripts/fuzz.sh 30
      ;;
    *)
      echo "check.sh: no check is called $check; there are format gcc clang tidy address threads fuzz" >&2
      exit 2
      ;;
  esac
done
