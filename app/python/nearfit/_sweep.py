"""Sweeps: queries of many parts at many poses, over processes and machines (docs/sweeps.md)."""

import collections
import collections.abc
import contextlib
import dataclasses
import logging
import math
import os
import pathlib
import queue
import sys
import time

import numpy as np

from . import _pieces
from ._pieces import MAX_NAME_BYTES, MAX_PIECE_ROWS
from ._sweep_folder import PIECES, SweepFolder, piece_name

# No name on PyPI: whoever registered it there would be installed.
REMEDY = "pip install '.[sweep]' in the folder of nearfit's sources"
# A piece is worth its overhead (a message, a file, a sync: milliseconds), and is short enough that little is lost with it.
PIECE_SECONDS = 5.0
# Rows of the first pieces, before anything is measured; a piece that turns out long ends in time by itself.
FIRST_ROWS = 4096
# Below this the overhead of a piece outweighs that its work can be shared.
MIN_ROWS = 256
# Bytes of meshes and poses, as delivered, that a worker keeps. With their hierarchies they take several times as much.
STORE_BYTES = 1 << 30
# A piece waits for at most one other on its worker: what takes this many times its budget hangs, and is given to another.
LATE_FACTOR = 6.0
MIN_LATE_SECONDS = 2.0
# A piece first misses the specification, then meshes and poses, perhaps once more on another worker.
MAX_MISSES = 5
# Workers that compute one piece at the same time, where each in turn is late.
MAX_ASKED = 4
# How often a piece is tried on workers that are lost.
MAX_ATTEMPTS = 8
# After this without any worker the sweep ends with an error.
NO_WORKER_SECONDS = 120.0
# Rounding to three digits: a little less than kQuaternionSlack and kMatrixSlack (1e-3), so that no pose that passes here is refused
# by a worker after hours.
POSE_SLACK = 0.999e-3
# Equals kMaxPosition (core/scene/part.h) [m].
MAX_POSITION = 1e9
# How often the number of workers and late pieces are looked at.
LOOK_SECONDS = 0.25
# Of a cluster that a sweep starts. By default Dask samples the stack of each worker every 10 ms and looks at its event loops every
# 20 ms, for a dashboard that there is none of: together 3 % of two processors.
LOCAL_CONFIG = {"distributed.worker.profile.enabled": False, "distributed.admin.tick.interval": "1s",
                "distributed.admin.system-monitor.interval": "5s"}


def _fail(message):
    import nearfit

    raise nearfit.Error(message)


