#!/usr/bin/env python3
"""Writes manual pages and completions for bash and zsh from what the programs print with --help.

    write_help_files.py BIN OUT --version V --date YYYY-MM-DD [--compress FROM=TO.gz ...]

BIN is the folder of nearfit-cli and, where it is built, nearfit. Writes OUT/man/*.1.gz, OUT/bash/* and OUT/zsh/_*.
A program whose help cannot be read, or says nothing of its options, is an error.
"""

import argparse
import gzip
import os
import pathlib
import re
import subprocess
import sys
from dataclasses import dataclass, field

DESCRIPTION_COLUMN = 30  # Where CLI11 puts descriptions, from the indent of names on.
NAME_INDENT = 2


@dataclass
class Option:
    """An option as its help has it."""

    names: list  # Without the {default} of a flag.
    value: str  # Empty for a flag.
    text: str
    is_optional: bool = False  # Its value may be left out.
    is_repeated: bool = False
    choices: list = field(default_factory=list)


@dataclass
class Command:
    """A program or one of its commands."""

    words: list
    text: str = ""
    usage: str = ""
    sections: list = field(default_factory=list)  # Pairs of a title and rows (left, right).
    options: list = field(default_factory=list)
    notes: list = field(default_factory=list)  # Lines after the sections.
    commands: list = field(default_factory=list)


