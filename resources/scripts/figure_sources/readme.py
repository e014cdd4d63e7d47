"""Tables and figures of README.md."""

import re

import bench
import common as c
import numbers_text as n
import provenance
import scenes
import scripting
import springs


def _revision_rows(results):
    groups = {}
    for file in provenance.result_files(results):
        table = results.table(file)
        revision = table.head.get("revision", "")[:12]
        if not revision and "revision" in table.columns:  # A scene may have been run anew by itself.
            revision = ", ".join(sorted({row["revision"] for row in table.rows}))
        date = table.head.get("date", "not said")[:10]
        key = (date, revision or "not said", c.machine_letter(table), provenance.compiler(table) or "not said")
        groups.setdefault(key, []).append(table)
    return groups


def sources(results):
    """Which files are of which revision, day, processor, compiler and load."""
    rows = []
    for (date, revision, letter, compiler), tables in sorted(_revision_rows(results).items()):
        names = []
        for table in tables:
            folder, name = table.file.split("/")[1], table.file.rsplit("/", 1)[1]
            note = provenance.note(table)
            names.append(f"{folder}/{name}" + (f" (**{note}**)" if note else ""))
        loads = [float(load.split()[0]) for load in map(provenance.load, tables) if load]
        if not loads and "load" in tables[0].columns:
            loads = tables[0].numbers("load")
        rows.append([f"`{revision}`", date, letter, compiler, n.span(loads) if loads else "not said", ", ".join(names)])
    return n.table(["revision", "date", "machine", "compiler", "load before", "files"], rows, right_from=9)


def machines(results):
    """Each machine by the heads of its files, a sentence each."""
    said = {}
    for file in provenance.result_files(results):
        table = results.table(file)
        letter = c.machine_letter(table)
        name = re.search(r"AMD [A-Za-z0-9 ]*[A-Za-z0-9]|Intel[^(,]*", provenance.machine(table).replace("(R)", ""))
        said.setdefault(letter, set()).add(f"{provenance.processors(table)} processors of an "
                                           f"{name.group().strip() if name else 'unknown model'}")
    return "; ".join(f"**{letter}**: {', '.join(sorted(kinds))} {c.MACHINES[letter]}"
                     for letter, kinds in sorted(said.items())) + "."


def _timed(what, table, values, verdict):
    return [what, c.machine_letter(table), *map(n.time, values), verdict]


def _tick_verdict(values):
    return n.verdict((("p50", values[0], c.TICK_GOALS[0]), ("p99", values[1], c.TICK_GOALS[1])))


def _felt_ticks(results):
    feel, million = results.bench("feel"), results.bench("feel_million")
    columns = ("p50", "p99", "max")
    rows = []

    def add(what, table, conditions):
        values = c.worst(table, columns, conditions)
        rows.append(_timed(what, table, values, _tick_verdict(values)))

    add("whole tick in contact at 0.1 m/s, worst of [six pairs](tests/bench/results/README.md#queries)", feel,
        c.paper_ticks("0.1 m/s"))
    add("the same at 1 m/s", feel, c.paper_ticks("1 m/s"))
    for scene, name in c.CONFORMING.items():
        add(name, feel, c.tick_rows("conforming", [scene]))
    springs = c.paper_ticks("0.1 m/s", "springs' tick [us]") + c.paper_ticks("1 m/s", "springs' tick [us]")
    add("springs' mode, worst of the six pairs at both speeds", feel, springs)
    add("springs' mode, worst of the conforming parts above", feel,
        c.tick_rows("conforming", c.CONFORMING, "springs' tick [us]"))
    for speed in ("0.1 m/s", "1 m/s"):
        add(f"two blobs of a million triangles each, {speed}", million, c.tick_rows(speed, ["organic-1m"]))
    return rows


