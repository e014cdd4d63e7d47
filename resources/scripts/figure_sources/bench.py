"""Tables and figures of tests/bench/results/README.md."""

import common as c
import fronts
import numbers_text as n
import provenance

METHOD_COLUMNS = ("p50_us", "p99_us", "max_us")
# "exact" is said of the whole set alone (glossary): this one drops minima.
METHOD_NAMES = {"exact grouped": "grouped (`exact grouped` in the file)"}
SKIP_NAMES = {
    "features": "features that can carry no minimum", "barriers": "barriers that cannot be there, as bodies are apart",
    "broad-phase": "1,000 parts out of reach", "still-ticks": "minima of a tick at rest",
    "lists": "searches, by lists from the other thread", "instances": "99 of 100 equal geometries",
    "laziness": "hierarchies of 97 hidden parts of 100", "cache": "parsing and building of files read before",
    "frames": "frames without change",
}


def _us(value):
    """A time in us without its unit, which stands in the table's caption."""
    return n.plain(value)


def _queried(results):
    """(file, scene) of the pairs of the tables of queries."""
    paper, generated = results.bench("query_paper"), results.bench("query_generated")
    return [(paper, f"paper-{pair}") for pair in c.PAIRS] + [(paper, "scan-bunny-armadillo"), (generated, "organic-70k"),
                                                             (generated, "organic-1m"), (results.bench("query_flats"), "peg-hole")]


def queries(results):
    rows = []
    for table, scene in _queried(results):
        cold, tracked, fcl = ({"scene": scene, "method": m} for m in ("nearfit-cold", "nearfit-tracked", "fcl-seeded"))
        sizes = [n.count(table.number(column, **cold)) for column in ("scene_triangles", "part_triangles")]
        rows.append([f"{scene} ({sizes[0]}, {sizes[1]})", *(_us(table.number(k, **cold)) for k in METHOD_COLUMNS),
                     *(_us(table.number(k, **tracked)) for k in ("p50_us", "p99_us", "p99_9_us", "max_us")),
                     n.count(table.number("count_max", **cold)), *(_us(table.number(k, **fcl)) for k in METHOD_COLUMNS)])
    return n.table(["pair (triangles)", "searched anew: p50", "p99", "max", "tracked: p50", "p99", "p99.9", "max",
                    "minima at most", "FCL, min distance alone: p50", "p99", "max"], rows)


# Goals of a query, in times as fast as FCL at p50 and p99; and of p99.9 of the tracked pair of a million triangles [us].
QUERY_GOALS = {"nearfit-cold": ("searched anew", 4.0), "nearfit-tracked": ("tracked", 25.0)}
MAX_MILLION = 200.0


def query_goals(results):
    """Times of FCL in times of each pair's queries; bold where a goal is missed."""
    rows = []
    for table, scene in _queried(results):
        cells = []
        for method, (_, goal) in QUERY_GOALS.items():
            for p in ("p50_us", "p99_us"):
                ratio = table.number(p, scene=scene, method="fcl-seeded") / table.number(p, scene=scene, method=method)
                cells.append(n.plain(ratio) if ratio >= goal else f"**{n.plain(ratio)}**")
        rows.append([f"`{scene}`", *cells])
    head = [f"{words}: p50, goal {goal:g}" if p == "p50" else f"p99, goal {goal:g}" for words, goal in QUERY_GOALS.values() for p in ("p50", "p99")]
    return n.table(["times FCL takes as long", *head], rows)


def query_goals_verdict(results):
    """Who misses which goal, and the tail of the largest pair."""
    said = []
    for method, (words, goal) in QUERY_GOALS.items():
        for p in ("p50", "p99"):
            missed = [f"`{scene}`" for table, scene in _queried(results)
                      if table.number(f"{p}_us", scene=scene, method="fcl-seeded") < goal * table.number(f"{p}_us", scene=scene, method=method)]
            if missed:
                said.append(f"{words}, {p}: {n.listed(missed)}")
    tail = results.bench("query_generated").number("p99_9_us", scene="organic-1m", method="nearfit-tracked")
    return ((f"Missed are: {'; '.join(said)}." if said else "All are met.") + f" The goal of 200 us at p99.9 for `organic-1m` tracked is "
            + (f"met, with {n.time(tail)}." if tail <= MAX_MILLION else f"missed, with {n.time(tail)}."))


