#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What an NVIDIA GPU makes of the kernels, told without one: registers, stack, spills, instructions by kind.

  scripts/gpu_static.py                     one variant of each kernel: halves in buffers
  scripts/gpu_static.py '^resolve_layers '  the rows of kernels/variants.txt that match
  scripts/gpu_static.py --against COMMIT    beside what that commit's kernels are

Prints a Markdown table. Needs clang and libclc of one version (Debian 12: clang-15 libclc-15; Debian 13: clang-19
libclc-19), and ptxas of CUDA for registers, stack and spills; without it, and for variants of images, a dash stands for
them. Calls are inlined, as a driver's compiler does. A loop counts once, so counts are not times. They repeat to the
digit, and tell what a change does.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
ARCHITECTURE = "sm_90"
# The passes of the default scene by temporal:balanced, as quincunx-render --explain lists them.
DEFAULT_PLAN = frozenset("""reproject layer_records turn_records advect_records layer_split temporal_tiles
    temporal_light resolve_temporal resolve_layers temporal_display display_layers present""".split())
MOST_REGISTERS = 128  # of a work-item in the default plan, which has neither stack nor spills
# The variant of a kernel that has most of these.
USUAL = frozenset("""SOURCE_STORAGE=BUFFER OUTPUT_STORAGE=BUFFER SOURCE_FORMAT=HALF OUTPUT_FORMAT=HALF
    VELOCITY_FORMAT=HALF HISTORY_FORMAT=HALF ALPHA=0 MOTION=1 LAYERS=1 TAPS=16 REACTIVE=0 RESIDUAL=0 VIEW=PICTURE
    MOTION_EDGE=1 OPEN_TRUST=1 SMOOTH=1 TONE_MAP=TONE_ACES DITHER=1""".split())
KINDS = {"PTX": r"[a-z]", "loads": r"ld\.", "stores": r"st\.", "float": r"[a-z.]+\.f32|cvt",
         "integer": r"[a-z.]+\.[sub](?:16|32|64)", "branches": r"bra"}
COLUMNS = ("registers", "stack", "spills", *KINDS)


