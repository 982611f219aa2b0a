"""The commands and options of pcednet, read from its --help: from them man pages, completion and the
reference of the documentation are made, so that these cannot say anything else.
"""

import dataclasses
import json
import re
import subprocess
import sys

COLUMN = 30  # where the descriptions of the help begin


@dataclasses.dataclass
class Option:
    """An option (`names` begin with -) or a positional argument (one name without)."""
    names: list
    kind: str = ""  # TEXT, INT, ...; empty for a flag
    choices: list = dataclasses.field(default_factory=list)
    allowed: str = ""  # such as "INT in [0 - 4096]"
    preset: str = ""
    several: bool = False
    required: bool = False
    excludes: list = dataclasses.field(default_factory=list)
    needs: list = dataclasses.field(default_factory=list)
    text: str = ""

    @property
    def is_folder(self):
        return re.match(r"(Output )?[Ff]older", self.text) is not None

    @property
    def is_file(self):
        return self.kind == "TEXT" and not self.choices and not self.is_folder


@dataclasses.dataclass
class Command:
    words: list  # ["tiles", "run"]; empty for the program itself
    summary: str
    examples: list
    usage: str
    positionals: list
    options: list
    commands: list

    @property
    def name(self):
        return " ".join(self.words)

    def all(self):
        """The commands of this one that do something, at any depth."""
        for command in self.commands:
            yield command
            yield from command.all()


def sections(text):
    """The help as (heading, lines); the heading of the description is empty."""
    found = [("", [])]
    for line in text.splitlines():
        heading = re.fullmatch(r"(Examples|Usage|Positionals|Options|Subcommands):(.*)", line)
        if heading:
            found.append((heading[1], [heading[2]] if heading[2] else []))
        elif line.strip():
            found[-1][1].append(line)
    return found


def entries(lines):
    """(what stands left, its description) of a table of the help."""
    found = []
    for i, line in enumerate(lines):
        if line.startswith(" " * COLUMN):
            continue
        if i + 1 < len(lines) and lines[i + 1].startswith(" " * COLUMN):
            found.append((line.strip(), lines[i + 1].strip()))
        else:
            found.append((line[:COLUMN].strip(), line[COLUMN:].strip()))
    return found


def option(left, text):
    names, _, rest = left.partition(" ")
    found = Option(names=names.split(","), text=text)
    rest, *relations = re.split(r"\s*\b(Excludes|Needs):\s*", " " + rest)
    for relation, words in zip(relations[::2], relations[1::2]):
        setattr(found, relation.lower(), words.split())
    found.required = bool(re.search(r" REQUIRED\b", rest))
    rest = rest.replace(" REQUIRED", "")
    found.several = " ..." in rest
    kind = re.fullmatch(r"([A-Z]+)(?: x \d+)?(?::(?:\{(.*?)\}|([^=]*?)))?(?:=(.*))?",
                        rest.replace(" ...", "").strip())
    if kind:
        found.kind, found.allowed, found.preset = kind[1], kind[3] or "", kind[4] or ""
        found.choices = kind[2].split(",") if kind[2] else []
    elif rest.strip():
        raise SystemExit(f"program_help.py: cannot read the help: {left}")
    return found


def read_command(program, words=()):
    """The Command that `program words --help` describes, with those below it."""
    text = subprocess.run([program, *words, "--help"], check=True, capture_output=True,
                          text=True).stdout
    found = Command(list(words), "", [], "", [], [], [])
    for heading, lines in sections(text):
        if heading == "":
            found.summary = " ".join(lines)
        elif heading == "Examples":
            found.examples = [line.strip() for line in lines]
        elif heading == "Usage":
            found.usage = re.sub(r"^\s*\S+", "pcednet", lines[0])
        elif heading == "Positionals":
            found.positionals = [option(*entry) for entry in entries(lines)]
        elif heading == "Options":
            found.options = [option(*entry) for entry in entries(lines)]
        elif heading == "Subcommands":
            found.commands = [read_command(program, (*words, name)) for name, _ in entries(lines)]
    return found


def experiments(program):
    """The names that `pcednet study` takes."""
    text = subprocess.run([program, "study", "list"], check=True, capture_output=True,
                          text=True).stdout
    return [line.split()[0] for line in text.splitlines() if line.strip()]


if __name__ == "__main__":
    json.dump(dataclasses.asdict(read_command(sys.argv[1])), sys.stdout)