def _evidence_ticks(results):
    table = results.evidence()
    columns = ("tick_us_p50", "tick_us_p99", "tick_us_max")
    rows = []
    hostile = [row["scene"] for row in table.rows if row["scene"].startswith("pair-")]
    led = [row["scene"] for row in table.rows if not row["scene"].startswith(("pair-", "nut-engaged", "gear-"))]
    for what, scenes in (("nut engaged on its bolt, 0.02 mm margin", ["nut-engaged"]),
                         ("gear onto its shaft and into mesh", ["gear-base"]),
                         (f"{len(led)} other led scenes, worst", led),
                         (f"hostile hand, worst of {len(hostile)} pairs", hostile)):
        values = c.worst(table, columns, [{"scene": s} for s in scenes])
        rows.append(_timed(f"[evidence](tests/evidence/results/README.md): {what}", table, values, _tick_verdict(values)))
    return rows


def _queries(results):
    paper, generated = results.bench("query_paper"), results.bench("query_generated")
    columns = ("p50_us", "p99_us", "max_us")
    rows = []
    for method, name in (("nearfit-cold", "exact set of minima, searched anew"),
                         ("nearfit-tracked", "the same, tracked as in a tick; the search ahead is not in it"),
                         ("fcl-seeded", "FCL, min distance alone")):
        values = c.worst(paper, columns, [{"scene": f"paper-{pair}", "method": method} for pair in c.PAIRS])
        rows.append(_timed(f"{name}, worst of six pairs", paper, values, ""))
    fcl = generated.numbers("p50_us", scene="organic-1m", method="fcl-seeded")[0], generated.numbers(
        "p99_us", scene="organic-1m", method="fcl-seeded")[0]
    for method, name, goal in (("nearfit-cold", "exact set, searched anew", 4), ("nearfit-tracked", "the same, tracked", 25),
                               ("fcl-seeded", "FCL, min distance alone", 0)):
        where = {"scene": "organic-1m", "method": method}
        values = [generated.number(column, **where) for column in columns]
        ratios = [fcl[i] / values[i] for i in (0, 1)]
        said = ""
        if goal:
            short = [p for p, ratio in zip(("p50", "p99"), ratios) if ratio < goal]
            said = (f"**missed** at {' and '.join(short)}" if short else "met") + (
                f": {n.plain(ratios[0])} and {n.plain(ratios[1])} times as fast as FCL, goal {goal} times")
        rows.append(_timed(f"two blobs of a million triangles each: {name}", generated, values, said))
    return rows


def _far_parts(results):
    table = results.bench("scene")
    far = [row for row in table.where() if row["parts"] != "alone"]
    ratios = [[float(row[f"{p}_ratio"]) for row in far] for p in ("p50", "p99")]
    alone = max(table.numbers("tick_max_us", parts="alone"))
    longest = max(float(row["tick_max_us"]) for row in far)
    return [["1,000 and 10,000 other parts far away, tick against without", c.machine_letter(table),
             *(f"x {n.span(r, n.times)}" for r in ratios), n.time(longest), f"without {n.time(alone)} at most"]]


def _round_trip(results):
    table = results.table("tests/usb/results/round_trip.csv")
    values = [max(table.numbers(column)) for column in ("p50", "p99", "max")]
    runs = len(table.where())
    return [_timed(f"report of an emulated device to its wrench, worst of {runs} runs{c.stale(table)}", table, values,
                   _tick_verdict(values))]


def fast(results):
    rows = (_felt_ticks(results) + _evidence_ticks(results) + _queries(results) + _far_parts(results) + _round_trip(results))
    return n.table(["what", "machine", "p50", "p99", "max", "goal"], rows, right_from=9)


def _window_row(table, what, drawn, figure, way):
    where = {"figure": figure, "way": way}
    scale = 1e3 if table.text("unit", **where) == "ms" else 1.0
    values = {p: table.number(p, **where) for p in ("p50", "p99", "max")}
    goal_of, goal = table.text("goal_of", **where), table.number("goal", **where)
    said = ""
    if goal_of:
        is_met = values[goal_of] <= goal
        more = n.beside_goal(values[goal_of], goal, table.text("unit", **where))
        said = f"{'met' if is_met else '**missed**'} ({more}{goal_of} {n.time(scale * goal)})"
    return [what, drawn, *(n.time(scale * values[p]) for p in ("p50", "p99", "max")), said]


