"""Tables and verdicts of the paper's arguments (its sections 4.1 to 4.3) and of the sweeps, from `nearfit-bench paper`."""

import numbers_text as n
from paper import NAMES, NEEDED, Figures, letter

TICK = 1e3  # [us]
MIN_BIRTHS = 100  # Fewer show a claim about births at the cutoff, and do not prove it.


def _arguments(results):
    return Figures(results, "arguments")


@NEEDED
def arguments(results):
    figures, rows = _arguments(results), []
    for scene in figures.scenes:
        first = True
        for method in figures.methods("force [N]"):
            if not figures.row(scene, method, "force [N]"):
                continue
            jumps, examined = (figures.text(scene, method, q, "p50", n.count) for q in ("ticks with a jump", "ticks examined for one"))
            rows.append([scene if first else "", NAMES.get(method, method), figures.text(scene, method, "springs", "p50", n.count),
                         figures.text(scene, method, "springs", "max", n.count), figures.text(scene, method, "force [N]", "mean"),
                         figures.text(scene, method, "change of force a tick [N]", "max"),
                         "-" if jumps == "-" else f"{jumps} of {examined}", figures.text(scene, method, "jump of force [N]", "max"),
                         figures.text(scene, method, "tick [us]", "p50"), figures.text(scene, method, "tick [us]", "max")])
            first = False
    return n.table(["row", "springs at", "springs: p50", "max", "force, mean [N]", "largest change a tick [N]", "ticks that jump, of those examined",
                    "largest jump [N]", "tick [us]: p50", "max"], rows, right_from=2)


def _jumps(figures, method):
    """The largest jump of each row of the appendix [N]; 0 where none was found."""
    found = {}
    for scene in figures.scenes:
        if figures.row(scene, method, "ticks with a jump"):
            found[letter(scene)] = figures.number(scene, method, "jump of force [N]", "max") or 0.0
    return found


def _where_it_jumps(found):
    jumping = {row: size for row, size in found.items() if size > 0}
    if not jumping:
        return "jumps on no row"
    return f"jumps on {n.listed(jumping)}, by up to {n.listed([n.plain(size) for size in jumping.values()])} N"


@NEEDED
def one_spring(results):
    """Figure 5 a of the paper: the spring at the global minimum, beside the sum at all minima."""
    figures = _arguments(results)
    one, all_of_them = _jumps(figures, "global minimum"), _jumps(figures, "exact")
    calm = [row for row, size in one.items() if size == 0]
    jumping = [row for row in one if row not in calm]
    said = (f"The argument holds on {n.listed(jumping)}" if jumping else "The argument holds on no row") + (
        f", and not on {n.listed(calm)}, where no jump was found" if calm and jumping else "") + ". "
    said += f"The spring at the global minimum {_where_it_jumps(one)}. "
    said += f"The sum at the exact minima {_where_it_jumps(all_of_them)}"
    better, worse = ([row for row in one if test(all_of_them[row], one[row])] for test in (lambda a, b: a < b, lambda a, b: a > b))
    said += (f": less than the one spring on {n.listed(better)}" if better else ": nowhere less than the one spring") + (
        f", more on {n.listed(worse)}" if worse else "") + "." + (" So the sum is no steadier in general." if worse else "")
    for method in ("exact grouped", "grouped"):
        if method in figures.methods("ticks with a jump"):
            said += f" One spring for each area (`grouped`) {_where_it_jumps(_jumps(figures, method))}."
    return said


@NEEDED
def all_pairs(results):
    """Figure 5 b of the paper: springs at all pairs within the cutoff."""
    figures = _arguments(results)
    counts, exact = ([value for value, _ in figures.over_scenes(m, "springs")] for m in ("all pairs", "exact"))
    median, longest = (figures.over_scenes("all pairs", "tick [us]", column) for column in ("p50", "max"))
    slow = [row for time, row in longest if time > TICK]
    return (f"The argument holds on {n.listed(slow)}, where a tick takes more than 1 ms. Springs at all pairs of triangles number "
            f"{n.span(counts, n.count)} at the median, where there are {n.span(exact, n.count)} exact minima. A tick of them takes "
            f"{n.time(min(median)[0])} to {n.time(max(median)[0])} at the median and {n.time(max(longest)[0])} at most.")


