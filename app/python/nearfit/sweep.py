"""`python -m nearfit.sweep`: a sweep from the command line, as `nearfit-cli sweep` runs it.

The module can be called, too, because importing it gives the package's attribute `sweep`, a function, its place.
"""

import argparse
import pathlib
import signal
import sys
import types

import numpy as np

from ._sweep import MAX_PIECE_ROWS, PIECE_SECONDS, SweepResult, need, open_sweep, sweep
from ._sweep_folder import read_file

__all__ = ["SweepResult", "open_sweep", "sweep"]

USAGE, FAILURE, STOPPED = 2, 1, 130
# 100,000,000 poses as 16 numbers each.
MAX_POSES_BYTES = 16 << 30
# Equals kQuaternionSlack (core/scene/part.h): rounding to three digits.
QUATERNION_SLACK = 1e-3


class _CallableModule(types.ModuleType):
    def __call__(self, *arguments, **options):
        return sweep(*arguments, **options)


sys.modules[__name__].__class__ = _CallableModule


class _UsageError(Exception):
    pass


def _check_row(numbers, where):
    if not np.isfinite(numbers).all():
        raise ValueError(f"{where}: a number is not finite; write tx,ty,tz,qw,qx,qy,qz")
    if abs(np.linalg.norm(numbers[3:]) - 1) > QUATERNION_SLACK:
        raise ValueError(f"{where}: the quaternion's length is not 1; normalise it")


def _rows_of_csv(text):
    rows, is_first = [], True
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        fields = line.split(",")
        try:
            numbers = [float(field) for field in fields]
        except ValueError:
            if is_first:
                is_first = False
                continue
            raise ValueError(f"line {number}: it is no pose; write tx,ty,tz,qw,qx,qy,qz") from None
        if len(numbers) != 7:
            raise ValueError(f"line {number}: it has {len(numbers)} numbers; write the seven tx,ty,tz,qw,qx,qy,qz")
        _check_row(numbers, f"line {number}")
        rows.append(numbers)
        is_first = False
    if not rows:
        raise ValueError("it has no pose; write tx,ty,tz,qw,qx,qy,qz in each line")
    return np.array(rows)


def read_poses(path):
    """Poses of a file, (k, 4, 4) or (k, 7): CSV with tx, ty, tz, qw, qx, qy, qz in each line, or such an array of numpy (.npy).
    Raises ValueError, OSError, and for a damaged .npy what numpy does."""
    import io

    data = read_file(path, MAX_POSES_BYTES, follows=True)
    if pathlib.Path(path).suffix != ".npy":
        return _rows_of_csv(data.decode("utf-8"))
    # A header may claim any size, and objects could run code.
    array = np.load(io.BytesIO(data), allow_pickle=False)
    if not isinstance(array, np.ndarray) or array.dtype.kind not in "fiu":
        raise ValueError("it is no array of numbers; write float64 (k, 4, 4) or (k, 7)")
    array = np.asarray(array, dtype=float)
    if array.ndim == 2 and array.shape[1] == 7 and len(array):
        for i, row in enumerate(array):
            _check_row(row, f"pose {i}")
        return array
    if array.ndim != 3 or array.shape[1:] != (4, 4):
        raise ValueError(f"it is an array {array.shape}; write (k, 4, 4) or (k, 7)")
    return array


def _tolerance(text):
    name, _, size = text.rpartition("=")
    try:
        return name, float(size)
    except ValueError:
        raise argparse.ArgumentTypeError(f"\"{text}\" is not NAME=D") from None


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise _UsageError(message)


