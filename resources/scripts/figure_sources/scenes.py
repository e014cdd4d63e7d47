"""Tables of whole scenes and documents: checks, verdicts, paths, suggestions, imports, and the hour with the window open."""

import common as c
import numbers_text as n

UNITS = {"s": 1e6, "ms": 1e3, "us": 1.0}


def _of_unit(value, unit):
    if unit in UNITS:
        return n.time(UNITS[unit] * value)
    return n.plain(value) if unit in ("", "1", "x") else f"{n.plain(value)} {unit}"


def _met(text):
    return "**missed**" if text.lower() == "no" else "met" if text.lower() == "yes" else text


def _goal(row):
    said = _met(row["met"])
    try:
        return f"{said} ({_of_unit(float(row['goal']), row['unit'])})"
    except ValueError:
        return said


@c.needs("tests/bench/results/check.csv")
def checks(results):
    """All figures of the checks; `worst` is the worst of the turns."""
    rows, last = [], ""
    for row in results.bench("check").where():
        name = f"`{row['scene']}` ({n.count(float(row['parts']))} parts, {n.count(float(row['triangles']))} triangles)"
        rows.append(["" if name == last else name, f"`{row['method']}`", row["figure"], _of_unit(float(row["median"]), row["unit"]),
                     _of_unit(float(row["worst"]), row["unit"]), _goal(row), row["remark"]])
        last = name
    return n.table(["scene", "method", "figure", "median", "worst", "goal", "remark"], rows, right_from=9)


def _share(part, whole):
    return f"{n.count(float(part))} of {n.count(float(whole))}"


@c.needs("tests/bench/results/verdicts.csv")
def verdicts(results):
    """Older files have neither depths nor volumes."""
    table = results.bench("verdicts")
    is_full = "depths" in table.columns
    rows = []
    for row in table.where():
        cells = [row["scene"], n.count(float(row["pairs"])), n.count(float(row["agree"])), n.plain(float(row["worst_distance_difference_m"])),
                 *(n.count(float(row[k])) for k in ("clear", "near", "touching", "clashes", "contained"))]
        if is_full:
            cells += [*(_share(row[k], row["depths"]) for k in ("depths_free", "depths_least", "depths_beaten")),
                      f"{_share(row['volumes_by_rays'], row['volumes'])} ({n.plain(100 * float(row['worst_by_rays']))} %)",
                      f"{_share(row['volumes_by_booleans'], row['booleans'])} ({n.plain(float(row['worst_by_booleans']))})"]
        rows.append(cells)
    head = ["scene", "pairs", "agree", "largest difference of distance [m]", "clear", "near", "touching", "clashes", "contained"]
    if is_full:
        head += ["depths that free", "of which less does not", "beaten another way", "volumes by rays (largest difference)",
                 "by Nef polyhedra (the same, relative)"]
    return n.table(head, rows)


def _looks(row):
    """How the looks at random places were decided, of a row of path.csv."""
    parts = [(row["tested"], "by predicates"), (row["measured"], "by a gap measured there"), (row["boxed"], "by boxes apart"),
             (row["argued"], "from a gap before")]
    return ", ".join(f"{n.count(float(value))} {how}" for value, how in parts if float(value) > 0)


@c.needs("tests/bench/results/path.csv")
def paths(results):
    """Older files have no times of processes, nor how the places were looked at."""
    table = results.bench("path")
    is_full = "tested" in table.columns
    rows = []
    for row in table.where():
        cells = [f"`{row['scene']}`", n.count(float(row["poses"])), n.count(float(row["triangles"])),
                 n.time(1e6 * float(row["certified_s"])), n.time(1e6 * float(row["verified_s"])), n.plain(float(row["ratio"]))]
        if is_full:
            processes = [n.time(1e6 * float(row[k])) if row[k] else "-" for k in ("certify_process_s", "verify_process_s")]
            plainly = n.count(float(row["plainly_tested"])) if row["plainly_tested"] else "-"
            cells[3:3] = [n.count(float(row["moving"])), n.count(float(row["others"]))]
            cells += [*processes, _share(row["meetings"], row["places"]), _looks(row), plainly]
        else:
            cells.append(_share(row["meetings"], row["places"]))
        rows.append([*cells, _met(row["met"])])
    head = ["path", "poses", "triangles", *(["parts that move", "others"] if is_full else []), "certified in", "verified in", "ratio",
            *(["`certify`, process", "`verify`, process"] if is_full else []), "places where parts meet",
            *(["looks at these places", "tested once more by predicates alone"] if is_full else []), "goal"]
    return n.table(head, rows)


