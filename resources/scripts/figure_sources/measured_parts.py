"""What resources/scripts/measure runs: parts in order, each with its commands, the files that it makes and a limit of time."""

import pathlib
import re
import subprocess
from dataclasses import dataclass, field

# All parts together but those apart, waiting for a quiet machine not counted.
MAX_MINUTES = 120
SPRINGS = "spring,printed,grouped"
PAPER = ("paper-bunny-sphere,paper-spring-teapot,paper-gear-disc,paper-gear-gear,paper-crankshaft-gear,paper-crankshaft-sphere,"
         "scan-bunny-armadillo")
FELT = "cylinder-tube,box-hole,wheels,round-peg,rectangular-peg,gears,nut-bolt"
XVFB = ["xvfb-run", "-a", "-s", "-screen 0 1600x1000x24"]
# That of Debian has numpy and matplotlib, which pictures need.
PYTHON = "/usr/bin/python3"


@dataclass
class Setting:
    """Of one run: revision, folders, and whether a busy machine is put up with."""
    revision: str
    root: pathlib.Path
    bin: pathlib.Path
    shared: pathlib.Path
    folder: pathlib.Path
    allows_busy: bool = False
    helps: dict = field(default_factory=dict)

    @property
    def results(self):
        """Mirrors tests/, so that nothing among the sources changes until all is done."""
        return self.folder / "tests"

    def help_of(self, *command):
        """What a program says to --help; empty if it does not start."""
        if command not in self.helps:
            try:
                said = subprocess.run([str(self.bin / command[0]), *command[1:], "--help"], capture_output=True, text=True)
                self.helps[command] = said.stdout if said.returncode == 0 else ""
            except OSError:
                self.helps[command] = ""
        return self.helps[command]


@dataclass
class Step:
    """A command, its standard output in a file if there is one, or a function with words for it.

    `may_miss`: exit code 1 says that a goal was missed, after all results were written. These are results too.
    """
    command: list = None
    output: pathlib.Path = None
    may_miss: bool = False
    function: object = None
    what: str = ""


@dataclass
class Part:
    """`files` and `pictures` (patterns, beside them) are relative to tests/. Parts apart run only by their whole name. A part
    with an `interpreter`, relative to the build's folder, needs the Python package that the build makes there."""
    name: str
    minutes: float
    files: tuple
    make: object
    pictures: tuple = ()
    program: str = "nearfit-bench"
    command: str = ""
    is_apart: bool = False
    interpreter: str = ""

    def steps(self, setting):
        return self.make(setting)

    def is_offered(self, setting):
        """False for a command that the programs do not have, such as one of a later revision, or without its interpreter."""
        if self.interpreter and not (setting.bin.parent / self.interpreter).exists():
            return False
        offered = setting.help_of(self.program)
        return not self.command or bool(re.search(rf"^\s+{re.escape(self.command)}\b", offered, re.MULTILINE))

    def made(self, setting):
        """Files that are there, pictures too."""
        found = [setting.results / name for name in self.files]
        for pattern in self.pictures:
            found += sorted(setting.results.glob(pattern))
        return found


def _busy(setting):
    return ["--allow-busy"] if setting.allows_busy else []


def _bench_file(setting, name):
    return setting.results / "bench" / "results" / name


def _bench(setting, command, *options, csv):
    return Step([str(setting.bin / "nearfit-bench"), command, *_busy(setting), *options, "--csv", str(_bench_file(setting, csv))])


def _bench_part(name, minutes, command, *options, csv="", is_shown=False, uses_shared=False, may_miss=False):
    csv = csv or f"{name}.csv"

    def make(setting):
        shared = ["--shared", str(setting.shared)] if uses_shared else []
        step = _bench(setting, command, *shared, *options, csv=csv)
        step.may_miss = may_miss
        if is_shown:
            step.command = XVFB + step.command
        return [step]

    return Part(name.replace("_", "-"), minutes, (f"bench/results/{csv}",), make, command=command)


def _feel(setting):
    step = _bench(setting, "feel", "--groups", "smoothness,pairs,conforming,sliding", "--shared", str(setting.shared), "--clock", "thread",
                  "--seconds", "2", "--count", "3000", "--scenes", FELT, csv="feel.csv")

    def certified():
        lines = _bench_file(setting, "feel.csv").read_text().splitlines(True)
        kept = [line for line in lines if line.startswith(("#", "group")) or "poses that meet" in line]
        _bench_file(setting, "certified.csv").write_text("".join(kept))

    return [step, Step(function=certified, what="rows of poses that meet, to certified.csv")]