def _parser():
    parser = _Parser(prog="nearfit.sweep", description="Least distance, minima below a threshold and overlap of parts at poses.")
    parser.add_argument("scene", help="scene file (*.nearfit)")
    parser.add_argument("--parts", default="", help="names of the parts to place, separated by commas")
    parser.add_argument("--part", action="append", default=[], help="one more part, whose name may have commas")
    parser.add_argument("--poses", required=True, help="poses, world from part: FILE.csv or FILE.npy")
    parser.add_argument("--threshold", type=float, required=True, help="count minima nearer than this [m]")
    parser.add_argument("--cutoff", type=float, required=True, help="look no farther than this [m]")
    parser.add_argument("-o", "--out", required=True, help="folder for the results")
    parser.add_argument("--workers", type=int, help="processes; 0: none besides this one; default: one for each processor")
    parser.add_argument("--scheduler", help="address of a Dask scheduler, such as tcp://HOST:8786, instead of processes here")
    parser.add_argument("--tolerance", type=_tolerance, action="append", default=[], metavar="NAME=D",
                        help="each draw moves this part by up to D [m] along each axis")
    parser.add_argument("--draws", type=int, default=1, help="draws of the tolerances")
    parser.add_argument("--seed", type=int, default=0, help="seed of the draws")
    parser.add_argument("--measures", default="distance,minima,overlap", help="what to compute, separated by commas")
    parser.add_argument("--piece-poses", type=int, help=f"max rows in a piece; default: as time says, at most {MAX_PIECE_ROWS}")
    parser.add_argument("--piece-seconds", type=float, default=PIECE_SECONDS, help="time after which a piece ends [s]")
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")
    return parser


def _client_of(address):
    import nearfit

    distributed = need("distributed")
    try:
        return distributed.Client(address)
    # Dask raises what it meets: ValueError for an unknown protocol, OSError where nobody answers.
    except Exception as e:
        raise nearfit.Error(f"--scheduler {address}: it cannot be used: {str(e) or type(e).__name__}; give the address of a Dask "
                            "scheduler that runs, such as tcp://HOST:8786") from None


def _run(arguments):
    import nearfit

    options = _parser().parse_args(arguments)
    parts = [name for name in options.parts.split(",") if name] + options.part
    if not parts:
        raise _UsageError("name at least one part by --parts or --part")
    if options.scheduler and options.workers is not None:
        raise _UsageError("--scheduler and --workers exclude each other")
    try:
        poses = read_poses(options.poses)
    except (OSError, ValueError, EOFError, MemoryError) as e:
        raise nearfit.Error(f"{options.poses}: {str(e) or type(e).__name__}") from None
    # numpy reads a head by Python's tokenizer and parser, and lets through all that these raise for a damaged one.
    except Exception as e:
        raise nearfit.Error(f"{options.poses}: it cannot be read: {str(e) or type(e).__name__}; write it by numpy.save()") from None
    scene = nearfit.Scene.open(options.scene)
    client = None
    if options.scheduler:
        client = _client_of(options.scheduler)
    try:
        result = sweep(scene, parts, poses, client, cutoff=options.cutoff, threshold=options.threshold, folder=options.out,
                       tolerances=dict(options.tolerance), draws=options.draws, seed=options.seed,
                       measures=options.measures.split(","), workers=options.workers, piece_poses=options.piece_poses,
                       piece_seconds=options.piece_seconds, progress=not options.quiet)
    finally:
        if client is not None:
            client.close()
    print(f"{len(result):,} rows in {len(result.pieces):,} pieces: {result.folder}")


def _stop(*_):
    raise KeyboardInterrupt


def _say(message):
    print("nearfit-cli: " + " ".join(str(message).split()), file=sys.stderr)


def main(arguments=None):
    """Runs a sweep; returns the exit code: 0, 1 for a failure, 2 for wrong usage, 130 where it was stopped."""
    import nearfit

    signal.signal(signal.SIGTERM, _stop)
    try:
        _run(sys.argv[1:] if arguments is None else arguments)
    except _UsageError as e:
        _say(f"{e}; see nearfit-cli sweep --help")
        return USAGE
    except KeyboardInterrupt:
        _say("the sweep was stopped; the same command goes on where it stopped")
        return STOPPED
    except (nearfit.Error, OSError) as e:
        _say(e)
        return FAILURE
    return 0


if __name__ == "__main__":
    sys.exit(main())
