"""Tables and verdicts of `nearfit-bench paper`: Appendix A and the judged algorithm."""

import common as c
import fronts
import numbers_text as n

FILE = "tests/bench/results/paper.csv"
NEEDED = c.needs(FILE)
# "exact" is said of the whole set alone (glossary): grouping drops minima.
NAMES = {"exact grouped": "grouped", "exact printed law": "exact, printed law"}


class Figures:
    """Rows of paper.csv by part, scene, method and quantity; what a row of a table lacks reads "-"."""

    def __init__(self, results, *parts):
        self.rows = [row for row in results.table(FILE).where() if row["part"] in parts]
        self.scenes = list(dict.fromkeys(row["scene"] for row in self.rows))

    def settings(self, scene):
        return list(dict.fromkeys(row["setting"] for row in self.rows if row["scene"] == scene))

    def methods(self, quantity):
        return list(dict.fromkeys(row["method"] for row in self.rows if row["quantity"] == quantity))

    def row(self, scene, method, quantity, setting=""):
        found = [row for row in self.rows if (row["scene"], row["method"], row["quantity"], row["setting"]) ==
                 (scene, method, quantity, setting)]
        return found[0] if found and float(found[0]["samples"]) > 0 else None

    def number(self, scene, method, quantity, column="p50", setting=""):
        """None where there is no such row."""
        row = self.row(scene, method, quantity, setting)
        return float(row[column]) if row else None

    def text(self, scene, method, quantity, column="p50", write=n.plain, setting=""):
        value = self.number(scene, method, quantity, column, setting)
        return "-" if value is None else write(value)

    def p50_and_max(self, scene, method, quantity, setting=""):
        return f"{self.text(scene, method, quantity, 'p50', setting=setting)} ({self.text(scene, method, quantity, 'max', setting=setting)})"

    def rate(self, scene, method):
        """Median of the loop's rate [Hz], and that of its slowest tick."""
        slowest = self.text(scene, method, "loop [us]", "max", lambda us: n.count(1e6 / us))
        return f"{self.text(scene, method, 'loop [Hz]', 'p50', n.count)} ({slowest})"

    def over_scenes(self, method, quantity, column="p50"):
        """(value, row of the appendix) of each scene that has one."""
        values = [(self.number(scene, method, quantity, column), letter(scene)) for scene in self.scenes]
        return [(value, name) for value, name in values if value is not None]


def letter(scene):
    """The row of the appendix, or the whole name of a pair that is not in it."""
    return scene[0] if scene[1:2] == " " else scene


def _printed_rate(hertz):
    # The paper prints 1506 for a rate of 1506.76.
    return n.count(int(hertz))


def _appendix(results):
    figures = Figures(results, "appendix")
    # A pair of scans may be judged as well, of which the paper prints nothing.
    figures.scenes = [scene for scene in figures.scenes if figures.row(scene, "printed", "minima at the pose")]
    return figures


@NEEDED
def appendix(results):
    """Rows a to f, counts and rates beside those that the paper prints."""
    figures, rows = _appendix(results), []
    for scene in figures.scenes:
        counts = [figures.text(scene, m, "minima at the pose", "p50", n.count)
                  for m in ("printed", "paper-spans", "paper-cones", "nearfit-cold")]
        rows.append([scene, *counts, figures.text(scene, "printed", "loop [Hz]", "p50", _printed_rate),
                     *(figures.rate(scene, m) for m in ("paper spans", "exact tracked", "proxy's tick"))])
    return n.table(["row", "minima: printed", "strict reading", "cones", "exact", "loop [Hz]: printed", "strict reading here: p50 (slowest)",
                    "exact, tracked: p50 (slowest)", "proxy's tick: p50 (slowest)"], rows)


