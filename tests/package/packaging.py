"""What the tests of packages share."""
import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77
PROGRAM = os.environ["PCEDNET"]
SOURCE = pathlib.Path(os.environ["PCEDNET_SOURCE_DIR"])
BUILD = pathlib.Path(os.environ["PCEDNET_BUILD_DIR"])
VERSION = os.environ["PCEDNET_VERSION"]
MADE = BUILD / "packaging"  # by packaging/make_files.py

sys.path.insert(0, str(SOURCE / "packaging"))


def need(*programs):
    """Ends the test as skipped where a program is absent."""
    for program in programs:
        if not shutil.which(program):
            print(f"skipped: no {program}; scripts/setup.sh test installs it")
            sys.exit(SKIPPED)


def run(*words, **options):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=600,
                          **options)
    if done.returncode != 0:
        raise AssertionError(f"exit {done.returncode}: {' '.join(map(str, words))}\n"
                             f"{done.stdout}\n{done.stderr}")
    return done
