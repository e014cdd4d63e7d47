#!/usr/bin/env python3
"""Tests of resources/scripts/measure and of what Python writes as heads of results; needs Python 3 and git."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = pathlib.Path("resources") / "scripts"
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / SCRIPTS / "figure_sources"))
import heads  # noqa: E402
import measured_parts  # noqa: E402

NOBODY = {f"GIT_{who}_{what}": "nobody@example.org" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
# A program that writes what nearfit-bench would: arguments, and the revision that it is told of.
BENCH = """#!/bin/sh
[ "$1" = --help ] && { echo "  program    Solves"; echo "  query    Asks"; exit 0; }
echo run >> "$(dirname "$0")/runs"
while [ "$1" != --csv ]; do shift; done
printf '# revision: %s\\nkind\\nring\\n' "$(cat "$(dirname "$0")/revision")" > "$2"
exit "$(cat "$(dirname "$0")/code")"
"""


class Tree(unittest.TestCase):
    """A repository with the scripts, programs that do nothing, and no figures."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name) / "tree"
        self.bin = self.root / "build" / "release" / "bin"
        self.bin.mkdir(parents=True)
        (self.root.parent / "shared").mkdir()
        shutil.copytree(ROOT / SCRIPTS, self.root / SCRIPTS)
        (self.root / SCRIPTS / "figures").write_text("print('figures are made')\n")
        (self.root / ".gitignore").write_text("build/\n")
        (self.root / "source.cpp").write_text("int x;\n")
        self.results = self.root / "tests" / "bench" / "results"
        self.results.mkdir(parents=True)
        (self.results / "program.csv").write_text("old\n")
        self.git("init", "-q")
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "All")
        self.revision = self.git("rev-parse", "--short=12", "HEAD").strip()
        self.write("nearfit-bench", BENCH, 0o755)
        self.write("revision", self.revision)
        self.write("code", "0")

    def git(self, *arguments):
        return subprocess.run(["git", "-C", str(self.root), *arguments], env={**os.environ, **NOBODY}, check=True,
                              capture_output=True, text=True).stdout

    def write(self, name, text, mode=0o644):
        (self.bin / name).write_text(text)
        (self.bin / name).chmod(mode)

    def measure(self, *arguments):
        command = [sys.executable, str(self.root / SCRIPTS / "measure"), "--no-build", "--allow-busy", *arguments]
        return subprocess.run(command, capture_output=True, text=True)

    def runs(self):
        file = self.bin / "runs"
        return len(file.read_text().splitlines()) if file.exists() else 0


class Measure(Tree):
    def test_copies_results_among_the_sources_and_makes_the_figures(self):
        out = self.measure("--parts", "program")
        self.assertEqual(out.returncode, 0, out.stderr)
        self.assertIn(f"# revision: {self.revision}", (self.results / "program.csv").read_text())
        self.assertIn("figures are made", out.stdout)

    def test_goes_on_where_it_was_and_measures_again_only_when_told(self):
        self.measure("--parts", "program")
        self.assertIn("measured before", self.measure("--parts", "program").stdout)
        self.assertEqual(self.runs(), 1)
        self.measure("--parts", "program", "--again")
        self.assertEqual(self.runs(), 2)

    def test_refuses_changed_sources_but_not_results_that_it_wrote_itself(self):
        self.measure("--parts", "program")
        self.assertEqual(self.measure("--parts", "query-flats").returncode, 0)
        (self.root / "source.cpp").write_text("int y;\n")
        out = self.measure("--parts", "program")
        self.assertNotEqual(out.returncode, 0)
        self.assertRegex(out.stderr, r"cannot be repeated; commit first\n.*source\.cpp")

    def test_leaves_results_as_they_were_where_a_part_fails(self):
        self.write("code", "1")
        out = self.measure("--parts", "program")
        self.assertEqual(out.returncode, 1)
        self.assertIn("exit code 1", out.stdout)
        self.assertEqual((self.results / "program.csv").read_text(), "old\n")

    def test_refuses_results_of_programs_that_were_built_from_another_revision(self):
        self.write("revision", "fedcba987654")
        self.assertIn("build the programs anew", self.measure("--parts", "program").stdout)
        self.assertEqual((self.results / "program.csv").read_text(), "old\n")

    def test_leaves_out_commands_that_the_programs_do_not_have(self):
        out = self.measure("--parts", "paper")
        self.assertEqual((out.returncode, self.runs()), (0, 0))
        self.assertIn("left out", out.stdout)

    def test_stops_a_part_that_takes_longer_than_its_minutes_times_the_factor(self):
        self.write("nearfit-bench", BENCH.replace("echo run", "sleep 1; echo run"), 0o755)
        out = self.measure("--parts", "program", "--time-factor", "0.001")
        self.assertEqual(out.returncode, 1)
        self.assertRegex(out.stdout, r"was stopped: the part has 0\.00\d+ minutes \(--time-factor\)")
        self.assertEqual((self.results / "program.csv").read_text(), "old\n")
        self.assertEqual(self.measure("--parts", "program").returncode, 0)

    def test_refuses_a_time_factor_that_would_stop_every_part(self):
        for factor in ("0", "-1", "nan", "inf", "half"):
            out = self.measure("--parts", "program", "--time-factor", factor)
            self.assertEqual((out.returncode, self.runs()), (2, 0), factor)
            self.assertIn("--time-factor", out.stderr)

    def test_names_the_parts_where_one_is_misspelt(self):
        self.assertRegex(self.measure("--parts", "qery").stderr, "no part begins with.*query-paper")