@NEEDED
def appendix_times(results):
    """Queries alone, the loop with the search beside it, and builds."""
    figures, rows = _appendix(results), []
    for scene in figures.scenes:
        queries = [figures.p50_and_max(scene, m, "query [us]")
                   for m in ("nearfit-cold", "nearfit-tracked", "paper-spans", "paper-cones", "fcl")]
        loops = [figures.text(scene, "exact tracked", q, "mean") for q in ("loop [us]", "loop and search beside it [us]")]
        rows.append([scene, *queries, *loops, *(figures.text(scene, m, "build [s]") for m in ("paper-spans", "nearfit"))])
    return n.table(["row", "query [us]: exact, searched anew: p50 (max)", "exact, tracked", "strict reading", "cones",
                    "FCL, distance alone, unseeded", "loop of exact, tracked: mean [us]", "with the search beside it",
                    "built in [s]: paper's", "Nearfit's"], rows)


@NEEDED
def appendix_verdict(results):
    figures = _appendix(results)
    exact, printed = (dict(map(reversed, figures.over_scenes(m, "minima at the pose"))) for m in ("nearfit-cold", "printed"))
    same = [row for row in exact if exact[row] == printed[row]]
    others = [f"on {row} it is {n.count(exact[row])} where the paper prints {n.count(printed[row])}" for row in exact if row not in same]
    said = f"The exact count is the printed one on {n.listed(same)}" + (f"; {n.listed(others)}" if others else "") + ". "
    ratios = [figures.number(scene, "exact tracked", "loop [Hz]") / figures.number(scene, "paper spans", "loop [Hz]")
              for scene in figures.scenes]
    slowest = max(figures.over_scenes("proxy's tick", "loop [us]", "max"))
    short = [row for time, row in figures.over_scenes("paper spans", "loop [us]", "max") if time > 1e3]
    return said + (f"At the median the loop of exact, tracked minima is {n.span(ratios)} times as fast as the strict reading's. The strict reading "
                   + (f"has ticks of more than 1 ms on {n.listed(short)}" if short else "keeps to 1 ms on all rows")
                   + f"; the proxy's slowest takes {n.time(slowest[0])} (row {slowest[1]}).")


@NEEDED
def appendix_in_short(results):
    """For the README: counts and rates alone."""
    figures, rows = _appendix(results), []
    for scene in figures.scenes:
        counts = [figures.text(scene, m, "minima at the pose", "p50", n.count) for m in ("printed", "nearfit-cold")]
        rows.append([scene, *counts, figures.text(scene, "printed", "loop [Hz]", "p50", _printed_rate),
                     *(figures.rate(scene, m) for m in ("paper spans", "exact tracked", "proxy's tick"))])
    return n.table(["row of Appendix A", "minima: printed", "exact", "loop [Hz]: printed, 2003", "the paper's algorithm here: p50 (slowest)",
                    "exact, tracked: p50 (slowest)", "proxy's tick: p50 (slowest)"], rows)


@NEEDED
def built(results):
    """Time to build the hierarchies of the appendix's rows."""
    figures = _appendix(results)
    paper, ours = ([value for value, _ in figures.over_scenes(m, "build [s]")] for m in ("paper-spans", "nearfit"))
    return f"{n.span(paper)} s for the baseline's on one core, and {n.span(ours)} s for Nearfit's on all"


@NEEDED
def judged_poses(results):
    figures = Figures(results, "judge")
    counts = sorted({int(figures.row(scene, m, "minima missed")["samples"]) for scene in figures.scenes
                     for m in figures.methods("minima missed") if figures.row(scene, m, "minima missed")})
    return n.span(counts, n.count)


@NEEDED
def judge(results):
    figures, rows = Figures(results, "judge"), []
    for scene in figures.scenes:
        first = True
        for method in figures.methods("minima missed"):
            if not figures.row(scene, method, "minima missed"):
                continue
            cells = [figures.text(scene, method, q, "mean") for q in ("minima missed", "minima that are none")]
            share = figures.text(scene, method, "poses with another set [share]", "mean", lambda v: f"{n.plain(100 * v)} %")
            errors = [figures.text(scene, method, f"{kind} error [relative]", column)
                      for kind in ("force", "torque") for column in ("p50", "max")]
            rows.append([scene if first else "", NAMES.get(method, method), *cells, share, *errors])
            first = False
    return n.table(["row", "method", "missed a pose", "none a pose", "poses with another set", "force error: p50", "max",
                    "torque error: p50", "max"], rows, right_from=2)


