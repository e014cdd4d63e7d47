"""Pieces of a sweep: what a worker keeps, computes and encodes (docs/sweeps.md).

A sweep's rows are numbered: variants outermost, then draws of the tolerances, parts and poses. A piece is a range of rows.
Each pose is searched cold, so the answer of a row depends on nothing but the specification: neither on where pieces begin
nor on who computes them.
"""

import collections
import hashlib
import json
import struct
import threading
import time

import numpy as np

# Columns that a caller may leave out, and what computes them costs.
MEASURES = ("distance", "minima", "overlap")
# The first batch of a piece, so that one of slow poses is cut in time; it doubles while a batch is short.
FIRST_BATCH = 16
MAX_BATCH = 4096
# A batch that takes less of the piece's time than this can be doubled without being late.
BATCH_SHARE = 1 / 20
# Minima are searched up to so many thresholds: what lies just beyond the threshold decides which minima below it are one flat
# region. Surfaces of a region deviate from parallel by a millionth of their size (kFlatTolerance), so twice is ample.
THRESHOLD_REACH = 2.0
# A piece's columns, names included, have to fit into memory.
MAX_PIECE_ROWS = 1 << 20
# Names stand in each row: so many of this many bytes are less than the 2 GiB of a column of text. Part names are shorter.
MAX_NAME_BYTES = 1024
# A mesh as delivered: its fingerprint, counts of vertices and triangles, then coordinates [m] and indices.
MESH_HEAD = struct.Struct("<64sQQ")
# Poses as delivered: numbers in each, 7 (translation [m], quaternion) or 16 (matrix), then these.
POSES_HEAD = struct.Struct("<Q")


def digest(data):
    """SHA-256 of bytes, as hexadecimal text."""
    return hashlib.sha256(data).hexdigest()


def canonical(value):
    """JSON of a specification in bytes, the same for equal values: numbers by their shortest exact digits, no NaN."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False).encode()


def mesh_blob(mesh):
    """Bytes of a mesh, for Store.put()."""
    vertices = np.ascontiguousarray(mesh.vertices, dtype="<f8")
    triangles = np.ascontiguousarray(mesh.triangles, dtype="<u4")
    head = MESH_HEAD.pack(mesh.fingerprint.encode(), len(vertices), len(triangles))
    return head + vertices.tobytes() + triangles.tobytes()


def poses_blob(poses):
    """Bytes of poses, (k, 7) or (k, 4, 4), for Store.put()."""
    return POSES_HEAD.pack(poses[0].size) + np.ascontiguousarray(poses, dtype="<f8").tobytes()


def _mesh_of(blob):
    import nearfit

    fingerprint, vertices, triangles = MESH_HEAD.unpack_from(blob)
    first = MESH_HEAD.size + 24 * vertices
    mesh = nearfit.Mesh(np.frombuffer(blob, "<f8", 3 * vertices, MESH_HEAD.size).reshape(-1, 3),
                        np.frombuffer(blob, "<u4", 3 * triangles, first).reshape(-1, 3))
    # Building repairs what a file may have wrong; a mesh that is built already has to stay as it is.
    if mesh.fingerprint.encode() != fingerprint.rstrip(b"\0"):
        raise nearfit.Error(f"mesh {fingerprint[:12].decode()}: built anew it is another one; pass nearfit.Mesh(m.vertices, "
                            "m.triangles) of it as a variant's mesh")
    return mesh


def _poses_of(blob):
    (width,) = POSES_HEAD.unpack_from(blob)
    return np.frombuffer(blob, "<f8", offset=POSES_HEAD.size).reshape((-1, 7) if width == 7 else (-1, 4, 4))


def moved(poses, shift):
    """A copy of poses, (k, 7) or (k, 4, 4), moved along the world's axes [m]."""
    poses = np.array(poses, dtype=float)
    translations = poses[:, :3] if poses.ndim == 2 else poses[:, :3, 3]
    translations += shift
    return poses


def shift_of(seed, draw, part, size):
    """(3,) shift [m] of a part, along the world's axes, each uniform in [-size, size). It depends on its arguments alone, not on
    a generator whose stream another version of numpy may change, nor on the order in which draws are made."""
    if size == 0:
        return np.zeros(3)
    head = f"{seed}:{draw}:".encode() + part.encode()
    words = struct.unpack_from("<3Q", hashlib.sha256(head).digest())
    # 53 bits are what a double holds.
    return np.array([size * ((word >> 11) * 2.0**-52 - 1.0) for word in words])


class Rows:
    """Where the rows of a specification lie."""

    def __init__(self, spec):
        self.parts, self.variants = spec["parts"], spec["variants"]
        self.draws, self.poses = spec["draws"], spec["count"]
        self.total = len(self.variants) * self.draws * len(self.parts) * self.poses

    def place(self, row):
        """(variant, draw, part, pose) of a row, each counted from 0."""
        rest, pose = divmod(row, self.poses)
        rest, part = divmod(rest, len(self.parts))
        variant, draw = divmod(rest, self.draws)
        return variant, draw, part, pose

    def runs(self, begin, end):
        """Yields (variant, draw, part, first pose, last pose + 1) of each run of rows that differ by pose alone."""
        while begin < end:
            variant, draw, part, pose = self.place(begin)
            count = min(end - begin, self.poses - pose)
            yield variant, draw, part, pose, pose + count
            begin += count