class Parts(unittest.TestCase):
    def setting(self):
        return measured_parts.Setting("0123456789ab", ROOT, pathlib.Path("bin"), pathlib.Path("shared"), pathlib.Path("/measured"))

    def test_take_at_most_two_hours_together(self):
        self.assertLessEqual(sum(part.minutes for part in measured_parts.chosen("")), measured_parts.MAX_MINUTES)

    def test_apart_run_by_their_whole_name_alone(self):
        apart = [part.name for part in measured_parts.PARTS if part.is_apart]
        self.assertEqual(apart, ["maker-contact", "window-hour"])
        self.assertNotIn("window-hour", [part.name for part in measured_parts.chosen("")])
        self.assertEqual([part.name for part in measured_parts.chosen("window")], ["window"])
        self.assertEqual([part.name for part in measured_parts.chosen("window-hour")], ["window-hour"])

    def test_stress_every_mode_with_every_command_that_has_modes(self):
        modes = {}
        for part in measured_parts.PARTS:
            for step in part.steps(self.setting()):
                words = step.command or []
                if words and words[0] == "bin/nearfit-stress" and "--mode" in words:
                    modes.setdefault(words[1], set()).update(words[words.index("--mode") + 1].split(","))
        every = {"proxy", "spring", "printed", "grouped"}
        self.assertEqual(modes, {"hand": every, "rest": every, "limit": every, "hours": every})

    def test_have_names_of_their_own_and_write_no_file_twice(self):
        names = [part.name for part in measured_parts.PARTS]
        files = [file for part in measured_parts.PARTS for file in part.files]
        self.assertEqual(len(set(names)), len(names))
        self.assertEqual(len(set(files)), len(files))

    def test_make_every_result_that_is_committed_but_those_of_other_systems_and_programs(self):
        # What other programs read back needs these programs, from registries.
        apart = {"app/results/read_back.csv", "app/results/report_page.csv"}
        committed = {str(file.relative_to(ROOT / "tests")) for kind in ("csv", "txt")
                     for file in (ROOT / "tests").glob(f"*/results/*.{kind}") if file.parts[-3] != "systems"}
        made = {file for part in measured_parts.PARTS for file in part.files}
        self.assertEqual(committed - made, apart & committed)

    def test_write_nothing_among_the_sources_while_they_run(self):
        setting = self.setting()
        for part in measured_parts.PARTS:
            for step in part.steps(setting):
                for word in step.command or []:
                    self.assertTrue("/results" not in word or word.startswith("/measured/"), f"{part.name}: {word}")


class Heads(Tree):
    def test_name_the_revision_and_whether_sources_differ_from_it(self):
        self.assertEqual(heads.revision(self.root), self.revision)
        (self.results / "program.csv").write_text("new\n")
        self.assertEqual(heads.revision(self.root), self.revision, "results are not what is measured")
        (self.root / "source.cpp").write_text("int y;\n")
        self.assertEqual(heads.revision(self.root), f"{self.revision}-dirty")
        self.assertEqual(heads.revision(self.root / ".."), "unknown")

    def test_refuse_for_commit_what_cannot_be_repeated(self):
        file = self.results / "program.csv"
        heads.check_repeatable(file, self.root, 0.0, False)
        heads.check_repeatable(file, self.root, 2.0, True)
        with self.assertRaisesRegex(heads.NotRepeatable, "2.0 processors at work"):
            heads.check_repeatable(file, self.root, 2.0, False)
        (self.root / "source.cpp").write_text("int y;\n")
        with self.assertRaisesRegex(heads.NotRepeatable, "dirty"):
            heads.check_repeatable(file, self.root, 0.0, True)
        heads.check_repeatable(self.root / "build" / "x.csv", self.root, 2.0, False)
        heads.check_repeatable(None, self.root, 2.0, False)

    def test_say_that_the_machine_was_busy_in_their_first_line(self):
        self.assertTrue(heads.head(self.root, self.root, 1.5)[0].startswith("busy machine: other programs kept 1.5 of"))
        quiet = heads.head(self.root, self.root, 0.0)
        self.assertTrue(quiet[0].startswith("processor: "))
        names = {line.partition(":")[0] for line in quiet}
        self.assertLessEqual({"processor", "compiler", "revision", "load at start", "command", "date"}, names)


if __name__ == "__main__":
    unittest.main()
