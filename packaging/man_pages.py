"""Man pages in roff: pcednet(1), and pcednet-COMMAND(1) for every command."""

import re
import textwrap

SEE_MORE = "https://doi.org/10.1145/3481804"


def roff(text):
    """Text as roff prints it: no escape, no request at the begin of a line."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("`", "\\(ga")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def bold(text):
    return f"\\fB{roff(text)}\\fR"


def italic(text):
    return f"\\fI{roff(text)}\\fR"


def section(title, *lines):
    return [f".SH {title}", *lines] if lines else []


def value_of(option):
    if option.choices:
        separator = "," if option.several else "|"
        return roff(separator.join(option.choices))
    kinds = {"INT": "N", "UINT": "N", "FLOAT": "X"}
    if option.kind == "TEXT":
        return italic("FOLDER" if option.is_folder else "TEXT")
    return italic(kinds[option.kind])


def paragraph(option):
    """An option and what it does."""
    head = ", ".join(bold(name) for name in option.names)
    if option.kind and option.names[0].startswith("-"):
        head += " " + value_of(option)
    if option.several:
        head += " ..."
    remarks = []
    if option.preset:
        remarks.append(f"default: {option.preset}")
    if " in [" in option.allowed:
        low, high = re.search(r"\[(\S+) - (\S+)\]", option.allowed).groups()
        remarks.append(f"{low} to {high}")
    elif option.allowed:
        remarks.append({"NONNEGATIVE": "0 or above", "POSITIVE": "above 0"}.get(
            option.allowed, option.allowed))
    if option.required and option.names[0].startswith("-"):
        remarks.append("required")
    text = option.text + (f" ({'; '.join(remarks)})" if remarks else "")
    text = text[:1].upper() + text[1:] + "."
    lines = [".TP", head, *textwrap.wrap(roff(text), 78, break_on_hyphens=False)]
    for words, names in (("Not with", option.excludes), ("Only with", option.needs)):
        if names:
            lines.append(f"{words} {', '.join(bold(name) for name in names)}.")
    return lines


def options(command):
    lines = []
    for option in command.positionals + command.options:
        lines += paragraph(option)
    return lines


def example(line):
    """`pcednet ...`, and a remark behind three spaces or more."""
    words, _, remark = re.match(r"(.*?)(\s{2,}(.*))?$", line).groups()
    return [".TP", bold(words), roff(remark[:1].upper() + remark[1:] + ".") if remark else "\\&"]


def examples(command):
    lines = []
    for line in command.examples:
        lines += example(line)
    return lines


def head(name, summary, about):
    summary = summary[:1].lower() + summary[1:]
    return [f'.TH {name.upper().replace("-", chr(92) + "-")} 1 "{about["date"]}" '
            f'"pcednet {about["version"]}" "User commands"', ".nh",
            ".SH NAME", f"{roff(name)} \\- {roff(summary)}"]


def synopsis(command):
    usage = re.sub(r"\[OPTIONS\]", r"[\\fIOPTION\\fR]...", roff(command.usage))
    usage = usage.replace("SUBCOMMAND", "\\fICOMMAND\\fR")
    words = " ".join(["pcednet", *command.words])
    return usage.replace(roff(words), bold(words), 1)


def page_of_command(command, about):
    name = "-".join(["pcednet", *command.words])
    lines = head(name, command.summary, about)
    below = list(command.all())
    lines += section("SYNOPSIS", *(f"{synopsis(c)}\n.br" for c in below or [command]))
    lines += section("DESCRIPTION", *textwrap.wrap(roff(command.summary + "."), 78))
    if below:
        for one in below:
            lines += section(roff(" ".join(one.words).upper()),
                             *textwrap.wrap(roff(one.summary + "."), 78), *options(one))
            lines += [".PP", "Examples:", *examples(one)] if one.examples else []
    else:
        lines += section("OPTIONS", *options(command))
    lines += section("EXAMPLES", *examples(command))
    lines += section("EXIT STATUS", "See", ".BR pcednet (1).")
    lines += section("SEE ALSO", ".BR pcednet (1)")
    return name, "\n".join(lines) + "\n"


def page_of_program(program, exit_codes, about):
    lines = head("pcednet", "find edges in 3D point clouds", about)
    lines += section("SYNOPSIS", "\\fBpcednet\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]...")
    lines += section(
        "DESCRIPTION", "pcednet labels every point of a point cloud as non\\-edge, smooth\\-edge,",
        "sharp\\-edge or boundary, with confidences, and draws the edges as curves.",
        "It reads PLY, PCD, OBJ, OFF, STL, LAS, LAZ, COPC, E57 and text.",
        "It implements PCEDNet (Himeur et al., ACM Transactions on Graphics 41, 2021).")
    commands = []
    for command in program.commands:
        commands += [".TP", f"{bold(command.name)}", roff(command.summary) + "."]
    lines += section("COMMANDS", *commands)
    lines += section("OPTIONS", *options(program))
    lines += section("EXAMPLES", *examples(program))
    codes = []
    for code, meaning in exit_codes:
        codes += [".TP", bold(code), roff(meaning[:1].upper() + meaning[1:]) + "."]
    lines += section("EXIT STATUS", *codes, ".PP",
                     "With several inputs, the code is that of the first failure.")
    lines += section(
        "FILES", ".TP", "\\fI../share/pcednet/models\\fR",
        "The shipped models, beside the folder of the program.")
    see = ",\n".join(f".BR pcednet\\-{c.name} (1)" for c in program.commands)
    lines += section("SEE ALSO", *see.split("\n"), ".PP", roff(SEE_MORE))
    return "pcednet", "\n".join(lines) + "\n"


def exit_codes(text):
    """The table of docs/command-line.md."""
    table = text[text.index("## Exit codes"):]
    return re.findall(r"^\| (\d+) \| (.*?) \|$", table[:table.index("\n## ")], re.M)


def pages(program, codes, about):
    """The pages by name. `about` has the version and the date."""
    yield page_of_program(program, codes, about)
    for command in program.commands:
        yield page_of_command(command, about)
