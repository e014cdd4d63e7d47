"""Tables of `nearfit-bench paper`: Appendix A, the judged algorithm, the arguments, the sweeps."""

import common as c
import numbers_text as n

FILE = "tests/bench/results/paper.csv"
NEEDED = c.needs(FILE)
# "exact" is said of the whole set alone (glossary): these drop minima.
NAMES = {"exact grouped": "grouped: one spring an area (`exact grouped` in the file)", "exact printed law": "exact, printed law"}


class Figures:
    """Rows of paper.csv by part, scene, method and quantity; what a row of a table lacks reads "-"."""

    def __init__(self, results, part):
        self.rows = results.table(FILE).where(part=part)
        self.scenes = list(dict.fromkeys(row["scene"] for row in self.rows))

    def settings(self, scene):
        return list(dict.fromkeys(row["setting"] for row in self.rows if row["scene"] == scene))

    def methods(self, quantity):
        return list(dict.fromkeys(row["method"] for row in self.rows if row["quantity"] == quantity))

    def row(self, scene, method, quantity, setting=""):
        found = [row for row in self.rows if (row["scene"], row["method"], row["quantity"], row["setting"]) ==
                 (scene, method, quantity, setting)]
        return found[0] if found and float(found[0]["samples"]) > 0 else None

    def text(self, scene, method, quantity, column="p50", write=n.plain, setting=""):
        row = self.row(scene, method, quantity, setting)
        return write(float(row[column])) if row else "-"


@NEEDED
def appendix(results):
    """Rows a to f beside what the paper prints; the rate of the slowest hundredth is the worst case."""
    figures = Figures(results, "appendix")
    rows = []
    for scene in figures.scenes:
        counts = [figures.text(scene, m, "minima at the pose", "p50", n.count)
                  for m in ("printed", "paper-spans", "paper-cones", "nearfit-cold")]
        # Of a loop at p99 of its time.
        slowest = {m: figures.text(scene, m, "loop [us]", "p99", lambda us: n.count(1e6 / us))
                   for m in ("paper spans", "exact tracked", "proxy's tick")}
        rows.append([scene, *counts, figures.text(scene, "printed", "loop [Hz]", "p50", n.count),
                     *(f"{figures.text(scene, m, 'loop [Hz]', 'p50', n.count)} ({slowest[m]})" for m in slowest),
                     figures.text(scene, "nearfit-tracked", "query [us]"), figures.text(scene, "fcl-seeded", "query [us]"),
                     f"{figures.text(scene, 'paper-spans', 'build [s]')}, {figures.text(scene, 'nearfit', 'build [s]')}"])
    return n.table(["row", "minima: printed", "strict reading", "cones", "exact", "loop [Hz]: printed", "strict reading here",
                    "exact, tracked", "proxy's tick", "query [us]: exact, tracked", "FCL, distance alone",
                    "built in [s]: paper's, Nearfit's"], rows)


@NEEDED
def appendix_in_short(results):
    """For the README: counts and rates alone."""
    figures = Figures(results, "appendix")
    rows = []
    for scene in figures.scenes:
        counts = [figures.text(scene, m, "minima at the pose", "p50", n.count) for m in ("printed", "nearfit-cold")]
        rates = []
        for method in ("paper spans", "exact tracked", "proxy's tick"):
            slow = figures.text(scene, method, "loop [us]", "max", lambda us: n.count(1e6 / us))
            rates.append(f"{figures.text(scene, method, 'loop [Hz]', 'p50', n.count)} ({slow})")
        rows.append([scene, *counts, figures.text(scene, "printed", "loop [Hz]", "p50", n.count), *rates])
    return n.table(["row of Appendix A", "minima: printed", "exact", "loop [Hz]: printed, 2003", "the paper's algorithm here: p50 (slowest)",
                    "exact, tracked", "proxy's tick"], rows)


@NEEDED
def judge(results):
    figures = Figures(results, "judge")
    rows = []
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
def front(results):
    """Time of all threads against the error of the summed force, and who is on the front of each row."""
    appendix, judged = Figures(results, "appendix"), Figures(results, "judge")
    rows = []
    for scene in judged.scenes:
        points = []
        for method in judged.methods("force error [relative]"):
            error = judged.row(scene, method, "force error [relative]")
            whole = appendix.row(scene, method, "loop and search beside it [us]")
            if error and whole:
                points.append((float(whole["mean"]), float(error["mean"]), method))
        for time, error, method in sorted(points):
            is_on = not any(t <= time and e <= error and (t, e) != (time, error) for t, e, _ in points)
            name = scene if not rows or all(row[0] != scene for row in rows) else ""
            rows.append([name, NAMES.get(method, method), n.plain(time), appendix.text(scene, method, "loop [us]", "p99"),
                         appendix.text(scene, method, "prepared in [s]"), n.plain(error),
                         judged.text(scene, method, "force error [relative]", "max"), "**front**" if is_on else ""])
    return n.table(["row", "method", "all threads, mean [us]", "the loop alone, p99 [us]", "prepared in [s]", "force error: mean", "max",
                    "on the front"], rows, right_from=2)


