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
# A mesh as delivered: magic, vertices and triangles as counts, then coordinates [m] and indices.
MESH_HEAD = struct.Struct("<8sQQ")
MESH_MAGIC = b"nfmesh1\0"


def digest(data):
    """SHA-256 of bytes, as hexadecimal text."""
    return hashlib.sha256(data).hexdigest()


def canonical(value):
    """JSON of a specification in bytes, the same for equal values: numbers by their shortest exact digits, no NaN."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False).encode()


def mesh_blob(mesh):
    """Bytes of a mesh, for delivery()."""
    vertices = np.ascontiguousarray(mesh.vertices, dtype="<f8")
    triangles = np.ascontiguousarray(mesh.triangles, dtype="<i4")
    return MESH_HEAD.pack(MESH_MAGIC, len(vertices), len(triangles)) + vertices.tobytes() + triangles.tobytes()


def poses_blob(poses):
    """Bytes of poses (k, 4, 4), for delivery()."""
    return np.ascontiguousarray(poses, dtype="<f8").tobytes()


def _mesh_of(blob):
    import nearfit

    magic, vertices, triangles = MESH_HEAD.unpack_from(blob)
    if magic != MESH_MAGIC or len(blob) != MESH_HEAD.size + 24 * vertices + 12 * triangles:
        raise nearfit.Error("a mesh arrived damaged; start the sweep again")
    first = MESH_HEAD.size + 24 * vertices
    return nearfit.Mesh(np.frombuffer(blob, "<f8", 3 * vertices, MESH_HEAD.size).reshape(-1, 3),
                        np.frombuffer(blob, "<i4", 3 * triangles, first).reshape(-1, 3))


def _poses_of(blob):
    return np.frombuffer(blob, "<f8").reshape(-1, 4, 4)


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


class Store:
    """What a worker keeps by content: meshes with their hierarchies, poses and specifications, those least used forgotten when
    they take more than `limit` bytes as delivered. It forgets nothing that the scene at hand needs."""

    def __init__(self):
        self._lock = threading.RLock()
        self._kept = collections.OrderedDict()
        self._sizes = {}
        self._scene = (None, None)
        self.limit = 0

    def put(self, blobs, limit):
        """Takes {digest: (kind, bytes)}. Raises Error where bytes are not those that the digest names."""
        import nearfit

        with self._lock:
            self.limit = limit
            for name, (kind, blob) in blobs.items():
                if name in self._kept:
                    self._kept.move_to_end(name)
                    continue
                if digest(blob) != name:
                    raise nearfit.Error("what a worker received is damaged; start the sweep again")
                self._kept[name] = {"mesh": _mesh_of, "poses": _poses_of, "spec": json.loads}[kind](blob)
                self._sizes[name] = len(blob)
            self._forget(set(blobs))

    def _forget(self, spared):
        spared = spared | self._in_use()
        for name in list(self._kept):
            if sum(self._sizes.values()) <= self.limit:
                return
            if name not in spared:
                del self._kept[name], self._sizes[name]

    def _in_use(self):
        key = self._scene[0]
        return set() if key is None else {key[0], *key[3]}

    def get(self, name):
        with self._lock:
            self._kept.move_to_end(name)
            return self._kept[name]

    def lacks(self, names):
        with self._lock:
            return [name for name in names if name not in self._kept]

    def bytes(self):
        """Bytes of what is kept, as delivered."""
        with self._lock:
            return sum(self._sizes.values())

    def scene(self, sweep, spec, variant, draw):
        """The scene of a variant and a draw. The last one is kept: rows of one scene follow one another."""
        import nearfit

        meshes = meshes_of(spec, variant)
        key = (sweep, variant, draw, tuple(meshes))
        with self._lock:
            if self._scene[0] != key:
                scene = nearfit.Scene()
                for (name, _, pose), mesh in zip(spec["scene"], meshes):
                    pose = np.array(pose, dtype=float).reshape(4, 4)
                    pose[:3, 3] += shift_of(spec["seed"], draw, name, spec["tolerances"].get(name, 0.0))
                    scene.add(self.get(mesh), name=name, pose=pose)
                self._scene = (key, scene)
            return self._scene[1]


def meshes_of(spec, variant):
    """Digests of the meshes of a variant's parts, in the order of the scene."""
    other = spec["variants"][variant]["meshes"]
    return [other.get(name, mesh) for name, mesh, _ in spec["scene"]]


# One for all workers of a process.
STORE = Store()


def deliver(blobs, limit):
    """Runs on a worker: keeps what it lacked. Returns the names of what it has now."""
    STORE.put(blobs, limit)
    return sorted(blobs)


def measure(scene, part, poses, spec):
    """Columns of a batch of poses: a dictionary of arrays of one length."""
    import nearfit

    columns = {}
    if "distance" in spec["measures"]:
        columns["distance"] = np.asarray(nearfit.distance(scene, part, poses, cutoff=spec["cutoff"], threads=1),
                                         dtype=float)
    if "minima" in spec["measures"]:
        found = nearfit.lmds(scene, part, poses, spec["cutoff"], threads=1)
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
    store = store or STORE
    if store.lacks([sweep]):
        return {"lacks": [sweep]}
    started, row, batches, batch = clock(), begin, [], FIRST_BATCH
    spec = store.get(sweep)
    for variant, draw, part, first, last in Rows(spec).runs(begin, end):
        lacks = store.lacks(needs(spec, variant, part))
        if lacks:
            if batches:
                break
            return {"lacks": lacks}
        scene = store.scene(sweep, spec, variant, draw)
        name = spec["parts"][part]
        shift = shift_of(spec["seed"], draw, name, spec["tolerances"].get(name, 0.0))
        poses = store.get(spec["poses"][part])
        while first < last and (not batches or clock() - started < seconds):
            count = min(batch, last - first)
            placed = poses[first:first + count].copy()
            placed[:, :3, 3] += shift
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


def run_piece(sweep, begin, end, seconds):
    """Task of a worker: compute(), and who computed it."""
    import distributed

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
    """What a piece's file says that it is."""
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
