"""Tables of the stress runs in the springs' modes."""

import common as c
import numbers_text as n

MODES = {"spring": "springs", "printed": "printed law", "grouped": "grouped (one spring for each area)"}
# Energy that the hand may gain [J]: the proxy's 0.1 and the share that the passivity controller takes springs to hold.
MAX_GAIN = 0.15
# The force in the same place a cycle later [N], and growth of memory [bytes]: bounds of tests/stress/long_run.h.
MAX_FORCE_DRIFT = 1e-3
SOFT, REFERENCE_RATE = ("40", "200"), 1000.0  # [N/m], [Hz]
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


def _wished(text):
    """Order and name of a stiffness that is asked for."""
    return (1, 0.0, "the limit") if text == "limit" else (0, float(text), f"{n.count(float(text))} N/m")


@c.needs("tests/stress/results/rest_springs.csv")
def low_rates(results):
    """Trials at rest and hands shaken at each rate and wished stiffness, in each mode of springs."""
    table = results.stress("rest_springs")
    wished = sorted({row["stiffness wished N/m"] for row in table.where()}, key=_wished)
    rows = []
    for mode, name in MODES.items():
        rates = sorted({float(row["rate Hz"]) for row in table.where(mode=mode)}, reverse=True)
        for rate in rates:
            at_rate = [row for row in table.where(mode=mode) if float(row["rate Hz"]) == rate]
            cells = []
            for stiffness in wished:
                chosen = [row for row in at_rate if row["stiffness wished N/m"] == stiffness]
                cells.append(f"{sum(int(row['at rest']) for row in chosen)}, {sum(int(row['shaken']) for row in chosen)} of {len(chosen)}")
            for rows_of in ([row for row in at_rate if row["rough"] == "0"], at_rate):
                cells.append(n.plain(max(float(row["handle rms um"]) for row in rows_of)) if rows_of else "-")
            rows.append(["" if rate != rates[0] else name, n.plain(rate), *cells,
                         n.plain(max(float(row["largest force step N"]) for row in at_rate)),
                         n.plain(max(float(row["energy gain J"]) for row in at_rate))])
    return n.table(["mode", "rate [Hz]", *(f"{_wished(stiffness)[2]}: at rest, shaken" for stiffness in wished),
                    "worst rest, steady [um]", "with uneven periods [um]", "largest step of the force [N]", "energy gained [J]"], rows)


@c.needs("tests/stress/results/rest_springs.csv")
def soft_springs(results):
    """The paper's claim that soft springs stand rates below 1 kHz."""
    table = results.stress("rest_springs")
    said, worse = [], []
    for mode in ("spring", "printed"):
        shaken = {}
        for row in table.where(mode=mode):
            if row["stiffness wished N/m"] in SOFT:
                counts = shaken.setdefault(float(row["rate Hz"]), [0, 0])
                counts[0] += int(row["shaken"])
                counts[1] += 1
        low = {rate: counts for rate, counts in sorted(shaken.items(), reverse=True) if rate <= REFERENCE_RATE}
        said.append(f"{MODES[mode]} {n.listed([f'{counts[0]} of {counts[1]} at {n.plain(rate)} Hz' for rate, counts in low.items()])}")
        reference = low.get(REFERENCE_RATE, [0, 1])
        worse += [f"{MODES[mode]} at {n.plain(rate)} Hz" for rate, counts in low.items()
                  if counts[0] * reference[1] > reference[0] * counts[1]]
    return (f"Hands shaken by soft springs, of {n.listed(SOFT)} N/m: {'; '.join(said)}. "
            + (f"The paper's claim does not hold: more are shaken than at 1 kHz by {n.listed(worse)}." if worse else
               "The paper's claim holds in this sense: at no rate below 1 kHz are more shaken than at 1 kHz."))


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


FIGURES = {"stress in the springs' modes": by_mode, "low rates": low_rates, "soft springs and rates": soft_springs}
