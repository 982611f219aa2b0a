"""Completion of command lines for bash and zsh."""

import re


def choices_of(option, command, known):
    """Words that an option or an argument may be, beside files."""
    if option.choices:
        return option.choices
    if option.names[-1] in ("--model", "--models"):
        return known["models"] + (["none"] if command.words == ["annotate"] else [])
    if command.words == ["study"] and option.names == ["names"]:
        return known["experiments"] + ["list"]
    return []


def takes_files(option, command):
    is_name = command.words == ["study"] and option.names == ["names"]
    return option.is_file and not is_name


# bash ------------------------------------------------------------------------------------------

BASH = """# Completion of pcednet for bash, made from its --help.
_pcednet() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  # bash takes the = of --option=value for a word.
  [[ $current == '=' ]] && current=''
  [[ $before == '=' ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
  local command=${COMP_WORDS[1]} words='' kind=file depth=1
  case $command in
@GROUPS@
  esac
  COMPREPLY=()
  if ((COMP_CWORD <= depth)); then
    ((COMP_CWORD == 1)) && command=''
    ((COMP_CWORD == 2)) && command=${COMP_WORDS[1]}
    case $command in
@COMMANDS@
    esac
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    return
  fi
  case "$command $before" in
@VALUES@
    *)
      case $command in
@OPTIONS@
      esac
      # Options only where one begins; elsewhere the words of the argument, and files.
      [[ $current == -* ]] && kind=none || words=$arguments
      ;;
  esac
  [[ $words ]] && COMPREPLY=($(compgen -W "$words" -- "$current"))
  case $kind in
    file) compopt -o default -o filenames 2>/dev/null
          local IFS=$'\\n'
          COMPREPLY+=($(compgen -f -- "$current")) ;;
    folder) compopt -o filenames 2>/dev/null
            local IFS=$'\\n'
            COMPREPLY+=($(compgen -d -- "$current")) ;;
  esac
}
complete -F _pcednet pcednet
"""


def bash(program, known):
    runnable = [c for c in program.all() if not c.commands]
    groups = [f"    {c.name}) depth=2; command+=\" ${{COMP_WORDS[2]}}\" ;;"
              for c in program.commands if c.commands]
    names = " ".join(c.name for c in program.commands)
    commands = [f"      '') words='{names} --help --version' ;;"]
    commands += [f"      {c.name}) words='{' '.join(s.words[-1] for s in c.commands)} --help' ;;"
                 for c in program.commands if c.commands]
    values, options = {}, []
    for command in runnable:
        for option in command.options:
            if not option.kind:
                continue
            words = " ".join(choices_of(option, command, known))
            kind = "file" if takes_files(option, command) else \
                "folder" if option.is_folder else "none"
            for name in option.names:
                values.setdefault((words, kind), []).append(f"'{command.name} {name}'")
        flags = " ".join(name for o in command.options for name in o.names)
        arguments = " ".join(w for o in command.positionals
                             for w in choices_of(o, command, known))
        kind = "file" if any(takes_files(o, command) for o in command.positionals) else \
            "folder" if any(o.is_folder for o in command.positionals) else "none"
        options.append(f"        '{command.name}') words='{flags}' kind={kind} "
                       f"arguments='{arguments}' ;;")
    lines = [f"    {'|'.join(heads)}) words='{words}' kind={kind} ;;"
             for (words, kind), heads in values.items()]
    text = BASH
    for mark, block in (("GROUPS", groups), ("COMMANDS", commands), ("VALUES", lines),
                        ("OPTIONS", options)):
        text = text.replace(f"@{mark}@", "\n".join(block))
    return text.replace("depth=1\n", "depth=1 arguments=''\n", 1)


# zsh -------------------------------------------------------------------------------------------

def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def described(text):
    """A description within the brackets of _arguments."""
    return re.sub(r"([\[\]:\\])", r"\\\1", text)


def action(option, command, known):
    words = choices_of(option, command, known)
    files = "_files" if takes_files(option, command) else "_files -/" if option.is_folder else ""
    if words and files:
        return f" _pcednet_words_or_files {' '.join(words)}"
    return f"({' '.join(words)})" if words else files or " "


def zsh_option(option, command, known):
    many = "*" if option.several else ""
    label = option.names[-1].lstrip("-")
    value = f":{label}:{action(option, command, known)}" if option.kind else ""
    for name in option.names:
        equals = "=" if option.kind and name.startswith("--") else ""
        others = [] if option.several else option.names + option.excludes
        without = f"({' '.join(others)})" if others else ""
        yield quoted(f"{without}{many}{name}{equals}[{described(option.text)}]{value}")


def zsh_function(command, known):
    name = "_".join(["_pcednet", *command.words])
    lines = [f"{name}() {{", "  _arguments -s -S \\"]
    specs = [spec for o in command.options for spec in zsh_option(o, command, known)]
    for i, option in enumerate(command.positionals):
        place = "*" if option.several else str(i + 1)
        specs.append(quoted(f"{place}:{option.names[0]}:{action(option, command, known)}"))
    return lines + ["    " + " \\\n    ".join(specs), "}"]


def zsh_menu(command):
    """A function that completes the name of a command below this one, and then hands over."""
    name = "_".join(["_pcednet", *command.words]) if command.words else "_pcednet"
    extra = " '--version[Print the version]'" if not command.words else ""
    lines = [f"{name}() {{", "  local curcontext=\"$curcontext\" state",
             f"  _arguments -C '(-h --help)'{{-h,--help}}'[Print help]'{extra} "
             "'1:command:->command' '*::argument:->argument'",
             "  case $state in", "    command)", "      local -a commands=("]
    lines += ["        " + quoted(f"{c.words[-1]}:{c.summary}") for c in command.commands]
    lines += ["      )", "      _describe command commands ;;", "    argument)",
              "      case $words[1] in"]
    lines += [f"        {c.words[-1]}) {'_'.join(['_pcednet', *c.words])} ;;"
              for c in command.commands]
    return lines + ["      esac ;;", "  esac", "}"]


def zsh(program, known):
    lines = ["#compdef pcednet", "# Completion of pcednet for zsh, made from its --help.", "",
             "_pcednet_words_or_files() {",
             "  _alternative \"words:word:($*)\" 'files:file:_files'", "}", ""]
    for command in [*program.all(), program]:
        lines += zsh_menu(command) if command.commands else zsh_function(command, known)
        lines.append("")
    return "\n".join([*lines, '_pcednet "$@"', ""])