class Forgotten(KeyError):
    """A worker does not have, or no longer, what a digest names."""


class Store:
    """Store of a worker, by content: meshes with their hierarchies, poses and specifications, those least used forgotten when
    they take more than `limit` bytes as delivered. It forgets nothing that the scene at hand needs. For several threads."""

    def __init__(self):
        self._lock = threading.RLock()
        self._kept = collections.OrderedDict()
        self._sizes = {}
        self._bytes = 0
        self._scenes = {}
        self.limit = 0

    def put(self, blobs, limit):
        """Takes {digest: (kind, bytes)}. Raises Error where bytes are not those that the digest names."""
        import nearfit

        if any(digest(blob) != name for name, (_, blob) in blobs.items()):
            raise nearfit.Error("what a worker received is damaged; start the sweep again")
        with self._lock:
            self.limit = limit
            for name, (kind, blob) in blobs.items():
                if name not in self._kept:
                    self._kept[name] = (kind, blob)
                    self._sizes[name] = len(blob)
                    self._bytes += len(blob)
                self._kept.move_to_end(name)
            self._forget(set(blobs))

    def _forget(self, spared):
        spared = spared | self._in_use()
        for name in list(self._kept):
            if self._bytes <= self.limit:
                return
            if name not in spared:
                del self._kept[name]
                self._bytes -= self._sizes.pop(name)

    def _in_use(self):
        return {name for kept in self._scenes.values() for name in (kept["key"][0], *kept["key"][3])}

    def get(self, name):
        """The mesh, poses or specification of a digest, made of its bytes at the first call. Raises Forgotten."""
        with self._lock:
            if name not in self._kept:
                raise Forgotten(name)
            self._kept.move_to_end(name)
            kind, kept = self._kept[name]
        if kind is None:
            return kept
        # Not under the lock: a mesh takes a while, and a delivery must not wait in the thread that talks to the scheduler.
        made = {"mesh": _mesh_of, "poses": _poses_of, "spec": json.loads}[kind](kept)
        with self._lock:
            if name in self._kept:
                self._kept[name] = (None, made)
        return made

    def lacks(self, names):
        with self._lock:
            return [name for name in names if name not in self._kept]

    def bytes(self):
        """Bytes of what is kept, as delivered."""
        with self._lock:
            return self._bytes

    def scene(self, sweep, spec, variant, draw, part):
        """The scene of a variant and a draw, for queries of a part (a name). Each thread keeps the last one: rows of one scene
        follow one another, and a scene is not to be changed while another thread uses it."""
        import nearfit

        meshes, thread = meshes_of(spec, variant), threading.get_ident()
        key, kept = (sweep, variant, draw, tuple(meshes)), self._scenes.get(thread)
        if kept is None or kept["key"] != key:
            kept = {"key": key, "scene": nearfit.Scene(), "rows": {}, "part": part}
            for (name, _, row, is_visible), mesh in zip(spec["scene"], meshes):
                shift = shift_of(spec["seed"], draw, name, spec["tolerances"].get(name, 0.0))
                kept["rows"][name] = moved([row], shift)[0]
                kept["scene"].add(self.get(mesh), name=name, pose=kept["rows"][name], visible=is_visible)
            with self._lock:
                self._scenes[thread] = kept
        if kept["part"] != part:
            # Moving a part makes a scene forget what it keeps for queries of others, some 20 MB each: nobody asks for them again.
            kept["scene"].set_pose(part, kept["rows"][part])
            kept["part"] = part
        return kept["scene"]


def meshes_of(spec, variant):
    """Digests of the meshes of a variant's parts, in the order of the scene."""
    other = spec["variants"][variant]["meshes"]
    return [other.get(name, mesh) for name, mesh, *_ in spec["scene"]]


# One for all workers of a process.
STORE = Store()


def lacking(names):
    """Runs on a worker: those of the names that it has not."""
    return STORE.lacks(names)


def deliver(blobs, limit):
    """Runs on a worker: keeps what it lacked."""
    STORE.put(blobs, limit)


def measure(scene, part, poses, spec):
    """Columns of a batch of poses: a dictionary of arrays of one length."""
    import nearfit

    columns = {}
    if "distance" in spec["measures"]:
        columns["distance"] = np.asarray(nearfit.distance(scene, part, poses, cutoff=spec["cutoff"], threads=1),
                                         dtype=float)
    if "minima" in spec["measures"]:
        # No minimum is nearer than zero; but what is asked has to be more.
        within = min(spec["cutoff"], THRESHOLD_REACH * spec["threshold"]) or spec["cutoff"]
        found = nearfit.lmds(scene, part, poses, within, threads=1)
        # Counts of minima below the threshold up to each place; differences at the offsets are those of poses.
        below = np.concatenate(([0], np.cumsum(np.asarray(found.distances) < spec["threshold"])))
        columns["minima"] = np.diff(below[np.asarray(found.offsets)]).astype(np.int32)
        columns["complete"] = np.asarray(found.complete, dtype=bool)
    if "overlap" in spec["measures"]:
        columns["overlap"] = np.asarray(nearfit.overlap(scene, part, poses, threads=1), dtype=bool)
    return columns


