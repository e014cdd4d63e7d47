"""Figures as text: two digits below a hundred, whole numbers above, thousands with a comma."""


def plain(value):
    """A figure without unit."""
    if value == 0:
        return "0"
    size = abs(value)
    if size >= 99.5:
        return f"{value:,.0f}"
    if size >= 9.95:
        return f"{value:.0f}"
    if size >= 0.0995:
        return f"{value:.2f}".rstrip("0").rstrip(".") if size < 0.995 else f"{value:.1f}"
    return f"{value:.2g}"


def count(value):
    return f"{value:,.0f}"


def time(microseconds):
    """A time [us] with its unit: us, from 1,000 ms, from a million s."""
    if microseconds >= 999_500:
        return f"{plain(1e-6 * microseconds)} s"
    return f"{plain(1e-3 * microseconds)} ms" if microseconds >= 999.5 else f"{plain(microseconds)} us"


def times(factor):
    """A factor near one, which two decimals tell from it, or a larger one."""
    return f"{factor:.2f}" if factor < 1.995 else plain(factor)


def span(values, write=plain):
    """ "3 to 7", or one figure where both ends read alike."""
    low, high = write(min(values)), write(max(values))
    return low if low == high else f"{low} to {high}"


def listed(words):
    """ "none", "a", "a and b", "a, b and c"."""
    words = [str(word) for word in words] or ["none"]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def table(head, rows, right_from=1):
    """A Markdown table; columns from `right_from` on are aligned to the right."""
    rules = ["---" if i < right_from else "---:" for i in range(len(head))]
    lines = [head, rules] + rows
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def beside_goal(value, goal, unit):
    """A missed value with a digit more, where it would read like its goal; else nothing."""
    value, goal = float(value), float(goal)
    return f"{value:.3g} {unit}; goal " if value > goal and plain(value) == plain(goal) else ""


def verdict(checks):
    """`checks`: (name, value, goal) of figures that must be at most their goals. "met", or what is missed."""
    missed = [f"{name}, goal {time(goal)}" for name, value, goal in checks if value > goal]
    return f"**missed** at {', '.join(missed)}" if missed else "met"
