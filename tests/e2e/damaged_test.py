#!/usr/bin/env python3
"""Damaged copies of every format: one clear message with the place, exit code 3, within a second of
processor time and 200 MB. Usage: damaged_test.py VFPLAN [-v] [--no-limits]

Originals are made here, small and whole, and must be read; then each is cut short, given a wrong type,
NaN, a ring that crosses itself, counts of 10^9 and nesting 10^5 deep, as far as its format can have that.
"""

import gzip
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from osgeo import ogr, osr

PROGRAM = sys.argv[1]
WORK = Path(tempfile.mkdtemp(prefix="vfplan-damaged-"))
LIMITS = "--no-limits" not in sys.argv  # sanitizers take both
MOST_CPU_S = 1.0 if LIMITS else 1e9
MOST_MB = 200 if LIMITS else 1e9
DEEP = 100_000
MANY = 1_000_000_000

ROOM = [[0, 0], [8, 0], [8, 6], [0, 6], [0, 0]]
BOW = [[0, 0], [8, 6], [8, 0], [0, 6], [0, 0]]


def geojson(ring, properties='{"class":"outline"}'):
    return ('{"type":"FeatureCollection","features":[\n{"type":"Feature","properties":%s,'
            '"geometry":{"type":"Polygon","coordinates":[%s]}}\n]}\n' % (properties, json.dumps(ring)))


def osm(ring):
    nodes = "".join('<node id="%d" lat="%.7f" lon="%.7f"/>\n' % (i + 1, 60 + y * 1e-5, 25 + x * 2e-5)
                    for i, (x, y) in enumerate(ring[:-1]))
    refs = "".join('<nd ref="%d"/>' % (i + 1) for i in range(len(ring) - 1)) + '<nd ref="1"/>'
    return ('<?xml version="1.0"?>\n<osm version="0.6">\n%s<way id="1">%s<tag k="building" v="yes"/></way>\n'
            '</osm>\n' % (nodes, refs))


def dxf(ring, count=None):
    out = ("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n"
           "0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nWALL\n100\nAcDbEntity\n100\nAcDbPolyline\n"
           "90\n%d\n70\n1\n" % (count or len(ring) - 1))
    out += "".join("10\n%s\n20\n%s\n" % (x, y) for x, y in ring[:-1])
    return out + "0\nENDSEC\n0\nEOF\n"


def cityjson(ring):
    corners = ring[:-1]
    return json.dumps({
        "type": "CityJSON", "version": "2.0", "transform": {"scale": [1, 1, 1], "translate": [0, 0, 0]},
        "CityObjects": {"a": {"type": "Building", "geometry": [
            {"type": "MultiSurface", "lod": "1",
             "boundaries": [[list(range(len(corners)))[::-1]]]}]}},
        "vertices": [[x, y, 0] for x, y in corners]}, indent=1)


def house_expo(ring):
    return json.dumps({"verts": ring[:-1], "room_category": {"Room": [[0, 0, 8, 6]]}, "id": "x",
                       "room_num": 1}, indent=1)


def structured3d(ring):
    corners = ring[:-1]
    n = len(corners)
    return json.dumps({
        "junctions": [{"ID": i, "coordinate": [x * 1000, y * 1000, 0]} for i, (x, y) in enumerate(corners)],
        "lines": [{"ID": i} for i in range(n)],
        "planes": [{"ID": 0, "type": "floor"}],
        "semantics": [{"ID": 0, "type": "kitchen", "planeID": [0]}],
        "planeLineMatrix": [[1] * n],
        "lineJunctionMatrix": [[int(j in (i, (i + 1) % n)) for j in range(n)] for i in range(n)]}, indent=1)


def sweet_home(ring):
    corners = [(x * 100, y * 100) for x, y in ring[:-1]]
    out = "<?xml version='1.0'?>\n<home version='7000'>\n"
    for i, (x, y) in enumerate(corners):
        u, v = corners[(i + 1) % len(corners)]
        out += ("<wall id='w%d' xStart='%s' yStart='%s' xEnd='%s' yEnd='%s' thickness='10'/>\n"
                % (i, x, y, u, v))
    out += "<room>" + "".join("<point x='%s' y='%s'/>" % c for c in corners) + "</room>\n"
    return out + "</home>\n"


def office(ring):
    points = "".join('<point x="%s" y="%s"/>\n' % (x * 50, y * 50) for x, y in ring)
    return ('<?xml version="1.0"?>\n<building id="b">\n<scale>\n<represented_distance><value>45</value>'
            '<um>pixel</um></represented_distance>\n<real_distance><value>90</value><um>cm</um></real_distance>\n'
            '</scale>\n<floor><spaces>\n<space id="s"><labels><label>HALL</label></labels>\n'
            '<bounding_polygon>\n%s</bounding_polygon>\n<space_representation>\n'
            '<linesegment id="p"><point x="150" y="0"/><point x="150" y="0"/><class>PORTAL</class>'
            '<type>EXPLICIT</type></linesegment>\n</space_representation>\n</space>\n'
            '</spaces></floor>\n</building>\n' % points)


