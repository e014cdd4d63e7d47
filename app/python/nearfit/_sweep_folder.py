"""The folder of a sweep: its manifest, its pieces and its lock. What lies there is read as untrusted."""

import contextlib
import fcntl
import json
import os
import pathlib
import re
import stat

from . import _pieces

MANIFEST = "manifest.json"
PIECES = "pieces"
LOCK = ".lock"
FORMAT = 1
# A manifest names each part, mesh and variant: a million of each fit.
MAX_MANIFEST = 1 << 30
# A row takes at most its numbers and flags, uncompressed, with room for Parquet's own; a file of more is not ours. Names are
# stored once a page.
MAX_ROW_BYTES = 64
MAX_PIECE_HEAD = 16 << 20
# Columns of text, and the rows of which they are checked at once.
NAMES = ("variant", "part")
NAME_BATCH = 1 << 16
# Differences between two manifests that a message lists.
MAX_TOLD = 5

_NAME = re.compile(r"(\d{15})-(\d{15})\.parquet")


def piece_name(begin, end):
    return f"{begin:015d}-{end:015d}.parquet"


def range_of(name):
    """(begin, end) of a piece's name; None for other names."""
    found = _NAME.fullmatch(name)
    return (int(found[1]), int(found[2])) if found else None


def read_file(path, max_bytes, follows=False):
    """Bytes of an ordinary file, through a symbolic link only if `follows`. Raises OSError, and ValueError where it is none or too
    long."""
    handle = os.open(path, os.O_RDONLY | (0 if follows else os.O_NOFOLLOW) | os.O_NONBLOCK | os.O_CLOEXEC)
    status = os.fstat(handle)
    if not stat.S_ISREG(status.st_mode):
        # open() would refuse a folder, and leave it open.
        os.close(handle)
        raise ValueError("it is not a file")
    with open(handle, "rb") as file:
        if status.st_size > max_bytes:
            raise ValueError(f"it has {status.st_size:,} bytes, more than such a file can have")
        return file.read(max_bytes)