@NEEDED
def arguments(results):
    figures = Figures(results, "arguments")
    rows = []
    for scene in figures.scenes:
        first = True
        for method in figures.methods("force [N]"):
            if not figures.row(scene, method, "force [N]"):
                continue
            rows.append([scene if first else "", NAMES.get(method, method), figures.text(scene, method, "springs", "p50", n.count),
                         figures.text(scene, method, "springs", "max", n.count), figures.text(scene, method, "force [N]", "mean"),
                         figures.text(scene, method, "change of force a tick [N]", "max"),
                         figures.text(scene, method, "ticks with a jump", "p50", n.count),
                         figures.text(scene, method, "jump of force [N]", "max"),
                         figures.text(scene, method, "tick [us]", "p50"), figures.text(scene, method, "tick [us]", "max")])
            first = False
    return n.table(["row", "springs at", "springs: p50", "max", "force, mean [N]", "largest change a tick [N]", "ticks that jump",
                    "largest jump [N]", "tick [us]: p50", "max"], rows, right_from=2)


@NEEDED
def onset(results):
    figures = Figures(results, "arguments")
    rows = [[scene, figures.text(scene, "exact", "springs born at the cutoff", "p50", n.count),
             figures.text(scene, "exact", "their push in the tick of birth [N]", "max"),
             figures.text(scene, "exact", "motion of a tick [of the cutoff]", "max"),
             figures.text(scene, "exact", "jumps with one at the cutoff alone", "p50", n.count),
             figures.text(scene, "exact", "jumps with a birth or death within the cutoff", "p50", n.count)] for scene in figures.scenes]
    return n.table(["row", "springs born at the cutoff", "their largest push then [N]", "largest motion a tick [of the cutoff]",
                    "jumps: at the cutoff alone", "with a birth or death within it"], rows)


@NEEDED
def law_and_centre(results):
    """The print to the letter beside ours, and the box's centre beside the volume's."""
    figures = Figures(results, "arguments")
    rows = []
    for scene in figures.scenes:
        boxes = [f"{figures.text(scene, f'box of the {body}', 'centre of mass off [of the diagonal]', 'p50', lambda v: f'{n.plain(100 * v)} %')}, "
                 f"{figures.text(scene, f'box of the {body}', 'torque error [relative]', 'max')}" for body in ("part", "scene")]
        rows.append([scene, figures.text(scene, "as printed", "force differs from ours [relative]", "max"),
                     figures.text(scene, "as printed", "cosine of torque to ours", "max"),
                     figures.text(scene, "as printed", "our torque over k times the printed", "max"), *boxes])
    return n.table(["row", "printed force differs by at most", "cosine of the printed torque to ours, max", "ours over k times it, max",
                    "the part's box: centre off, torque error at most", "the scene's box"], rows)


def _sweep(results, part, head):
    figures = Figures(results, part)
    methods = figures.methods("query [us]")
    rows = []
    for scene in figures.scenes:
        for i, setting in enumerate(figures.settings(scene)):
            rows.append([scene if i == 0 else "", n.plain(float(setting)) if part == "triangles" else f"{100 * float(setting):g} %",
                         *(f"{figures.text(scene, m, 'query [us]', 'p50', setting=setting)} "
                           f"({figures.text(scene, m, 'query [us]', 'max', setting=setting)})" for m in methods),
                         figures.text(scene, "nearfit-cold", "minima", "p50", n.count, setting),
                         figures.text(scene, "nearfit-cold", "minima", "max", n.count, setting)])
    return n.table(["row" if part == "cutoff" else "bodies", head, *(f"{m} [us]: p50 (max)" for m in methods), "exact minima: p50", "max"],
                   rows)


@NEEDED
def cutoff(results):
    return _sweep(results, "cutoff", "cutoff, of the diagonal")


@NEEDED
def triangles(results):
    return _sweep(results, "triangles", "triangles")


FIGURES = {"appendix a": appendix, "appendix a in short": appendix_in_short, "judged": judge, "front on the paper's meshes": front, "arguments": arguments, "onset": onset,
           "law and centre": law_and_centre, "cutoff sweep": cutoff, "triangle sweep": triangles}
