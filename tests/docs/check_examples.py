#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles the C++ examples of the pages, so that they are of the interface as it is.

    check_examples.py ROOT C++-COMPILER

Only the syntax is checked. What an example takes for granted (its reader's own functions and variables) stands in
SCENES below, one for each example of a page in order. An example that follows a link to a file of docs/examples, which
other tests build and run, has to stand there word by word.
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

# (page, index of the example): declarations before it; statements go into a function.
SCENES = {
    ("control.md", 0): """
        std::vector<FrameTiming> timers_that_came_back();
        void draw(std::uint64_t frame, Extent render);""",
    ("control.md", 1): """
        struct Measured { FrameTiming timing; double resolve_ms; std::optional<ContentStatistics> content; };
        std::vector<Measured> timers_that_came_back();
        void draw(std::uint64_t frame, Extent render);
        template <typename... Any> void resolve(const Any&...);""",
    ("control.md", 2): "extern Device device;",
    ("options.md", 0): """
        extern ResolveSettings settings;
        extern ResolvePlan plan;
        extern ResolveService service;
        extern FrameInputs inputs, inputs_of_the_region;
        extern FrameOutputs outputs;""",
}

QUOTE = r"\]\(examples/([\w.]+)\)[^`]*(?:`\w+`[^`]*)?:\n\n```\w+\n(.*?)```\n"


def changed_quotes(root):
    """What pages quote of docs/examples, where it does not stand there so; and how many quotes there are."""
    changed, count = [], 0
    for path in sorted(glob.glob(os.path.join(root, "docs", "*.md"))):
        with open(path, encoding="utf-8") as text:
            quotes = re.findall(QUOTE, text.read(), re.S)
        for name, code in quotes:
            with open(os.path.join(root, "docs", "examples", name), encoding="utf-8") as text:
                if code not in text.read():
                    changed.append(f"{os.path.basename(path)}: its quote of examples/{name} is not what stands there")
        count += len(quotes)
    return changed, count


def examples(root):
    """Every other example in C++ of the manual's pages, with its place."""
    for path in sorted(glob.glob(os.path.join(root, "docs", "*.md"))):
        with open(path, encoding="utf-8") as text:
            content = re.sub(QUOTE, "", text.read(), flags=re.S)
        for index, code in enumerate(re.findall(r"```cpp\n(.*?)```", content, re.S)):
            yield (os.path.basename(path), index), code


def program(place, code, headers):
    """The example as a translation unit."""
    before = "".join(f"#include <quincunx/{name}>\n" for name in headers) + "using namespace quincunx;\n"
    return before + SCENES[place] + "\nStatus example() {\n" + code + "return {};\n}\n"


def main():
    root, cxx = sys.argv[1:]
    folders = [os.path.join(root, "host", "include"), os.path.join(root, "host", "control", "include")]
    headers = sorted(name for folder in folders
                     for name in glob.glob("**/*.h", root_dir=os.path.join(folder, "quincunx"), recursive=True)
                     if not name.startswith("c/") and name != "quincunx.h")
    changed, quoted = changed_quotes(root)
    for line in changed:
        print(line)
    failed, found = len(changed), 0
    for place, code in examples(root):
        found += 1
        name = "%s, example %d" % (place[0], place[1] + 1)
        if place not in SCENES:
            print(f"{name}: SCENES does not say what it takes for granted")
            failed += 1
            continue
        with tempfile.TemporaryDirectory() as folder:
            source = os.path.join(folder, "example.cpp")
            with open(source, "w", encoding="utf-8") as file:
                file.write(program(place, code, headers))
            run = subprocess.run([cxx, "-std=c++20", "-DCL_TARGET_OPENCL_VERSION=120", "-fsyntax-only", "-Werror",
                                  *(f"-I{folder}" for folder in folders), source], capture_output=True, text=True)
            if run.returncode != 0:
                print(f"{name}:\n{run.stderr}")
                failed += 1
    print(f"{failed} of {found} examples do not compile")
    return 1 if failed or found < len(SCENES) or quoted < 3 else 0


if __name__ == "__main__":
    sys.exit(main())
