"""Tables of the stress runs in the springs' modes."""

import common as c
import numbers_text as n

MODES = {"spring": "springs", "printed": "printed law", "grouped": "one spring for each area (`grouped`)"}
# What the hand may gain [J]: the proxy's 0.1 and what the passivity controller takes springs to hold.
MAX_GAIN = 0.15
# The force in the same place a cycle later [N], and growth of memory [bytes]: bounds of tests/stress/long_run.h.
MAX_FORCE_DRIFT = 1e-3
FILES = tuple(f"tests/stress/results/{name}_springs.csv" for name in ("hand", "rest", "limit", "hours"))


def _hand(results, mode):
    table = results.stress("hand_springs")
    rows = table.where(mode=mode)
    gain = max(float(r["energy gain J"]) for r in rows if r["scene"] != "huge")
    failed = [r["scene"] for r in rows if r["failure"]]
    return [f"`hand`: {n.count(sum(int(r['ticks']) for r in rows))} ticks, {len(rows)} scenes",
            f"gain {n.plain(gain)} J; step of the force before limits {n.plain(max(float(r['largest force step N']) for r in rows))} N; "
            f"held back in {n.plain(100 * sum(int(r['springs held']) for r in rows) / sum(int(r['ticks']) for r in rows))} % of ticks",
            f"**missed** by {', '.join(failed)}" if failed else "met"]


def _rest(results, mode):
    table = results.stress("rest_springs")
    rows = table.where(mode=mode)
    shaken = sum(int(r["shaken"]) for r in rows)
    still = sum(int(r["at rest"]) for r in rows)
    worst = max(rows, key=lambda r: float(r["handle rms um"]))
    return [f"`rest`: {n.count(len(rows))} trials, {len({r['scene'] for r in rows})} scenes",
            f"{n.count(still)} at rest; worst {n.plain(float(worst['handle rms um']))} um ({worst['scene']}, "
            f"{n.plain(float(worst['rate Hz']))} Hz), {n.plain(max(float(r['force rms mN']) for r in rows))} mN",
            f"**{n.count(shaken)} shaken**" if shaken else "no hand is shaken"]


def _limit(results, mode):
    ratios = results.stress("limit_springs").numbers("simulated by enforced", mode=mode)
    return [f"`limit`: {len(ratios)} devices", f"simulated limit {n.span(ratios, lambda v: f'{v:.3f}')} times the enforced one",
            "met" if min(ratios) > 1.0 else "**missed**"]


def _hours(results, mode):
    row = results.stress("hours_springs").where(mode=mode)[0]
    drift = abs(float(row["force drift N"]))
    return [f"`hours`: {n.count(int(row['ticks']))} ticks",
            f"force drifts by {n.plain(drift)} N; memory grows by {n.plain(float(row['growth bytes']) / 1024)} KiB",
            "met" if drift <= MAX_FORCE_DRIFT else "**missed**"]


@c.needs(*FILES)
def by_mode(results):
    """Each command in each mode of springs, with its worst case."""
    rows = []
    for mode, name in MODES.items():
        for i, part in enumerate((_hand, _rest, _limit, _hours)):
            rows.append(["" if i else name, *part(results, mode)])
    return n.table(["mode", "run", "worst case", "verdict"], rows, right_from=9)


@c.needs("tests/stress/results/rest_springs.csv")
def low_rates(results):
    """Rest and contact at each rate, in each mode of springs."""
    table = results.stress("rest_springs")
    rows = []
    for mode, name in MODES.items():
        rates = sorted({float(r["rate Hz"]) for r in table.where(mode=mode)}, reverse=True)
        for rate in rates:
            chosen = [r for r in table.where(mode=mode) if float(r["rate Hz"]) == rate]
            steady = [r for r in chosen if r["rough"] == "0"]
            rows.append(["" if rate != rates[0] else name, n.plain(rate),
                         f"{sum(int(r['at rest']) for r in chosen)} of {len(chosen)}",
                         sum(int(r["shaken"]) for r in chosen),
                         n.plain(max(float(r["handle rms um"]) for r in steady)),
                         n.plain(max(float(r["handle rms um"]) for r in chosen)),
                         n.plain(max(float(r["largest force step N"]) for r in chosen)),
                         n.plain(max(float(r["energy gain J"]) for r in chosen)),
                         n.plain(max(float(r["stiffness N/m"]) for r in chosen))])
    return n.table(["mode", "rate [Hz]", "trials at rest", "shaken", "worst rest, steady [um]", "with uneven periods [um]",
                    "largest step of the force [N]", "energy gained [J]", "stiffness up to [N/m]"], rows)


def readme_row(results):
    """The springs' row of the README's table of stability."""
    if not all(results.has(file) for file in FILES):
        return ["what the device does not bear of the sum's stiffness is held back; the stress runs have the mode, without results yet",
                "not shown"]
    hand, rest = results.stress("hand_springs"), results.stress("rest_springs")
    gain = max(float(r["energy gain J"]) for r in hand.where() if r["scene"] != "huge")
    failed = sum(bool(r["failure"]) for r in hand.where())
    shaken = sum(int(r["shaken"]) for r in rest.where())
    ratio = min(results.stress("limit_springs").numbers("simulated by enforced"))
    drift = max(map(abs, results.stress("hours_springs").numbers("force drift N")))
    missed = [name for name, is_missed in (
        ("energy", gain > MAX_GAIN), ("the hand", failed), ("rest", shaken), ("stiffness", ratio <= 1.0),
        ("drift", drift > MAX_FORCE_DRIFT)) if is_missed]
    return [f"in [three modes](tests/stress/README.md#modes): a hand gains {n.plain(gain)} J of the {MAX_GAIN:g} J allowed; "
            f"{n.count(sum(rest.numbers('at rest')))} of {n.count(len(rest.where()))} trials at rest down to 100 Hz, {shaken} hands shaken; "
            f"limit {ratio:.3f} times the enforced one; drift {n.plain(drift)} N",
            f"**missed**: {', '.join(missed)}" if missed else "met"]


FIGURES = {"stress in the springs' modes": by_mode, "low rates": low_rates}
