"""Tables and figures of the READMEs of stress runs, devices and evidence, and of resources/docs."""

import re

import common as c
import numbers_text as n


def stress(results):
    hand, rest, hours = (results.stress(name) for name in ("hand", "rest", "hours"))
    gain = max(float(row["energy gain J"]) for row in hand.where() if row["scene"] != "huge")
    parts = []
    for rough, name in (("0", "steady"), ("1", "uneven")):
        rows = rest.where(rough=rough)
        still = sum(float(r["handle rms um"]) == 0 and float(r["force rms mN"]) == 0 for r in rows)
        parts.append(f"{name} at most {n.plain(max(rest.numbers('handle rms um', rough=rough)))} um and "
                     f"{n.plain(max(rest.numbers('force rms mN', rough=rough)))} mN, {still} of {len(rows)} at zero")
    scenes = len({row["scene"] for row in rest.where()})
    drifts = [max(abs(v) for v in hours.numbers(k)) for k in ("free drift m", "contact drift m", "late drift m")]
    rows = [
        ["`hand`", "[hand.csv](results/hand.csv)",
         f"{n.count(sum(hand.numbers('ticks')))} ticks, {n.count(sum(hand.numbers('certified')))} poses certified, "
         f"{n.count(sum(hand.numbers('meetings')))} meet; relative error of the account of energy at most "
         f"{n.plain(max(hand.numbers('ledger error')))}; a hand gains at most {n.plain(gain)} J of the 0.1 J allowed (the "
         f"kilometre scene, {n.plain(hand.number('energy gain J', scene='huge'))} J, left out); work at most "
         f"{n.count(max(hand.numbers('most work')))}"],
        ["`rest`", "[rest.csv](results/rest.csv)",
         f"{scenes} scenes: {n.count(sum(rest.numbers('at rest')))} of {n.count(len(rest.where()))} trials at rest{_others(rest)}; "
         f"{'; '.join(parts)}"],
        ["`limit`", "[limit.csv](results/limit.csv)",
         f"the simulated limit is {n.span(results.stress('limit').numbers('simulated by enforced'), lambda v: f'{v:.3f}')} times what is "
         f"enforced, over {len(results.stress('limit').where())} devices"],
        ["`hours`", "[hours.csv](results/hours.csv)",
         f"{n.count(sum(hours.numbers('ticks')))} ticks: drift of place at most {n.plain(max(drifts))} m, of force "
         f"{n.plain(max(abs(v) for v in hours.numbers('force drift N')))} N; memory grows by "
         f"{n.plain(max(hours.numbers('growth bytes')) / 1024)} KiB"],
        ["`oracle`", "[oracle.txt](results/oracle.txt)", _oracle(results)],
    ]
    return n.table(["command", "table", "outcome"], rows, right_from=9)


def _others(rest):
    """The trials that are not at rest, by scene."""
    moving = [c.stress_scene(row["scene"]) for row in rest.where() if row["at rest"] == "0"]
    return f", the other {len(moving)} of {n.listed(sorted(set(moving)))}" if moving else ""


def _oracle(results):
    text = results.text("tests/stress/results/oracle.txt")
    rows = re.findall(r"(\d+) minima.*?(\d+) poses judged exactly.*?(\d+) differences", text)
    found, judged, differences = (sum(int(row[i]) for row in rows) for i in range(3))
    return f"{n.count(found)} minima and regions; {n.count(judged)} poses judged exactly; {n.count(differences)} differences"


def round_trip(results):
    table = results.table("tests/usb/results/round_trip.csv")
    rows = [[f"{n.count(float(row['rate']))} Hz, {row['scene']}, run {row['run']}", *(n.time(float(row[k])) for k in
                                                    ("servo_p50", "servo_p99", "p50", "p99", "p99_9", "max")), row["stopped_before"]]
            for row in table.where()]
    return n.table(["rate, scene", "to the wrench: p50", "p99", "as the device sees it: p50", "p99", "p99.9", "max", "runs stopped before"],
                   rows)


def round_trip_load(results):
    table = results.table("tests/usb/results/round_trip.csv")
    return f"at a load of {table.head.get('load at start') or table.head.get('load average before')} before the run"


def _limit_off(results, is_rendered):
    """Largest difference of the simulated limit from the formula or the eigenvalues, with or without rendered damping."""
    rows = [row for row in results.stress("limit").where() if (float(row["coupling damping N s/m"]) > 0) == is_rendered]
    return f"{n.plain(max(100 * abs(float(row['simulated N/m']) / float(row['exact N/m']) - 1) for row in rows))} %"


def limit_without(results):
    return _limit_off(results, False)


def limit_with(results):
    return _limit_off(results, True)


PROBLEMS = {"floor": "floor", "ring": "ring: a peg in its bore", "wedge": "wedge: jammed"}