def need(name):
    """Imports a package that sweeps need. Raises Error, with the remedy, where it is missing."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as e:
        _fail(f"sweeps need the Python package {name}, which cannot be imported ({e}); run {REMEDY}")


@dataclasses.dataclass(frozen=True)
class SweepResult:
    """Rows of a finished sweep, in its folder.

    One row for each variant, draw, part and pose, in this order, the last fastest. Columns: variant, draw, part, pose (its
    number), distance [m] (0 where the part touches or overlaps another, inf beyond the cutoff), minima (below the threshold),
    complete (False where a list of minima was full, so that there may be more) and overlap; of the last four those that were
    asked for.
    """

    folder: pathlib.Path
    spec: dict = dataclasses.field(repr=False)
    sweep: str
    pieces: tuple = dataclasses.field(repr=False)

    def __len__(self):
        return _pieces.Rows(self.spec).total

    def tables(self):
        """Yields the rows as pyarrow tables, a piece each, in order; each is checked."""
        import nearfit

        with SweepFolder(self.folder, nearfit.Error) as folder:
            for begin, end in self.pieces:
                try:
                    yield folder.read_piece(self.sweep, self.spec, begin, end)
                except ValueError as e:
                    _fail(f"{self.folder / PIECES / piece_name(begin, end)}: {e}; run the sweep again")

    def table(self):
        """All rows as one pyarrow table, in order. It does not depend on how they were cut into pieces."""
        pa = need("pyarrow")
        return pa.concat_tables(table.replace_schema_metadata(None) for table in self.tables()).combine_chunks()

    def arrays(self):
        """{column: numpy array} of all rows, in order."""
        table = self.table()
        return {name: table.column(name).to_numpy() for name in table.schema.names}


def open_sweep(folder):
    """The result of a finished sweep in its folder. Raises Error where rows are missing or anything was changed."""
    import nearfit

    need("pyarrow")
    with SweepFolder(folder, nearfit.Error) as opened:
        manifest = opened.manifest()
        spec, sweep = manifest["spec"], manifest["sweep"]
        try:
            pieces = opened.finished(sweep, spec, drops=False)
        except OSError as e:
            _fail(f"{folder}: it cannot be read: {e.strerror}")
        missing = _pieces.Rows(spec).total - sum(end - begin for begin, end in pieces)
        if missing:
            _fail(f"{folder}: {missing:,} of {_pieces.Rows(spec).total:,} rows are missing; run the sweep again to finish it")
        return SweepResult(pathlib.Path(folder), spec, sweep, tuple(pieces))


def _poses_array(poses, where):
    poses = np.asarray(poses, dtype=float)
    if poses.shape[1:] not in ((4, 4), (7,)) or len(poses) == 0:
        _fail(f"{where}: poses must be an array (k, 4, 4) or (k, 7) of at least one pose, not {poses.shape}")
    numbers = poses.reshape(len(poses), -1)
    good = np.isfinite(numbers).all(axis=1)
    good &= (np.abs(numbers[:, (3, 7, 11) if poses.ndim == 3 else (0, 1, 2)]) <= MAX_POSITION).all(axis=1)
    if poses.ndim == 3:
        good &= (poses[:, 3] == (0, 0, 0, 1)).all(axis=1)
        good &= (np.abs(np.swapaxes(poses[:, :3, :3], 1, 2) @ poses[:, :3, :3] - np.eye(3)) < POSE_SLACK).all(axis=(1, 2))
        good &= np.linalg.det(poses[:, :3, :3]) > 0
    else:
        good &= np.abs(np.linalg.norm(poses[:, 3:], axis=1) - 1) < POSE_SLACK
    if not good.all():
        _fail(f"{where}: pose {int(np.argmin(good))} is no rigid transform: give finite numbers, positions within "
              f"{MAX_POSITION:g} m, and a rotation or a unit quaternion")
    return poses


def _names(parts):
    return [parts] if isinstance(parts, str) else list(parts)


def _positive(name, value, or_zero=False):
    if not (isinstance(value, (int, float, np.integer, np.floating)) and math.isfinite(value) and
            (value > 0 or (or_zero and value == 0))):
        _fail(f"{name}: it must be {'zero or more' if or_zero else 'more than zero'} and finite, not {value!r}")
    return float(value)


def _count(name, value, least=1):
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
        _fail(f"{name}: it must be an integer of at least {least}, not {value!r}")
    return int(value)


class _Inputs:
    """Inputs of a sweep: its specification, and the blobs that it names, by digest."""

    def __init__(self, scene, parts, poses, variants, tolerances, draws, seed, measures, cutoff, threshold):
        import nearfit

        self.blobs = {}
        self._meshes = {}
        there, parts = list(scene.parts), _names(parts)
        self._check_parts("parts", parts, there)
        if not parts or len(set(parts)) != len(parts):
            _fail("parts: name at least one part, and none twice")
        cutoff, threshold = _positive("cutoff", cutoff), _positive("threshold", threshold, True)
        if threshold > cutoff:
            _fail(f"threshold: {threshold:g} m is more than the cutoff of {cutoff:g} m, beyond which no minimum is looked for")
        wanted = set(_names(measures))
        if not wanted or wanted - set(_pieces.MEASURES):
            _fail(f"measures: choose among {', '.join(_pieces.MEASURES)}")
        measures = [m for m in _pieces.MEASURES if m in wanted]
        tolerances = {name: _positive(f"tolerance of {name}", size, True) for name, size in sorted((tolerances or {}).items())}
        self._check_parts("tolerances", tolerances, there)
        if not tolerances and draws != 1:
            _fail("draws: without tolerances all draws are alike; give tolerances, or leave draws out")
        arrays = self._poses(poses, parts)
        self.spec = {
            "nearfit": nearfit.__version__, "parts": parts, "count": len(arrays[0]), "poses": [self._add_poses(a) for a in arrays],
            "scene": [[name, self._add_mesh(scene.mesh(name)), np.asarray(scene.pose_row(name), float).ravel().tolist(),
                       scene.is_visible(name)] for name in there],
            "variants": self._variants(variants, there), "tolerances": tolerances, "draws": _count("draws", draws),
            "seed": _count("seed", seed, 0), "measures": measures, "cutoff": cutoff, "threshold": threshold}
        self._meshes.clear()
        spec = _pieces.canonical(self.spec)
        self.sweep = _pieces.digest(spec)
        self.blobs[self.sweep] = ("spec", spec)

    @staticmethod
    def _check_parts(what, names, there):
        for name in names:
            if name not in there:
                _fail(f"{what}: the scene has no part \"{name}\"")

    @staticmethod
    def _poses(poses, parts):
        if not isinstance(poses, collections.abc.Mapping):
            return [_poses_array(poses, "poses")] * len(parts)
        if set(poses) != set(parts):
            _fail("poses: give poses for each of the parts, and for no other")
        arrays = [_poses_array(poses[name], f"poses of {name}") for name in parts]
        if len({len(array) for array in arrays}) > 1:
            _fail("poses: give each part the same number of poses")
        return arrays

    def _keep(self, kind, blob):
        name = _pieces.digest(blob)
        self.blobs[name] = (kind, blob)
        return name

    def _add_poses(self, array):
        return self._keep("poses", _pieces.poses_blob(array))

    def _add_mesh(self, mesh):
        # Parts that share a mesh share its vertices: by their address it is hashed once. While the mesh is kept no other one gets
        # that address.
        address = mesh.vertices.__array_interface__["data"][0]
        if address not in self._meshes:
            self._meshes[address] = (mesh, self._keep("mesh", _pieces.mesh_blob(mesh)))
        return self._meshes[address][1]

    def _variants(self, variants, there):
        if variants is None:
            variants = {"nominal": {}}
        if not isinstance(variants, collections.abc.Mapping) or not variants:
            _fail("variants: give a dictionary of at least one variant: {name: {part: mesh}}")
        found = []
        for name, meshes in variants.items():
            if not isinstance(name, str) or not name:
                _fail("variants: a name must be text, and not empty")
            if name.encode(errors="replace").decode() != name:
                _fail(f"variants: the name {ascii(name)} cannot be written in UTF-8; choose another one")
            if len(name.encode()) > MAX_NAME_BYTES:
                _fail(f"variants: a name has more than {MAX_NAME_BYTES} bytes; shorten it")
            self._check_parts(f"variant \"{name}\"", meshes, there)
            found.append({"name": name, "meshes": {part: self._add_mesh(mesh) for part, mesh in sorted(meshes.items())}})
        return found

    def needed(self, row):
        """Blobs that a row is computed from."""
        variant, _, part, _ = _pieces.Rows(self.spec).place(row)
        return {name: self.blobs[name] for name in (self.sweep, *_pieces.needs(self.spec, variant, part))}

    def check_store(self, limit):
        """Raises Error where a worker could not keep what one piece needs."""
        sizes = {name: len(blob) for name, (_, blob) in self.blobs.items()}
        most = max(sum(sizes[name] for name in dict.fromkeys(_pieces.meshes_of(self.spec, v)))
                   for v in range(len(self.spec["variants"])))
        most += max(sizes[name] for name in self.spec["poses"]) + sizes[self.sweep]
        if most > limit:
            _fail(f"store_bytes: the meshes and poses of one piece take {most:,} bytes, more than the {limit:,} that a worker "
                  "keeps; raise it, or sweep fewer poses at once")


class _Waiting:
    """Rows that nobody has begun, as ranges in order."""

    def __init__(self, total, finished):
        self._ranges, free = collections.deque(), 0
        for begin, end in [*finished, (total, total)]:
            if free < begin:
                self._ranges.append((free, begin))
            free = end
        self.rows = sum(end - begin for begin, end in self._ranges)

    def take(self, count):
        begin, end = self._ranges.popleft()
        middle = min(end, begin + count)
        if middle < end:
            self._ranges.appendleft((middle, end))
        self.rows -= middle - begin
        return begin, middle

    def give_back(self, begin, end):
        """Rows of a piece that came back undone; they are the next to be taken."""
        if begin < end:
            self._ranges.appendleft((begin, end))
            self.rows += end - begin


class _Piece:
    """A range of rows that workers compute: `futures` has more than one where the first is late."""

    def __init__(self, begin, end):
        self.begin, self.end = begin, end
        self.attempts, self.misses, self.started = 0, 0, 0.0
        self.futures = []
        self.is_done = False


class _Here:
    """Computes pieces in this process, one after the other."""

    workers = 1

    def __init__(self, inputs, limit):
        self._inputs, self._limit = inputs, limit
        self._store = _pieces.Store()
        self._waiting = collections.deque()

    def slots(self):
        return 1

    def submit(self, piece, seconds):
        self._waiting.append((piece, seconds))

    def next(self, timeout):
        piece, seconds = self._waiting.popleft()
        while True:
            answer = _pieces.compute(self._inputs.sweep, piece.begin, piece.end, seconds, self._store)
            if "lacks" not in answer:
                return piece, answer
            # All that the piece needs: were it given what it lacks alone, that could drive out the rest, again and again.
            self._store.put(self._inputs.needed(piece.begin), self._limit)

    def drop(self, piece):
        pass

    def stop(self):
        self._waiting.clear()


class _Lost(Exception):
    """A worker was lost, or does not have what it was sent."""


class _OnDask:
    """Computes pieces by the workers of a Dask client."""

    def __init__(self, client, inputs, limit):
        self._client, self._inputs, self._limit = client, inputs, limit
        self._answers = queue.SimpleQueue()
        self._number = 0
        self._looked, self._threads, self._last_seen = -math.inf, {}, time.monotonic()

    @property
    def workers(self):
        return len(self._threads)

    def slots(self):
        """Threads of all workers at present."""
        now = time.monotonic()
        if now - self._looked >= LOOK_SECONDS:
            if self._client.status != "running":
                _fail("the connection to Dask's scheduler was lost; start the sweep again: it goes on where it stopped")
            self._threads, self._looked = dict(self._client.nthreads()), now
            if self._threads:
                self._last_seen = now
            elif now - self._last_seen > NO_WORKER_SECONDS:
                _fail("Dask has had no worker for two minutes; start workers, then the sweep again: it goes on where it stopped")
        return sum(self._threads.values())

    def submit(self, piece, seconds):
        self._number += 1
        # Each try has a key of its own: a piece may be asked for twice, and never be taken from an earlier sweep.
        # Where pieces drive each other's inputs out of a full store, one brings its own along.
        blobs = self._inputs.needed(piece.begin) if piece.misses >= MAX_MISSES else None
        future = self._client.submit(_pieces.run_piece, self._inputs.sweep, piece.begin, piece.end, seconds, blobs, self._limit,
                                     key=f"nearfit-{self._inputs.sweep[:12]}-{id(self):x}-{self._number}", pure=False)
        piece.futures.append(future)
        piece.started = time.monotonic()
        future.add_done_callback(lambda done, piece=piece: self._answers.put((piece, done)))

    def next(self, timeout):
        """(piece, answer or exception); None where none comes in time."""
        try:
            piece, future = self._answers.get(timeout=timeout)
        except queue.Empty:
            return None
        if piece.is_done or future not in piece.futures:
            return None
        piece.futures.remove(future)
        return piece, self._answer_of(future)

    def _answer_of(self, future):
        import distributed
        import distributed.comm

        if future.status != "finished":
            # A cancelled or lost future has no exception, and would be waited for.
            error = future.exception() if future.status == "error" else None
            is_lost = error is None or isinstance(error, (distributed.scheduler.KilledWorker, distributed.comm.CommClosedError,
                                                          OSError, MemoryError))
            return _Lost(str(error or future.status)) if is_lost else error
        try:
            answer = future.result()
        except (OSError, distributed.comm.CommClosedError, distributed.client.CancelledError) as e:
            return _Lost(str(e))
        if "lacks" in answer:
            self._deliver(answer["worker"], answer["lacks"])
        return answer

    def _deliver(self, worker, names):
        """Sends a worker what it lacks. It is asked again: pieces that waited for each other lacked the same."""
        # A worker that has gone meanwhile has no answer; the next one says itself what it lacks.
        with contextlib.suppress(OSError, KeyError, ValueError):
            lacks = self._client.run(_pieces.lacking, names, workers=[worker], on_error="return").get(worker)
            if not lacks or isinstance(lacks, Exception):
                return
            blobs = {name: self._inputs.blobs[name] for name in lacks}
            refused = self._client.run(_pieces.deliver, blobs, self._limit, workers=[worker], on_error="return").get(worker)
            if isinstance(refused, RuntimeError):
                _fail(f"a worker refused what it was sent: {refused}")

    def drop(self, piece):
        """Lets go of the futures of a piece that another one has answered."""
        for future in piece.futures:
            future.cancel()
        piece.futures.clear()

    def stop(self):
        pass


class _Progress:
    """A line on stderr, or calls of a function with (rows done, rows in all)."""

    def __init__(self, wanted, total, done):
        self._call = wanted if callable(wanted) else None
        self._shows = bool(wanted) and not callable(wanted)
        self._is_terminal = self._shows and sys.stderr.isatty()
        # A log gets a line now and then.
        self._pause = 0.2 if self._is_terminal else 30.0
        self._total, self._first, self._begun, self._last = total, done, time.monotonic(), -math.inf
        self._width = 0

    def show(self, done, workers):
        if self._call:
            self._call(done, self._total)
        now = time.monotonic()
        if not self._shows or (now - self._last < self._pause and done < self._total):
            return
        self._last = now
        rate = (done - self._first) / max(now - self._begun, 1e-9)
        left = f", {(self._total - done) / rate:.0f} s left" if rate > 0 and done < self._total else ""
        text = (f"sweep: {100 * done / self._total:.1f} % of {self._total:,} rows, {rate:,.0f} a second, {workers} "
                f"worker{'s' if workers != 1 else ''}{left}")
        if self._is_terminal:
            sys.stderr.write("\r" + text.ljust(self._width))
            self._width = len(text)
        else:
            sys.stderr.write(text + "\n")
        sys.stderr.flush()

    def end(self):
        if self._is_terminal and self._width:
            sys.stderr.write("\n")
            sys.stderr.flush()


class _Run:
    """Hands pieces out, takes answers in, and writes them."""

    def __init__(self, engine, inputs, folder, finished, piece_poses, piece_seconds, progress):
        self._engine, self._spec, self._folder = engine, inputs.spec, folder
        total = _pieces.Rows(inputs.spec).total
        self._waiting = _Waiting(total, finished)
        self._done = total - self._waiting.rows
        self._piece_poses, self._seconds = piece_poses, piece_seconds
        self._row_seconds = None
        self._out = set()
        self._written = list(finished)
        self._progress = _Progress(progress, total, self._done)
        self._total = total

    def run(self):
        try:
            while self._waiting.rows or self._out:
                self._hand_out()
                self._progress.show(self._done, self._engine.workers)
                got = self._engine.next(LOOK_SECONDS)
                if got is not None:
                    self._take(*got)
            self._progress.show(self._done, self._engine.workers)
        finally:
            self._progress.end()
            for piece in self._out:
                self._engine.drop(piece)
            self._engine.stop()
        return sorted(self._written)

    def _piece_rows(self, slots):
        if self._piece_poses is not None:
            return self._piece_poses
        rows = FIRST_ROWS if self._row_seconds is None else int(self._seconds / self._row_seconds)
        # Towards the end pieces get smaller, so that workers end together.
        fair = self._waiting.rows // (2 * max(slots, 1))
        return max(1, min(rows, MAX_PIECE_ROWS, max(fair, MIN_ROWS)))

    def _hand_out(self):
        slots = self._engine.slots()
        # Each thread has the next piece at hand when it ends one. What hangs keeps nobody from working.
        wanted = 1 if isinstance(self._engine, _Here) else 2 * slots
        late = self._late()
        while self._waiting.rows and len(self._out) - len(late) < wanted:
            piece = _Piece(*self._waiting.take(self._piece_rows(slots)))
            self._out.add(piece)
            self._submit(piece)
        # The first answer is taken; all have the same numbers.
        if not self._waiting.rows and len(self._out) - len(late) < slots:
            for piece in [p for p in late if len(p.futures) < MAX_ASKED][:1]:
                self._submit(piece)

    def _submit(self, piece):
        self._engine.submit(piece, self._seconds)

    def _late(self):
        """Pieces whose last try takes so long that its worker seems to hang, the latest first."""
        begun = time.monotonic() - max(MIN_LATE_SECONDS, LATE_FACTOR * self._seconds)
        return sorted((piece for piece in self._out if piece.started < begun), key=lambda piece: piece.started)

    def _take(self, piece, answer):
        if isinstance(answer, _Lost):
            piece.attempts += 1
            if piece.futures:
                return
            if piece.attempts >= MAX_ATTEMPTS:
                _fail(f"{self._place(piece)}: workers were lost {piece.attempts} times while they computed it ({answer}); give "
                      "workers more memory, or find what ends them, and start the sweep again: it goes on where it stopped")
            self._submit(piece)
        elif isinstance(answer, Exception):
            _fail(f"{self._place(piece)}: {answer}")
        elif "lacks" in answer:
            piece.misses += 1
            self._submit(piece)
        else:
            self._accept(piece, answer)

    def _accept(self, piece, answer):
        end = answer["end"]
        self._folder.write_piece(piece.begin, end, answer["data"])
        self._written.append((piece.begin, end))
        piece.is_done = True
        self._out.discard(piece)
        self._engine.drop(piece)
        self._waiting.give_back(end, piece.end)
        self._done += end - piece.begin
        cost = max(answer["seconds"], 1e-9) / (end - piece.begin)
        # Costs change from part to part: half of what is known is of the last piece.
        self._row_seconds = cost if self._row_seconds is None else 0.5 * (self._row_seconds + cost)

    def _place(self, piece):
        variant, draw, part, pose = _pieces.Rows(self._spec).place(piece.begin)
        return (f"variant \"{self._spec['variants'][variant]['name']}\", draw {draw}, part \"{self._spec['parts'][part]}\", from "
                f"pose {pose}")


@contextlib.contextmanager
def local_client(workers):
    """A cluster on this machine alone, one process of one thread for each core by default; ends with the context."""
    dask, distributed = need("dask"), need("distributed")
    with dask.config.set(LOCAL_CONFIG):  # The workers take it over as they start.
        cluster = distributed.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None,
                                           host="127.0.0.1", silence_logs=logging.CRITICAL)
    try:
        with distributed.Client(cluster) as client:
            yield client
    finally:
        cluster.close(timeout=10)


def _processors():
    return len(os.sched_getaffinity(0))


def sweep(scene, parts, poses, client=None, *, cutoff, threshold, folder, variants=None, tolerances=None, draws=1, seed=0,
          measures=_pieces.MEASURES, workers=None, piece_poses=None, piece_seconds=PIECE_SECONDS, store_bytes=STORE_BYTES,
          progress=True):
    """Least distance, number of minima below a threshold and overlap of parts, at poses, in variants of a scene.

    Each part in turn is placed at each pose, while all others stay where the scene has them.

    @param scene       Scene; it is read once, and not changed. Parts that are hidden are in nobody's way.
    @param parts       Names of the parts to place: a list, or one name.
    @param poses       (k, 4, 4), or (k, 7) rows tx ty tz [m], qw qx qy qz: world from part, for each part; or {part: poses}.
    @param client      dask.distributed.Client; None: processes on this machine, as `workers` says. Its workers need nearfit of
                       the same version.
    @param cutoff      Max distance to look for [m].
    @param threshold   Minima nearer than this are counted [m]; at most the cutoff.
    @param folder      For the results. Of a sweep that was stopped it has what was finished, and the same call goes on from
                       there. It is refused where it belongs to another sweep, with what differs.
    @param variants    {name: {part: Mesh}}: parts of other meshes; None: the scene as it is, named "nominal".
    @param tolerances  {part: t}: each draw moves the part, wherever it is placed, by up to t [m] along each axis of the world.
    @param draws       Number of draws of the tolerances.
    @param seed        Seed of the draws; each depends on it, its number and the part's name alone.
    @param measures    Any of "distance", "minima" and "overlap"; what is left out takes no time.
    @param workers     Without a client: number of processes; None: one for each processor; 0: in this process, without Dask.
    @param piece_poses    Max number of rows in a piece, at most 2^20; None: as many as take `piece_seconds`.
    @param piece_seconds  Time after which a piece ends [s]; the rest of its rows becomes another one.
    @param store_bytes    Bytes of meshes and poses that a worker keeps, as delivered.
    @param progress    True: a line on stderr; or a function of (rows done, rows in all).
    @return SweepResult. Its rows are the same, to the last bit, whatever computes them and however they are cut.

    Raises Error for inputs that make no sense, a folder of another sweep, and workers that are lost again and again.
    """
    import nearfit

    need("pyarrow")
    inputs = _Inputs(scene, parts, poses, variants, tolerances, draws, seed, measures, cutoff, threshold)
    piece_seconds = _positive("piece_seconds", piece_seconds)
    if piece_poses is not None:
        piece_poses = min(_count("piece_poses", piece_poses), MAX_PIECE_ROWS)
    inputs.check_store(_count("store_bytes", store_bytes))
    if client is None:
        workers = _processors() if workers is None else _count("workers", workers, 0)
    with contextlib.ExitStack() as stack:
        opened = stack.enter_context(SweepFolder(folder, nearfit.Error))
        opened.begin(inputs.sweep, inputs.spec)
        finished = opened.finished(inputs.sweep, inputs.spec)
        for note in opened.notes:
            if progress:
                print(f"sweep: {note}", file=sys.stderr)
        if sum(end - begin for begin, end in finished) < _pieces.Rows(inputs.spec).total:
            if client is None and workers == 0:
                engine = _Here(inputs, store_bytes)
            else:
                engine = _OnDask(client or stack.enter_context(local_client(workers)), inputs, store_bytes)
            finished = _Run(engine, inputs, opened, finished, piece_poses, piece_seconds, progress).run()
        return SweepResult(pathlib.Path(folder), inputs.spec, inputs.sweep, tuple(finished))