def _full_row(table, what, figure, way):
    """Our own view with nothing left out; older files lack it."""
    if not any(row["figure"] == figure and row["way"] == way for row in table.rows):
        return [what, "all", "not measured yet", "", "", ""]
    drawn, _ = c.drawn(table, figure=figure, way=way)
    return _window_row(table, what, n.count(drawn), figure, way)


def window(results):
    """Frame figures with what was drawn, and the same meshes in full beside them."""
    table = results.bench("window")
    turning = c.the_way(table, "frame", "1")
    total = c.sizes_in(turning)
    some, _ = c.drawn(table, figure="frame", way=turning)
    large = c.the_way(table, "large", "frame; 1")
    some_large, all_large = c.drawn(table, figure="large", way=large)
    hits = int(re.match(r"\d+", table.text("remark", figure="pick", way=c.the_way(table, "pick", "1"))).group())
    picks = int(table.number("count", figure="pick", way=c.the_way(table, "pick", "1")))
    rows = [
        _window_row(table, "start", "", "start", "until it has drawn and answers"),
        _window_row(table, f"picture while a scene of {n.count(total)} triangles turns, servo running", n.count(some), "frame",
                    turning),
        _full_row(table, "the same at full detail, servo running", "frame", "full detail; servo runs"),
        _window_row(table, "the same meshes in plain VTK, no servo", "all", "frame", "plain VTK; no servo"),
        _window_row(table, f"picture while {n.count(all_large)} triangles turn", n.count(some_large), "large", large),
        _full_row(table, "the same at full detail", "large", "frame; full detail"),
        _window_row(table, "the same meshes in plain VTK", "all", "large", "frame; plain VTK"),
        _window_row(table, "an event's wait in that scene", "", "large", "an event's wait"),
        _window_row(table, f"pick among a million triangles; {n.count(hits)} of {n.count(picks)} hit, so that the median is of a miss",
                    "", "pick", c.the_way(table, "pick", "1")),
    ]
    return n.table(["what, on machine " + c.machine_letter(table), "triangles and lines of edges drawn", "p50", "p99", "max", "goal"], rows,
                   right_from=9)


def hierarchy(results):
    table = results.bench("build")
    where = {"mesh": "organic-1m", "method": "nearfit-tree"}
    return (f"A hierarchy of {n.count(table.number('triangles', **where))} triangles takes {n.plain(table.number('median_s', **where))} s "
            f"to build on {provenance.processors(table)} processors of machine {c.machine_letter(table)} (median; "
            f"{n.plain(table.number('bytes_per_triangle', **where))} bytes a triangle).")


def _oracle(results):
    text = results.text("tests/stress/results/oracle.txt")
    rows = re.findall(r"^(\d+) poses of (\d+) pairs.*?: (\d+) minima.*?(\d+) differences", text, re.MULTILINE)
    poses, found, differences = (sum(int(row[i]) for row in rows) for i in (0, 2, 3))
    return poses, int(rows[0][1]), found, differences


def _meeting(results):
    feel = results.bench("certified")
    benchmark = feel.numbers("samples", quantity="poses that meet")
    evidence, hand = results.evidence(), results.stress("hand")
    met = (sum(feel.numbers("max", quantity="poses that meet")) + sum(evidence.numbers("poses_met")) +
           sum(hand.numbers("meetings")))
    return sum(benchmark), sum(evidence.numbers("poses_certified")), sum(hand.numbers("certified")), met