@c.needs("tests/bench/results/path.csv")
def path_readings(results):
    """Verified "within twice that", read as twice 10 s and as twice the path's own time to certify."""
    rows = [row for row in results.bench("path").where() if row["goal_s"]]
    limit = 2.0 * max(float(row["goal_s"]) for row in rows)
    slowest = max(rows, key=lambda row: float(row["verified_s"]))
    beyond = [row for row in rows if float(row["ratio"]) > 2.0]
    said = "all are" if not beyond else "all are but " + ", ".join(
        f"`{row['scene']}` ({n.plain(float(row['ratio']))} times {n.time(1e6 * float(row['certified_s']))})" for row in beyond)
    met = float(slowest["verified_s"]) <= limit
    return (f'"Verified within twice that" can mean two times. As twice 10 s, which the table goes by, all {len(rows)} paths '
            f"{'are' if met else 'are not'} within it: the slowest takes {n.time(1e6 * float(slowest['verified_s']))}. As twice the time to "
            f"certify the same path, {said}.")


@c.needs("tests/bench/results/suggest.csv")
def suggestions(results):
    """Older files have only the search's own word."""
    table = results.bench("suggest")
    is_full = "verified" in table.columns
    rows = []
    for row in table.where():
        cells = [row["scene"], f"{row['found']} of {row['seeds']}", n.time(1e6 * float(row["p50_s"])), n.time(1e6 * float(row["max_s"]))]
        if is_full:
            methods = {"straight": "straight", "sliding": "sliding", "sliding_trees": "trees by sliding", "connected_trees": "connected trees"}
            by = ", ".join(f"{row[k]} {name}" for k, name in methods.items() if int(row[k]) > 0)
            cells += [*(_share(row[k], row["said_found"]) for k in ("certified", "verified", "free")),
                      _share(row["meetings"], row["tested"]), by or "-"]
        rows.append([*cells, f"{_met(row['met'])} ({row['goal']})"])
    checked = ["certified", "verified", "free", "places that meet", "found by"] if is_full else []
    return n.table(["puzzle", "seeds that find a path", "p50", "longest", *checked, "goal"], rows)


DOCUMENT_FIGURES = ("file to ready to feel", "cache to ready to feel", "OpenCASCADE alone", "ratio to OpenCASCADE",
                    "memory in all a triangle")


@c.needs("tests/bench/results/import.csv")
def documents(results):
    table = results.bench("import")
    rows = []
    for document in dict.fromkeys(row["document"] for row in table.where()):
        mine = {row["figure"]: row for row in table.where(document=document)}
        first = next(iter(mine.values()))
        cells = []
        for figure in DOCUMENT_FIGURES:
            row = mine.get(figure)
            if not row:
                cells.append("-")
                continue
            said = " **missed**" if _met(row["met"]) == "**missed**" else ""
            cells.append(f"{_of_unit(float(row['median']), row['unit'])} ({_of_unit(float(row['max']), row['unit'])}){said}")
        rows.append([f"`{document}`", n.count(float(first["placed_triangles"])), *cells])
    return n.table(["document", "triangles placed", "file to ready: median (max)", "from the cache", "OpenCASCADE alone",
                    "ratio to it", "memory a triangle"], rows)


@c.needs("tests/bench/results/window_hour.csv")
def hour(results):
    """The first, the median and the worst minute of an open window."""
    table = results.bench("window_hour")
    minutes = table.numbers("minute")
    rows = []
    for column, what, unit in (("memory_MB", "resident memory", "MB"), ("late_p50_us", "lateness, p50", "us"),
                               ("late_p99_us", "p99", "us"), ("late_p99_9_us", "p99.9", "us"), ("late_max_us", "max", "us"),
                               ("tick_p99_us", "tick, p99", "us"), ("overruns", "ticks left out", "")):
        values = table.numbers(column)
        worst = max(range(len(values)), key=values.__getitem__)
        rows.append([what, *(_of_unit(v, unit) for v in (values[0], sorted(values)[len(values) // 2], values[worst], values[-1])),
                     f"{minutes[worst]:.0f}"])
    return n.table([f"{max(minutes):.0f} minutes, {n.count(sum(table.numbers('ticks')))} ticks, in contact in "
                    f"{n.plain(100 * sum(table.numbers('in_contact')) / len(minutes))} % of the snapshots shown", "first row", "median", "worst",
                    "last", "worst at minute"], rows)


READ_BACK = "tests/app/results/read_back.csv"


@c.needs(READ_BACK, command="tests/app/export/read_back.py")
def read_back(results):
    table, rows = results.table(READ_BACK), []
    for row in table.where():
        errors = f"{row['validator_errors']} errors, {row['validator_warnings']} warnings ({row['validator']})" if row["validator"] else "none"
        rows.append([f"`.{row['format']}`", row["reader"], row["parts"], row["names_equal"], row["max_pose_error"], row["colours_differing"],
                     row["shapes_not_shared"], errors, "right" if row["right"] == "yes" else "**not right**"])
    writers = ", ".join(sorted({f"{row['writer']} at `{table.head['revision']}`" for row in table.where()}))
    return n.table([f"format, written by {writers}", "read by", "parts", "names equal", "poses off by at most", "colours that differ",
                    "shapes not shared", "validator", "outcome"], rows, right_from=9)


FIGURES = {"read back": read_back, "checks": checks, "verdicts": verdicts, "paths": paths, "path readings": path_readings, "suggestions": suggestions, "documents": documents,
           "window hour": hour}