def flats(results):
    """Queries of merged flats, beside FCL on the same triangles."""
    table = results.bench("query_flats")
    cold, tracked, seeded, unseeded = (n.time(table.number("p50_us", scene="peg-hole", method=m))
                                       for m in ("nearfit-cold", "nearfit-tracked", "fcl-seeded", "fcl"))
    sizes = [n.count(table.number(column, scene="peg-hole", method="fcl")) for column in ("scene_triangles", "part_triangles")]
    return (f"of {n.listed(sizes)} triangles, takes {cold} at p50 searched anew and {tracked} tracked; FCL takes {seeded}, and "
            f"{unseeded} without the bound from its last answer")


def pairs_that_miss(results):
    """The six pairs against the goal of a whole tick, at each speed."""
    table, said = results.bench("feel"), []
    for run in ("0.1 m/s", "1 m/s"):
        missed = []
        for pair in c.PAIRS:
            where = {"group": "cost", "scene": f"paper-{pair}", "run": run, "quantity": "tick [us]"}
            times = [table.number(p, **where) for p in ("p50", "p99")]
            if any(time > goal for time, goal in zip(times, c.TICK_GOALS)):
                missed.append(f"{c.pair_name(pair)} ({n.time(times[0])} at p50, {n.time(times[1])} at p99)")
        said.append(f"at {run} " + (f"{n.listed(missed)} {'misses' if len(missed) == 1 else 'miss'} it" if missed else "all meet it"))
    return "; ".join(said)


def million(results):
    table = results.bench("build")
    rows = []
    for method, what in (("nearfit-tree", "hierarchy"), ("fcl", "FCL's hierarchy"),
                         ("nearfit-cache-write", "mesh and hierarchy to the cache"),
                         ("nearfit-cache-query", "from the cache, and a first query")):
        where = {"mesh": "organic-1m", "method": method}
        rows.append([what, n.time(1e6 * table.number("least_s", **where)), n.time(1e6 * table.number("median_s", **where)),
                     n.plain(table.number("bytes_per_triangle", **where))])
    return n.table([f"{n.count(table.number('triangles', mesh='organic-1m', method='fcl'))} triangles, machine "
                    f"{c.machine_letter(table)}", "least", "median", "bytes a triangle"], rows)


def far_parts(results):
    table = results.bench("scene")
    rows = []
    for row in table.where():
        if row["parts"] == "alone":
            continue
        rows.append([f"{row['scene']}, {n.count(float(row['other_parts']) - 1)}",
                     *(f"x {n.times(float(row[f'{p}_ratio']))}" for p in ("p50", "p99", "mean")),
                     n.time(float(row["tick_max_us"])),
                     n.time(table.number("tick_max_us", scene=row["scene"], parts="alone"))])
    return n.table(["other parts far away", "tick against the parts alone: p50", "p99", "mean", "longest tick", "longest alone"], rows)


def ticks(results):
    table = results.bench("feel")
    rows = []
    for pair in c.PAIRS:
        cells = []
        for run in ("0.1 m/s", "1 m/s"):
            where = {"group": "cost", "scene": f"paper-{pair}", "run": run}
            for quantity in ("tick [us]", "springs' tick [us]"):
                cells += [_us(table.number(p, quantity=quantity, **where)) for p in ("p50", "p99", "max")]
        rows.append([c.pair_name(pair), *cells])
    return n.table(["proxy's tick, then that of springs", "0.1 m/s: p50", "p99", "max", "springs: p50", "p99", "max",
                    "1 m/s: p50", "p99", "max", "springs: p50", "p99", "max"], rows)


def conforming_ticks(results):
    table = results.bench("feel")
    rows = []
    for scene, name in c.CONFORMING.items():
        cells = [_us(table.number(p, group="cost", scene=scene, run="conforming", quantity=quantity))
                 for quantity in ("tick [us]", "springs' tick [us]") for p in ("p50", "p99", "max")]
        rows.append([name, *cells])
    return n.table(["conforming parts, tick with queries", "p50", "p99", "max", "springs: p50", "p99", "max"], rows)


