#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that C and Python have what C++ has: the public headers and quincunx.py against a table.

    check_parity.py --headers host/include host/control/include --python host/tools/python/quincunx.py --table c_parity.txt

The table's rows are `C++ | C | Python | why`: a function or a field of the structs in ROOTS, what it is in C (without
"quincunx_"; several names, or the one side empty), what it is in Python (a function, a class, a method, a parameter as
`Resolver.resolve(depth)`; empty for fields of structs, which Python knows by the headers), and why, where a side has
none. `Image::*` stands for all of a class. `A.* | b.*` stands for the fields of A that have no row and are
called the same in b, extents as _width and _height, points as _x and _y. Fails, with one line for each finding, on what is in a header and
not in the table, and on what is in the table and nowhere else.
"""
import argparse
import ast
import itertools
import os
import re
import sys

# Structs whose every field is compared, groups within them included.
ROOTS = ("SceneNeeds", "ResolveSettings", "FrameInputs", "FocusInputs", "FrameOutputs", "FrameReport", "PassReport",
         "FrameSync", "ExternalMemory", "ImageView", "ContentStatistics", "FrameTiming", "QualityFrame",
         "QualityChoice",
         "ProportionalSettings", "MinimumOfNSettings", "QualitySettings", "OutputSettings", "DetailSettings")
LEAVES = ("Extent", "Vec2", "Rectangle", "MethodVariant")  # structs that count as one value


def without_comments(text):
    text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
    return re.sub(r'//[^\n]*|/\*.*?\*/|("(?:\\.|[^"\\])*")', lambda found: found.group(1) or " ", text, flags=re.S)


def block_end(text, start):
    """The position behind the brace that closes the one at `start`."""
    depth = 0
    for at in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return at + 1
    raise ValueError("a brace is not closed")


def statements(body):
    """The declarations at the top of a class's body, function bodies left out."""
    flat, at = "", 0
    while at < len(body):
        if body[at] == "{":
            end = block_end(body, at)
            flat += "{}" if re.match(r"\s*[;,)]", body[end:]) else ";"
            at = end
        else:
            flat += body[at]
            at += 1
    return [re.sub(r"\s+", " ", part).strip() for part in flat.split(";")]


class Type:
    """A class or struct: its public fields as (name, type), and its public functions' names."""

    def __init__(self, kind, name, body):
        self.fields, self.functions = [], []
        public = kind == "struct"
        for text in statements(body):
            while label := re.match(r"(public|private|protected) ?: ?", text):
                public, text = label.group(1) == "public", text[label.end():]
            skipped = re.match(r"(friend|using|static constexpr|constexpr|template|enum|struct|class|explicit)\b", text)
            if not text or not public or skipped or "operator" in text:
                continue
            call = re.match(r"[^=]*?(~?\w+) ?\(", text)
            if call:
                if call.group(1).lstrip("~") != name:
                    self.functions.append(call.group(1))
            elif field := re.match(r"(.*[\w>\]] ?[&*]?) ?\b(\w+) ?(?:=.*|\{\})?$", text):
                self.fields.append((field.group(2), field.group(1).strip()))


def declared(texts):
    """({name: Type} of all classes, names of the functions that the library exports)."""
    types, functions = {}, set()
    opening = re.compile(r"\b(struct|class)\s+(?:\[\[\w+\]\]\s*)?(QUINCUNX_API\s+)?(\w+)(?:\s*:\s*public[^{;]*)?\s*\{")
    for text in map(without_comments, texts):
        while found := opening.search(text):
            end = block_end(text, found.end() - 1)
            body = text[found.end():end - 1]
            types[found.group(3)] = Type(found.group(1), found.group(3), body)
            if found.group(2):
                functions |= {f"{found.group(3)}::{name}" for name in types[found.group(3)].functions}
            text = text[:found.start()] + text[end:]
        functions |= set(re.findall(r"QUINCUNX_API\s[^;{}()]*?\b(\w+)\s*\(", text))
    return types, functions


def flattened(types, name, prefix):
    """The paths of a struct's fields: of a group, those of its fields."""
    for field, kind in types[name].fields:
        if kind in types and types[kind].fields and kind not in LEAVES + ROOTS:
            yield from flattened(types, kind, f"{prefix}.{field}")
        else:
            yield f"{prefix}.{field}"


def names_of_cpp(texts):
    types, functions = declared(texts)
    missing = [f"the struct {name} of ROOTS is in no header" for name in ROOTS if name not in types]
    fields = {path for name in ROOTS if name in types for path in flattened(types, name, name)}
    return fields | functions, missing


