"""Tables of whole scenes and documents: checks, verdicts, paths, suggestions, imports, and the hour with the window open."""

import re

import common as c
import numbers_text as n
from results import FigureError

HOUR = "tests/bench/results/window_hour.csv"
UNITS = {"s": 1e6, "ms": 1e3, "us": 1.0}


def of_unit(value, unit):
    if unit in UNITS:
        return n.time(UNITS[unit] * value)
    return n.plain(value) if unit in ("", "1", "x") else f"{n.plain(value)} {unit}"


def _met(text):
    return "**missed**" if text.lower() == "no" else "met" if text.lower() == "yes" else text


def _goal(row):
    said = _met(row["met"])
    try:
        return f"{said} ({of_unit(float(row['goal']), row['unit'])})"
    except ValueError:
        return said


@c.needs("tests/bench/results/check.csv")
def checks(results):
    """All figures of the checks; `worst` is the worst of the turns."""
    rows, last = [], ""
    for row in results.bench("check").where():
        name = f"`{row['scene']}` ({n.count(float(row['parts']))} parts, {n.count(float(row['triangles']))} triangles)"
        rows.append(["" if name == last else name, f"`{row['method']}`", row["figure"], of_unit(float(row["median"]), row["unit"]),
                     of_unit(float(row["worst"]), row["unit"]), _goal(row), row["remark"]])
        last = name
    return n.table(["scene", "method", "figure", "median", "worst", "goal", "remark"], rows, right_from=9)


def _check_setting(results, pattern):
    """A setting of the run, by a line of the file's head."""
    table = results.bench("check")
    found = next((said for said in (re.search(pattern, comment) for comment in table.comments) if said), None)
    if not found:
        raise FigureError(table.file, f'no line of its head has "{pattern}"', "measure it anew")
    return found.group(1)


@c.needs("tests/bench/results/check.csv")
def check_turns(results):
    turns = int(_check_setting(results, r"^(\d+) turns"))
    return "one turn, which is `median` and `worst`" if turns == 1 else f"{turns} turns"


@c.needs("tests/bench/results/check.csv")
def peer_seconds(results):
    return _check_setting(results, r"end after (\S+) s")


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
            cells.append(f"{of_unit(float(row['median']), row['unit'])} ({of_unit(float(row['max']), row['unit'])}){said}")
        rows.append([f"`{document}`", n.count(float(first["placed_triangles"])), *cells])
    return n.table(["document", "triangles placed", "file to ready: median (max)", "from the cache", "OpenCASCADE alone",
                    "ratio to it", "memory a triangle"], rows)


