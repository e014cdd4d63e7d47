#!/usr/bin/env python3
"""Runs a minute of contact with each maker's stand-in, and writes what each took from a pose to the answer, and the most
energy that its motors gave.

    tests/makers/contact_figures.py --program build/release/bin/maker_stress_tests --csv tests/makers/results/contact.csv

Takes nine minutes, on a machine that does nothing else. Exits 1 if a model misses its goal, after all results are written.
"""

import argparse
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True  # The folder is the repository's.
sys.path.insert(0, str(ROOT / "resources" / "scripts" / "figure_sources"))
import heads  # noqa: E402

COLUMNS = "model,rate_hz,samples,p50_us,p99_us,p99_9_us,max_us,max_energy_j"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, required=True, help="maker_stress_tests")
    parser.add_argument("--csv", type=pathlib.Path, required=True, help="file for the results")
    parser.add_argument("--allow-busy", action="store_true", help="measure although other programs run; the results say so")
    options = parser.parse_args()
    head = heads.head_or_exit("contact_figures.py", options.csv, ROOT, options.program.resolve().parents[1], options.allow_busy)
    result = subprocess.run([options.program], capture_output=True, text=True)
    print(result.stdout)
    rows = [line.removeprefix("figures,") for line in result.stdout.splitlines() if line.startswith("figures,")]
    if not rows:
        sys.exit(f"contact_figures.py: {options.program} told no figures: {result.stderr[-400:]}")
    options.csv.parent.mkdir(parents=True, exist_ok=True)
    options.csv.write_text("".join(f"# {line}\n" for line in head) + "\n".join([COLUMNS, *rows]) + "\n")
    return 1 if result.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