def names_of_c(texts):
    """Functions, and fields as "settings.method", but for sizes and padding."""
    names = set()
    for text in map(without_comments, texts):
        names |= set(re.findall(r"^QUINCUNX_API [\w* ]*?\bquincunx_(\w+)\(", text, re.M))
        for struct, body in re.findall(r"typedef struct quincunx_(\w+) \{(.*?)\}", text, re.S):
            fields = re.findall(r"(\w+)(?:\[\w+\])?\s*[,;]", body)
            names |= {f"{struct}.{field}" for field in fields if field != "struct_size" and "padding" not in field}
    return names


def names_of_python(text):
    """Functions, classes, methods, and parameters as "Resolver.resolve(depth)"."""
    names = set()

    def visit(nodes, prefix):
        for node in nodes:
            if isinstance(node, ast.ClassDef):
                names.add(node.name)
                visit(node.body, node.name + ".")
            elif isinstance(node, ast.FunctionDef):
                name = prefix + node.name if node.name != "__init__" else prefix[:-1]
                names.add(name)
                names.update(f"{name}({arg.arg})" for arg in node.args.args)

    visit(ast.parse(text).body, "")
    return names


def rows_of(text):
    """[(C++, [C], [Python], why)] of a table."""
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            cells = [cell.strip() for cell in line.split("|")]
            if len(cells) != 4:
                raise SystemExit(f"line {number} of the table has {len(cells)} cells; it must be 'C++ | C | Python | why'")
            rows.append((cells[0], cells[1].split(), cells[2].split(), cells[3]))
    return rows


def same_in_c(field, struct, c):
    """The names that a field of this name has in a struct of C; none where it has none."""
    stem = field.removesuffix("_extent")
    for names in ([field], [stem + "_width", stem + "_height"], [field + "_x", field + "_y"]):
        if all(f"{struct}.{name}" in c for name in names):
            return [f"{struct}.{name}" for name in names]
    return []


def expanded(rows, cpp, c):
    """The rows, where each `A.* | b.*` is a row for each field that it stands for; and what is wrong with those."""
    made, found, named = [], [], {row[0] for row in rows}
    for row in rows:
        if not row[0].endswith(".*"):
            made.append(row)
            continue
        struct = row[0][:-1]
        pairs = [(name, same_in_c(name.split(".")[-1], each[:-2], c)) for each in row[1]
                 for name in sorted(cpp) if name.startswith(struct) and name not in named]
        made += [(name, in_c, [], "") for name, in_c in pairs if in_c]
        taken = [in_c for _, in_c in pairs if in_c]
        found += [f"C++ has {name}, and {' '.join(in_c)} stands for another field of that name, too: give it a row"
                  for name, in_c in pairs if in_c and taken.count(in_c) > 1]
        if not any(in_c for _, in_c in pairs):
            found.append(f"the row {row[0]} is stale: no field of it is called the same in C")
    return made, found


def compare(rows, cpp, c, python):
    """The findings, each a line."""
    rows, found = expanded(rows, cpp, c)
    wide = tuple(name[:-1] for name, *_ in rows if name.endswith("::*"))
    in_cpp = [row[0] for row in rows if row[0]]
    in_c = {name for row in rows for name in row[1]}
    found += [f"C++ has {name}, and the table has not: give C and Python it, too, or say why not"
              for name in sorted(cpp - set(in_cpp)) if not name.startswith(wide)]
    found += [f"C has quincunx_{name}, and the table has not" for name in sorted(c - in_c)]
    for name, in_row, shown, why in rows:
        label = name or " ".join(in_row)
        if name.endswith("::*"):
            if not any(other.startswith(name[:-1]) for other in cpp):
                found.append(f"the row {label} is stale: no such class has functions")
        elif name and name not in cpp:
            found.append(f"the row {label} is stale: C++ has it no more")
        found += [f"the row {label} is stale: C has no quincunx_{each}" for each in in_row if each not in c]
        found += [f"the row {label} is stale: quincunx.py has no {each}" for each in shown if each not in python]
        is_field = bool(in_row) and all("." in each for each in in_row)
        if not why and (not name or not in_row or (not shown and not is_field)):
            found.append(f"the row {label} leaves a side empty and does not say why")
    found += [f"the table has {name} twice" for name in sorted(set(in_cpp)) if in_cpp.count(name) > 1]
    return found


def read(path):
    with open(path, encoding="utf-8") as text:
        return text.read()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--headers", required=True, nargs="+")
    parser.add_argument("--python", required=True)
    parser.add_argument("--table", required=True)
    arguments = parser.parse_args()
    cpp, c = [], []
    for path, _, names in itertools.chain.from_iterable(map(os.walk, arguments.headers)):
        for name in names:
            text = read(os.path.join(path, name))
            (c if 'extern "C"' in text or os.path.basename(path) == "c" else cpp).append(text)
    names, found = names_of_cpp(cpp)
    rows = rows_of(read(arguments.table))
    found += compare(rows, names, names_of_c(c), names_of_python(read(arguments.python)))
    for finding in found:
        print(finding)
    print(f"{len(rows)} rows for {len(names)} names of C++, {len(found)} findings")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
