#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles the C and C++ examples of the pages, so that they are of the interface as it is.

    check_examples.py ROOT C++-COMPILER C-COMPILER

Only the syntax is checked. What an example takes for granted (its reader's own functions and variables) stands in
SCENES below, one for each example of a page in order.
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

# (page, index of the example among those of its language): declarations before it; statements go into a function.
SCENES = {
    ("integrate.md", "cpp", 0): """
        struct Slot { cl_mem colour, depth, velocity; };
        extern Slot slots[3];
        extern ImageView picture;
        Extent wanted_extent();
        bool running();
        bool is_cut();
        Vec2 halton(std::uint64_t frame, Extent render, Extent output);
        void draw(const Slot& slot, Extent render, Vec2 jitter);
        int fail(const Status& status);""",
    ("integrate.md", "c", 0): "",
    ("control.md", "cpp", 0): """
        struct Measured {
          std::uint64_t frame; Extent render_extent; double gpu_ms, cpu_ms, interval_ms; int queued, missed_vsyncs;
        };
        std::vector<Measured> timers_that_came_back();
        extern DynamicViewport viewport;
        void draw(std::uint64_t frame);""",
    ("control.md", "cpp", 1): """
        struct Measured { FrameTiming timing; double resolve_ms; std::optional<ContentStatistics> content; };
        std::vector<Measured> timers_that_came_back();
        void draw(std::uint64_t frame, Extent render);
        template <typename... Any> void resolve(const Any&...);""",
    ("control.md", "cpp", 2): "extern Device device;",
    ("options.md", "cpp", 0): """
        extern ResolveSettings settings;
        extern ResolvePlan plan;
        extern ResolveService service;
        extern FrameInputs inputs, inputs_of_the_region;
        extern FrameOutputs outputs;""",
}


def examples(root):
    """Every example in C or C++ of the manual's pages, with its place."""
    for path in sorted(glob.glob(os.path.join(root, "docs", "*.md"))):
        with open(path, encoding="utf-8") as text:
            content = text.read()
        for language in ("c", "cpp"):
            for index, code in enumerate(re.findall(r"```%s\n(.*?)```" % language, content, re.S)):
                yield (os.path.basename(path), language, index), code


def program(place, code, headers):
    """The example as a translation unit."""
    if place[1] == "c":
        includes = "".join(re.findall(r"#include .*\n", code))
        return includes + "#include <stdio.h>\nvoid example(void) {\n" + code.replace(includes, "") + "}\n"
    before = "".join(f"#include <quincunx/{name}>\n" for name in headers) + "using namespace quincunx;\n"
    if re.search(r"^int run\(\)", code, re.M):
        return before + SCENES[place] + "\n" + code.replace("using namespace quincunx;\n", "")
    return before + SCENES[place] + "\nStatus example() {\n" + code + "return {};\n}\n"


def main():
    root, cxx, cc = sys.argv[1:]
    include = os.path.join(root, "host", "include")
    headers = sorted(name for name in os.listdir(os.path.join(include, "quincunx"))
                     if not name.startswith("c_") and name != "quincunx.h")
    failed = found = 0
    for place, code in examples(root):
        found += 1
        name = "%s, example %d in %s" % (place[0], place[2] + 1, place[1])
        if place not in SCENES:
            print(f"{name}: SCENES does not say what it takes for granted")
            failed += 1
            continue
        with tempfile.TemporaryDirectory() as folder:
            source = os.path.join(folder, "example." + place[1])
            with open(source, "w", encoding="utf-8") as file:
                file.write(program(place, code, headers))
            compiler = [cxx, "-std=c++20", "-DCL_TARGET_OPENCL_VERSION=120"] if place[1] == "cpp" else [cc, "-std=c99"]
            run = subprocess.run(compiler + ["-fsyntax-only", "-I", include, source], capture_output=True, text=True)
            if run.returncode != 0:
                print(f"{name}:\n{run.stderr}")
                failed += 1
    print(f"{failed} of {found} examples do not compile")
    return 1 if failed or found < len(SCENES) else 0


if __name__ == "__main__":
    sys.exit(main())
