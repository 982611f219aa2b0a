"""Rules of the house that a compiler does not check.

rules.py RULE ROOT prints each breach as "file:line: what is wrong" and exits with 1 if there is
one, with 77 (skipped) if the rule cannot be checked here. `rules.py self` checks the rules
themselves on a small house with one breach of each.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
SOURCES = (".h", ".cpp")
MAX_LINES = {".h": 150, ".cpp": 400}
CLANG_FORMAT = "14"  # others lay out some constructs differently


class Skip(Exception):
    """The rule cannot be checked here."""


def read(path):
    return path.read_text(encoding="utf-8")


def sources(root, *folders):
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SOURCES and path.is_file():
                yield path


def arguments(text, function):
    """The words between the parentheses of every call of a CMake function."""
    text = re.sub(r"#.*", "", text)
    return [call.split() for call in re.findall(rf"\b{function}\s*\(([^)]*)\)", text)]


WINGS = {"pcednet": "pcednet_room", "workbench": "workbench_room"}


def room_order(root):
    """Every room as (wing, name), from the bottom up."""
    order = []
    text = re.sub(r"#.*", "", read(root / "CMakeLists.txt"))
    for names, wing in re.findall(r"foreach\(room ([^)]*)\)\s*add_subdirectory\(src/(\w+)/", text):
        order += [(wing, name) for name in names.split()]
    if not order:
        raise SystemExit("CMakeLists.txt: no foreach(room ...) lists the rooms")
    return order


def rooms_used(root, wing, room):
    listing = root / "src" / wing / room / "CMakeLists.txt"
    (words,) = arguments(read(listing), WINGS[wing])
    if words[0] != room:
        raise SystemExit(f"{listing}: names the room {words[0]}")
    used = []
    if "USES" in words:
        for word in words[words.index("USES") + 1:]:
            if word in ("LINKS", "PRIVATE_LINKS"):
                break
            used.append(word)
    return used


def check_rooms(root):
    """A room, which is a folder, uses rooms above it in the lists only, and includes what it says
    it uses."""
    order = room_order(root)
    names = [name for _, name in order]
    include = re.compile(r'\s*#\s*include\s*[<"](pcednet|workbench)/([^">]+)/[^/">]+[">]')
    for folder in sorted(path for path in (root / "src").glob("*/**/*") if path.is_dir()):
        wing, _, room = folder.relative_to(root / "src").as_posix().partition("/")
        if (wing, room) not in order:
            yield f"src/{wing}/{room}: not among the rooms of CMakeLists.txt"
            continue
        used = rooms_used(root, wing, room)
        for other in used:
            if other not in names[:names.index(room)]:
                yield f"src/{wing}/{room}/CMakeLists.txt: uses {other}, which is not above it"
        allowed = [place for place in order if place[1] in (room, *used)]
        for path in sorted(path for path in folder.glob("*") if path.suffix in SOURCES):
            for number, line in enumerate(read(path).splitlines(), 1):
                found = include.match(line)
                if found and found.groups() not in allowed:
                    yield f"{path}:{number}: includes {found[2]}, which {room} does not use"


def check_sizes(root):
    """Headers and sources fit in a head."""
    for path in sources(root, "src", "apps"):
        lines = read(path).count("\n")
        if lines > MAX_LINES[path.suffix]:
            yield f"{path}:{lines}: more than {MAX_LINES[path.suffix]} lines"


def check_suffixes(root):
    """C++ stands in headers and sources, which the other rules read."""
    others = {".inc", ".inl", ".ipp", ".tpp", ".tcc", ".hpp", ".hh", ".hxx", ".cc", ".cxx", ".c"}
    for folder in ("src", "apps", "tests", "bench", "examples", "python", "fuzz"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in others and "node_modules" not in path.parts:
                yield f"{path}:1: is neither .h nor .cpp"


def check_silence(root):
    """The library neither prints nor ends the program."""
    speech = re.compile(
        r"std::(cout|cerr|clog)\b|\bfmt::print\b|(?<![\w:])(std::)?(v?printf|puts|putchar)\s*\("
        r"|\bf(printf|puts|putc)\s*\([^;]*\bstd(out|err)\b"
        r"|(?<![\w:.>])(std::)?(_?_?[eE]xit|quick_exit|abort|terminate)\s*\(")
    for path in sources(root, "src"):
        for number, line in enumerate(read(path).splitlines(), 1):
            if speech.search(line.split("//")[0]):
                yield f"{path}:{number}: prints or ends the program: {line.strip()}"


def check_version(root):
    """One version number, that of CMake, wherever another file repeats it."""
    version = re.search(r"project\(pcednet\s+VERSION\s+([\d.]+)", read(root / "CMakeLists.txt"))[1]
    places = {"CHANGELOG.md": r"^##\s+\[?v?(\d[\d.]*)", "CITATION.cff": r"^version:\s*[\"']?([^\"'\s]+)"}
    for name, pattern in places.items():
        if not (root / name).exists():
            continue
        found = re.search(pattern, read(root / name), re.MULTILINE)
        if not found or found[1] != version:
            yield f"{name}: says {found[1] if found else 'no version'}, CMakeLists.txt {version}"


def check_colours(root):
    """The pages name and colour the classes as the library does."""
    table = root / "src/pcednet/cloud/class_table.h"
    palette = root / "web/shared/colours.ts"
    classes = [(name, f"#{int(r):02x}{int(g):02x}{int(b):02x}") for name, r, g, b in
               re.findall(r'\{k\w+, "([\w-]+)", \{(\d+), (\d+), (\d+)\}\}', read(table))]
    paper = re.search(r"paper: \[(.*?)\]", read(palette), re.DOTALL)[1]
    shown = [(name.replace(" ", "-"), colour) for name, colour in
             re.findall(r'name: "(.*?)", colour: "(.*?)"', paper)]
    if not classes or shown[:len(classes)] != classes:
        yield f"{palette}: shows {shown}, {table.name} has {classes}"


def check_style(root):
    """Every source is as clang-format leaves it."""
    program = shutil.which("clang-format-14") or shutil.which("clang-format")
    if not program:
        raise Skip("no clang-format here")
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout
    if not re.search(rf"version {CLANG_FORMAT}\.", version):
        raise Skip(f"needs clang-format {CLANG_FORMAT}, here is: {version.strip()}")
    paths = list(sources(root, "src", "apps", "tests", "bench", "examples", "python", "fuzz"))
    done = subprocess.run([program, "--dry-run", "-Werror", *map(str, paths)],
                          capture_output=True, text=True)
    yield from (line for line in done.stderr.splitlines() if ": error:" in line)


def check_mentions(root):
    """Comments of installed headers name functions and headers that are installed."""
    (headers,) = [words[1:] for words in arguments(read(root / "cmake/PcednetInstall.cmake"), "set")
                  if words[0] == "public_headers"]
    texts = {header: read(root / "src/pcednet" / header).splitlines() for header in headers}
    code = "\n".join(line.split("//")[0] for lines in texts.values() for line in lines)
    known = set(re.findall(r"\w+", code)) | {pathlib.Path(header).name for header in headers}
    for header, lines in texts.items():
        for number, line in enumerate(lines, 1):
            comment = line.partition("//")[2]
            for name in re.findall(r"(\w+)\(\)|(\w+\.h)\b|\bsee (?:\w+::)*(\w+)", comment):
                if "".join(name) not in known:
                    yield f"src/pcednet/{header}:{number}: names {''.join(name)}, which is not installed"


def calls(text):
    """Every pair of parentheses: where it opens, and what it holds between its commas."""
    opened = []
    for end, sign in enumerate(text):
        if sign in "([{":
            opened.append((sign, end, [end + 1]))
        elif sign == "," and opened:
            opened[-1][2].append(end + 1)
        elif sign in ")]}" and opened:
            bracket, begin, starts = opened.pop()
            if bracket == "(":
                yield begin, [text[a:b] for a, b in zip(starts, [*starts[1:], end])]


def check_draws(root):
    """At most one argument of a call draws from `random`: their order is left to the compiler."""
    draw = re.compile(r"\brandom_?\s*\.\s*\w+\s*\(|[(,{]\s*random_?\s*[,)}]")
    for path in sources(root, "src", "apps", "tests", "bench", "examples", "fuzz"):
        text = re.sub(r"//.*", lambda comment: " " * len(comment[0]), read(path))
        for begin, parts in calls(text):
            if sum(bool(draw.search(part)) for part in parts) > 1 and ";" not in "".join(parts):
                line = text.count("\n", 0, begin) + 1
                yield f"{path}:{line}: draws random numbers in more than one argument"


RULES = {"rooms": check_rooms, "sizes": check_sizes, "suffixes": check_suffixes, "draws": check_draws,
         "silence": check_silence, "version": check_version, "colours": check_colours,
         "mentions": check_mentions, "style": check_style}


def check_self():
    """Every rule finds its breach, and nothing else in the same house without it."""
    sound = {
        "CMakeLists.txt": """project(pcednet VERSION 1.2.3)
