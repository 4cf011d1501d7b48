#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that libraries and the rooms within them use each other one way only, by what their files include.

    check_arrows.py FOLDER              fails, with one line for each finding
    check_arrows.py FOLDER --picture    draws the libraries of the table anew: docs/images/libraries.svg

A finding is an include that ROOMS does not allow or that leads nowhere, a row of ROOMS that no include needs, a folder
of sources that is in no row, or a picture that is not the table's.
"""
import os
import re
import sys

# Each room, its folder (or what a header of another project begins with), and the rooms above it in this table that it
# uses. What these use it may use too, but the inside of a library (a folder src) only where its own row says so. A
# library is what stands before the slash. A room has all that lies below its folder and is in no other row.
ROOMS = (
    ("OpenCL", "<CL/", ""),
    ("OpenGL", "<epoxy/", ""),
    ("control", "host/control/include", ""),
    ("control/src", "host/control/src", "control"),
    ("kernels", "kernels", ""),
    ("core", "host/include", "control OpenCL"),
    ("core/plan", "host/src/plan", "core kernels"),
    ("core/device", "host/src/device", "core"),
    ("core/passes", "host/src/passes", "core/plan core/device"),
    ("core/c_interface", "host/src/c_interface", "core/plan"),
    ("tools/program", "host/tools/program", "core"),
    ("tools/image", "host/tools/image", "tools/program"),
    ("tools/page", "host/tools/page", "tools/image"),
    ("gl", "gl_interop/include", "core OpenGL"),
    ("gl/src", "gl_interop/src", "gl"),
    ("record", "host/tools/record", "tools/image core/plan"),
    ("sequence", "host/tools/sequence", "record tools/page core/plan core/passes"),
    ("diagnose", "host/tools/diagnose", "sequence"),
    ("resolve", "host/tools", "diagnose"),
    ("scenes", "scenes", "core"),
    ("scenes/builtin", "scenes/builtin", "scenes"),
    ("scenes/gltf", "scenes/gltf", "scenes"),
    ("scenes/catalog", "scenes/catalog", "scenes/builtin scenes/gltf"),
    ("scenes/render", "scenes/render", "scenes gl"),
    ("renderer/frames", "scenes/frames", "scenes/catalog scenes/render record"),
    ("renderer/session", "scenes/session", "renderer/frames tools/page"),
    ("renderer/window", "scenes/window", "renderer/session"),
    ("renderer/programs", "scenes/programs", "renderer/window"),
    ("bench/harness", "scenes/bench/harness", "core/device"),
    ("bench/traces", "scenes/bench/traces", "scenes tools/page bench/harness"),
    ("bench", "scenes/bench", "bench/harness bench/traces renderer/session core/passes"),
)
SHEDS = ("diagnose", "bench")  # built only where they are asked for
# Folders that headers are found in, besides that of the file which includes them.
ROOTS = ("", "host/control/include/", "host/control/src/", "host/include/", "host/src/", "host/", "gl_interop/include/",
         "gl_interop/src/", "kernels/", "kernels/include/", "host/tools/record/include/", "scenes/", "cmake/")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|(<[^>]+>))', re.M)
PICTURE = "docs/images/libraries.svg"


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


class Arrows:
    def __init__(self, folder, rooms=ROOMS):
        self.folder, self.rooms = folder, rooms
        self.uses = {name: uses.split() for name, _, uses in rooms}
        self.folders = sorted(((path, name) for name, path, _ in rooms), key=lambda row: -len(row[0]))
        self.files = set()
        self.generated = set()  # headers that the build writes (cmake/embed.cmake)
        for top in ("cmake", "kernels", "host", "gl_interop", "scenes"):
            for path, _, names in os.walk(os.path.join(folder, top)):
                self.files |= {os.path.relpath(os.path.join(path, name), folder) for name in names
                               if name.endswith((".h", ".cpp", ".cl"))}
                if "CMakeLists.txt" in names:
                    self.generated |= {name + ".h" for name in re.findall(
                        r"quincunx_embed\(\w+ FUNCTION [\w:]*?(\w+)\s", read(os.path.join(path, "CMakeLists.txt")))}

    def room_of(self, path):
        return next((name for folder, name in self.folders
                     if path.startswith(folder if folder.startswith("<") else folder + "/")), None)

    def is_inside(self, room):
        return "src" in next(path for name, path, _ in self.rooms if name == room).split("/")

    def allowed(self, room):
        """The rooms that a room may include, itself with them."""
        found = {room}
        for used in self.uses[room]:
            found.add(used)
            found |= {name for name in self.allowed(used) if not self.is_inside(name)}
        return found

    def target(self, file, quoted, angled):
        """The file that an include leads to, or the name of another project's header; None where it leads nowhere."""
        if angled or quoted in self.generated:
            return angled or "cmake/"
        own = os.path.normpath(os.path.join(os.path.dirname(file), quoted))
        return next((path for path in (own, *(root + quoted for root in ROOTS)) if path in self.files), None)

    def run(self):
        findings, needed = [], set()
        for index, (name, _, _) in enumerate(self.rooms):
            below = [used for used in self.uses[name] if used not in [row[0] for row in self.rooms[:index]]]
            findings += [f"ROOMS: {name} uses {used}, which is no row above it" for used in below]
        if findings:
            return findings
        allowed = {name: self.allowed(name) for name, _, _ in self.rooms}
        for file in sorted(self.files):
            room = self.room_of(file)
            if room is None:
                if not file.startswith("cmake/"):  # the struct of embedded files, and headers to precompile
                    findings.append(f"{file} lies in no folder of ROOMS")
                continue
            for found in INCLUDE.finditer(text := read(os.path.join(self.folder, file))):
                target = self.target(file, *found.groups())
                other = self.room_of(target) if target else None
                place = f"{file}:{text.count(chr(10), 0, found.start()) + 1}: "
                if target is None:
                    findings.append(place + f"{found[1]} leads nowhere")
                elif other and other not in allowed[room]:
                    findings.append(place + f"{room} must not use {other} ({target})")
                elif other and other != room:
                    needed.add((room, other))
        for name, _, _ in self.rooms:
            for used in self.uses[name]:
                if not any(room == name and used in {other, *self.allowed(other)} for room, other in needed):
                    findings.append(f"ROOMS: {name} uses {used}, and no file of it does")
        return findings

    def picture(self):
        """Boxes of libraries, each above all that it uses. Arrows that follow from others are left out."""
        libraries = list(dict.fromkeys(name.split("/")[0] for name, folder, _ in self.rooms if folder[0] != "<"))
        uses = {library: {used.split("/")[0] for name, _, _ in self.rooms if name.split("/")[0] == library
                          for used in self.uses[name]} & set(libraries) - {library} for library in libraries}
        every = {}
        for library in libraries:  # those that a library uses come before it
            every[library] = uses[library].union(*(every[used] for used in uses[library]))
        direct = {library: [used for used in uses[library] if not any(used in every[o] for o in uses[library])]
                  for library in libraries}
        layer = {}
        for library in libraries:
            layer[library] = 1 + max((layer[used] for used in uses[library]), default=-1)
        height, width, gap, top = 44, 200, 34, max(layer.values())
        place = {}
        for number in range(top + 1):
            row = [library for library in libraries if layer[library] == number]
            for i, library in enumerate(row):
                place[library] = (360 + (i - (len(row) - 1) / 2) * (width + 40), 8 + (top - number) * (height + gap))
        lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 720 {16 + top * (height + gap) + height}" '
                 'font-family="sans-serif" font-size="12" text-anchor="middle">',
                 '<marker id="a" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
                 '<path d="M0 0L8 4L0 8z" fill="#555"/></marker>',
                 '<rect width="100%" height="100%" fill="#fff"/>']
        for library in libraries:
            x, y = place[library]
            for used in sorted(direct[library]):
                to_x, to_y = place[used]
                lines.append(f'<path d="M{x:g} {y + height}L{to_x:g} {to_y}" stroke="#555" marker-end="url(#a)"/>')
        for library in libraries:
            x, y = place[library]
            parts = [name.split("/")[1] for name, _, _ in self.rooms if re.match(library + "/(?!src)", name)]
            dash = ' stroke-dasharray="4 3"' if library in SHEDS else ""
            lines.append(f'<rect x="{x - width / 2:g}" y="{y}" width="{width}" height="{height}" rx="5" fill="#eef3f8" '
                         f'stroke="#456"{dash}/>')
            lines.append(f'<text x="{x:g}" y="{y + (18 if parts else 27)}" font-weight="bold">{library}</text>')
            if parts:
                lines.append(f'<text x="{x:g}" y="{y + 35}" font-size="10">{", ".join(parts)}</text>')
        return "\n".join(lines) + "\n</svg>\n"


def main():
    arrows = Arrows(sys.argv[1])
    picture = os.path.join(sys.argv[1], PICTURE)
    if "--picture" in sys.argv:
        with open(picture, "w", encoding="utf-8") as file:
            file.write(arrows.picture())
        return 0
    findings = arrows.run()
    if not os.path.exists(picture) or read(picture) != arrows.picture():
        findings.append(f"{PICTURE} is not that of ROOMS: {' '.join(sys.argv)} --picture")
    for finding in findings:
        print(finding)
    print(f"{len(findings)} findings in {len(arrows.files)} files of {len(ROOMS)} rooms")
    return 1 if findings or not arrows.files else 0


if __name__ == "__main__":
    sys.exit(main())
