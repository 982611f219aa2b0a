"""Makes what a package carries beside the program:

    make_files.py PCEDNET SOURCE OUT [--version V] [--date YYYY-MM-DD]

writes OUT/man1/*.1.gz, OUT/bash/pcednet and OUT/zsh/_pcednet from what PCEDNET says of itself.
"""

import argparse
import gzip
import pathlib
import sys

sys.dont_write_bytecode = True
import completion
import man_pages
import program_help


def write(path, data):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("pcednet")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--version", default="")
    parser.add_argument("--date", default="")
    arguments = parser.parse_args()

    program = program_help.read_command(arguments.pcednet)
    known = {"experiments": program_help.experiments(arguments.pcednet),
             "models": sorted(p.stem for p in arguments.source.glob("models/*.safetensors"))}
    codes = man_pages.exit_codes((arguments.source / "docs/command-line.md").read_text("utf-8"))
    about = {"version": arguments.version, "date": arguments.date}
    for name, text in man_pages.pages(program, codes, about):
        write(arguments.out / "man1" / f"{name}.1.gz", gzip.compress(text.encode(), 9, mtime=0))
    write(arguments.out / "bash/pcednet", completion.bash(program, known).encode())
    write(arguments.out / "zsh/_pcednet", completion.zsh(program, known).encode())


if __name__ == "__main__":
    main()
