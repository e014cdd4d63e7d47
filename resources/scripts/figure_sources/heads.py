"""Heads of result files that Python writes, alike those of nearfit-bench (tests/bench/machine.cpp, run_rules.h)."""

import csv
import datetime
import os
import pathlib
import platform
import re
import shlex
import subprocess
import sys
import time

# Equal to kBusyProcessors and kWatch of tests/bench/run_rules.cpp: a build or a test keeps a whole processor at work, a quiet
# machine far less; half a second resolves a fiftieth of a processor.
BUSY_PROCESSORS = 0.25
WATCH_SECONDS = 0.5


class NotRepeatable(Exception):
    """Why results are refused."""


def _spent():
    """(busy, all) clock ticks of all processors so far; what a hypervisor took for others counts as busy."""
    fields = [float(word) for word in pathlib.Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]]
    return sum(fields) - fields[3] - fields[4], sum(fields)


def others_at_work(seconds=WATCH_SECONDS):
    """Processors that other programs keep at work, while this one sleeps."""
    before = _spent()
    time.sleep(seconds)
    after = _spent()
    return os.cpu_count() * (after[0] - before[0]) / max(1.0, after[1] - before[1])


def is_busy(at_work):
    return at_work >= BUSY_PROCESSORS


def _git(root, *arguments):
    try:
        said = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True)
    except OSError:
        return None
    return said.stdout.strip() if said.returncode == 0 else None


def changes(root):
    """Files that git knows and that differ from the commit, a line each, as core/git_revision.cmake counts them: results
    and pages are not what is measured. None without git."""
    return _git(root, "status", "--porcelain", "--untracked-files=no", "--", ".", ":(exclude)tests/*/results/*",
                ":(exclude)*.md")


def revision(root):
    """Revision of the tree, "-dirty" behind it where it differs; "unknown" without git."""
    name, differs = _git(root, "rev-parse", "--short=12", "HEAD"), changes(root)
    if not name or differs is None:
        return "unknown"
    return f"{name}-dirty" if differs else name


def is_for_commit(file, root):
    """True where the file would lie among the sources, not under build/."""
    try:
        within = pathlib.Path(file).resolve().relative_to(pathlib.Path(root).resolve())
    except ValueError:
        return False
    return within.parts[:1] != ("build",)


def check_repeatable(file, root, at_work, allows_busy):
    """Raises NotRepeatable for results among the sources that no other could repeat; `file` may be None."""
    if file is None or not is_for_commit(file, root):
        return
    name = revision(root)
    if name == "unknown" or name.endswith("-dirty"):
        raise NotRepeatable(f"{file}: results of revision {name} cannot be repeated; commit, build anew and run again, or "
                            "write to a folder outside the sources")
    if is_busy(at_work) and not allows_busy:
        raise NotRepeatable(f"{file}: other programs keep {at_work:.1f} processors at work; wait until they are done, or "
                            "allow it with --allow-busy")


def _compiler(build):
    """The compiler that CMake names in a build folder."""
    for file in sorted(pathlib.Path(build).glob("CMakeFiles/*/CMakeCXXCompiler.cmake")):
        text = file.read_text()
        names = [re.search(rf'set\(CMAKE_CXX_COMPILER_{what} "([^"]+)"\)', text) for what in ("ID", "VERSION")]
        if all(names):
            return f"{names[0].group(1).replace('GNU', 'GCC')} {names[1].group(1)}"
    return "unknown"


def head_or_exit(script, file, root, build, allows_busy):
    """head() of a run that is about to begin; ends the program, with its name, if check_repeatable() refuses `file`."""
    at_work = others_at_work()
    try:
        check_repeatable(file, root, at_work, allows_busy)
    except NotRepeatable as refusal:
        sys.exit(f"{script}: {refusal}")
    return head(root, build, at_work)


def write_csv(file, head, columns, rows):
    """Writes a result file: `head` as comments, then `rows`, a dict each; makes its folder."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("w", newline="", encoding="utf-8") as out:
        out.writelines(f"# {line}\n" for line in head)
        writer = csv.DictWriter(out, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def head(root, build, at_work):
    """Lines of a head, without "# "."""
    cpu = pathlib.Path("/proc/cpuinfo").read_text()
    model = re.search(r"model name\s*: (.*)", cpu)
    flags = (re.search(r"flags\s*: (.*)", cpu) or [None, ""])[1].split()
    vector = [f for f in flags if f.startswith(("sse", "avx", "bmi")) or f in ("fma", "ssse3", "f16c")]
    lines = []
    if is_busy(at_work):
        lines.append(f"busy machine: other programs kept {at_work:.1f} of {os.cpu_count()} processors at work before the run")
    return lines + [
        f"processor: {model.group(1) if model else platform.machine()} ({os.cpu_count()} available)",
        f"vector instructions: {' '.join(vector)}", f"kernel: {platform.system()} {platform.release()} {platform.machine()}",
        f"compiler: {_compiler(build)}", f"revision: {revision(root)}", f"command: {shlex.join(sys.argv)}",
        f"date: {datetime.datetime.now(datetime.timezone.utc):%Y-%m-%dT%H:%M:%SZ}",
        "load at start: " + " ".join(f"{load:.2f}" for load in os.getloadavg())]