def _scene(setting):
    step = _bench(setting, "scene", "--repeat", "3", csv="scene.csv")
    step.command += ["--instances-csv", str(_bench_file(setting, "scene_instances.csv"))]
    return [step]


def _error(setting):
    page = [PYTHON, str(setting.root / "tests" / "bench" / "error_page.py"), str(_bench_file(setting, "error.csv")), "--out",
            str(_bench_file(setting, ""))]
    return [_bench(setting, "error", csv="error.csv"), Step(page)]


def _check(setting):
    return [_bench(setting, "check", "--repeat", "1", "--peer-seconds", "20", csv="check.csv")]


def _paper(setting):
    # Of each tick: drawn, and too long to keep.
    samples = str(setting.folder / "paper_force.csv")
    plots = [PYTHON, str(setting.root / "tests" / "bench" / "paper_plots.py"), str(_bench_file(setting, "paper.csv")), "--samples",
             samples, "--out", str(_bench_file(setting, ""))]
    # Springs at all pairs of triangles take 0.1 s a tick in row b.
    return [_bench(setting, "paper", "--shared", str(setting.shared), "--clock", "thread", "--ticks", "400", "--examined", "20",
                   "--samples", samples, csv="paper.csv"), Step(plots)]


def _hour(setting):
    csv, picture = (str(_bench_file(setting, f"window_hour.{kind}")) for kind in ("csv", "png"))
    program = [str(setting.bin / "nearfit-bench-window"), "hour", *_busy(setting), "--minutes", "60", "--csv", csv]
    return [Step(XVFB + program, may_miss=True), Step([PYTHON, str(setting.root / "tests" / "bench" / "hour_plot.py"), csv, picture])]


def _window(setting):
    program = [str(setting.bin / "nearfit-bench-window"), "figures", *_busy(setting), "--shared", str(setting.shared), "--csv",
               str(_bench_file(setting, "window.csv"))]
    return [Step(XVFB + program)]


def _stress_part(name, minutes, *options, file="", pictures=(), draw=None, may_miss=False):
    """Its command is the first word of its name."""
    file = f"stress/results/{file or name.replace('-', '_') + '.csv'}"
    command = name.partition("-")[0]

    def make(setting):
        steps = [Step([str(setting.bin / "nearfit-stress"), command, *options], output=setting.results / file, may_miss=may_miss)]
        return steps + (draw(setting) if draw else [])

    return Part(name, minutes, (file,), make, pictures, "nearfit-stress", command)


def _draw_limit(setting):
    folder = setting.results / "stress" / "results"
    return [Step([PYTHON, str(setting.root / "tests" / "stress" / "plot_limit.py"), str(folder / "limit.csv"), str(folder / "limit.png")])]


def _maker_contact(setting):
    csv = setting.results / "makers" / "results" / "contact.csv"
    return [Step([PYTHON, str(setting.root / "tests" / "makers" / "contact_figures.py"), "--program",
                  str(setting.bin / "maker_stress_tests"), "--csv", str(csv), *_busy(setting)], may_miss=True)]


def _evidence(setting):
    results = setting.results / "evidence" / "results"
    return [Step([PYTHON, str(setting.root / "tests" / "evidence" / "run"), "--models", str(setting.shared / "models" / "public"), "--bin",
                  str(setting.bin), "--out", str(setting.folder / "evidence"), "--results", str(results), *_busy(setting)], may_miss=True)]


def _round_trip(setting):
    csv = setting.results / "usb" / "results" / "round_trip.csv"
    return [Step([PYTHON, str(setting.root / "tests" / "usb" / "round_trip"), "--seconds", "12", "--runs", "2", "--models",
                  str(setting.shared / "models" / "public" / "peghole"), "--bin", str(setting.bin), "--out",
                  str(setting.folder / "round_trip"), "--csv", str(csv), *_busy(setting)], may_miss=True)]


def _package_part(name, minutes, script, *options, file):
    """A script on the Python package of this build, in the virtual environment that the build makes."""
    interpreter = "python/venv/bin/python"

    def make(setting):
        build = setting.bin.parent
        options_here = [option.format(bin=setting.bin, build=build, csv=setting.results / file) for option in options]
        return [Step(["env", f"PYTHONPATH={build / 'python' / 'package'}", str(build / interpreter),
                      str(setting.root / "tests" / "app" / "python" / script), *options_here, *_busy(setting)], may_miss=True)]

    return Part(name, minutes, (file,), make, interpreter=interpreter)