def write_file(path, data):
    """Writes a file whole or not at all, also when the machine stops: under another name, to the disk, then renamed."""
    path = pathlib.Path(path)
    hidden = path.with_name(f".writing-{os.getpid()}-{path.name}")
    with contextlib.suppress(FileNotFoundError):
        os.unlink(hidden)
    handle = os.open(hidden, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
    try:
        with open(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(handle)
        os.rename(hidden, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(hidden)
        raise
    _sync_folder(path.parent)


def _sync_folder(folder):
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def differences(there, now, where=""):
    """Lines that say in what two specifications differ."""
    if isinstance(there, dict) and isinstance(now, dict):
        for key in sorted({*there, *now}):
            name = f"{where}.{key}" if where else key
            if key not in there or key not in now:
                yield f"{name} is {'new' if key in now else 'no longer there'}"
            else:
                yield from differences(there[key], now[key], name)
    elif isinstance(there, list) and isinstance(now, list) and len(there) == len(now):
        for i, (old, new) in enumerate(zip(there, now)):
            yield from differences(old, new, f"{where}[{_label(new, i)}]")
    elif there != now or type(there) is not type(now):
        yield f"{where} was {_short(there)} and is {_short(now)}"


def _label(value, index):
    """A part or variant by its name, other values by their number."""
    if isinstance(value, list) and value and isinstance(value[0], str):
        return value[0]
    if isinstance(value, dict) and isinstance(value.get("name"), str):
        return value["name"]
    return index


def _short(value):
    text = json.dumps(value)
    return text if len(text) <= 40 else text[:36] + " ..."


class SweepFolder:
    """A sweep's folder, locked for this process while it is open."""

    def __init__(self, path, error):
        """@param error  Raised for problems, with one line."""
        self.path, self._error = pathlib.Path(path), error
        self._lock = None
        self.notes = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def begin(self, sweep, spec):
        """Locks the folder, makes it where it is new, and refuses it where it belongs to another sweep."""
        try:
            (self.path / PIECES).mkdir(parents=True, exist_ok=True)
            self._lock = os.open(self.path / LOCK, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise self._error(f"{self.path}: another sweep writes there; wait for its end, or choose another folder") from None
        except OSError as e:
            raise self._error(f"{self.path}: it cannot be written to: {e.strerror}; choose another folder") from None
        if (self.path / MANIFEST).exists() or (self.path / MANIFEST).is_symlink():
            self._compare(sweep, spec)
        elif any(range_of(name) for name in os.listdir(self.path / PIECES)):
            raise self._error(f"{self.path}: it has pieces but no {MANIFEST}, so nothing says of which sweep; choose another "
                              "folder, or remove it")
        else:
            write_file(self.path / MANIFEST, json.dumps({"nearfit_sweep": FORMAT, "sweep": sweep, "spec": spec}, indent=1,
                                                        allow_nan=False).encode() + b"\n")
        for name in os.listdir(self.path / PIECES):
            if name.startswith(".writing-"):
                # A folder of that name is none of ours, and harms nobody.
                with contextlib.suppress(IsADirectoryError):
                    os.unlink(self.path / PIECES / name)

    def _compare(self, sweep, spec):
        there = self.manifest()["spec"]
        told = list(differences(there, spec))
        if not told and there == spec:
            return
        more = f", and {len(told) - MAX_TOLD} more" if len(told) > MAX_TOLD else ""
        raise self._error(f"{self.path}: it belongs to another sweep: {'; '.join(told[:MAX_TOLD])}{more}; choose another folder, "
                          "or remove it")

    def manifest(self):
        """The manifest, of which only the form is checked."""
        path = self.path / MANIFEST
        try:
            manifest = json.loads(read_file(path, MAX_MANIFEST))
        except (OSError, ValueError, RecursionError) as e:
            raise self._error(f"{path}: it cannot be read: {e}; choose another folder, or remove it") from None
        if not isinstance(manifest, dict) or manifest.get("nearfit_sweep") != FORMAT:
            raise self._error(f"{path}: it is no manifest of a sweep of this version; choose another folder")
        spec = manifest.get("spec")
        try:
            good = manifest["sweep"] == _pieces.digest(_pieces.canonical(spec)) and _is_spec(spec)
        except (KeyError, TypeError, ValueError, RecursionError):
            good = False
        if not good:
            raise self._error(f"{path}: it was changed since the sweep wrote it; choose another folder, or remove it")
        return manifest

    def write_piece(self, begin, end, data):
        write_file(self.path / PIECES / piece_name(begin, end), data)

    def finished(self, sweep, spec, drops=True):
        """Ranges of rows, in order, of pieces that belong to the sweep and are whole. With `drops` others are removed, and
        noted; their rows are then computed anew."""
        taken, free = [], 0
        for name in sorted(os.listdir(self.path / PIECES)):
            rows = range_of(name)
            if rows is None:
                continue
            try:
                if not free <= rows[0] < rows[1] <= _pieces.Rows(spec).total:
                    raise ValueError("its rows are not those of a piece of this sweep, or those of another piece too")
                self.read_piece(sweep, spec, *rows)
            except ValueError as e:
                if not drops:
                    raise self._error(f"{self.path / PIECES / name}: {e}; run the sweep again") from None
                self.notes.append(f"{name} is computed anew: {e}")
                self._remove(self.path / PIECES / name)
                continue
            taken.append(rows)
            free = rows[1]
        return taken

    def _remove(self, path):
        try:
            os.unlink(path)
        except OSError as e:
            raise self._error(f"{path}: it is no piece of this sweep, and cannot be removed: {e.strerror}; remove it, or choose "
                              "another folder") from None

    def read_piece(self, sweep, spec, begin, end):
        """The table of a piece. Raises ValueError, saying why, where it is not whole or not of this sweep."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        path, count = self.path / PIECES / piece_name(begin, end), end - begin
        if count > _pieces.MAX_PIECE_ROWS:
            raise ValueError(f"it has {count:,} rows, more than a piece can have")
        try:
            data = read_file(path, MAX_PIECE_HEAD + MAX_ROW_BYTES * count)
            # A few bytes can stand for a long name in each row: names stay in dictionaries until they are known to be the sweep's.
            file = pq.ParquetFile(pa.BufferReader(data), page_checksum_verification=True, read_dictionary=list(NAMES))
            # Before anything is unpacked: a few bytes can stand for billions of rows.
            if file.metadata.num_rows != count or not file.schema_arrow.equals(_packed(_pieces.schema_of(spec))):
                raise ValueError("its rows or columns are not those of this sweep")
            said = file.schema_arrow.metadata or {}
            if any(said.get(key) != value for key, value in _pieces.head_of(sweep, begin, end).items()):
                raise ValueError("it is of another sweep")
            _check_names(file, spec)
            table = file.read()
            table.validate(full=True)
            table = table.cast(_pieces.schema_of(spec).with_metadata(table.schema.metadata))
        except (OSError, pa.ArrowException) as e:
            # A message may be empty.
            raise ValueError(f"it cannot be read: {next(iter(str(e).splitlines()), type(e).__name__)}") from None
        if any(column.null_count for column in table.columns):
            raise ValueError("it has empty cells")
        for i, expected in enumerate(_pieces.key_columns(spec, begin, end)):
            if not table.column(i).combine_chunks().equals(expected):
                raise ValueError(f"its column {table.schema.names[i]} is not that of these rows")
        return table


def _packed(schema):
    """A piece's schema with its names in dictionaries."""
    import pyarrow as pa

    for name in NAMES:
        i = schema.get_field_index(name)
        schema = schema.set(i, schema.field(i).with_type(pa.dictionary(pa.int32(), pa.string())))
    return schema


def _check_names(file, spec):
    """Reads the names of a piece, which is open with them in dictionaries, and raises ValueError where one is not the sweep's."""
    expected = {"variant": {v["name"] for v in spec["variants"]}, "part": set(spec["parts"])}
    for batch in file.iter_batches(batch_size=NAME_BATCH, columns=list(NAMES)):
        for name in NAMES:
            there = batch.column(name).dictionary
            # A dictionary of longer names is not copied into Python's strings.
            if there.nbytes > len(there) * (_pieces.MAX_NAME_BYTES + 8) or not expected[name].issuperset(there.to_pylist()):
                raise ValueError(f"its column {name} is not that of these rows")


def _is_spec(spec):
    """True for the form of a specification: what Rows, schema_of() and key_columns() rely on."""
    def is_count(value):
        return type(value) is int and value > 0

    def is_name(value):
        return isinstance(value, str) and len(value.encode()) <= _pieces.MAX_NAME_BYTES

    return (isinstance(spec, dict) and is_count(spec["draws"]) and is_count(spec["count"]) and
            isinstance(spec["parts"], list) and len(spec["parts"]) > 0 and all(is_name(p) for p in spec["parts"]) and
            isinstance(spec["variants"], list) and len(spec["variants"]) > 0 and
            all(isinstance(v, dict) and is_name(v["name"]) for v in spec["variants"]) and
            isinstance(spec["measures"], list) and all(m in _pieces.MEASURES for m in spec["measures"]))
