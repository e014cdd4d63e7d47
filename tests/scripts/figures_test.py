#!/usr/bin/env python3
"""Tests of resources/scripts/figures on small made-up result files and pages; needs Python 3 alone."""

import contextlib
import io
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "resources" / "scripts" / "figure_sources"))
import catalogue  # noqa: E402
import common  # noqa: E402
import fronts  # noqa: E402
import markers  # noqa: E402
import numbers_text  # noqa: E402
import provenance  # noqa: E402
import scenes  # noqa: E402
from results import FigureError, Results, Table  # noqa: E402

HEAD = """# processor: AMD EPYC (2 available)
# compiler: GCC-compatible 12.2.0
# revision: 0123456789ab
# load at start: 0.10 0.20 0.30
"""
TIMES = HEAD + "pair,method,p50_us\nball-bowl,cold,12.34\nball-bowl,tracked,1.5\n"
OF_TIMES = "<!-- figures: csv tests/bench/results/times.csv: method, p50_us | pair=ball-bowl -->"
MADE = "| method | p50_us |\n| --- | ---: |\n| cold | 12 |\n| tracked | 1.5 |"


def page(inside, mark=OF_TIMES):
    return f"# Page\n\n{mark}\n{inside}\n<!-- end -->\n\nText.\n"


class Folder(unittest.TestCase):
    """A tree with one result file and one page; not in a repository."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.csv = self.root / "tests" / "bench" / "results" / "times.csv"
        self.csv.parent.mkdir(parents=True)
        self.csv.write_text(TIMES)
        self.page = self.root / "PAGE.md"
        self.page.write_text(page(MADE))

    def run_script(self, *arguments):
        command = [sys.executable, str(ROOT / "resources" / "scripts" / "figures"), "--root", str(self.root), *arguments]
        return subprocess.run(command, capture_output=True, text=True)

    def errors(self, *arguments):
        """Lines of stderr about the page, without those about files that only the real tree has."""
        return [line for line in self.run_script(*arguments).stderr.splitlines() if "PAGE.md" in line]


class Check(Folder):
    def test_finds_nothing_where_the_page_is_as_the_file_says(self):
        self.assertEqual(self.errors("--check"), [])

    def test_finds_a_stale_number_and_says_where(self):
        self.page.write_text(page(MADE.replace("12", "13")))
        self.assertEqual(len(self.errors("--check")), 1)
        self.assertIn("PAGE.md:3:", self.errors("--check")[0])
        self.assertEqual(self.run_script("--check").returncode, 1)
        self.assertIn("13", self.page.read_text(), "a check changes nothing")

    def test_a_run_mends_a_stale_number_and_leaves_the_rest_alone(self):
        self.page.write_text(page("old"))
        self.run_script()
        self.assertEqual(self.page.read_text(), page(MADE))

    def test_a_result_file_that_is_not_there_is_an_error_with_the_line_of_the_page(self):
        self.csv.unlink()
        self.assertRegex(self.errors("--check")[0], r"PAGE\.md:3: .*times\.csv: it cannot be read")

    def test_a_column_that_is_not_there_is_an_error_that_names_those_that_are(self):
        self.csv.write_text(TIMES.replace("p50_us", "p51_us"))
        self.assertRegex(self.errors("--check")[0], r'no column "p50_us"; it has pair, method, p51_us')

    def test_a_row_that_is_not_there_is_an_error(self):
        self.csv.write_text(TIMES.replace("ball-bowl", "box-floor"))
        self.assertRegex(self.errors("--check")[0], r'no row with pair "ball-bowl"')

    def test_an_error_leaves_the_page_as_it_was(self):
        self.page.write_text(page("old", "<!-- figures: nothing has this name -->"))
        self.assertRegex(self.errors()[0], "there is no such figure")
        self.assertIn("old", self.page.read_text())


class Markers(unittest.TestCase):
    def rewrite(self, text, made="new"):
        return markers.rewrite("P.md", text, lambda name: made)

    def test_within_a_sentence_nothing_but_the_figure_changes(self):
        text, names, stale = self.rewrite("It takes <!-- figures: t -->5 us<!-- end -->, at most.\n", "7 us")
        self.assertEqual(text, "It takes <!-- figures: t -->7 us<!-- end -->, at most.\n")
        self.assertEqual((names, stale), (["t"], [(1, "t")]))

    def test_a_place_without_end_is_an_error_that_says_where(self):
        for text in ("a\n<!-- figures: t -->\nold\n", "a\n<!-- figures: t -->\n<!-- figures: u -->\n<!-- end -->\n"):
            with self.assertRaisesRegex(FigureError, r"P\.md:2: .*has no"):
                self.rewrite(text)

    def test_an_end_without_beginning_is_an_error(self):
        with self.assertRaisesRegex(FigureError, r"P\.md:3: .*closes nothing"):
            self.rewrite("<!-- figures: t -->\n<!-- end -->\n<!-- end -->\n")

    def test_a_marker_that_is_misspelt_is_an_error(self):
        for wrong in ("<!-- figure: t -->", "<!--figures: t-->", "<!-- End -->"):
            with self.assertRaisesRegex(FigureError, r"P\.md:2: .*is no marker"):
                self.rewrite(f"a\n{wrong}\n")

    def test_a_figure_within_a_line_does_not_begin_it_for_markdown_takes_that_for_html(self):
        with self.assertRaisesRegex(FigureError, "begins with a comment"):
            self.rewrite("  <!-- figures: t -->5<!-- end --> us\n")


class Tables(unittest.TestCase):
    def test_two_rows_that_fit_are_an_error_where_one_is_asked_for(self):
        with self.assertRaisesRegex(FigureError, "2 rows fit"):
            Table("t.csv", TIMES).number("p50_us", pair="ball-bowl")

    def test_a_text_where_a_number_belongs_is_an_error(self):
        with self.assertRaisesRegex(FigureError, '"cold" in column "method" is not a number'):
            Table("t.csv", TIMES).number("method", p50_us="12.34")

    def test_the_worst_of_rows_is_taken_column_by_column(self):
        table = Table("t.csv", "scene,p50,max\na,1,9\nb,3,4\n")
        self.assertEqual(common.worst(table, ("p50", "max"), [{"scene": "a"}, {"scene": "b"}]), [3, 9])

    def test_machines_of_one_name_are_told_apart_by_their_instructions(self):
        heads = ["# vector instructions: avx512f avx512_vp2intersect\na\n1\n", "# vector instructions: avx512f\na\n1\n",
                 "# vector instructions: avx2\na\n1\n", "a\n1\n",
                 "# processor: Intel(R) Xeon(R) Processor (2 available)\n# vector instructions: avx512f\na\n1\n"]
        self.assertEqual([common.machine_letter(Table("t.csv", head)) for head in heads], ["A", "B", "D", "C", "E"])

    def test_a_picture_that_does_not_say_what_it_drew_is_an_error(self):
        rows = "figure,remark\nlarge,82500 of 9680000 triangles a picture\nframe,8509 triangles a picture\nother,none\n"
        table = Table("w.csv", rows)
        self.assertEqual(common.drawn(table, figure="large"), (82500, 9680000))
        self.assertEqual(common.drawn(table, figure="frame"), (8509, None))
        with self.assertRaisesRegex(FigureError, "does not say how many triangles"):
            common.drawn(table, figure="other")


class Numbers(unittest.TestCase):
    def test_are_written_with_two_digits_below_a_hundred(self):
        written = {0: "0", 0.00123: "0.0012", 0.123: "0.12", 0.5: "0.5", 1.25: "1.2", 9.97: "10", 42.4: "42", 1234.5: "1,234"}
        self.assertEqual({value: numbers_text.plain(value) for value in written}, written)

    def test_times_carry_the_unit_that_reads_best(self):
        written = {5.25: "5.2 us", 999.4: "999 us", 1500: "1.5 ms", 2.9e6: "2.9 s"}
        self.assertEqual({value: numbers_text.time(value) for value in written}, written)

    def test_a_miss_that_reads_like_its_goal_has_a_digit_more(self):
        self.assertEqual([numbers_text.beside_goal(value, 50, "ms") for value in (49, 50, 50.2, 51)], ["", "", "50.2 ms; goal ", ""])

    def test_a_verdict_names_each_goal_that_is_missed(self):
        self.assertEqual(numbers_text.verdict([("p50", 90, 100), ("p99", 400, 400)]), "met")
        self.assertEqual(numbers_text.verdict([("p50", 101, 100), ("p99", 1, 400)]), "**missed** at p50, goal 100 us")


class History:
    """Git that knows some revisions."""

    def __init__(self, *known, is_there=True):
        self.known, self.is_there = known, is_there

    def has(self, revision):
        return revision in self.known if self.is_there else None


class Provenance(Folder):
    def problems(self, history=History("0123456789ab")):
        return provenance.problems(Results(self.root), history)

    def test_a_clean_file_has_none(self):
        self.assertEqual(self.problems(), [])

    def test_a_revision_that_is_not_in_the_history_is_one_unless_git_is_missing(self):
        self.assertRegex(self.problems(History())[0], r"times\.csv: revision is not in the history")
        self.assertEqual(self.problems(History(is_there=False)), [])

    def test_a_dirty_revision_is_one_without_git_too(self):
        self.csv.write_text(TIMES.replace("0123456789ab", "0123456789ab-dirty"))
        self.assertRegex(self.problems(History(is_there=False))[0], "revision is dirty")

    def test_each_line_that_is_missing_of_the_head_is_one(self):
        for name, fault in (("processor", "no machine"), ("compiler", "no compiler"), ("revision", "no revision"),
                            ("load at start", "no load")):
            self.csv.write_text("".join(line for line in TIMES.splitlines(True) if not line.startswith(f"# {name}:")))
            self.assertTrue(any(fault in line for line in self.problems()), fault)

    def test_a_busy_machine_is_one_unless_the_first_line_says_so(self):
        busy = TIMES.replace("0.10 0.20", "8.50 0.20")
        self.csv.write_text(busy)
        self.assertRegex(self.problems()[0], "busy machine")
        self.csv.write_text("# busy machine: other programs kept 1.5 of 2 processors at work\n" + busy)
        self.assertEqual(self.problems(), [])
        table = Results(self.root).table("tests/bench/results/times.csv")
        self.assertEqual(provenance.note(table), "busy machine")
        self.assertIn("bench/times.csv (**busy machine**)", catalogue.make(Results(self.root), "sources"))
        self.assertIn("`times.csv` (busy machine)", catalogue.make(Results(self.root), "stale files"))

    def test_revisions_that_stand_in_the_rows_are_looked_up_too(self):
        rows = HEAD.replace("# revision: 0123456789ab\n", "") + "scene,load,revision\na,0.1,0123456789ab\nb,0.1,fedcba987654\n"
        self.csv.write_text(rows)
        self.assertEqual(len(self.problems()), 1)
        self.assertRegex(self.problems()[0], "not in the history")

    def test_the_list_of_what_cannot_be_repeated_names_each_file(self):
        out = self.run_script("--provenance")
        self.assertEqual(out.returncode, 0)
        self.assertIn("tests/bench/results/times.csv: 0123456789ab", out.stdout)


class Fronts(unittest.TestCase):
    def on(self, *points):
        return [p[2] for p in fronts.front(list(points))]

    def test_hold_who_is_not_beaten_in_time_and_error(self):
        self.assertEqual(self.on((1, 0.5, "quick"), (2, 0.1, "near"), (3, 0.3, "beaten")), ["quick", "near"])

    def test_take_differences_below_two_percent_for_none(self):
        self.assertEqual(self.on((1.0, 0.1, "a"), (1.01, 0.1, "b"), (1.03, 0.1, "slower")), ["a", "b"])
        self.assertEqual(self.on((1.0, 0.102, "farther off"), (1.01, 0.09, "near")), ["near"])

    def test_take_errors_of_rounding_for_none(self):
        self.assertEqual(self.on((1, 3e-14, "quick"), (2, 1e-16, "exact"), (3, 0.0, "zero")), ["quick"])

    def test_leave_out_who_found_nothing_and_who_drops_minima_by_choice(self):
        self.assertEqual(self.on((1, float("nan"), "nothing"), (2, 0.0, "exact grouped"), (2, 0.0, "grouped"), (3, 0.1, "a")), ["a"])


class RealTree(unittest.TestCase):
    def test_every_figure_can_be_made_and_none_is_empty(self):
        results = Results(ROOT)
        for name in catalogue.FIGURES:
            with self.subTest(name), contextlib.redirect_stdout(io.StringIO()):
                self.assertTrue(catalogue.make(results, name).strip())


PAPER_HEADER = "part,scene,setting,method,quantity,samples,mean,p50,p90,p99,p99_9,max\n"


class FirstArrival(Folder):
    """Figures of results that are not committed yet."""

    def write(self, file, text):
        path = self.root / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(HEAD + text)

    def make(self, name):
        return catalogue.make(Results(self.root), name)

    def paper(self):
        def row(part, method, quantity, value, worst=None, scene="a disc-gear", setting="", samples=1):
            worst = value if worst is None else worst
            return f"{part},{scene},{setting},{method},{quantity},{samples},{value},{value},{value},{worst},{worst},{worst}\n"

        text = PAPER_HEADER
        for method, count in (("printed", 3), ("paper-spans", 3), ("paper-cones", 9), ("nearfit-cold", 2)):
            text += row("appendix", method, "minima at the pose", count)
        text += row("appendix", "printed", "loop [Hz]", 176.9)
        for method in ("nearfit-cold", "nearfit-tracked", "paper-spans", "paper-cones", "fcl"):
            text += row("appendix", method, "query [us]", 7, 70)
        text += row("appendix", "paper-spans", "build [s]", 0.3) + row("appendix", "nearfit", "build [s]", 0.1)
        for method, time, slowest in (("paper spans", 4000, 8000), ("exact tracked", 5, 50), ("proxy's tick", 20, 100)):
            text += row("appendix", method, "loop [Hz]", 1e6 / time) + row("appendix", method, "loop [us]", time, slowest)
        for method, whole, error in (("paper spans", 4000, 0.5), ("exact tracked", 30, 0), ("FCL global distance", 20, 0.9),
                                     ("exact grouped", 10, 0.3)):
            text += row("appendix", method, "loop and search beside it [us]", whole)
            text += row("judge", method, "force error [relative]", error) + row("judge", method, "minima missed", 0, samples=25)
        for method, jumps, size in (("global minimum", 2, 1.1), ("exact", 1, 0.4), ("all pairs", 0, "nan"), ("grouped", 1, 0.2)):
            text += row("arguments", method, "force [N]", 0.7) + row("arguments", method, "springs", 1)
            text += row("arguments", method, "ticks with a jump", jumps) + row("arguments", method, "ticks examined for one", 20)
            text += row("arguments", method, "jump of force [N]", size, samples=jumps) + row("arguments", method, "tick [us]", 2000)
        text += row("arguments", "proxy", "force [N]", 1.5) + row("arguments", "proxy", "change of force a tick [N]", 0.3)
        text += row("arguments", "exact", "springs born at the cutoff", 12)
        text += row("arguments", "box of the scene", "centre of mass off [of the diagonal]", 0.02)
        text += row("arguments", "box of the scene", "torque error [relative]", 0.1)
        # A pair of scans that is judged alone.
        text += row("judge", "exact tracked", "force error [relative]", 0, scene="scans")
        text += row("judge", "exact tracked", "minima missed", 0, scene="scans", samples=25)
        text += row("judge", "exact tracked", "loop and search beside it [us]", 40, scene="scans")
        for part, setting in (("cutoff", "0.05"), ("triangles", "512")):
            text += row(part, "paper-spans", "query [us]", 3e5, 5e6, setting=setting)
            text += row(part, "nearfit-cold", "query [us]", 3, 9, setting=setting) + row(part, "nearfit-cold", "minima", 2, 4, setting=setting)
        self.write("tests/bench/results/paper.csv", text)

    def test_say_that_there_are_none_until_there_are(self):
        for name in ("appendix a", "judged", "front on the paper's meshes", "checks", "paths", "suggestions", "verdicts", "window hour",
                     "stress in the springs' modes", "low rates"):
            self.assertRegex(self.make(name), r"^\*No results are committed yet: .*\.csv")
        picture = "picture tests/bench/results/x.png as x.png: a plot"
        self.assertIn("`x.png` is not committed yet", self.make(picture))
        (self.root / "tests/bench/results/x.png").write_bytes(b"")
        self.assertEqual(self.make(picture), "![a plot](x.png)")

    def test_make_the_tables_of_the_paper_once_its_file_is_there(self):
        self.paper()
        self.assertIn("| a disc-gear | 3 | 2 | 176 | 250 (125) | 200,000 (20,000) | 50,000 (10,000) |", self.make("appendix a in short"))
        self.assertIn("| a disc-gear | 3 | 3 | 9 | 2 | 176 |", self.make("appendix a"))
        self.assertIn("on a it is 2 where the paper prints 3", self.make("appendix a, verdict"))
        self.assertIn("| a disc-gear | 7.0 (70) | 7.0 (70) | 7.0 (70) | 7.0 (70) | 7.0 (70) |", self.make("appendix a, times"))
        for name in ("appendix a", "appendix a, times", "appendix a in short"):
            self.assertNotIn("scans", self.make(name))
            for line in self.make(name).splitlines()[2:]:
                self.assertNotIn("-", [cell.strip() for cell in line.split("|")], f"{name}: {line}")
        front = {tuple(line.split(" | ")[:2]): line for line in self.make("front on the paper's meshes").splitlines()[2:]}
        self.assertEqual({name: "**front**" in line for (_, name), line in front.items() if "scans" not in line},
                         {"FCL global distance": True, "exact tracked": True, "paper spans": False, "grouped": False})
        self.assertIn("*exact tracked* on a and scans", self.make("fronts, verdict"))
        for name in ("judged", "arguments", "onset", "law as printed", "centre of the box"):
            self.assertIn("a disc-gear", self.make(name))
        self.assertEqual(self.make("judged poses"), "25")
        self.assertIn("| 2 of 20 | 1.1 |", self.make("arguments"))
        self.assertIn("The argument holds on a. The spring at the global minimum jumps on a, by up to 1.1 N.", self.make("one spring"))
        self.assertIn("less than the one spring on a. One spring for each area (`grouped`) jumps on a, by up to 0.2 N.", self.make("one spring"))
        self.assertIn("The argument holds on a, where a tick takes more than 1 ms.", self.make("all pairs"))
        self.assertIn("| 5 % | 300,000 (5,000,000) | 3.0 (9.0) | 2 | 4 |", self.make("cutoff sweep"))
        self.assertIn("| 512 | 300,000 (5,000,000) | 3.0 (9.0) | 2 | 4 |", self.make("triangle sweep"))
        self.assertEqual(self.make("longest answer of the paper's"), "300 ms at the median and 5.0 s at most")

    def test_name_what_the_springs_miss(self):
        self.springs(shaken=0, failure="")
        self.assertNotIn("**", self.make("stress in the springs' modes"))
        self.springs(shaken=1, failure="gained energy")
        made = self.make("stress in the springs' modes")
        self.assertIn("**1 shaken**", made)
        self.assertIn("**missed** by rings", made)
        self.assertIn("|  | 100 | 1, 1 of 1 | 5.0 | 5.0 |", self.make("low rates"))

    def test_judge_the_claim_on_low_rates_by_those_shaken_at_1_khz(self):
        self.springs(shaken=1, failure="")
        self.assertIn("The paper's claim does not hold: more are shaken than at 1 kHz by springs at 100 Hz", self.make("soft springs and rates"))
        self.springs(shaken=0, failure="")
        self.assertIn("The paper's claim holds", self.make("soft springs and rates"))

    def springs(self, shaken, failure):
        modes = ("spring", "printed", "grouped")
        self.write("tests/stress/results/hand_springs.csv",
                   "mode,scene,ticks,energy gain J,largest force step N,springs held,failure\n"
                   + "".join(f"{mode},rings,1000,0.02,3,10,{failure}\n" for mode in modes))
        self.write("tests/stress/results/rest_springs.csv",
                   "mode,scene,stiffness wished N/m,rate Hz,rough,handle rms um,force rms mN,largest force step N,energy gain J,at rest,shaken\n"
                   + "".join(f"{mode},flat,200,{rate},0,5,2,0.1,0.01,1,{shaken if rate == 100 else 0}\n" for mode in modes for rate in (1000, 100)))
        self.write("tests/stress/results/limit_springs.csv", "mode,simulated by enforced\n" + "".join(f"{m},2.1\n" for m in modes))
        self.write("tests/stress/results/hours_springs.csv",
                   "mode,ticks,force drift N,growth bytes\n" + "".join(f"{m},3600000,0,0\n" for m in modes))

    def test_make_the_table_of_makers_stand_ins_once_its_file_is_there(self):
        self.write("tests/makers/results/contact.csv",
                   "model,rate_hz,samples,p50_us,p99_us,p99_9_us,max_us,max_energy_j\nTouch,1000,60000,40,120,180,900,2.5e-06\n"
                   "Omega3,4000,240000,30,250,300,1900,1e-07\n")
        made = self.make("maker contact")
        self.assertIn("| Touch | 1,000 Hz | 60,000 | 40 us | 120 us | 180 us | 900 us | 2.5 uJ | met (p99 200 us) |", made)
        self.assertIn("| Omega3 | 4,000 Hz | 240,000 | 30 us | 250 us | 300 us | 1.9 ms | 0.1 uJ | **missed** (p99 200 us) |", made)

    def test_make_the_tables_of_python_and_sweeps_once_their_files_are_there(self):
        measured = {"cold_minima": (12345, "1", ""), "cold_cpp_us": (10, "us", ""), "cold_python_us": (11, "us", ""),
                    "cold_python_over_cpp": (1.1, "1", 1.05), "cold_python_all_processors_us": (6, "us", ""),
                    "tracked_python_us": (2, "us", ""), "tracked_python_all_processors_us": (1, "us", ""),
                    "call_without_query_us": (2.5, "us", 3), "call_over_batch_us": (1.5, "us", 3), "wheel_s": (200, "s", 180)}
        self.write("tests/app/results/python.csv", "measure,value,unit,goal\n" +
                   "".join(f"{name},{value},{unit},{goal}\n" for name, (value, unit, goal) in measured.items()))
        made = self.make("python package")
        self.assertIn("| Python over C++ | 1.10 | **missed** (at most 1.05) |", made)
        self.assertIn("| call of one pose, all out of reach | 2.5 us | met (at most 3.0 us) |", made)
        self.assertIn("| wheel built from nothing | 200 s | **missed** (at most 180 s) |", made)
        self.write("tests/app/results/sweep_cost.csv", 'quantity,value,unit\nrow of all measures,1500,us\nlarge: rows,1e9,\n'
                   'two workers over one,1.75,"times as fast, median"\n')
        made = self.make("sweep cost")
        self.assertIn("| row of all measures | 1.5 ms |  |", made)
        self.assertIn("| large: rows | 1,000,000,000 |  |", made)
        self.assertIn("| two workers over one | 1.75 | **missed** (at least 1.8) |", made)

    def test_make_the_tables_of_scenes_once_their_files_are_there(self):
        bench = "tests/bench/results/"
        self.write(bench + "check.csv", "scene,parts,meshes,triangles,threshold_m,method,figure,unit,runs,median,worst,goal,met,remark\n"
                   "parts200,200,20,2000000,0.1,nearfit,whole check,s,3,4,6.5,5,yes,\n")
        self.assertIn("| whole check | 4.0 s | 6.5 s | met (5.0 s) |", self.make("checks"))
        self.write(bench + "path.csv", "scene,poses,triangles,certified_s,verified_s,ratio,places,meetings,goal_s,met\n"
                   "peg,4000,576,12,3,0.25,1000000,0,10,no\n")
        self.assertIn("| `peg` | 4,000 | 576 | 12 s | 3.0 s | 0.25 | 0 of 1,000,000 | **missed** |", self.make("paths"))
        self.write(bench + "suggest.csv", "scene,seeds,found,p50_s,max_s,goal,met\npeg out,10,9,2,28,9 of 10 within 30 s,yes\n")
        self.assertIn("| peg out | 9 of 10 | 2.0 s | 28 s | met (9 of 10 within 30 s) |", self.make("suggestions"))
        self.write(bench + "verdicts.csv",
                   "scene,pairs,agree,worst_distance_difference_m,clear,near,touching,clashes,contained\nvise,10,10,1e-16,1,2,3,4,0\n")
        self.assertIn("| vise | 10 | 10 | 1e-16 | 1 | 2 | 3 | 4 | 0 |", self.make("verdicts"))
        self.write("tests/app/results/read_back.csv",
                   "# revision: abc\nwriter,content,format,reader,parts,names_equal,groups_equal,max_pose_error,max_error_to_chosen_pose,"
                   "max_volume_error,max_box_error,max_curved_volume_error,max_curved_box_error,exact_parts,closed,colours_differing,"
                   "shapes_not_shared,validator,validator_errors,validator_warnings,right\n"
                   "Nearfit 1,assembly,step AP214,OCP 7,12,yes,yes,1e-12,2e-12,3e-13,4e-13,,,12 of 12,,0,0,,,,yes\n"
                   "Nearfit 1,assembly,glb,trimesh 5,11,no,yes,1e-12,2e-12,6e-8,3e-8,1e-4,1e-5,,,0,0,gltf-validator 2,3,0,no\n"
                   "Nearfit 1,swept volume,stl,trimesh 5,1,,,,,0.2,0.01,,,,yes,,,,,,yes\n")
        self.assertIn("| step AP214 | OCP 7 | 12 | yes | yes | 1e-12, 2e-12 | 3e-13 | 4e-13 | 12 of 12 | 0 | 0 | none | right |",
                      self.make("read back"))
        self.assertIn("| 6e-8 (curved 1e-4) |", self.make("read back"))
        self.assertIn("| swept volume, `.stl` | trimesh 5 | yes | - | 0.2 | 0.01 | none | right |", self.make("read back meshes"))
        self.assertIn("| 3 errors, 0 warnings (gltf-validator 2) | **not right** |", self.make("read back"))
        self.write("tests/app/results/report_page.csv",
                   "# revision: abc\npage,KiB,validator,messages,false_alarms,outside_references,browser,requests,pages_a4,parted_a4,"
                   "pages_letter,parted_letter,right\nclash,99,vnu 26,0,14,0,Chromium 156,0,5,0,6,1,no\n")
        made = self.make("report pages")
        self.assertIn("| report, by vnu 26 and Chromium 156 at `0123456789ab` |", made)
        self.assertIn("| clash | 99 KiB | 0 | 0 | 0 | 5, 0 parted | 6, 1 parted | **not right** |", made)
        self.assertEqual(scenes.readme_hour_row(Results(self.root)), [])
        self.write(bench + "window_hour.csv", "# growth after the first tenth: 2097152 bytes\n"
                   "minute,memory_MB,ticks,overruns,late_p50_us,late_p99_us,late_p99_9_us,late_max_us,tick_p50_us,tick_p99_us,tick_max_us,"
                   "in_contact,pictures\n1,200,60000,0,1,20,30,900,20,40,80,0.5,900\n2,210,60000,3,1,20,30,2500,20,40,80,0.7,900\n")
        made = self.make("window hour")
        self.assertIn("120,000 ticks, in contact in 60 %", made)
        self.assertIn("| max | 900 us | 2.5 ms | 2.5 ms | 2.5 ms | 2 |", made)
        self.assertIn("Memory grew by 2.0 MiB between the second tenth of the time and the last: met (16 MiB).", self.make("window hour, verdict"))
        question, said, verdict = scenes.readme_hour_row(Results(self.root))[0]
        self.assertIn("2 minutes of wall clock, 120,000 ticks", question)
        self.assertEqual((said, verdict), ("memory grows by 2.0 MiB after the first tenth; lateness at most 2.5 ms, 3 ticks left out",
                                           "met (16 MiB)"))


if __name__ == "__main__":
    unittest.main()