# What is timed comes first; the stress runs, whose results do not depend on time, take all processors.
PARTS = (
    _bench_part("query_paper", 1, "query", "--clock", "thread", "--scenes", PAPER, uses_shared=True),
    _bench_part("query_generated", 3, "query", "--clock", "thread"),
    _bench_part("query_flats", 2, "query", "--clock", "thread", "--scenes", "peg-hole"),
    Part("paper", 9, ("bench/results/paper.csv",), _paper, ("bench/results/paper_*.png",), command="paper"),
    Part("check", 3, ("bench/results/check.csv",), _check, command="check"),
    _bench_part("path", 2, "path", uses_shared=True),
    _bench_part("suggest", 4, "suggest", may_miss=True),
    _bench_part("verdicts", 2, "verdicts", uses_shared=True),
    _bench_part("build", 2, "build"),
    _bench_part("program", 1, "program", "--clock", "thread"),
    Part("feel", 7, ("bench/results/feel.csv", "bench/results/certified.csv"), _feel, command="feel"),
    _bench_part("dense", 2, "feel", "--groups", "dense,curved", "--count", "1500", "--clock", "thread"),
    _bench_part("feel_million", 2, "feel", "--groups", "pairs", "--pairs", "organic-1m", "--count", "1500", "--clock", "thread"),
    _bench_part("tessellation", 1, "feel", "--groups", "tessellation"),
    Part("error", 15, ("bench/results/error.csv", "bench/results/error.md"), _error, ("bench/results/error_*.png",), command="error"),
    _bench_part("skips", 2, "skips", is_shown=True),
    _bench_part("import", 4, "import", uses_shared=True),
    Part("scene", 1, ("bench/results/scene.csv", "bench/results/scene_instances.csv"), _scene, command="scene"),
    Part("window", 6, ("bench/results/window.csv",), _window, program="nearfit-bench-window", command="figures"),
    _package_part("python", 4, "bench.py", "--bench", "{bin}/nearfit-bench", "--csv", "{csv}", "--wheel", file="app/results/python.csv"),
    _package_part("sweep-cost", 3, "sweep_cost.py", "--build", "{build}", "--out", "{csv}", file="app/results/sweep_cost.csv"),
    Part("round-trip", 3, ("usb/results/round_trip.csv",), _round_trip, program="nearfit-emulate"),
    Part("evidence", 6, ("evidence/results/evidence.csv", "evidence/results/goals.json", "evidence/results/README.md"), _evidence,
         ("evidence/results/*.png",), program="nearfit-cli"),
    _stress_part("hand", 13, "--mode", "proxy", "--ticks", "10000000", "--certify", "10", "--threads", "2"),
    _stress_part("rest", 5, "--mode", "proxy", may_miss=True),
    _stress_part("limit", 1, "--mode", "proxy", may_miss=True, pictures=("stress/results/limit.png",), draw=_draw_limit),
    _stress_part("hours", 3, "--mode", "proxy", "--hours", "8", may_miss=True),
    _stress_part("hand-springs", 2, "--mode", SPRINGS, "--ticks", "200000", "--certify", "none", "--threads", "2", may_miss=True),
    # Its usual periods are those of 5,000, 2,000, 1,000, 500, 200 and 100 Hz.
    _stress_part("rest-springs", 3, "--mode", SPRINGS, "--seconds", "3", may_miss=True),
    _stress_part("limit-springs", 2, "--mode", SPRINGS, may_miss=True),
    _stress_part("hours-springs", 2, "--mode", SPRINGS, "--hours", "1", may_miss=True),
    _stress_part("oracle", 4, "--poses", "500000", "--threads", "2", file="oracle.txt"),
    Part("maker-contact", 10, ("makers/results/contact.csv",), _maker_contact, program="maker_stress_tests", is_apart=True),
    Part("window-hour", 63, ("bench/results/window_hour.csv",), _hour, ("bench/results/window_hour.png",),
         program="nearfit-bench-window", command="hour", is_apart=True),
)


def chosen(names):
    """Parts whose names begin with one of `names`, which have commas between; all but those apart where there is none. ValueError for
    a name that no part begins with."""
    starts = [name.strip() for name in names.split(",") if name.strip()]
    for start in starts:
        if not any(_is_meant(part, start) for part in PARTS):
            raise ValueError(f'no part begins with "{start}"; choose from {", ".join(part.name for part in PARTS)}')
    return [part for part in PARTS if (any(_is_meant(part, start) for start in starts) if starts else not part.is_apart)]


def _is_meant(part, start):
    return part.name == start if part.is_apart else part.name.startswith(start)