def accurate(results):
    poses, pairs, found, differences = _oracle(results)
    queries = [results.bench(name) for name in ("query_paper", "query_generated", "query_flats")]
    off = max(max(table.numbers("worst_difference_m")) for table in queries)
    benchmark, evidence, stress, met = _meeting(results)
    margins = sorted((float(row["least_distance_margins"]), row["scene"]) for row in results.evidence().where())
    error = results.bench("error")
    force = error.numbers("force_rms", pair="sphere-bowl", method="exact tracked")
    field = n.span(error.numbers("force_rms", pair="sphere-bowl", method="points in field 32"))
    rows = [
        ["Is every minimum found, and none made up?",
         f"{n.count(poses)} poses of {pairs} pairs, damaged meshes too, against brute force and rational arithmetic",
         f"{n.count(differences)} differences in {n.count(found)}"],
        ["Is the min distance right?", "every pose of the query benchmark, against FCL", f"largest difference {off:.0e} m"],
        ["Does the part ever meet another one?",
         f"exact predicates at {n.count(benchmark)} poses of the benchmark, {n.count(evidence)} of the "
         f"[evidence](tests/evidence/README.md), {n.count(stress)} of the [stress runs](tests/stress/README.md)",
         f"at {n.count(met) if met else 'none'}"],
        ["Does contact hold at the margin?", f"min distance in {len(margins)} scenes of real parts (evidence)",
         f"**{margins[0][0]:.2f}** margins at worst ({margins[0][1]}), then {margins[1][0]:.2f} ({margins[1][1]}), "
         f"{margins[2][0]:.2f} ({margins[2][1]}); median {margins[len(margins) // 2][0]:.2f}"],
        ["How far is a mesh off its solid?",
         "solids with known minima, meshed ever finer ([error.md](tests/bench/results/error.md))",
         "distance: falls as the square of the edge; resting place: as the edge"],
        ["Does the paper's sum of springs converge?",
         f"the same solids, force of a ball in a bowl{c.stale(error)}",
         f"**no**: off by {n.span(force)} of a spring's max force, at any fineness; points in a field of 32 cells by {field}"],
    ]
    return n.table(["question", "checked how", "result"], rows, right_from=9)


# Energy that the adversarial hand may gain [J], and drift of the servo in hours [m]: the bounds of tests/stress.
MAX_GAIN, MAX_DRIFT = 0.1, 2e-7


def stable(results):
    rest, hand, limit, hours = (results.stress(name) for name in ("rest", "hand", "limit", "hours"))
    steady, rough = (
        (max(rest.numbers("handle rms um", rough=r)), max(rest.numbers("force rms mN", rough=r))) for r in ("0", "1"))
    at_rest = sum(rest.numbers("at rest"))
    moving = sorted({c.stress_scene(row["scene"]) for row in rest.where() if row["at rest"] == "0"})
    periods = rest.numbers("period ms")
    restless = [row for row in results.evidence().where() if int(row["ticks_at_rest_that_step"]) > 0]
    steps = "; ".join(f"{row['scene']}: steps in {n.count(int(row['ticks_at_rest_that_step']))} of "
                      f"{n.count(int(row['ticks_at_rest']))} ticks, noise {n.plain(float(row['rest_noise_N']))} N"
                      for row in restless)
    noisy = [float(row["rest_noise_N"]) for row in results.evidence().where()
             if row not in restless and float(row["rest_noise_N"]) > 0]
    gain = max(float(row["energy gain J"]) for row in hand.where() if row["scene"] != "huge")
    huge = hand.number("energy gain J", scene="huge")
    ratio = limit.numbers("simulated by enforced")
    drift = max(abs(v) for column in ("free drift m", "contact drift m", "late drift m", "force drift N")
                for v in hours.numbers(column))
    rows = [
        [f"Does a pressed part rest? {n.count(len(rest.where()))} trials, periods of {n.span(periods)} ms",
         f"{n.plain(steady[0])} um and {n.plain(steady[1])} mN; with uneven periods {n.plain(rough[0])} um and {n.plain(rough[1])} mN",
         f"**missed** in {n.count(len(rest.where()) - at_rest)} trials, all of {n.listed(moving)}" if moving else "met"],
        [f"And real parts ({len(results.evidence().rows)} scenes of the evidence, open sheets among them)?",
         f"{steps}; {len(noisy)} others have noise of up to {n.plain(max(noisy))} N without a step" if noisy else steps,
         "**missed** by " + ", ".join(row["scene"] for row in restless) if restless else "met"],
        [f"Does a hand gain energy? {n.count(sum(hand.numbers('ticks')))} adversarial ticks",
         f"{n.plain(gain)} J of the 0.1 J allowed; the kilometre scene, {n.plain(huge)} J, is left out",
         "met" if gain <= MAX_GAIN else "**missed**"],
        ["Is the enforced stiffness below the limit of stability?",
         f"the simulated limit is {min(ratio):.3f} to {n.plain(max(ratio))} times as high",
         "met" if min(ratio) > 1.0 else "**missed**"],
        [f"Does it drift? {1e-3 * sum(hours.numbers('ticks')) / 3600:g} simulated hours, {n.count(sum(hours.numbers('ticks')))} ticks",
         f"{'none' if drift == 0 else f'up to {n.plain(drift)}'}; memory grows by {n.plain(max(hours.numbers('growth bytes')) / 1024)} KiB",
         "met" if drift <= MAX_DRIFT else "**missed**"],
        *scenes.readme_hour_row(results),
        ["Is the force smooth? On a path refined 10 times, change per tick falls 10 times", *_smoothness(results)],
        ["And in the springs' mode?", *springs.readme_row(results)],
    ]
    return n.table(["question", "worst case", "verdict"], rows, right_from=9)