def pol(ring, count=None):
    corners = ring[:-1]
    return "%d %s\n" % (count or len(corners), " ".join("%d/1 %d/1" % tuple(c) for c in corners))


def pgm(width=160, height=120, size=None):
    rows = b""
    for y in range(height):
        rows += bytes(0 if x < 4 or y < 4 or x >= width - 4 or y >= height - 4 else 254 for x in range(width))
    w, h = size or (width, height)
    return b"P5\n%d %d\n255\n" % (w, h) + rows


ROS = "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n"


def by_gdal(driver, name, ring):
    path = WORK / name
    data = ogr.GetDriverByName(driver).CreateDataSource(str(path))
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(32635)
    layer = data.CreateLayer("buildings", srs, ogr.wkbPolygon)
    layer.CreateField(ogr.FieldDefn("class", ogr.OFTString))
    for k in range(40):
        feature = ogr.Feature(layer.GetLayerDefn())
        feature["class"] = "building"
        text = ",".join("%f %f" % (x + 12 * k, y) for x, y in ring)
        feature.SetGeometry(ogr.CreateGeometryFromWkt("POLYGON((%s))" % text))
        layer.CreateFeature(feature)
    del layer, data
    return path.read_bytes()


def deep_json(key):
    return '{"type":"x",%s:%s%s}' % (key, "[" * DEEP, "]" * DEEP)


def replaced(text, old, new):
    assert old in text, (old, text[:200])
    return text.replace(old, new, 1)


def doubles(data, value, find=struct.pack("<d", 8.0)):
    """The bytes with every coordinate 8.0 (or another) made something else."""
    assert find in data
    return data.replace(find, struct.pack("<d", value))


CASES = []  # name, file name, bytes, exit codes allowed, preset, a place is expected


def case(name, file, data, codes=(3,), place=True):
    CASES.append((name, file, data if isinstance(data, bytes) else data.encode(), codes, place))


def text_format(name, file, make, deep=None, nan=("8", "NaN"), wrong=("8", '"east"'), bow=(0, 3), many=None):
    whole = make(ROOM)
    case(name + " whole", file, whole, (0,), False)
    for share in (0.3, 0.6, 0.9):
        case("%s cut at %.0f %%" % (name, 100 * share), file, whole[:int(len(whole) * share)])
    case(name + " not a number", file, replaced(whole, *nan))
    case(name + " wrong type", file, replaced(whole, *wrong))
    case(name + " crossing ring", file, make(BOW), bow)
    if deep:
        case(name + " nested", file, deep, (3,), False)
    if many:
        case(name + " 10^9 vertices", file, many, (0, 3))  # the count alone is wrong


text_format("GeoJSON", "a.geojson", geojson, geojson(ROOM).replace("[[[0, 0]", "[" * DEEP + "[[[0, 0]"))
text_format("OSM", "a.osm", osm, "<osm>" + "<way>" * DEEP, nan=("60.0000000", "NaN"), wrong=("60.0000000", "north"))
text_format("DXF", "a.dxf", dxf, nan=("10\n8\n", "10\nNaN\n"), wrong=("10\n8\n", "ten\n8\n"), many=dxf(ROOM, MANY))
text_format("CityJSON", "a.json", cityjson, deep_json('"CityObjects"'), nan=("8,", "NaN,"), wrong=("8,", '"east",'))
text_format("HouseExpo", "b.json", house_expo, deep_json('"verts"'), nan=("8,", "NaN,"), wrong=("8,", '"east",'))
text_format("Structured3D", "annotation_3d.json", structured3d, deep_json('"junctions"'), nan=("8000,", "NaN,"),
            wrong=("8000,", '"east",'))
text_format("Sweet Home 3D", "Home.xml", sweet_home, "<home>" + "<wall>" * DEEP, nan=("'800'", "'NaN'"),
            wrong=("'800'", "'east'"))
text_format("office XML", "a.xml", office, "<building><scale>" + "<floor>" * DEEP, nan=('"400"', '"NaN"'),
            wrong=('"400"', '"east"'))
text_format("AGPLIB", "a.pol", pol, nan=("8/1", "1/0"), wrong=("8/1", "east"), many=pol(ROOM, MANY))

case("ROS whole", "map.yaml", ROS, (0,), False)
case("ROS cut", "cut.yaml", ROS[:25])
case("ROS not a number", "nan.yaml", ROS.replace("0.05", ".nan"))
case("ROS wrong type", "type.yaml", ROS.replace("[0, 0, 0]", "east"))
case("ROS nested", "deep.yaml", ROS + "a: " + "[" * DEEP)
case("ROS image cut", "image.yaml", ROS.replace("map.pgm", "cut.pgm"), (3,), False)
case("ROS image of 10^9", "huge.yaml", ROS.replace("map.pgm", "huge.pgm"), (3,), False)
(WORK / "map.pgm").write_bytes(pgm())
(WORK / "cut.pgm").write_bytes(pgm()[:9000])
(WORK / "huge.pgm").write_bytes(pgm(size=(40000, 40000)))

