"""Which result files cannot be repeated, and why: heads without what they must say, and revisions that are not there."""

import pathlib
import re
import subprocess

# A sequence of our own runs leaves a load of up to one a processor behind, twice as many say that others were at work.
BUSY_LOAD_PER_PROCESSOR = 2.0


def result_files(results):
    found = list(results.root.glob("tests/*/results/*.csv")) + list(results.root.glob("tests/*/results/*.txt"))
    return sorted(str(file.relative_to(results.root)) for file in found)


def note(table):
    """Words for a reader where a table stands on a file of a busy machine; empty where it does not."""
    return "busy machine" if says_busy(table) else ""


def machine(table):
    return table.head.get("processor") or table.head.get("machine") or ""


def compiler(table):
    if "compiler" in table.head:
        return table.head["compiler"].replace("GCC-compatible", "GCC")
    # Heads of older runs name it with the machine, or as a line of its own.
    named = re.search(r"GCC ([\d.]+)", table.head.get("machine", ""))
    plain = next((line for line in table.comments if line.startswith("g++")), None)
    # tests/systems/run names the compiler of the system that it made.
    return f"GCC {named.group(1)}" if named else f"GCC {plain.split()[-1]}" if plain else ""


def load(table):
    """Load averages, the first that of the last minute, before the run, or at its end where no other is known."""
    for name in ("load at start", "load average before"):
        if name in table.head:
            return table.head[name]
    said = re.search(r"load ([\d.]+)", table.head.get("machine", ""))
    return said.group(1) if said else ""


def processors(table):
    said = re.search(r"\((\d+) available\)|(\d+) (?:cores|processors)", machine(table))
    return int(said.group(1) or said.group(2)) if said else 1


def says_busy(table):
    """A run on a busy machine says so in the first line of its file."""
    return table.first_comment.startswith("busy machine")


def _was_busy(table):
    before = next((table.head[n] for n in ("load at start", "load average before") if n in table.head), "")
    return bool(before) and float(before.split()[0]) > BUSY_LOAD_PER_PROCESSOR * processors(table)


def faults(table, is_known_revision):
    """is_known_revision(name) -> True, False, or None where git cannot tell."""
    found = set()
    revisions = {row["revision"] for row in table.rows} if "revision" in table.columns else {table.head.get("revision", "")}
    if not machine(table):
        found.add("no machine")
    if not compiler(table):
        found.add("no compiler")
    if not load(table) and "load" not in table.columns:
        found.add("no load")
    for revision in revisions:
        if not revision:
            found.add("no revision")
        if revision.endswith("-dirty"):
            found.add("revision is dirty")
        if revision and is_known_revision(revision.removesuffix("-dirty")) is False:
            found.add("revision is not in the history")
    if _was_busy(table) and not says_busy(table):
        found.add("busy machine")
    return found


class History:
    """Asks git; every answer is None where there is no git, no repository or only a shallow one."""

    def __init__(self, root):
        self.root = root
        answer = self._git("rev-parse", "--is-shallow-repository")
        top = self._git("rev-parse", "--show-toplevel")
        # Sources unpacked within another repository have no history of their own.
        self.is_there = (answer is not None and answer.returncode == 0 and answer.stdout.strip() == "false"
                         and pathlib.Path(top.stdout.strip()).resolve() == pathlib.Path(root).resolve())

    def _git(self, *arguments):
        try:
            return subprocess.run(["git", "-C", str(self.root), *arguments], capture_output=True, text=True)
        except OSError:
            return None

    def has(self, revision):
        """True if it is HEAD or one of its ancestors."""
        if not self.is_there:
            return None
        if not re.fullmatch(r"[0-9a-f]{7,40}", revision):
            return False
        return self._git("merge-base", "--is-ancestor", revision, "HEAD").returncode == 0


def problems(results, history):
    """A line for each fault of a result file; empty if all is well."""
    return [f"{file}: {fault}; measure it anew with resources/scripts/measure at a clean committed revision"
            for file in result_files(results) for fault in sorted(faults(results.table(file), history.has))]
