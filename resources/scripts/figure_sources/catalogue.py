"""All figures by name, and those that name their file and columns themselves."""

import re

import bench
import numbers_text as n
import others
import paper
import paper_arguments
import readme
import scenes
import scripting
import springs
from results import FigureError

FIGURES = {**readme.FIGURES, **bench.FIGURES, **others.FIGURES, **paper.FIGURES, **paper_arguments.FIGURES, **scenes.FIGURES,
           **scripting.FIGURES, **springs.FIGURES}
PICTURE = re.compile(r"picture (?P<file>\S+) as (?P<link>\S+): (?P<text>.+)")
OF_COLUMNS = re.compile(r"csv (?P<file>\S+): (?P<columns>[^|]+?)(?: \| (?P<conditions>.+))?")


def make(results, name):
    if name in FIGURES:
        return FIGURES[name](results)
    if picture := PICTURE.fullmatch(name):
        return _picture(results, **picture.groupdict())
    found = OF_COLUMNS.fullmatch(name)
    if not found:
        raise FigureError(f'"{name}"', "there is no such figure", "resources/scripts/figures --list names them")
    return _columns(results.table(found["file"]), [c.strip() for c in found["columns"].split(",")], found["conditions"])


def _picture(results, file, link, text):
    """A link, once there is something to show."""
    if results.has(file):
        return f"![{text}]({link})"
    return f"*`{file.rsplit('/', 1)[1]}` is not committed yet: `resources/scripts/measure` draws it.*"


def _columns(table, columns, conditions):
    where = {}
    for condition in (conditions or "").split(","):
        if not condition.strip():
            continue
        column, equals, value = condition.partition("=")
        if not equals:
            raise FigureError(table.file, f'"{condition.strip()}" is no condition', "write COLUMN=VALUE")
        where[column.strip()] = value.strip()
    rows = table.where(**where)
    for column in columns:
        if column not in table.columns:
            raise FigureError(table.file, f'there is no column "{column}"', f"it has {', '.join(table.columns)}")
    return n.table(columns, [[_cell(row[column]) for column in columns] for row in rows], right_from=1)


def _cell(value):
    try:
        return n.plain(float(value))
    except ValueError:
        return value.replace("|", "\\|")
