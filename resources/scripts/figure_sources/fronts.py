"""The front of time against error: one definition for tables, plots and pages."""

# Times and errors that differ by less are equal: the same method, timed twice, differs by that much.
MARGIN = 1.02
# Smaller errors are equal. Double precision leaves 1e-16 to 1e-13 of a force that is summed over some minima, and which of
# these a method has depends on the order of its sum.
FLOOR = 1e-12


def is_only_measured(method):
    """True for methods that drop minima by choice: tables and plots have them, fronts do not."""
    return method in ("grouped", "exact grouped")


def _beats(one, other):
    """True if `one`, (time, error), is as quick and as near, and more than the margin quicker or nearer."""
    (time, error), (other_time, other_error) = one, other
    return (time <= other_time * MARGIN and error <= other_error * MARGIN
            and (time * MARGIN < other_time or error * MARGIN < other_error))


def front(points):
    """Returns the `points`, (time, error, method, ...), that no other beats; fastest first. A NaN error says that nothing was found."""
    known = [(p, (p[0], max(p[1], FLOOR))) for p in points if p[1] == p[1] and not is_only_measured(p[2])]
    kept = [p for p, place in known if not any(_beats(other, place) for _, other in known)]
    return sorted(kept, key=lambda p: p[:2])
