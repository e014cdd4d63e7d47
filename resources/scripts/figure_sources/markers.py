"""Generated places in Markdown: <!-- figures: NAME --> ... <!-- end -->, over lines of their own or within a sentence."""

import re

from results import FigureError

OPEN = re.compile(r"<!-- figures: (.+?) -->")
CLOSE = "<!-- end -->"
# Any comment that looks like a marker but is spelled otherwise would be passed over in silence.
LOOKS_LIKE = re.compile(r"<!--\s*(figures?\b|end\b)[^>]*-->", re.IGNORECASE)


def _line(text, place):
    return text.count("\n", 0, place) + 1


def _check_spelling(file, text):
    for found in LOOKS_LIKE.finditer(text):
        if found.group() != CLOSE and not OPEN.fullmatch(found.group()):
            raise FigureError(f"{file}:{_line(text, found.start())}", f'"{found.group()}" is no marker',
                              'write "<!-- figures: NAME -->" or "<!-- end -->"')


def rewrite(file, text, make):
    """The text with each generated place made anew by make(name); errors name file and line.

    Returns (text, names, stale): `stale` lists (line, name) of the places that differed.
    """
    _check_spelling(file, text)
    pieces, names, stale, end = [], [], [], 0
    while found := OPEN.search(text, end):
        where = f"{file}:{_line(text, found.start())}"
        _no_close_before(file, text, end, found.start())
        close = text.find(CLOSE, found.end())
        following = OPEN.search(text, found.end())
        if close < 0 or (following and following.start() < close):
            raise FigureError(where, f'"{found.group()}" has no "{CLOSE}"', "add it behind what is generated")
        try:
            made = make(found.group(1))
        except FigureError as error:
            raise FigureError(where, str(error), "see resources/scripts/figures --help") from None
        old = text[found.end():close]
        if not old.startswith("\n") and not text[text.rfind("\n", 0, found.start()) + 1:found.start()].strip():
            raise FigureError(where, "a line that begins with a comment is HTML to Markdown",
                              "begin it with a word, or give the figure lines of its own")
        new = f"\n{made}\n" if old.startswith("\n") or "\n" in made else made
        if new != old:
            stale.append((_line(text, found.start()), found.group(1)))
        pieces += [text[end:found.end()], new, CLOSE]
        names.append(found.group(1))
        end = close + len(CLOSE)
    _no_close_before(file, text, end, len(text))
    return "".join(pieces) + text[end:], names, stale


def _no_close_before(file, text, begin, end):
    lone = text.find(CLOSE, begin, end)
    if lone >= 0:
        raise FigureError(f"{file}:{_line(text, lone)}", f'"{CLOSE}" closes nothing', "take it out")