def ticks_verdict(results):
    """Who misses the goal of a whole tick, by name."""
    table = results.bench("feel")
    missed = []
    runs = [(f"paper-{pair}", run, f"{c.pair_name(pair)} at {run}") for run in ("0.1 m/s", "1 m/s") for pair in c.PAIRS]
    runs += [(scene, "conforming", name) for scene, name in c.CONFORMING.items()]
    for scene, run, name in runs:
        where = {"group": "cost", "scene": scene, "run": run, "quantity": "tick [us]"}
        over = [p for p, goal in zip(("p50", "p99"), c.TICK_GOALS) if table.number(p, **where) > goal]
        if over:
            missed.append(f"{name} ({', '.join(over)})")
    return f"Of {len(runs)} runs {len(missed)} miss the goal: {'; '.join(missed)}." if missed else "All meet the goal."


MODES = {"proxy": "proxy", "spring": "springs", "grouped": "springs, one for each area", "printed": "printed law"}


def _felt(table, scene, mode, way, quantity, column="max"):
    return table.number(column, group="smoothness", scene=scene, run=f"{mode} {way}", quantity=quantity)


def smoothness(results):
    """The lesser of both refined ways, slower and at the same speed, where a mode has both."""
    table = results.bench("feel")
    rows = []
    for scene, name in c.CONFORMING.items():
        for mode, words in MODES.items():
            cells = [n.times(c.refined(table, scene, mode, f"{kind} change ratio", p)) for kind in ("force", "torque")
                     for p in ("p50", "p99", "max")]
            rows.append([name if mode == "proxy" else "", words, *cells])
    return n.table(["", "mode", "force: median", "p99", "largest", "torque: median", "p99", "largest"], rows, right_from=2)


def births(results):
    """Jumps of the springs' modes where a minimum comes or goes within the cutoff."""
    table = results.bench("feel")
    rows = []
    for scene, name in c.CONFORMING.items():
        cells = []
        for mode in ("spring", "grouped", "printed"):
            force = _felt(table, scene, mode, "x1", "force [N]")
            jumps = [_felt(table, scene, mode, way, "force change [N]") for way in ("x1", "x10")]
            cells += [f"{n.plain(jump)} ({n.plain(100 * jump / force)} %)" for jump in jumps]
        rows.append([name, *cells])
    return n.table(["largest change of force in a tick [N] (of the mode's largest force)", "springs", "10 times slower", "one for each area",
                    "10 times slower", "printed law", "10 times slower"], rows)


def _against_the_sum(table, way):
    """(less, as large, larger): scenes with the largest change of one spring for each area, and of the sum; 5 % is as large."""
    kinds = ([], [], [])
    for scene, name in c.CONFORMING.items():
        grouped, summed = (_felt(table, scene, mode, way, "force change [N]") for mode in ("grouped", "spring"))
        kind = 0 if grouped < 0.95 * summed else 2 if grouped > 1.05 * summed else 1
        kinds[kind].append(name if kind == 1 else f"{name} ({n.plain(grouped)} for {n.plain(summed)} N)")
    return kinds


def grouped_jumps(results):
    """Largest change of force in a tick with one spring for each area, against that of the sum."""
    table = results.bench("feel")
    said = []
    for way, words in (("x10", "On the refined way"), ("x1", "on the plain one")):
        parts = [f"{word} on {n.listed(scenes)}" for word, scenes in zip(("less", "as large", "larger"), _against_the_sum(table, way)) if scenes]
        said.append(f"{words} it is {', '.join(parts)}")
    less_fallen = []
    for scene, name in c.CONFORMING.items():
        grouped, summed = (_felt(table, scene, mode, "x10", "force change ratio", "p99") for mode in ("grouped", "spring"))
        if grouped < 0.95 * summed:
            less_fallen.append(f"{name} ({n.times(grouped)} for {n.times(summed)} times)")
    return f"{'; '.join(said)}." + (f" Refined ten times, the change at p99 falls less than that of the sum on {n.listed(less_fallen)}."
                                    if less_fallen else "")