def _smoothness(results):
    table = results.bench("feel")
    said, missed = [], []
    for p, name in (("p99", "p99"), ("max", "largest")):
        ratios = sorted((c.refined(table, scene, "proxy", "force change ratio", p), scene) for scene in c.CONFORMING)
        said.append(f"{name}: " + ", ".join(f"{n.times(ratio)} times ({scene})" for ratio, scene in ratios[:2]))
        missed += [scene for ratio, scene in ratios if ratio < 9.0 and scene not in missed]
    return "; ".join(said), f"**missed** by {', '.join(missed)}" if missed else "met"


def wrench_of_the_nut(results):
    table = results.evidence()
    said = [n.time(table.number(f"wrench_us_{p}", scene="nut-engaged")) for p in ("p99", "p99.9", "max")]
    return f"{said[0]} at p99, {said[1]} at p99.9 and {said[2]} at most"


MISSED_FILES = ("tests/bench/results/check.csv", "tests/bench/results/import.csv", "tests/bench/results/window.csv",
                scripting.PYTHON, scripting.SWEEP_COST)


@c.needs(*MISSED_FILES)
def missed_elsewhere(results):
    """Goals that are missed of tables that stand elsewhere, a line for each table."""
    checks = [f"`{row['method']}` on `{row['scene']}`, {row['figure']}: {n.plain(float(row['median']))} ({row['goal']})"
              for row in results.bench("check").where() if row["met"] == "no"]
    documents = [f"`{row['document']}`, {row['figure']}: {scenes.of_unit(float(row['median']), row['unit'])} "
                 f"({scenes.of_unit(float(row['goal']), row['unit'])})" for row in results.bench("import").where() if row["met"] == "no"]
    window = [f"`{row['figure']}`, {row['way']}: {goals}" for row in results.bench("window").where()
              if (goals := ", ".join(bench.missed_of_window(row)))]
    lines = (("[Checks](tests/bench/results/README.md#checks-of-whole-scenes)", checks),
             ("[Documents](tests/bench/results/README.md#documents)", documents),
             ("[The window](tests/bench/results/README.md#the-window)", window),
             ("[Python](resources/docs/python.md)", scripting.missed_of_python(results)),
             ("[Sweeps](resources/docs/sweeps.md)", scripting.missed_of_sweeps(results)))
    said = [f"- {what}: {'; '.join(missed)}." for what, missed in lines if missed]
    return "\n".join(said) if said else "None."


FIGURES = {
    "sources": sources, "machines": machines, "fast": fast, "window": window, "hierarchy of a million": hierarchy,
    "wrench of the nut": wrench_of_the_nut, "missed elsewhere": missed_elsewhere,
    "accurate": accurate, "stable": stable,
}