@c.needs(HOUR, command="resources/scripts/measure --parts window-hour")
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
        rows.append([what, *(of_unit(v, unit) for v in (values[0], sorted(values)[len(values) // 2], values[worst], values[-1])),
                     f"{minutes[worst]:.0f}"])
    return n.table([f"{max(minutes):.0f} minutes, {n.count(sum(table.numbers('ticks')))} ticks, in contact in "
                    f"{n.plain(100 * sum(table.numbers('in_contact')) / len(minutes))} % of the snapshots shown", "first row", "median", "worst",
                    "last", "worst at minute"], rows)


# Growth of memory after the first tenth that `nearfit-bench-window hour` allows [bytes]: kMaxHourGrowth of tests/bench/hour_row.h.
MAX_HOUR_GROWTH = 16 << 20


def _hour_growth(table):
    return float(table.comment("growth after the first tenth:").split()[0])


def _hour_verdict(table):
    growth = _hour_growth(table)
    said = "met" if growth <= MAX_HOUR_GROWTH else "**missed**"
    touched = sum(table.numbers("in_contact")) > 0
    return f"{said} (16 MiB)" + ("" if touched else "; **nothing was touched**")


@c.needs(HOUR, command="resources/scripts/measure --parts window-hour")
def hour_verdict(results):
    """Growth of memory against its goal."""
    table = results.bench("window_hour")
    return (f"Memory grew by {_hour_growth(table) / (1 << 20):.1f} MiB between the second tenth of the time and the last: {_hour_verdict(table)}.")


def readme_hour_row(results):
    """A row of the README's table of stability, once there are results."""
    if not results.has(HOUR):
        return []
    table = results.bench("window_hour")
    return [[f"And with [the window open](tests/bench/results/README.md#an-hour)? {max(table.numbers('minute')):.0f} minutes of wall clock, "
             f"{n.count(sum(table.numbers('ticks')))} ticks",
             f"memory grows by {_hour_growth(table) / (1 << 20):.1f} MiB after the first tenth; lateness at most "
             f"{n.time(max(table.numbers('late_max_us')))}, {n.count(sum(table.numbers('overruns')))} ticks left out", _hour_verdict(table)]]


READ_BACK = "tests/app/results/read_back.csv"


def _outcome(row):
    return "right" if row["right"] == "yes" else "**not right**"


def _gltf_issues(row):
    return f"{row['validator_errors']} errors, {row['validator_warnings']} warnings ({row['validator']})" if row["validator"] else "none"


def _flat_and_curved(row, what):
    curved = row[f"max_curved_{what}_error"]
    return f"{row[f'max_{what}_error']} (curved {curved})" if curved else row[f"max_{what}_error"]


def _rows_of_content(table, *contents):
    return [row for row in table.where() if row["content"] in contents]


def _written_by(table):
    return ", ".join(sorted({f"{row['writer']} at `{table.head['revision']}`" for row in table.where()}))


@c.needs(READ_BACK, command="tests/app/export/read_back.py")
def read_back(results):
    """Placements and assemblies, with the poses of the program and those that were chosen."""
    table = results.table(READ_BACK)
    rows = [[row["format"], row["reader"], row["parts"], row["names_equal"], row["groups_equal"] or "-",
             f"{row['max_pose_error']}, {row['max_error_to_chosen_pose']}", _flat_and_curved(row, "volume") or "-",
             _flat_and_curved(row, "box") or "-", row["exact_parts"] or "-", row["colours_differing"] or "-",
             row["shapes_not_shared"] or "-", _gltf_issues(row), _outcome(row)]
            for row in _rows_of_content(table, "placement", "assembly")]
    return n.table([f"format, written by {_written_by(table)}", "read by", "parts", "names equal", "groups equal",
                    "poses off by at most: JSON export, chosen", "volumes off by", "boxes off by", "solids with their curved faces",
                    "colours that differ", "shapes not shared", "validator", "outcome"], rows, right_from=13)


@c.needs(READ_BACK, command="tests/app/export/read_back.py")
def read_back_meshes(results):
    """Meshes, the animation of a path, and swept volumes."""
    table = results.table(READ_BACK)
    rows = [[f"{row['content']}, `.{row['format']}`", row["reader"], row["closed"] or "-", row["max_error_to_chosen_pose"] or "-",
             _flat_and_curved(row, "volume") or "-", _flat_and_curved(row, "box") or "-", _gltf_issues(row), _outcome(row)]
            for row in _rows_of_content(table, "mesh", "animation", "swept volume")]
    return n.table(["file", "read by", "closed", "vertices off by [m]", "volumes off by", "boxes off by", "validator", "outcome"], rows,
                   right_from=8)


REPORT_PAGE = "tests/app/results/report_page.csv"


@c.needs(REPORT_PAGE, command="tests/app/cli/report_page.py")
def report_pages(results):
    table = results.table(REPORT_PAGE)
    rows = [[row["page"], f"{row['KiB']} KiB", row["messages"], row["outside_references"], row["requests"],
             *(f"{row[f'pages_{paper}']}, {row[f'parted_{paper}']} parted" for paper in ("a4", "letter")), _outcome(row)]
            for row in table.where()]
    programs = " and ".join(dict.fromkeys(row[which] for row in table.where() for which in ("validator", "browser")))
    return n.table([f"report, by {programs} at `{table.head['revision']}`", "size", "messages", "references to elsewhere",
                    "requests to the network", "pages on A4", "on Letter", "outcome"], rows, right_from=8)


FIGURES = {
    "read back": read_back, "read back meshes": read_back_meshes, "report pages": report_pages, "checks": checks, "turns of the check": check_turns, "seconds of a peer": peer_seconds, "verdicts": verdicts,
    "paths": paths, "path readings": path_readings, "suggestions": suggestions, "documents": documents, "window hour": hour, "window hour, verdict": hour_verdict,
}
