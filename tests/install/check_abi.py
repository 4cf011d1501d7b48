#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks what a shared library of Quincunx shows, and what its installed headers ask for.

    check_abi.py --library libquincunx.so --soname libquincunx.so.1 --headers PREFIX/include
                 [--c-symbols c_symbols.txt] [--archive libquincunx.a ... --user libtools.a ...]

Fails, with one line for each finding, on
- a SONAME other than the one given
- an exported symbol that is not the project's, or whose type names a library that only the inside uses
- a header that includes such a library, or a function of the C interface that a header has and the library has not
- with --c-symbols, the list of the C interface: its SONAME, then its functions with the QUINCUNX_API_VERSION that each
  came with. Whatever the library exports for C is there, and nothing else; the highest version is that of the headers
- with --archive, the same code as static libraries: a symbol of it that a --user needs and the shared one hides
"""
import argparse
import os
import re
import subprocess
import sys

OURS = re.compile(r"(?:(?:typeinfo|typeinfo name|vtable) for )?quincunx::|quincunx_\w+$")
INSIDE = re.compile(r"\b(?:fmt|spdlog|nlohmann|CLI)::|\bXXH\d*_|^[^(]*::Impl::")
INSIDE_HEADER = re.compile(r"#\s*include\s*[<\"](?:fmt|spdlog|nlohmann|CLI|xxhash)[/.]")


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def symbols_of(file, *options):
    """{mangled: demangled} of what nm lists; versions (name@@NODE) cut off, the nodes themselves left out."""
    def names(*more):
        lines = output_of("nm", "--portability", *options, *more, file).splitlines()
        return [line for line in lines if re.search(r" [A-Za-z](?: |$)", line) and " A " not in line]

    mangled = [line.split(" ")[0].split("@")[0] for line in names()]
    demangled = [re.sub(r"@@?QUINCUNX_\d+$", "", re.sub(r" [A-Za-z](?: [0-9a-f]*)*$", "", line).rstrip())
                 for line in names("--demangle")]
    return dict(zip(mangled, demangled))


def foreign(symbols):
    """The findings about exported symbols, given as {mangled: demangled}."""
    found = []
    for name in sorted(symbols.values()):
        if not OURS.match(name):
            found.append(f"exports '{name}', which is not the project's")
        elif INSIDE.search(name):
            found.append(f"exports '{name}', whose type belongs to the inside")
    return found


def hidden_but_needed(defined, exported, needed):
    return [f"hides '{defined[name]}', which a program needs; it wants QUINCUNX_API in its header"
            for name in sorted(set(needed) & set(defined) - set(exported))]


def soname_of(library):
    found = re.search(r"\(SONAME\).*\[(.+)\]", output_of("readelf", "--dynamic", library))
    return found.group(1) if found else "none"


def headers_that_leak(folder):
    found = []
    for path, _, names in os.walk(folder):
        for name in names:
            with open(os.path.join(path, name), encoding="utf-8") as header:
                found += [f"{os.path.join(path, name)}:{number} has '{line.strip()}'"
                          for number, line in enumerate(header, 1) if INSIDE_HEADER.search(line)]
    return found


def functions_of_c(folder):
    """The functions that headers below a folder declare for C."""
    found = set()
    for path, _, names in os.walk(folder):
        for name in names:
            with open(os.path.join(path, name), encoding="utf-8") as header:
                found |= set(re.findall(r"^QUINCUNX_API [\w* ]*\b(quincunx_\w+)\(", header.read(), re.M))
    return found


def differs_from_list(text, exported, soname, version):
    """The findings about the C interface, given the list's text and the headers' QUINCUNX_API_VERSION."""
    head, *lines = text.split("\n")
    listed = {name: int(since) for name, since in (line.split() for line in lines if line)}
    ours = {name for name in exported if re.match(r"quincunx_\w+$", name)}
    found = [] if head == soname else [f"the list is of {head}, and the library is {soname}"]
    found += [f"exports '{name}', which the list has not: add it, with a QUINCUNX_API_VERSION that is one higher than "
              "that of the last release" for name in sorted(ours - set(listed))]
    found += [f"lacks '{name}', which the list has: programs of this SONAME use it" for name in sorted(set(listed) - ours)]
    if max(listed.values()) != version:
        found.append(f"the list's highest version is {max(listed.values())}, and QUINCUNX_API_VERSION is {version}")
    return found


def api_version_of(folder):
    with open(os.path.join(folder, "quincunx", "quincunx.h"), encoding="utf-8") as header:
        return int(re.search(r"#define QUINCUNX_API_VERSION (\d+)", header.read()).group(1))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--library", required=True)
    parser.add_argument("--soname", required=True)
    parser.add_argument("--headers", required=True)
    parser.add_argument("--c-symbols")
    parser.add_argument("--archive", nargs="*", default=[])
    parser.add_argument("--user", nargs="*", default=[])
    arguments = parser.parse_args()
    exported = symbols_of(arguments.library, "--dynamic", "--defined-only")
    if not exported:
        sys.exit(f"{arguments.library} exports nothing")
    findings = foreign(exported) + headers_that_leak(arguments.headers)
    if any(name.startswith("quincunx_") for name in exported):  # the library that has the C interface
        findings += [f"lacks '{name}', which a header declares"
                     for name in sorted(functions_of_c(arguments.headers) - set(exported))]
    soname = soname_of(arguments.library)
    if soname != arguments.soname:
        findings.append(f"{arguments.library} has the SONAME {soname}; it must be {arguments.soname}")
    if arguments.c_symbols:
        with open(arguments.c_symbols, encoding="utf-8") as listed:
            findings += differs_from_list(listed.read(), exported, soname, api_version_of(arguments.headers))
    if arguments.archive:
        defined = {}
        for archive in arguments.archive:
            defined.update(symbols_of(archive, "--defined-only", "--extern-only"))
        needed = [name for user in arguments.user for name in symbols_of(user, "--undefined-only")]
        findings += hidden_but_needed(defined, exported, needed)
    for finding in findings:
        print(finding)
    print(f"{os.path.basename(arguments.library)}: {len(exported)} symbols exported, {len(findings)} findings")
    sys.exit(1 if findings else 0)


if __name__ == "__main__":
    main()