def needs(spec, variant, part):
    """Digests of what rows of a variant and a part are computed from."""
    return [*dict.fromkeys(meshes_of(spec, variant)), spec["poses"][part]]


def compute(sweep, begin, end, seconds, store=None, clock=time.perf_counter):
    """Computes rows from `begin`, up to `end` or until `seconds` have passed, but one batch at least.

    Returns {"end": row after the last computed, "data": Parquet, "seconds": time taken}, or, where nothing could be computed
    for lack of inputs, {"lacks": their digests}.
    """
    import nearfit

    store = store or STORE
    if store.lacks([sweep]):
        return {"lacks": [sweep]}
    started, row, batches, batch = clock(), begin, [], FIRST_BATCH
    spec = store.get(sweep)
    if spec["nearfit"] != nearfit.__version__:
        raise nearfit.Error(f"a worker has version {nearfit.__version__} of nearfit, not {spec['nearfit']}; install the same on all")
    for variant, draw, part, first, last in Rows(spec).runs(begin, end):
        names, name = needs(spec, variant, part), spec["parts"][part]
        try:
            lacks = store.lacks(names)
            if lacks:
                raise Forgotten(lacks[0])
            scene, poses = store.scene(sweep, spec, variant, draw, name), store.get(spec["poses"][part])
        except Forgotten:
            if batches:
                break
            return {"lacks": store.lacks(names)}
        shift = shift_of(spec["seed"], draw, name, spec["tolerances"].get(name, 0.0))
        while first < last and (not batches or clock() - started < seconds):
            count = min(batch, last - first)
            placed = moved(poses[first:first + count], shift)
            before = clock()
            batches.append(measure(scene, name, placed, spec))
            if clock() - before < BATCH_SHARE * seconds:
                batch = min(2 * batch, MAX_BATCH)
            first += count
            row += count
        if first < last:
            break
    columns = {name: np.concatenate([b[name] for b in batches]) for name in batches[0]}
    return {"end": row, "data": encode(spec, sweep, begin, row, columns), "seconds": clock() - started}


def run_piece(sweep, begin, end, seconds, blobs=None, limit=0):
    """Task of a worker: compute(), and who computed it. `blobs` are what it has missed too often."""
    import distributed

    if blobs:
        STORE.put(blobs, limit)
    return {**compute(sweep, begin, end, seconds), "worker": distributed.get_worker().address}


def schema_of(spec):
    """Names and types of a piece's columns."""
    import pyarrow as pa

    types = {"distance": pa.float64(), "minima": pa.int32(), "complete": pa.bool_(), "overlap": pa.bool_()}
    names = [name for name in ("distance", "minima", "complete", "overlap")
             if name in spec["measures"] or (name == "complete" and "minima" in spec["measures"])]
    return pa.schema([pa.field(name, kind, nullable=False) for name, kind in
                      [("variant", pa.string()), ("draw", pa.int32()), ("part", pa.string()), ("pose", pa.int64())] +
                      [(name, types[name]) for name in names]])


def key_columns(spec, begin, end):
    """The columns that say which row it is."""
    import pyarrow as pa

    runs = list(Rows(spec).runs(begin, end))
    lengths = [last - first for *_, first, last in runs]

    def names(which, of):
        indices = pa.array(np.repeat(np.array([run[which] for run in runs], np.int32), lengths))
        return pa.DictionaryArray.from_arrays(indices, pa.array(of, pa.string())).cast(pa.string())

    return [names(0, [v["name"] for v in spec["variants"]]),
            pa.array(np.repeat(np.array([run[1] for run in runs], np.int32), lengths)),
            names(2, spec["parts"]),
            pa.array(np.concatenate([np.arange(first, last, dtype=np.int64) for *_, first, last in runs]))]


def head_of(sweep, begin, end):
    """Metadata of a piece's file: its sweep and its rows."""
    return {b"nearfit.sweep": sweep.encode(), b"nearfit.rows": f"{begin}-{end}".encode()}


def encode(spec, sweep, begin, end, columns):
    """Parquet of a piece, with checksums, as bytes."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    schema = schema_of(spec)
    table = pa.Table.from_arrays(key_columns(spec, begin, end) + [pa.array(columns[name]) for name in schema.names[4:]],
                                 schema=schema).replace_schema_metadata(head_of(sweep, begin, end))
    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd", use_dictionary=["variant", "part", "draw"],
                   column_encoding={"pose": "DELTA_BINARY_PACKED"}, write_page_checksum=True)
    return sink.getvalue().to_pybytes()