def skips(results):
    table = results.bench("skips")
    rows, last = [], ""
    for row in table.where():
        name = SKIP_NAMES.get(row["skip"], row["skip"])
        memory = ["", ""]
        if float(row["without_bytes"]) > 0:
            memory = [f", {n.plain(1e-6 * float(row[f'{side}_bytes']))} MB" for side in ("with", "without")]
        sides = [f"{n.time(float(row[f'{side}_p50_us']))}{size}" for side, size in zip(("with", "without"), memory)]
        rows.append(["" if name == last else name, f"{row['where']}, {row['of']}", *sides, n.times(float(row["p50_ratio"])),
                     n.times(float(row["p99_ratio"]))])
        last = name
    return n.table(["not computed", "where", "with the skip, p50", "without", "times, p50", "p99"], rows, right_from=2)


def _window_checks(row):
    """(name, value, goal, unit) of each goal of a row of window.csv. Older files have a goal for one column only."""
    checks = [(row["goal_of"], row.get(row["goal_of"]), row["goal"], row["unit"]),
              ("p99.9", row["p999"], row.get("goal_p999"), row["unit"]),
              ("ticks left out", row.get("left_out"), row.get("goal_left_out"), "")]
    # No ticks left out is a goal; a time of 0 is none.
    return [check for check in checks if check[1] and check[2] and (not check[3] or float(check[2]) > 0)]


def missed_of_window(row):
    """Goals of a row of window.csv that are missed, a few words each."""
    return [f"{name} {n.plain(float(value))} {unit}".rstrip() + f" ({n.plain(float(goal))})" for name, value, goal, unit in _window_checks(row)
            if float(value) > float(goal)]


def _window_goals(row):
    """Goals of a row of window.csv and if they are met."""
    said = []
    for name, value, goal, unit in _window_checks(row):
        verdict = "met" if float(value) <= float(goal) else "**missed**"
        said.append(f"{verdict}: {n.beside_goal(value, goal, unit)}{name} {n.plain(float(goal))} {unit}" if unit else
                    f"{verdict}: {name} {n.count(float(goal))}")
    return "; ".join(said)


def window(results):
    table = results.bench("window")
    counts = "left_out" in table.columns
    rows = []
    for row in table.where():
        rows.append([f"`{row['figure']}`", row["way"], row["unit"], *(n.plain(float(row[p])) for p in ("p50", "p99", "p999", "max")),
                     *([row["left_out"]] if counts else []), _window_goals(row), row["remark"]])
    return n.table(["figure", "way", "unit", "p50", "p99", "p99.9", "max", *(["ticks left out"] if counts else []), "goal", "remark"], rows,
                   right_from=10)


def _dense_groups(results, group):
    table = results.bench("dense")
    scenes = []
    for row in table.where(group=group):
        if row["scene"] not in scenes:
            scenes.append(row["scene"])
    return table, scenes


def dense(results):
    table, scenes = _dense_groups(results, "dense")
    rows = []
    for scene in scenes:
        where = {"group": "dense", "scene": scene}
        ratios = {run["run"]: float(run["p99"]) for run in table.where(quantity="p99 over that of x1", **where)}
        even = max(v for k, v in ratios.items() if "uneven" not in k)
        uneven = max(v for k, v in ratios.items() if "uneven" in k)
        rows.append([scene, n.time(max(table.numbers("p99", quantity="tick [us]", **where))),
                     n.time(max(table.numbers("max", quantity="tick [us]", **where))), n.times(even), n.times(uneven),
                     f"{max(table.numbers('max', quantity='off the pose of x1 [um]', **where)):.0e} um",
                     n.count(max(table.numbers("max", quantity="ticks truncated", **where)))])
    return n.table(["scene, worst of all cuts", "tick: p99", "max", "p99 against x1: finer", "at random places",
                    "off the pose of x1", "ticks that leave out minima"], rows)


def curved(results):
    table, scenes = _dense_groups(results, "curved")
    rows = []
    for scene in scenes:
        for row in table.where(group="curved", scene=scene, quantity="tick [us]"):
            where = {"group": "curved", "scene": scene, "run": row["run"]}
            rows.append([f"{scene}, {row['run']}", *(n.time(float(row[p])) for p in ("p50", "p99", "max")),
                         n.times(table.number("p99", quantity="p99 over that of x1", **where)),
                         f"{n.count(table.number('max', quantity='ticks truncated', **where))} of {row['samples']}"])
    return n.table(["scene", "tick: p50", "p99", "max", "p99 against x1", "ticks that leave out minima"], rows)