foreach(room core core/fast cloud gls) # order
  add_subdirectory(src/pcednet/${room})
endforeach()
foreach(room study)
  add_subdirectory(src/workbench/${room})
endforeach()
""",
        "src/pcednet/core/CMakeLists.txt": "pcednet_room(core LINKS gls)\n",
        "src/pcednet/core/a.h": "#pragma once\n",
        "src/pcednet/core/fast/CMakeLists.txt": "pcednet_room(core/fast USES core)\n",
        "src/pcednet/core/fast/d.h": '#include "pcednet/core/a.h"\n#include "pcednet/core/fast/e.h"\n',
        "src/pcednet/gls/CMakeLists.txt": "pcednet_room(gls\n  USES core)\n",
        "src/pcednet/gls/b.cpp": '#include "pcednet/core/a.h"\nint n = snprintf(b, 2, "x");\n'
                                 "f(a, random, {random.next(), random.next()});  // g(random), g(random)\n",
        "src/workbench/study/CMakeLists.txt": "workbench_room(study USES gls)\n",
        "src/workbench/study/c.cpp": '#include "workbench/study/c.h"\n\n#include "pcednet/gls/b.h"\n',
        "src/pcednet/cloud/class_table.h": "// {kNonEdge, \"non-edge\", {255, 0, 16}}\n",
        "src/pcednet/cloud/CMakeLists.txt": "pcednet_room(cloud)\n",
        "web/shared/colours.ts": 'paper: [ { name: "non-edge", colour: "#ff0010" }, { name: "none", colour: "#0" } ],\n',
        "CHANGELOG.md": "# Changes\n\n## Unreleased\n\n## 1.2.3\n\n## 1.2.2\n",
        "CITATION.cff": 'cff-version: 1.2.0\nversion: "1.2.3"\n',
        ".clang-format": "BasedOnStyle: Google\n",
        "cmake/PcednetInstall.cmake": "set(public_headers\n  core/a.h gls/p.h)\n",
        "src/pcednet/gls/p.h": "/// As core/a.h has it, see fit().\nint fit();\n",
    }
    breaches = {
        "rooms": [("src/pcednet/core/a.h", '#include "pcednet/gls/b.h"\n'),
                  ("src/pcednet/gls/CMakeLists.txt", "pcednet_room(gls)\n"),
                  ("src/pcednet/core/CMakeLists.txt", "pcednet_room(core USES gls)\n"),
                  ("src/pcednet/core/a.h", '#include "workbench/study/c.h"\n'),
                  ("src/pcednet/gls/CMakeLists.txt", "pcednet_room(gls USES core study)\n"),
                  ("src/workbench/study/c.cpp", '#include "pcednet/core/a.h"\n'),
                  ("src/workbench/study/c.cpp", '#include "workbench/gls/b.h"\n'),
                  ("src/pcednet/core/a.h", '#include "pcednet/core/fast/d.h"\n'),
                  ("src/pcednet/core/fast/d.h", '#include "pcednet/gls/b.h"\n'),
                  ("src/pcednet/gls/b.h", '#include "pcednet/core/fast/d.h"\n'),
                  ("src/pcednet/core/CMakeLists.txt", "pcednet_room(core USES core/fast)\n"),
                  ("src/pcednet/core/slow/d.h", "\n"),
                  ("src/pcednet/new/c.h", "\n"), ("src/workbench/new/c.h", "\n")],
        "sizes": [("src/pcednet/core/a.h", "\n" * 151), ("apps/main.cpp", "\n" * 401)],
        "suffixes": [("src/pcednet/gls/lanes.inc", "int w;\n"), ("bench/a.hpp", "#pragma once\n")],
        "silence": [("src/pcednet/gls/b.cpp", text) for text in
                    ('std::cout << 1;\n', 'printf("x");\n', "  std::exit(1);\n", "exit (1);\n",
                     'fmt::print(stderr, "x");\n', 'std::fprintf(stderr, "x");\n', "abort();\n")],
        "version": [("CHANGELOG.md", "## 1.2.2\n"), ("CITATION.cff", "version: 1.2.4\n")],
        "colours": [("web/shared/colours.ts", 'paper: [ { name: "non-edge", colour: "#ff0011" } ]\n'),
                    ("web/shared/colours.ts", 'paper: [ { name: "edge", colour: "#ff0010" } ]\n'),
                    ("src/pcednet/cloud/class_table.h", "\n")],
        "mentions": [("src/pcednet/gls/p.h", text) for text in
                     ("int fit();  ///< in place of find()\n", "/// As b.h has it.\n", "/// See, or see b::C\n")],
        "style": [("src/pcednet/core/a.h", "int  a ;\n")],
        "draws": [("src/pcednet/gls/b.cpp", text) for text in
                  ("Vec3 v(random.uniform(), 0,\n       random.normal());\n", "f(g(random), {random.next()});\n")],
    }
    for rule, check in RULES.items():
        for breach in [None, *breaches[rule]]:
            with tempfile.TemporaryDirectory() as folder:
                root = pathlib.Path(folder)
                for name, text in [*sound.items(), *([breach] if breach else [])]:
                    (root / name).parent.mkdir(parents=True, exist_ok=True)
                    (root / name).write_text(text, encoding="utf-8")
                try:
                    found = list(check(root))
                except Skip:
                    continue
                if bool(found) != bool(breach):
                    yield f"{rule}: finds {found} where the breach is {breach}"


def main():
    rule = sys.argv[1]
    try:
        found = list(check_self() if rule == "self" else RULES[rule](pathlib.Path(sys.argv[2])))
    except Skip as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    print("\n".join(found) or f"{rule}: kept")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
