"""Committed result files as tables that refuse to be guessed at: a missing file, column or row is an error that says where."""

import csv
import io
import pathlib


class FigureError(Exception):
    """A fault of a figure: where, what, and the remedy."""

    def __init__(self, where, what, remedy):
        super().__init__(f"{where}: {what}; {remedy}")


class Table:
    """One CSV file: the "# name: value" lines of its head, and rows as dictionaries of texts."""

    def __init__(self, file, text):
        self.file = file
        comments = [line[1:].strip() for line in text.splitlines() if line.startswith("#")]
        self.first_comment = text.splitlines()[0][1:].strip() if text.startswith("#") else ""
        self.head = {}
        for comment in comments:
            name, colon, value = comment.partition(":")
            if colon:
                self.head.setdefault(name.strip(), value.strip())
        self.comments = comments
        body = "".join(line + "\n" for line in text.splitlines() if not line.startswith("#"))
        reader = csv.DictReader(io.StringIO(body))
        self.columns = list(reader.fieldnames or [])
        self.rows = list(reader)

    def _known(self, column):
        if column not in self.columns:
            raise FigureError(self.file, f'there is no column "{column}"',
                              f"it has {', '.join(self.columns) or 'none'}")

    def where(self, **conditions):
        """Rows whose columns have these values; at least one."""
        for column in conditions:
            self._known(column)
        found = [row for row in self.rows if all(row[c] == str(v) for c, v in conditions.items())]
        if not found:
            said = ", ".join(f'{c} "{v}"' for c, v in conditions.items())
            raise FigureError(self.file, f"there is no row with {said}" if said else "there are no rows",
                              "measure it anew, or change the figure in resources/scripts/figure_sources")
        return found

    def text(self, column, **conditions):
        """The value of a column in the only row with these values."""
        self._known(column)
        found = self.where(**conditions)
        if len(found) > 1:
            raise FigureError(self.file, f"{len(found)} rows fit {conditions}", "name one more column")
        return found[0][column]

    def number(self, column, **conditions):
        return self._number(column, self.text(column, **conditions))

    def numbers(self, column, **conditions):
        """Values of a column in each row with these values, in the order of the file."""
        self._known(column)
        return [self._number(column, row[column]) for row in self.where(**conditions)]

    def _number(self, column, value):
        try:
            return float(value)
        except (TypeError, ValueError):
            raise FigureError(self.file, f'"{value}" in column "{column}" is not a number',
                              "mend the file") from None

    def comment(self, start):
        """The rest of the comment that starts so, such as the command of a run."""
        for line in self.comments:
            if line.startswith(start):
                return line[len(start):].strip()
        raise FigureError(self.file, f'its head has no line "# {start}"', "measure it anew")


class Results:
    """All result files below a root folder, read when first asked for."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self._tables = {}

    def table(self, file):
        """`file` is relative to the root."""
        if file not in self._tables:
            self._tables[file] = Table(file, self.text(file))
        return self._tables[file]

    def has(self, file):
        return (self.root / file).is_file()

    def text(self, file):
        try:
            return (self.root / file).read_text(encoding="utf-8")
        except OSError as error:
            raise FigureError(file, f"it cannot be read ({error.strerror})",
                              "commit it, or take the figure out") from None

    def bench(self, name):
        return self.table(f"tests/bench/results/{name}.csv")

    def stress(self, name):
        return self.table(f"tests/stress/results/{name}.csv")

    def evidence(self):
        return self.table("tests/evidence/results/evidence.csv")
