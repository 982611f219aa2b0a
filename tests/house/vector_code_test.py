"""The units of vector code export their table of functions and nothing else.

vector_code_test.py NM OBJECT... reads the symbols of the objects named *_baseline, *_avx2 and
*_avx512. Anything else that another object could see, the linker could merge with code for another
instruction set, see src/pcednet/core/simd.h.
"""

import re
import subprocess
import sys


def main():
    nm, *objects = sys.argv[1:]
    units = [path for path in objects if re.search(r"_(baseline|avx2|avx512)\.cpp\.", path)]
    breaches = []
    for unit in units:
        listed = subprocess.run([nm, "--defined-only", "--extern-only", unit],
                                capture_output=True, text=True, check=True).stdout
        names = [line.split()[-1] for line in listed.splitlines()]
        names = [name for name in names if not name.startswith("__")]  # of sanitizers
        table = re.search(r"(\w+?)\.cpp\.", unit)[1]
        if len(names) != 1 or table not in names[0]:
            breaches.append(f"{unit}: exports {', '.join(names)} in place of {table}")
    if not units:
        breaches.append("no unit of vector code among the objects")
    print("\n".join(breaches) or f"{len(units)} units export their tables alone")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