class Compiler:
    def __init__(self):
        for version in (15, 19, 18, 17, 16):
            self.clang = shutil.which(f"clang-{version}")
            libraries = [pathlib.Path("/usr/lib/clc/nvptx64--nvidiacl.bc"),
                         pathlib.Path(f"/usr/lib/llvm-{version}/share/clc/nvptx64--nvidiacl.bc")]
            self.library = next((path for path in libraries if path.exists()), None)
            if self.clang and self.library:
                break
        else:
            sys.exit("This needs clang and libclc of one version: apt-get install clang-15 libclc-15 (Debian 12), "
                     "clang-19 libclc-19 (Debian 13)")
        self.ptxas = shutil.which("ptxas") or shutil.which("/usr/local/cuda/bin/ptxas")

    def counts_of(self, kernels, name, options):
        """The columns of one variant, by name; None for what ptxas would tell."""
        source = next(kernels.rglob(f"{name}.cl"), None)
        if source is None:
            sys.exit(f"{kernels} has no {name}.cl")
        with tempfile.TemporaryDirectory() as folder:
            code = pathlib.Path(folder, "kernel.ptx")
            done = subprocess.run(
                [self.clang, "-x", "cl", "-cl-std=CL1.2", "-target", "nvptx64--nvidiacl", "-O3",
                 "-mllvm", "-inline-threshold=1000000", "-I", kernels, "-I", kernels / "include",
                 *(word for flag in ("-finclude-default-header", "-target-feature", "+ptx75", "-target-cpu", "sm_86",
                                     "-mlink-builtin-bitcode", str(self.library)) for word in ("-Xclang", flag)),
                 "-DLANES=1", *options, "-S", "-o", code, source], capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{name} {' '.join(options)} does not compile:\n{done.stderr}")
            ptx = code.read_text()
            counts = dict.fromkeys(COLUMNS)
            for kind, pattern in KINDS.items():
                counts[kind] = len(re.findall(rf"^\s+(?:@!?%p\d+ )?(?:{pattern})", ptx, re.MULTILINE))
            if self.ptxas:
                ptx = re.sub(r"\.target sm_\d+", f".target {ARCHITECTURE}", ptx)
                code.write_text(re.sub(r"\.version \d\.\d", ".version 7.8", ptx))
                done = subprocess.run([self.ptxas, f"-arch={ARCHITECTURE}", "-v", "-O3", "-o", f"{code}.cubin", code],
                                      capture_output=True, text=True)
                if "Unresolved extern" in done.stderr:  # images, which libclc has not
                    return counts
                if done.returncode != 0:
                    sys.exit(f"ptxas refuses {name} {' '.join(options)}:\n{done.stdout}{done.stderr}")
                for column, pattern in (("registers", r"Used (\d+) registers"), ("stack", r"(\d+) bytes stack"),
                                        ("spills", r"(\d+) bytes spill stores")):
                    counts[column] = max(map(int, re.findall(pattern, done.stderr)), default=0)
            return counts


def rows_of(kernels, pattern):
    """Those that match, or one of each kernel, as (name, options)."""
    rows = [line.split() for line in (kernels / "variants.txt").read_text().splitlines() if not line.startswith("#")]
    if pattern is not None:
        return [(row[0], row[1:]) for row in rows if re.search(pattern, " ".join(row) + " ")]
    usual = {}
    for row in rows:
        usual[row[0]] = max(usual.get(row[0], row), row, key=lambda other: len(USUAL.intersection(other)))
    return [(name, row[1:]) for name, row in sorted(usual.items())]


def table_of(compiler, kernels, pattern):
    return {(name, " ".join(options)): compiler.counts_of(kernels, name, options)
            for name, options in rows_of(kernels, pattern)}


def is_over_budget(name, counts):
    return name in DEFAULT_PLAN and bool((counts["registers"] or 0) > MOST_REGISTERS or counts["stack"] or
                                         counts["spills"])


def cell(count):
    return "–" if count is None else str(count)


def print_table(table, before):
    print("| kernel |", " | ".join(COLUMNS), "| budget |")
    print("|---|" + "---|" * (len(COLUMNS) + 1))
    names = [name for name, _ in table]
    for (name, options), counts in table.items():
        was = before.get((name, options)) if before is not None else counts
        cells = [cell(counts[column]) if was is None or was[column] == counts[column] else
                 f"{cell(was[column])} → {cell(counts[column])}" for column in COLUMNS]
        words = "" if name not in DEFAULT_PLAN else "over" if is_over_budget(name, counts) else "kept"
        row = name if names.count(name) == 1 else f"{name} {options}"
        print(f"| `{row}` |", " | ".join(cells), f"| {'new' if was is None else words} |")
    for name, options in (before or {}).keys() - table.keys():
        print(f"Gone: {name} {options}")


def kernels_of(commit, folder):
    archive = subprocess.run(["git", "-C", ROOT, "archive", commit, "kernels"], capture_output=True)
    if archive.returncode != 0:
        sys.exit(f"git has no commit '{commit}' with kernels: {archive.stderr.decode().strip()}")
    subprocess.run(["tar", "-x", "-C", folder], input=archive.stdout, check=True)
    return pathlib.Path(folder, "kernels")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rows", nargs="?", help="a regular expression over the rows of kernels/variants.txt")
    parser.add_argument("--against", metavar="COMMIT", help="another commit, to compare with")
    arguments = parser.parse_args()
    compiler = Compiler()
    before = None
    if arguments.against:
        with tempfile.TemporaryDirectory() as folder:
            before = table_of(compiler, kernels_of(arguments.against, folder), arguments.rows)
    table = table_of(compiler, ROOT / "kernels", arguments.rows)
    if not table:
        sys.exit(f"'{arguments.rows}' matches no row of kernels/variants.txt")
    print_table(table, before)


if __name__ == "__main__":
    main()