@NEEDED
def judge_verdict(results):
    figures, said = Figures(results, "judge"), []
    for method, name in (("paper spans", "The strict reading"), ("paper cones", "The reading by cones")):
        missed, none, poses = (figures.over_scenes(method, q, "mean")
                               for q in ("minima missed", "minima that are none", "poses with another set [share]"))
        if not none:
            continue
        losing, adding = ([row for value, row in of if value > 0] for of in (missed, none))
        worst, median = (max(figures.over_scenes(method, "force error [relative]", column))[0] for column in ("max", "p50"))
        share = n.span([100 * value for value, row in poses if row in adding] or [0.0])
        said.append(f"{name} missed " + (f"minima on {n.listed(losing)}" if losing else "none") + ", and found minima that are none "
                    + (f"on {n.listed(adding)}, at {share} % of the poses; its force is off by up to {n.plain(worst)} of the exact one"
                       f"{f', and by up to {n.plain(median)} at the median' if median > 0.01 else ''}" if adding else "on no row") + ".")
    return " ".join(said)


@NEEDED
def grouped_judged(results):
    """The row where grouping changes most."""
    figures = Figures(results, "judge")
    off, row = max(figures.over_scenes("exact grouped", "force error [relative]"))
    scene = next(s for s in figures.scenes if letter(s) == row)
    missed, most = (figures.text(scene, "exact grouped", quantity, column)
                    for quantity, column in (("minima missed", "mean"), ("force error [relative]", "max")))
    return (f"on row {row} it drops {missed} minima a pose, and the force is off by {n.plain(off)} of the exact sum at the median and "
            f"{most} at most")


def _judged_points(results):
    """(scene, points) of each judged row; a point is (time of all threads, error of the force, method), both means."""
    timed, judged = Figures(results, "appendix", "judge"), Figures(results, "judge")
    for scene in judged.scenes:
        points = []
        for method in judged.methods("force error [relative]"):
            error, time = (of.number(scene, method, quantity, "mean") for of, quantity in
                           ((judged, "force error [relative]"), (timed, "loop and search beside it [us]")))
            if error is not None and time is not None:
                points.append((time, error, method))
        yield scene, sorted(points)


@NEEDED
def front(results):
    """Time of all threads against the error of the summed force, and who is on the front of each row."""
    timed, rows = Figures(results, "appendix", "judge"), []
    for scene, points in _judged_points(results):
        kept = fronts.front(points)
        for i, point in enumerate(points):
            method = point[2]
            rows.append([scene if i == 0 else "", NAMES.get(method, method), n.plain(point[0]), timed.text(scene, method, "loop [us]", "max"),
                         timed.text(scene, method, "prepared in [s]"), n.plain(point[1]),
                         timed.text(scene, method, "force error [relative]", "max"), "**front**" if point in kept else
                         "measured only" if fronts.is_only_measured(method) else ""])
    return n.table(["row", "method", "all threads, mean [us]", "the loop alone, max [us]", "prepared in [s]", "force error: mean", "max",
                    "on the front"], rows, right_from=2)


@NEEDED
def front_verdict(results):
    """The holders of the fronts, with their rows."""
    holders = {}
    for scene, points in _judged_points(results):
        for point in fronts.front(points):
            holders.setdefault(NAMES.get(point[2], point[2]), []).append(letter(scene))
    said = [f"*{method}* on {n.listed(rows)}" for method, rows in holders.items()]
    return f"On the front are {n.listed(said)}."


FIGURES = {
    "appendix a": appendix, "appendix a, times": appendix_times, "appendix a, verdict": appendix_verdict,
    "appendix a in short": appendix_in_short, "built": built, "judged poses": judged_poses, "judged": judge, "judged, verdict": judge_verdict,
    "grouped, judged": grouped_judged, "front on the paper's meshes": front, "fronts, verdict": front_verdict,
}
