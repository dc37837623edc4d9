#!/usr/bin/env python3
"""Draws docs/images/flow.svg and writes docs/modules.md, both from the sources, so that they say what
is built. `docs/make.py` writes them, `docs/make.py --check` fails when they are not what it would write.

The picture has a row for each phase on the way from a site to its tables, as the flow functions of
engine/job/tables.cpp call them, and for each stage from tables to files, as engine/plan/planning.cpp
and engine/job/pipeline.cpp name them. Arcs lead from what makes a handle to what takes it.
"""

import html
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PICTURE = ROOT / "docs/images/flow.svg"
MODULES = ROOT / "docs/modules.md"
FLOW = "engine/job/tables.cpp"
PHASES = ("engine/tables", "engine/joining")


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def body_of(source, function):
    """The text between the braces of a function's definition."""
    start = re.search(rf"^\S[^\n;]*\b{function}\([^;{{]*\)\s*{{$", source, re.M | re.S)
    if not start:
        sys.exit(f"docs/make.py: no definition of {function}; has the flow moved?")
    end = source.index("\n}\n", start.end())
    return source[start.end():end]


def statements(body):
    body = re.sub(r"//[^\n]*", "", body)
    return [" ".join(s.split()) for s in body.split(";")]


def sources(pattern):
    """Of the rooms that phases lie in."""
    return [f for room in PHASES for f in sorted((ROOT / room).glob(pattern))]


def header_comment(name):
    """What the header that declares a function says of its phase: the comment above it."""
    for header in sources("*.h"):
        text = header.read_text(encoding="utf-8")
        found = re.search(r"((?:^//[^\n]*\n)+)[^\n/]*\b" + name + r"\(", text, re.M)
        if found:
            return " ".join(line.lstrip("/ ") for line in found.group(1).splitlines())
    return ""


class Row:
    def __init__(self, title, call, files, takes, gives, where):
        self.title, self.call, self.files = title, call, files
        self.takes, self.gives, self.where = takes, gives, where


def table_rows():
    """Rows of the two flow functions that make tables."""
    source = read(FLOW)
    rows = [Row("site", "make_site", "work/site.h5", [], "site", "engine/tables/site.cpp")]
    for function in ("make_tables", "make_coverage_table"):
        for s in statements(body_of(source, function)):
            call = re.search(r"(?:(\w+) = )?\b(make_\w+)\((.*)\)$", s)
            if not call or call.group(2) in ("make_coverage_table", "make_shard_folders"):
                continue
            gives, name, inner = call.groups()
            takes = [a.split(".")[0] for a in re.findall(r"[\w.]+", inner)]
            comment = header_comment(name)
            phase = re.search(r'Phase "(\w+)"', comment)
            files = re.findall(r"(?:work/\.\.\./|shards/)?[\w-]+\.h5", comment)
            if phase:
                title = phase.group(1)
                files = ", ".join(f.replace("/.../", "/tiles-SIDE/") for f in files)
            else:
                title = "tables"
                files = "field.h5" if "field" in name else "coverage.h5"
            where = next(str(c.relative_to(ROOT)) for c in [*sources("*.cpp"), ROOT / FLOW]
                         if re.search(rf"^\S.*\b{name}\(", c.read_text(encoding="utf-8"), re.M))
            rows.append(Row(title, name, files, takes, gives or files, where))
    return rows


def plan_rows():
    """Rows of the stages from tables to files."""
    rows = []
    outer = body_of(read("engine/job/pipeline.cpp"), "plan_of")
    inner = body_of(read("engine/plan/planning.cpp"), "plan_stations")
    parts = [(outer[:outer.index("plan_stations")], "engine/job/pipeline.cpp"),
             (inner, "engine/plan/planning.cpp"),
             (outer[outer.index("plan_stations"):], "engine/job/pipeline.cpp")]
    formats = re.findall(r'"([a-z]+\.(?:csv|geojson|gpkg|png|txt))"',
                         read("io/exports/text_tables.cpp") + read("io/exports/outputs.cpp"))
    said = {"read": "", "files": "plan.h5, " + ", ".join(formats), "hash": "summary.json"}
    own = {"read_coverage", "plan_tables_of", "index_of", "overlap_pairs",
           "make_graph", "make_plan", "add_ratios", "measure", "find_join_thresholds", "write_plan",
           "write_outputs", "result_hash"}
    for text, where in parts:
        pieces = re.split(r'progress\.stage\("(\w+)"\);', text)
        for stage, body in zip(pieces[1::2], pieces[2::2]):
            calls = [c for c in re.findall(r"\b(\w+)\(", body) if c in own]
            rows.append(Row(stage, ", ".join(dict.fromkeys(calls)), said.get(stage, ""),
                            [rows[-1].gives] if rows else ["field.h5", "coverage.h5"],
                            "stage " + stage, where))
    return rows