for driver, file in (("GPKG", "a.gpkg"), ("ESRI Shapefile", "a.shp"), ("FlatGeobuf", "a.fgb")):
    data = by_gdal(driver, file, [[x + 500000, y + 6700000] for x, y in ROOM])
    case(driver + " whole", file, data, (0,), False)
    for share in (0.3, 0.6, 0.9):
        case("%s cut at %.0f %%" % (driver, 100 * share), file, data[:int(len(data) * share)], (3,), False)
    case(driver + " not a number", file,
         doubles(data, float("nan"), struct.pack("<d", 500008 + 12)), (3,))
    counted = bytearray(data)
    where = data.find(struct.pack("<d", 500000.0) + struct.pack("<d", 6700000.0)) - 4
    while data[where:where + 4] != struct.pack("<I", 5) and where > 0:
        where -= 1
    counted[where:where + 4] = struct.pack("<I", MANY)
    case(driver + " 10^9 vertices", file, bytes(counted), (0, 3), False)
    if driver != "ESRI Shapefile":
        (WORK / file).unlink()

whole = gzip.compress(geojson(ROOM).encode())
case("gzip whole", "a.geojson.gz", whole, (0,), False)
case("gzip cut", "a.geojson.gz", whole[:len(whole) // 2], (3,), False)
case("gzip of zeros", "z.json.gz", gzip.compress(bytes(50_000_000)), (3,), False)


def zipped(name, entries):
    path = WORK / name
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as z:
        for entry, data in entries.items():
            z.writestr(entry, data)
    return path.read_bytes()


shapes = {f: (WORK / f).read_bytes() for f in ("a.shp", "a.shx", "a.dbf", "a.prj")}
case("zip of a Shapefile", "shapes.zip", zipped("shapes.zip", shapes), (0,), False)
case("zip cut", "cut.zip", zipped("cut.zip", shapes)[:1500], (3,), False)
case("zip of two sites", "two.zip", zipped("two.zip", {"a.geojson": "x", "b.geojson": "x"}), (3,), False)
case("zip of nothing", "none.zip", zipped("none.zip", {}), (3,), False)
case("sh3d", "home.sh3d", zipped("home.sh3d", {"Home": b"\xac\xed", "Home.xml": sweet_home(ROOM)}), (0,), False)
case("old sh3d", "old.sh3d", zipped("old.sh3d", {"Home": b"\xac\xed"}), (3,), False)
case("sh3d cut", "half.sh3d", zipped("half.sh3d", {"Home.xml": sweet_home(ROOM) * 50})[:300], (3,), False)

PLACE = re.compile(r":\d+|line \d+|at /|feature \d+|byte \d+|element|offset")


def main():
    failures = 0
    most_s = most_mb = 0
    for name, file, data, codes, place in CASES:
        path = WORK / file
        path.write_bytes(data)
        command = [PROGRAM, "inspect", str(path), "--out", str(WORK / "picture.png")]
        child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                 errors="replace")
        out, err = child.stdout.read(), child.stderr.read()
        _, status, used = os.wait4(child.pid, 0)
        code = os.waitstatus_to_exitcode(status)
        cpu_s, mb = used.ru_utime + used.ru_stime, used.ru_maxrss / 1024
        most_s, most_mb = max(most_s, cpu_s), max(most_mb, mb)
        wrong = []
        if code not in codes:
            wrong.append("exit code %d, not one of %s" % (code, codes))
        if code != 0 and (len(err.strip().splitlines()) != 1 or file not in err and "pgm" not in err):
            wrong.append("not one message that names the file")
        if code != 0 and place and not PLACE.search(err.replace(str(path), "", 1)):
            wrong.append("no place")
        if len(err) > 1000:
            wrong.append("a message of %d characters" % len(err))
        if cpu_s > MOST_CPU_S:
            wrong.append("%.2f s" % cpu_s)
        if mb > MOST_MB:
            wrong.append("%.0f MB" % mb)
        if wrong or "-v" in sys.argv:
            print("%-4s %s: %s\n       %s" % ("FAIL" if wrong else "ok", name, "; ".join(wrong),
                                             err.strip()[:400].replace(str(WORK), "")))
        failures += bool(wrong)
    subprocess.run(["rm", "-rf", str(WORK)], check=False)
    print("%d damaged and whole files, %d wrong; at most %.2f s and %.0f MB"
          % (len(CASES), failures, most_s, most_mb))
    sys.exit(1 if failures else 0)


main()