def feel_million(results):
    table = results.bench("feel_million")
    rows = []
    for row in table.where(group="cost"):
        if row["quantity"].endswith("tick [us]"):
            rows.append([f"{row['run']}, {row['quantity'].removesuffix(' [us]')}",
                         *(n.time(float(row[p])) for p in ("p50", "p99", "p99_9", "max"))])
    return n.table(["two surfaces of a million triangles", "p50", "p99", "p99.9", "max"], rows)


def sources_note(results):
    """The files of a busy machine, in a sentence."""
    notes = [f"`{table.file.rsplit('/', 1)[1]}` ({provenance.note(table)})"
             for table in map(results.table, provenance.result_files(results)) if provenance.note(table)]
    return f"Not to be repeated as they are, until measured anew: {', '.join(notes)}." if notes else "All can be repeated."


def _force_error(results, method):
    return n.span(results.bench("error").numbers("force_rms", pair="sphere-bowl", method=method))


def bowl(results):
    table = results.bench("error")
    rows = []
    for method in ("exact cold", "exact tracked", "exact grouped", "normal span", "points in field 32", "points in field 64",
                   "points in field 128", "decimated 4x", "decimated 16x"):
        where = {"pair": "sphere-bowl", "method": method}
        rows.append([METHOD_NAMES.get(method, method), _force_error(results, method), n.span(table.numbers("p50_us", **where)),
                     n.span(table.numbers("missed", **where)), n.span(table.numbers("extra", **where))])
    return n.table(["ball in a bowl, all finenesses", "force, rms error [N of 1 N]", "p50 [us]", "missed a pose",
                    "extra a pose"], rows)


def _holders(results, column):
    """Methods on the fronts of the solids, among those that miss no minimum, by the number of pairs."""
    table = results.bench("error")
    pairs = list(dict.fromkeys(row["pair"] for row in table.where()))
    counts = {}
    for pair in pairs:
        points = [(float(row["p50_us"]) + float(row["aside_us"]), float(row[column]), METHOD_NAMES.get(row["method"], row["method"]))
                  for row in table.where(pair=pair) if float(row["missed"]) == 0 and not fronts.is_only_measured(row["method"])]
        for method in {point[2] for point in fronts.front(points)}:
            counts[method] = counts.get(method, 0) + 1
    ordered = sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    return f"{n.listed([f'*{method}* on {count}' for method, count in ordered])} of {len(pairs)} pairs"


def holders_of_distance(results):
    return _holders(results, "distance_rms_m")


def holders_of_force(results):
    return _holders(results, "force_rms")


def grouped_in_bowl(results):
    """The error of the grouped force at the coarsest and the finest mesh, and the minima that it keeps too many."""
    rows = sorted(results.bench("error").where(pair="sphere-bowl", method="exact grouped"), key=lambda row: float(row["fineness"]))
    force, extra = ([float(row[column]) for row in (rows[0], rows[-1])] for column in ("force_rms", "extra"))
    sums = _force_error(results, "exact cold")
    return (f"off by {n.plain(force[0])} N on the coarsest mesh and by {n.plain(force[1])} N on the finest, with {n.plain(extra[0])} and "
            f"{n.plain(extra[1])} minima a pose too many, where the sum is off by {sums} N at all finenesses")


FIGURES = {
    "queries": queries, "queries against their goals": query_goals, "queries that miss": query_goals_verdict,
    "queries of flats": flats, "pairs that miss": pairs_that_miss, "build of a million": million, "far parts": far_parts,
    "ticks": ticks, "conforming ticks": conforming_ticks, "ticks that miss": ticks_verdict, "smoothness": smoothness,
    "births": births, "jumps of one for each area": grouped_jumps, "skips": skips, "all of window": window,
    "dense flats": dense, "curved faces": curved, "felt million": feel_million, "stale files": sources_note,
    "fronts of distance": holders_of_distance, "fronts of force": holders_of_force, "force in the bowl": bowl, "grouped in the bowl": grouped_in_bowl,
}