def picture():
    rows = table_rows() + plan_rows()
    gap = len(table_rows())
    made = {}
    arcs = []
    for i, row in enumerate(rows):
        for name in dict.fromkeys(row.takes):
            if name in made and made[name] != i:
                arcs.append((made[name], i))
        made[row.gives] = i
    step, top, left = 30, 56, 190
    y = [top + step * i + (24 if i >= gap else 0) for i in range(len(rows))]
    height = y[-1] + step + 10
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="1180" height="{height}" '
           f'viewBox="0 0 1180 {height}" font-family="DejaVu Sans, Verdana, sans-serif" '
           'font-size="12">',
           f'<rect width="1180" height="{height}" fill="#ffffff"/>']

    def text(x, at, words, colour="#222226", extra=""):
        out.append(f'<text x="{x}" y="{at}" fill="{colour}" {extra}>{html.escape(words)}</text>')

    for x, words in ((left, "phase or stage"), (left + 140, "made by"), (left + 470, "leaves")):
        text(x, 24, words, "#5c5c62", 'font-style="italic"')
    text(12, top - 14, "from a site to its tables", extra='font-weight="bold"')
    text(12, y[gap] + 38, "from tables to files", extra='font-weight="bold"')
    for a, b in arcs:
        reach = min(150, 14 + 11 * (b - a))
        out.append(f'<path d="M {left - 8} {y[a] + 8} C {left - 8 - reach} {y[a] + 8}, '
                   f'{left - 8 - reach} {y[b] + 4}, {left - 10} {y[b] + 4}" fill="none" '
                   'stroke="#7a86a8" stroke-width="1.2"/>')
        out.append(f'<path d="M {left - 12} {y[b] + 1} l 7 3 l -7 3 z" fill="#7a86a8"/>')
    for i, row in enumerate(rows):
        out.append(f'<rect x="{left}" y="{y[i] - 8}" width="124" height="22" rx="4" '
                   f'fill="{"#dfe7f7" if i < gap else "#e4f1e2"}" stroke="#8b93a8"/>')
        text(left + 8, y[i] + 7, row.title, extra='font-weight="bold"')
        text(left + 140, y[i] + 3, row.call, extra='font-size="11"')
        text(left + 140, y[i] + 15, row.where, "#7c7c84", 'font-size="9"')
        text(left + 470, y[i] + 7, row.files, "#3c5a2c", 'font-size="10"')
    out.append("</svg>")
    return "\n".join(out) + "\n"


def first_sentence(path):
    """What a header's first comment says, up to its first full stop."""
    words = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("//"):
            break
        words.append(line.lstrip("/ "))
    said = " ".join(words)
    return re.split(r"(?<!\beq)(?<!\bal)(?<=[a-z0-9)\"])\.(?: |$)", said)[0].rstrip(".")


def modules():
    lines = ["# Modules", "",
             "Made by `docs/make.py` from the first comment of each header. How they fit together: "
             "[architecture.md](architecture.md).", ""]
    rooms = ["kernels", "io"]
    for line in read("configs/cmake/rooms.txt").splitlines():
        rooms += [r for r in line.split("#")[0].split() if r not in rooms and r != "engine"]
    for room in rooms:
        lines += [f"## {room}/", "", "| module | what it is |", "|---|---|"]
        for header in sorted((ROOT / room).glob("*.h")):
            lines.append(f"| [{header.stem}](../{room}/{header.name}) | {first_sentence(header)} |")
        lines.append("")
    return "\n".join(lines)


def main():
    wanted = {PICTURE: picture(), MODULES: modules()}
    if sys.argv[1:] == ["--check"]:
        stale = [str(p.relative_to(ROOT)) for p, text in wanted.items()
                 if not p.exists() or p.read_text(encoding="utf-8") != text]
        if stale:
            sys.exit(f"{', '.join(stale)}: not what the sources say; run docs/make.py")
        return
    for path, text in wanted.items():
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
