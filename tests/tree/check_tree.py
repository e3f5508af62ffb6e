#!/usr/bin/env python3
"""Holds the folders to the arrows that their CMakeLists.txt declare.

    tests/tree/check_tree.py           status 1 and a line for each fault
    tests/tree/check_tree.py --graph   the arrows between folders, one a line

A fault is: an include of a folder that the file's folder does not link; a header's include of one that it links
PRIVATE; a link that nothing includes; a circle; a source that its CMakeLists.txt does not list; a file of solvers/ that
is in no folder. Ceres is held like a folder: one that includes it must not get it from another by chance.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The target of a library's headers, by their folder.
EXTERNAL = {"ceres": "Ceres::ceres"}


def folders():
    """Name -> path of every library folder."""
    found = {p.parent.name: p.parent for top in ("src/ibrdf", "solvers") for p in sorted((ROOT / top).glob("*/CMakeLists.txt"))
             if not (ROOT / top / p.parent.name).is_symlink()}
    found["io"] = ROOT / "io"
    return found


def target_of(include):
    """The target that an include needs, None where none is held to it."""
    parts = include.split("/")
    if parts[0] != "ibrdf":
        return EXTERNAL.get(parts[0])
    return "ibrdf::" + (parts[2] if parts[1] == "solvers" else parts[1])


def links(path):
    """What a folder's CMakeLists.txt links, PUBLIC and PRIVATE, and the sources that it lists."""
    text = re.sub(r"#.*", "", (path / "CMakeLists.txt").read_text())
    call = re.search(r"ibrdf_add_library\(([^)]*)\)", text).group(1)
    words, section, out = call.split()[1:], None, {"PUBLIC": set(), "PRIVATE": set(), "SOURCES": set(), "KERNELS": set()}
    for word in words:
        if word in out:
            section = word
        elif section:
            out[section].add(word)
    listed = out["SOURCES"] | out["KERNELS"] | set(re.findall(r"\S+\.cc", text))
    held = [{w for w in out[s] if w.startswith("ibrdf::") or w in EXTERNAL.values()} for s in ("PUBLIC", "PRIVATE")]
    return held[0], held[1], listed


def includes(path):
    return [i for i in re.findall(r'^#include ["<]([^">]+)[">]', path.read_text(), re.M) if target_of(i)]


def programs_may(name):
    # Mains link the umbrellas.
    return name == "programs"


def check():
    faults = []
    graph = {}
    for name, path in folders().items():
        public, private, listed = links(path)
        graph[name] = {n[7:] for n in public | private if n.startswith("ibrdf::")}
        used = set()
        for file in sorted(path.iterdir()):
            if file.suffix == ".cc" and file.name not in listed and not file.name.endswith("_main.cc"):
                faults.append(f"{file.relative_to(ROOT)}: not listed in {name}/CMakeLists.txt")
            if file.suffix not in (".h", ".cc") or programs_may(name):
                continue
            for include in includes(file):
                other = target_of(include)
                if other == "ibrdf::" + name:
                    continue
                used.add(other)
                if other not in public | private:
                    faults.append(f"{file.relative_to(ROOT)}: includes {include}, but {name} does not link {other}")
                elif file.suffix == ".h" and other not in public:
                    faults.append(f"{file.relative_to(ROOT)}: includes {include}, but {name} links {other} PRIVATE")
        if not programs_may(name):
            faults += [f"{name}: links {n}, which no file of it includes" for n in sorted((public | private) - used)]
    faults += circles(graph)
    faults += [f"{p.relative_to(ROOT)}: in no folder" for p in (ROOT / "solvers").iterdir()
               if p.is_file() and p.name != "CMakeLists.txt"]
    return graph, faults


def circles(graph):
    found, done = [], set()

    def visit(name, path):
        if name in path:
            found.append("circle: " + " -> ".join(path[path.index(name):] + [name]))
        elif name not in done:
            for other in sorted(graph.get(name, ())):
                visit(other, path + [name])
            done.add(name)

    for name in graph:
        visit(name, [])
    return found


def main():
    graph, faults = check()
    if "--graph" in sys.argv[1:]:
        for name, others in graph.items():
            print(name, "->", " ".join(sorted(others)) or "-")
        return 0
    for fault in faults:
        print(fault)
    print(f"{len(graph)} folders, {sum(map(len, graph.values()))} arrows, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