@NEEDED
def proxy_changes(results):
    """Where the proxy's force changes most in a tick."""
    figures = _arguments(results)
    changes = sorted(figures.over_scenes("proxy", "change of force a tick [N]", "max"), reverse=True)
    means = dict(map(reversed, figures.over_scenes("proxy", "force [N]", "mean")))
    return n.listed([f"{n.plain(value)} N on {row} (mean force {n.plain(means[row])} N)" for value, row in changes])


@NEEDED
def onset(results):
    figures = _arguments(results)
    rows = [[scene, figures.text(scene, "exact", "springs born at the cutoff", "p50", n.count),
             figures.text(scene, "exact", "their push in the tick of birth [N]", "max"),
             figures.text(scene, "exact", "motion of a tick [of the cutoff]", "max"),
             figures.text(scene, "exact", "jumps with one at the cutoff alone", "p50", n.count),
             figures.text(scene, "exact", "jumps with a birth or death within the cutoff", "p50", n.count)] for scene in figures.scenes]
    return n.table(["row", "springs born at the cutoff", "their largest push then [N]", "largest motion a tick [of the cutoff]",
                    "jumps: at the cutoff alone", "with a birth or death within it"], rows)


@NEEDED
def onset_verdict(results):
    figures = _arguments(results)

    def total(quantity):
        return sum(value for value, _ in figures.over_scenes("exact", quantity))

    born, alone, within, jumps = (total(q) for q in ("springs born at the cutoff", "jumps with one at the cutoff alone",
                                                     "jumps with a birth or death within the cutoff", "ticks with a jump"))
    births = figures.over_scenes("exact", "their push in the tick of birth [N]", "max")
    # A spring pushes with 1 N when it is pressed by the whole cutoff.
    allowed = dict(map(reversed, figures.over_scenes("exact", "motion of a tick [of the cutoff]", "max")))
    bound = "no more" if all(push <= allowed.get(row, 0.0) for push, row in births) else "**more**"
    said = f"{n.count(born)} springs were born at the cutoff in all"
    if births:
        said += f", and pushed with at most {n.plain(max(births)[0])} N in that tick, {bound} than the motion allows"
    if born < MIN_BIRTHS:
        said += ": an example of the claim, too few to prove it"
    return (f"{said}. Of {n.count(jumps)} jumps {n.count(alone) if alone else 'none'} came with a birth or death at the cutoff alone, "
            f"{n.count(within)} with one within it.")


@NEEDED
def printed_law(results):
    """The print to the letter beside ours of the same name."""
    figures = _arguments(results)
    rows = [[scene, figures.text(scene, "as printed", "force differs from ours [relative]", "max"),
             figures.text(scene, "as printed", "cosine of torque to ours", "max"),
             figures.text(scene, "as printed", "our torque over k times the printed", "max")] for scene in figures.scenes]
    return n.table(["row", "printed force differs from ours by at most, of ours", "cosine of the printed torque to ours, max",
                    "our torque over k times the printed, max"], rows)


@NEEDED
def box_centre(results):
    """The box's middle beside the centre of the volume."""
    figures, rows = _arguments(results), []
    for scene in figures.scenes:
        cells = []
        for body in ("part", "scene"):
            box = f"box of the {body}"
            off = figures.number(scene, box, "centre of mass off [of the diagonal]")
            cells += ["-" if off is None else n.plain(100 * off) if off > 1e-12 else "0",
                      *(figures.text(scene, box, "torque error [relative]", column, lambda v: n.plain(v if v > 1e-12 else 0.0))
                        for column in ("p50", "max"))]
        rows.append([scene, *cells])
    return n.table(["row", "part's box: centre off [% of its diagonal]", "torque off [of ours]: p50", "max",
                    "scene's box: centre off [% of its diagonal]", "torque off [of ours]: p50", "max"], rows)


@NEEDED
def box_verdict(results):
    figures = _arguments(results)
    box = "box of the scene"
    off = [100 * value for value, _ in figures.over_scenes(box, "centre of mass off [of the diagonal]")]
    worst, row = max(figures.over_scenes(box, "torque error [relative]", "max"))
    return (f"The middle of the scene's box is off by {n.span(off)} % of the diagonal, and the torque about it by up to {n.plain(worst)} of "
            f"ours (row {row}).")