def run_help(program, words):
    # The width of a terminal or the language must not change what is written.
    result = subprocess.run([program, *words, "--help"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                            env={**os.environ, "LC_ALL": "C.UTF-8"}, timeout=60)
    if result.returncode != 0 or "Options:" not in result.stdout:
        sys.exit(f"write_help_files: {program} {' '.join(words)} --help failed: {result.stderr.strip()}")
    return result.stdout.rstrip("\n").split("\n")


def read_option(left, text):
    left = re.split(r"\s+(?:Needs|Excludes):", left)[0]
    names, _, rest = left.partition(" ")
    words = [word for word in rest.split() if word not in ("REQUIRED", "...")]
    choices = re.search(r":\{([^}]*)\}", rest)
    # Behind the name of the value are its choices and default.
    value = re.split("[:=]", words[0])[0] if words else ""
    return Option([re.sub(r"\{.*", "", name) for name in names.split(",")], value.strip("[]"), text, value.startswith("["),
                  "..." in rest.split(), choices.group(1).split(",") if choices else [])


def read_rows(lines):
    """Pairs (left, right) of a section's lines."""
    rows = []
    is_description = [line.startswith(" " * DESCRIPTION_COLUMN) for line in lines] + [False]
    for i, line in enumerate(lines):
        if is_description[i]:
            continue
        # A left side too long for its column has its description on the next line.
        indent = len(line) - len(line.lstrip())
        split = len(line) if is_description[i + 1] else DESCRIPTION_COLUMN + indent - NAME_INDENT
        right = lines[i + 1] if is_description[i + 1] else line[split:]
        rows.append((line[:split].strip(), right.strip()))
    return rows


def read_command(program, words):
    lines = run_help(program, words[1:])
    command = Command(words)
    usage = next(i for i, line in enumerate(lines) if line.startswith("Usage: "))
    command.text = " ".join(line.strip() for line in lines[:usage] if line.strip())
    command.usage = lines[usage][len("Usage: "):]
    i = usage + 1
    while i < len(lines):
        title = re.match(r" *(\S[^:]*):$", lines[i])
        body = []
        j = i + 1
        while title and j < len(lines) and re.match(r" {2,}\S", lines[j]):
            body.append(lines[j])
            j += 1
        rows = read_rows(body)
        is_section = body and (title.group(1) in ("Positionals", "Subcommands") or
                               any(left.startswith("-") for left, _ in rows))
        if is_section and not command.notes:
            command.sections.append((title.group(1), rows))
            i = j
            continue
        # Borders of a group of options are no notes.
        if not re.match(r" *\[.*\]$", lines[i]) and (lines[i].strip() or command.notes):
            command.notes.append(lines[i].rstrip())
        i += 1
    for title, rows in command.sections:
        if title == "Subcommands":
            command.commands = [read_command(program, words + [left]) for left, _ in rows]
        elif title != "Positionals":
            command.options += [read_option(left, right) for left, right in rows]
    return command


def all_commands(command):
    yield command
    for each in command.commands:
        yield from all_commands(each)


# Manual pages.

def roff(text):
    """The text as it is: roff makes other signs of these, and commands of lines that begin with a dot."""
    for sign, name in (("\\", "\\e"), ("-", "\\-"), ("'", "\\(aq"), ("`", "\\(ga"), ("^", "\\(ha"), ("~", "\\(ti")):
        text = text.replace(sign, name)
    return "\\&" + text if text.startswith(".") else text


def roff_rows(rows):
    for left, right in rows:
        yield from (".TP", f"\\fB{roff(left)}\\fR", roff(right) or "\\&")


def roff_notes(notes):
    yield from (".PP", ".nf")
    for line in notes:
        yield roff(line) if line else ".sp"
    yield ".fi"


def manual_page(program, version, date, others):
    name = program.words[0]
    yield f'.TH {roff(name.upper())} 1 "{date}" "Nearfit {version}" "User Commands"'
    yield ".SH NAME"
    yield f"{roff(name)} \\- {roff(program.text[0].lower() + program.text[1:].rstrip('.'))}"
    yield ".SH SYNOPSIS"
    yield f".B {roff(program.usage)}"
    yield ".SH DESCRIPTION"
    yield roff(program.text)
    if not program.commands:
        yield from roff_notes(program.notes) if len(program.notes) > 1 else (".PP", *map(roff, program.notes))
    for title, rows in program.sections:
        if title != "Subcommands":
            yield f'.SH "{roff(title.upper())}"'
            yield from roff_rows(rows)
    if program.commands:
        yield ".SH COMMANDS"
        for command in list(all_commands(program))[1:]:
            yield f'.SS "{roff(" ".join(command.words[1:]))}"'
            yield roff(command.text)
            yield ".PP"
            yield f".B {roff(command.usage)}"
            for title, rows in command.sections:
                if title == "Subcommands":
                    continue
                if title != "Options":
                    yield from (".PP", f".I {roff(title)}:")
                yield from roff_rows((left, right) for left, right in rows if not left.startswith("-h,"))
            if command.notes and command.notes != program.notes:
                yield from roff_notes(command.notes)
        yield ".SH NOTES"
        yield from roff_notes(program.notes)
    yield ".SH SEE ALSO"
    yield ", ".join(f".BR {roff(other)} (1)" for other in others) or "The guide in /usr/share/nearfit/docs."


# Completions. Values of options are words to choose from, or names of files.

def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def bash_completion(program):
    function = "_" + program.words[0].replace("-", "_")
    yield f"# Completion of {program.words[0]} for bash; made from its --help."
    yield f"{function}() {{"
    yield '  local current="${COMP_WORDS[COMP_CWORD]}" previous="${COMP_WORDS[COMP_CWORD-1]}" command="" words="" i'
    yield "  # Bash makes words of their own of a value and the = before it."
    yield '  if [[ "$current" == "=" ]]; then'
    yield '    current=""'
    yield '  elif [[ "$previous" == "=" && $COMP_CWORD -ge 2 ]]; then'
    yield '    previous="${COMP_WORDS[COMP_CWORD-2]}"'
    yield "  fi"
    yield "  for ((i = 1; i < COMP_CWORD; ++i)); do"
    yield '    case "$command ${COMP_WORDS[i]}" in'
    inner = [" " + " ".join(c.words[1:]) for c in list(all_commands(program))[1:]]
    for words in inner:
        yield f'      {quoted(words)}) command="$command ${{COMP_WORDS[i]}}" ;;'
    yield "      *) ;;"
    yield "    esac"
    yield "  done"
    yield "  COMPREPLY=()"
    yield '  case "$command $previous" in'
    for command in all_commands(program):
        prefix = "".join(" " + word for word in command.words[1:])
        for option in command.options:
            if not option.value:
                continue
            patterns = " | ".join(quoted(f"{prefix} {name}") for name in option.names)
            if option.choices:
                yield f'    {patterns}) mapfile -t COMPREPLY < <(compgen -W {quoted(" ".join(option.choices))} -- "$current"); return ;;'
            elif option.is_optional:
                yield f'    {patterns}) [[ "$current" == -* ]] || {{ mapfile -t COMPREPLY < <(compgen -f -- "$current"); return; }} ;;'
            else:
                yield f'    {patterns}) mapfile -t COMPREPLY < <(compgen -f -- "$current"); return ;;'
    yield "    *) ;;"
    yield "  esac"
    yield '  case "$command" in'
    for command in all_commands(program):
        prefix = "".join(" " + word for word in command.words[1:])
        names = [name for option in command.options for name in option.names]
        below = [each.words[-1] for each in command.commands]
        yield f'    {quoted(prefix)}) words={quoted(" ".join(names + below))} ;;'
    yield "    *) ;;"
    yield "  esac"
    yield '  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")'
    yield "  # Anything else is a file."
    yield '  [[ "$current" == -* || ${#COMPREPLY[@]} -gt 0 ]] || mapfile -t COMPREPLY < <(compgen -f -- "$current")'
    yield "}"
    yield f"complete -o filenames -F {function} {program.words[0]}"


def zsh_text(text):
    return text.replace("\\", "\\\\").replace("[", "\\[").replace("]", "\\]")


def zsh_message(text):
    return re.sub(r"([\\:\[\]])", r"\\\1", text)


def zsh_option(option):
    value = ""
    if option.value:
        action = f"({' '.join(option.choices)})" if option.choices else "_files"
        value = f"{'::' if option.is_optional else ':'}{zsh_message(option.value)}:{action}"
    others = "*" if option.is_repeated else f"({' '.join(option.names)})"
    for name in option.names:
        sign = ("=" if name.startswith("--") else "+") if option.value and not option.is_optional else ""
        yield quoted(f"{others}{name}{sign}[{zsh_text(option.text)}]{value}")


def zsh_function(command):
    return "_" + "_".join(command.words)


def zsh_completion(program):
    yield f"#compdef {program.words[0]}"
    yield f"# Made from the --help of {program.words[0]}."
    for command in list(all_commands(program))[::-1]:
        yield f"{zsh_function(command)}() {{"
        specs = [spec for option in command.options for spec in zsh_option(option)]
        if not command.commands:
            yield "  _arguments -s -S \\"
            yield from (f"    {spec} \\" for spec in specs)
            yield "    '*:file:_files'"
        else:
            yield '  local curcontext="$curcontext" state line'
            yield "  local -a commands=("
            for each in command.commands:
                yield "    " + quoted(f"{each.words[-1]}:{each.text}")
            yield "  )"
            yield "  _arguments -C \\"
            yield from (f"    {spec} \\" for spec in specs)
            yield "    '1:command:->command' '*::argument:->rest'"
            yield "  case $state in"
            yield "    command) _describe command commands ;;"
            yield "    rest)"
            yield "      case $words[1] in"
            for each in command.commands:
                yield f"        {each.words[-1]}) {zsh_function(each)} ;;"
            yield "      esac ;;"
            yield "  esac"
        yield "}"
    yield f'{zsh_function(program)} "$@"'


def write(file, lines):
    file.parent.mkdir(parents=True, exist_ok=True)
    data = ("\n".join(lines) + "\n").encode()
    if file.suffix == ".gz":
        compress(data, file)
    else:
        file.write_bytes(data)


def compress(data, file):
    """Without name and time, so that the same text gives the same file."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("wb") as out, gzip.GzipFile(filename="", mode="wb", compresslevel=9, fileobj=out, mtime=0) as zipped:
        zipped.write(data)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("bin", type=pathlib.Path, help="folder of the programs")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--version", required=True)
    parser.add_argument("--date", required=True)
    parser.add_argument("--compress", action="append", default=[], metavar="FROM=TO.gz",
                        help="also compress this file; repeat it for more")
    arguments = parser.parse_args()
    names = [name for name in ("nearfit", "nearfit-cli") if (arguments.bin / name).is_file()]
    for name in names:
        program = read_command(arguments.bin / name, [name])
        others = [other for other in names if other != name]
        write(arguments.out / f"man/{name}.1.gz", manual_page(program, arguments.version, arguments.date, others))
        write(arguments.out / f"bash/{name}", bash_completion(program))
        write(arguments.out / f"zsh/_{name}", zsh_completion(program))
    for pair in arguments.compress:
        source, _, target = pair.partition("=")
        compress(pathlib.Path(source).read_bytes(), pathlib.Path(target))


if __name__ == "__main__":
    main()