def friction(results):
    table = results.bench("program")
    rows = []
    for problem, name in PROBLEMS.items():
        cells = []
        for count in (32, 256):
            where = {"kind": problem, "rows": count, "method": "nearfit-friction"}
            cells.append(f"{n.plain(100 * table.number('settled', **where))} %")
        for method in ("nearfit-friction", "nearfit"):
            for count in (32, 256):
                where = {"kind": problem, "rows": count, "method": method}
                cells.append(", ".join(n.plain(table.number(k, **where)) for k in ("p50_us", "p99_us", "max_us")))
        rows.append([name, *cells])
    return n.table(["problem", "settled at 32 rows", "at 256 rows", "step with friction [us], 32 rows: p50, p99, max", "256 rows",
                    "without friction [us], 32 rows", "256 rows"], rows)


def at_rest(results):
    table = results.evidence()
    restless = [row for row in table.where() if int(row["ticks_at_rest_that_step"]) > 0]
    said = [f"{row['scene']}, {n.count(int(row['ticks_at_rest_that_step']))} of {n.count(int(row['ticks_at_rest']))} ticks at rest, "
            f"{n.plain(float(row['rest_noise_N']))} N" for row in restless]
    return f"{'; '.join(said)}; in the other {len(table.rows) - len(restless)} scenes no tick at rest steps"


def drag_of_the_nut(results):
    return f"{n.plain(100 * results.evidence().number('drag_p50', scene='nut-engaged'))} % of the force at p50"


def most_energy(results):
    row = max(results.evidence().where(), key=lambda r: float(r["most_energy_J"]))
    return f"{n.plain(float(row['most_energy_J']))} J, of `{row['scene']}`"


def ball_in_bowl(results):
    table = results.bench("dense")
    rows = table.where(group="curved", scene="ball-bowl", quantity="tick [us]")
    said = [f"{n.time(float(row['p99']))} at p99 ({n.time(float(row['max']))} at most) for "
            f"{n.count(c.sizes_in(row['run'].split('(')[1]))} triangles" for row in (rows[0], rows[-1])]
    return ", ".join(said)


def nut_search(results):
    """The worst of all runs of the nut: `feel`, its finer threads, and the evidence."""
    where = {"group": "cost", "scene": "nut-bolt", "run": "conforming"}
    table, finer, evidence = results.bench("feel"), results.bench("dense"), results.evidence()
    ticks = [(float(row["p50"]), float(row["max"])) for of, scene in ((table, where), (finer, {"scene": "nut-thread"}))
             for row in of.where(quantity="tick [us]", **scene)]
    ticks += [tuple(evidence.number(f"tick_us_{p}", scene=scene) for p in ("p50", "max")) for scene in ("nut-engaged", "nut-on")]
    p50, longest = (max(column) for column in zip(*ticks))
    search = {"quantity": "search beside [us]", **where}
    return (f"ticks of up to {n.time(p50)} at the median and {n.time(longest)} at most, and "
            f"the search ahead {n.time(table.number('p50', **search))} at the median and {n.time(table.number('max', **search))} at most")


def million_ticks(results):
    table = results.bench("query_generated")
    return n.time(table.number("p99_us", scene="organic-1m", method="nearfit-tracked"))


MAKER_CONTACT = "tests/makers/results/contact.csv"
# Round trip at p99 [us].
MAX_MAKER_ROUND_TRIP = 200.0


@c.needs(MAKER_CONTACT, command="resources/scripts/measure --parts maker-contact")
def maker_contact(results):
    table = results.table(MAKER_CONTACT)
    rows = []
    for row in table.where():
        p99 = float(row["p99_us"])
        said = f"{'met' if p99 <= MAX_MAKER_ROUND_TRIP else '**missed**'} (p99 {n.time(MAX_MAKER_ROUND_TRIP)})"
        rows.append([row["model"], f"{n.count(float(row['rate_hz']))} Hz", n.count(float(row["samples"])),
                     *(n.time(float(row[column])) for column in ("p50_us", "p99_us", "p99_9_us", "max_us")),
                     f"{n.plain(1e6 * float(row['max_energy_j']))} uJ", said])
    return n.table([f"model, on machine {c.machine_letter(table)}", "rate", "poses", "p50", "p99", "p99.9", "max", "energy given", "goal"],
                   rows)


FIGURES = {
    "maker contact": maker_contact,
    "stress results": stress, "limit without rendered damping": limit_without, "limit with rendered damping": limit_with,
    "round trip": round_trip, "load of the round trip": round_trip_load, "friction": friction,
    "at rest": at_rest, "drag of the nut": drag_of_the_nut, "most energy": most_energy, "ball in bowl": ball_in_bowl,
    "nut": nut_search, "tracked million": million_ticks,
}