SHOWN = {"nearfit-cold": "exact, searched anew", "nearfit-tracked": "exact, tracked", "paper-spans": "the strict reading", "paper-cones": "cones",
         "fcl": "FCL's distance alone"}


def _sweep(results, part, head):
    figures = Figures(results, part)
    methods = figures.methods("query [us]")
    rows = []
    for scene in figures.scenes:
        for i, setting in enumerate(figures.settings(scene)):
            rows.append([scene if i == 0 else "", n.plain(float(setting)) if part == "triangles" else f"{100 * float(setting):g} %",
                         *(figures.p50_and_max(scene, m, "query [us]", setting) if figures.row(scene, m, "query [us]", setting) else "-"
                           for m in methods),
                         figures.text(scene, "nearfit-cold", "minima", "p50", n.count, setting),
                         figures.text(scene, "nearfit-cold", "minima", "max", n.count, setting)])
    return n.table(["row" if part == "cutoff" else "bodies", head, *(f"{SHOWN.get(m, m)} [us]: p50 (max)" for m in methods),
                    "exact minima: p50", "max"], rows)


@NEEDED
def cutoff(results):
    return _sweep(results, "cutoff", "cutoff, of the diagonal")


@NEEDED
def triangles(results):
    return _sweep(results, "triangles", "triangles")


def _growth(figures, scene, method, settings):
    """Median time at the last setting by that at the first."""
    first, last = (figures.number(scene, method, "query [us]", setting=setting) for setting in (settings[0], settings[-1]))
    return last / first


@NEEDED
def cutoff_verdict(results):
    """Median time at the largest cutoff in times of that at the least."""
    figures = Figures(results, "cutoff")
    said = []
    for method in figures.methods("query [us]"):
        ratios = []
        for scene in figures.scenes:
            ratios.append(_growth(figures, scene, method, figures.settings(scene)))
        said.append(f"{n.span(ratios)} times for {SHOWN.get(method, method)}")
    return f"From the least cutoff to the largest the median time grows {n.listed(said)}."


@NEEDED
def triangles_verdict(results):
    """Time at the largest size that the paper's methods are asked about, and how it grew."""
    figures, said = Figures(results, "triangles"), []
    for scene in figures.scenes:
        sizes = [s for s in figures.settings(scene) if figures.row(scene, "paper-spans", "query [us]", s)]
        if not sizes:
            continue
        growth = [f"{n.plain(_growth(figures, scene, m, sizes))} times for {SHOWN[m]}" for m in ("paper-spans", "nearfit-cold")]
        said.append(f"on {scene}, from {n.count(float(sizes[0]))} to {n.count(float(sizes[-1]))} triangles, {n.listed(growth)}")
    return f"The median time grows {'; '.join(said)}." if said else "The paper's methods were not asked."


def _sizes(results, method):
    figures = Figures(results, "triangles")
    return [float(row["setting"]) for row in figures.rows if row["method"] == method and row["quantity"] == "query [us]"]


@NEEDED
def smallest_sizes(results):
    figures = Figures(results, "triangles")
    return n.listed([n.count(size) for size in sorted({float(figures.settings(scene)[0]) for scene in figures.scenes})])


@NEEDED
def paper_sizes(results):
    sizes = _sizes(results, "paper-spans")
    return n.count(max(sizes)) if sizes else "no"


@NEEDED
def longest_answer(results):
    """The slowest query of the paper's methods in the sweep of triangles."""
    figures = Figures(results, "triangles")
    found = [(float(row["max"]), float(row["p50"])) for row in figures.rows
             if row["quantity"] == "query [us]" and row["method"] in ("paper-spans", "paper-cones")]
    return f"{n.time(max(found)[1])} at the median and {n.time(max(found)[0])} at most" if found else "not measured"


FIGURES = {
    "arguments": arguments, "one spring": one_spring, "all pairs": all_pairs, "changes of the proxy's force": proxy_changes,
    "onset": onset, "onset, verdict": onset_verdict, "law as printed": printed_law, "centre of the box": box_centre,
    "centre of the box, verdict": box_verdict, "cutoff sweep": cutoff, "cutoff sweep, verdict": cutoff_verdict, "triangle sweep": triangles,
    "triangle sweep, verdict": triangles_verdict, "smallest sizes": smallest_sizes, "largest size of the paper's": paper_sizes,
    "longest answer of the paper's": longest_answer,
}
