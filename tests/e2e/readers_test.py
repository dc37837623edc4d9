"""Opens the tables of a run with h5py and scipy, without any code of this program.

usage: readers_test.py VFPLAN CONFIGS
"""

import csv
import hashlib
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
import scipy.sparse
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse.csgraph import connected_components

try:  # python3-anndata
    import anndata.experimental
except ImportError:
    anndata = None
try:  # python3-gdal
    from osgeo import gdal
except ImportError:
    gdal = None

VFPLAN, CONFIGS = Path(sys.argv[1]), Path(sys.argv[2])


def text(value):
    return value.decode() if isinstance(value, bytes) else value


class Run:
    """One finished run, opened."""

    def __init__(self, folder, kind, sets):
        site = folder / f"{kind}.geojson"
        self.dir = folder / kind
        sets = [f"site.input={site}", *sets]
        subprocess.run([VFPLAN, "generate", kind, "--out", site], check=True, capture_output=True)
        subprocess.run(
            [VFPLAN, "run", CONFIGS / f"{kind}.toml", "--out", self.dir, "--quiet"]
            + [word for s in sets for word in ("--set", s)],
            check=True,
        )
        self.summary = json.loads((self.dir / "summary.json").read_text())
        self.field = h5py.File(self.dir / "field.h5", "r")
        self.coverage = h5py.File(self.dir / "coverage.h5", "r")
        self.plan = h5py.File(self.dir / "plan.h5", "r")
        self.pool = h5py.File(self.dir / "pool.h5", "r")
        # A plan's candidates are those of coverage.h5, then those of pool.h5.
        self.table = scipy.sparse.vstack(
            [
                scipy.sparse.csr_matrix(
                    (group["data"][:], group["indices"][:], group["indptr"][:]),
                    shape=group.attrs["shape"],
                )
                for group in (self.coverage["coverage"], self.pool["coverage"])
            ],
            format="csr",
        )
        pieces = self.coverage["pieces"]
        self.length = pieces["s1_m"][:] - pieces["s0_m"][:]
        self.origin = [self.field["crs"].attrs[f"origin_{a}_m"] for a in "xy"]

    def candidates(self, name):
        return np.concatenate([f[f"candidates/{name}"][:] for f in (self.coverage, self.pool)])

    def rows(self, name):
        with open(self.dir / name, newline="") as file:
            return list(csv.DictReader(file))


def on_every_run(test):
    def each(self):
        for name, run in self.runs.items():
            with self.subTest(name):
                test(self, run)

    return each


class Readers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = Path(cls.folder.name)
        formats = "output.formats=['csv']"
        crop = "site.crop_m=[0,0,400,292]"
        tiles = "field.tile_cells=64"
        cls.runs = {
            "town": Run(folder, "town", [crop, "field.cell_m=4", tiles, formats]),
            "flat": Run(folder, "flat", ["field.cell_m=0.1", tiles, formats]),
        }

    @classmethod
    def tearDownClass(cls):
        for run in cls.runs.values():
            for file in (run.field, run.coverage, run.pool, run.plan):
                file.close()
        cls.folder.cleanup()

    @on_every_run
    def test_headers(self, run):
        keys = set()
        for file in (run.field, run.coverage, run.plan):
            self.assertEqual(file.attrs["complete"], 1)
            self.assertEqual(file.attrs["format_version"], 4)
            self.assertTrue(text(file.attrs["title"]))
            keys.add(text(file.attrs["key"]))
        self.assertEqual(len(keys), 1)
        self.assertEqual(text(run.field.attrs["Conventions"]), "CF-1.8")

    @on_every_run
    def test_field_grid(self, run):
        vf, x, y = run.field["vf"], run.field["x"], run.field["y"]
        self.assertEqual(vf.shape, (len(y), len(x)))
        self.assertEqual(vf.size, run.summary["grid"]["cells"])
        self.assertEqual(vf.dtype, np.float32)
        self.assertEqual([d[0].name for d in vf.dims], ["/y", "/x"])
        self.assertTrue(h5py.h5ds.is_scale(x.id) and h5py.h5ds.is_scale(y.id))
        self.assertEqual(text(vf.attrs["units"]), "radian")
        self.assertEqual(text(x.attrs["units"]), "m")
        self.assertEqual(text(y.attrs["units"]), "m")
        self.assertEqual(text(vf.attrs["grid_mapping"]), "crs")
        self.assertTrue(np.isnan(vf.attrs["_FillValue"]))
        cell = vf.attrs["cell_m"]
        self.assertEqual(cell, run.summary["grid"]["cell_m"])
        for axis, values in (("x", x[:]), ("y", y[:])):
            self.assertTrue(np.allclose(np.diff(values), cell, atol=1e-9))
            first = run.field["vf"].attrs[f"grid_origin_{axis}_m"] + cell / 2
            self.assertAlmostEqual(values[0], first + run.origin["xy".index(axis)], places=9)

    @on_every_run
    def test_field_values(self, run):
        vf = run.field["vf"][:]
        free = ~np.isnan(vf)
        self.assertEqual(free.sum(), run.summary["grid"]["free_cells"])
        self.assertGreaterEqual(vf[free].min(), 0)
        self.assertLessEqual(vf[free].max(), np.float32(2 * np.pi))
        self.assertGreater(vf[free].max(), 3)

    @on_every_run
    def test_candidates_lie_on_the_field(self, run):
        vf, cell = run.field["vf"][:], run.candidates("cell")
        on = cell >= 0
        # Off the cells' centres there are connectors only.
        kinds = dict(pair.split(" ") for pair in text(run.coverage["candidates/kind"].attrs["meaning"]).split(", "))
        self.assertEqual({kinds[str(k)] for k in run.candidates("kind")[~on]} - {"connector"}, set())
        row, column = np.divmod(cell[on], vf.shape[1])
        np.testing.assert_array_equal(vf[row, column], run.candidates("vf")[on])
        # Their places are the cells' centres: in the site frame, the field in the input's.
        for axis, at, origin in (("x", column, run.origin[0]), ("y", row, run.origin[1])):
            centres = run.field[axis][:][at]
            np.testing.assert_allclose(run.candidates(axis)[on] + origin, centres, atol=1e-9)
        self.assertEqual(len(np.unique(cell[on])), on.sum())
        self.assertEqual(len(cell), run.summary["candidates"])

    @on_every_run
    def test_frames_are_named(self, run):
        for group in ("walls", "candidates"):
            self.assertIn("site frame", text(run.coverage[group].attrs["units"]))

    @on_every_run
    def test_coverage_is_csr(self, run):
        table = run.table
        angles = [f["coverage/angle_rad"][:] for f in (run.coverage, run.pool)]
        for file in (run.coverage, run.pool):
            group = file["coverage"]
            self.assertEqual(text(group.attrs["encoding-type"]), "csr_matrix")
            self.assertEqual(text(group.attrs["encoding-version"]), "0.1.0")
            self.assertEqual(group["indptr"].dtype, np.int64)
            self.assertEqual(group["indices"].dtype, np.int32)
        table.check_format(full_check=True)
        self.assertEqual(table.shape, (run.summary["candidates"], run.summary["pieces"]))
        for a, b in zip(table.indptr, table.indptr[1:]):
            self.assertTrue((np.diff(table.indices[a:b]) > 0).all(), "sorted, none twice")
        self.assertEqual(sum(map(len, angles)), table.nnz)
        self.assertGreaterEqual(table.data.min(), 0.5)  # visible_fraction
        self.assertLessEqual(table.data.max(), 1 + 1e-6)
        self.assertGreater(np.concatenate(angles).min(), 0)

    @on_every_run
    def test_status_and_lengths(self, run):
        s = run.summary
        seen = np.asarray((run.table > 0).sum(axis=0)).ravel() > 0
        status = run.coverage["pieces/status"][:]
        np.testing.assert_array_equal(seen, status == 0)
        self.assertAlmostEqual(run.length.sum(), s["length_m"], places=6)
        coverable = status != 1
        self.assertEqual(coverable.sum(), s["pieces_coverable"])
        self.assertAlmostEqual(run.length[coverable].sum(), s["length_coverable_m"], places=6)
        self.assertEqual(len(run.coverage["walls/x0"]), s["site"]["walls"])

    @on_every_run
    def test_plan_is_what_the_table_says(self, run):
        s, plan = run.summary, run.plan
        station = plan["stations/candidate"][:]
        component = plan["stations/component"][:]
        self.assertEqual(len(station), s["stations"])
        self.assertEqual(len(np.unique(station)), len(station))
        bits = (run.table[station] > 0).toarray()
        status = plan["piece_status"][:]
        main = bits[component == 0].any(axis=0)
        np.testing.assert_array_equal(main, status == 0)
        self.assertEqual(main.sum(), s["pieces_covered"])
        self.assertAlmostEqual(run.length[main].sum(), s["length_covered_m"], places=6)
        np.testing.assert_allclose(plan["stations/seen_length_m"][:], bits @ run.length, atol=1e-6)
        self.assertAlmostEqual(
            plan["stations/new_length_m"][:][component == 0].sum(), s["length_covered_m"], places=6
        )
        for i, row in enumerate(run.rows("stations.csv")):
            for axis, origin in zip("xy", run.origin):
                at = run.candidates(axis)[station[i]] + origin
                self.assertAlmostEqual(at, float(row[axis]), delta=6e-5)

    @on_every_run
    def test_roles_are_what_is_lost_without_the_station(self, run):
        plan = run.plan
        station = plan["stations/candidate"][:]
        bits = (run.table[station] > 0).toarray()
        only = bits & (bits.sum(axis=0) == 1)
        np.testing.assert_allclose(plan["stations/only_length_m"][:], only @ run.length, atol=1e-6)
        a, b = plan["links/from"][:], plan["links/to"][:]
        overlap = plan["links/overlap"][:]

        def parts(links, without=-1):
            keep = links & (a != without) & (b != without)
            graph = scipy.sparse.coo_matrix(
                (np.ones(keep.sum()), (a[keep], b[keep])), shape=(len(station),) * 2
            )
            return connected_components(graph, directed=False)[0]

        every = np.ones(len(a), dtype=bool)
        whole = parts(every)
        for i in range(len(station)):
            # Without the station it counts as a part of its own.
            lost = parts(every, i) - whole - ((a == i) | (b == i)).any()
            self.assertEqual(bool(plan["stations/articulation"][i]), lost > 0)
        ends = np.zeros(len(station), dtype=bool)
        for k in range(len(a)):
            if parts(every & (np.arange(len(a)) != k)) > whole:
                ends[[a[k], b[k]]] = True
        np.testing.assert_array_equal(plan["stations/bridge_end"][:].astype(bool), ends)
        for i in range(len(station)):
            # As the strongest tree goes: with stronger links alone the station is parted from
            # something that it is joined to by this one.
            needed = plan["stations/needed_overlap"][i]
            mine = (a == i) | (b == i)
            self.assertEqual(needed > 0, mine.any())
            if mine.any():
                self.assertIn(needed, overlap[mine])
                self.assertLess(parts(overlap >= needed), parts(overlap > needed))
        for i, row in enumerate(run.rows("stations.csv")):
            self.assertEqual(row["articulation"], str(plan["stations/articulation"][i]))
            self.assertAlmostEqual(
                float(row["only_length_m"]), plan["stations/only_length_m"][i], delta=6e-4
            )

    @on_every_run
    def test_links_are_overlaps(self, run):
        plan = run.plan
        bits = (run.table[plan["stations/candidate"][:]] > 0).toarray()
        own = bits @ run.length
        a, b = plan["links/from"][:], plan["links/to"][:]
        self.assertEqual(len(a), run.summary["links"])
        joint = (bits[a] & bits[b]) @ run.length
        expected = {
            "min_len": joint / np.minimum(own[a], own[b]),
            "mean_len": 2 * joint / (own[a] + own[b]),
            "union_len": joint / (own[a] + own[b] - joint),
        }
        for ratio, value in expected.items():
            np.testing.assert_allclose(plan[f"links/{ratio}"][:], value, atol=1e-9, err_msg=ratio)
        ratio = text(plan.attrs["overlap_ratio"])
        np.testing.assert_array_equal(plan["links/overlap"][:], plan[f"links/{ratio}"][:])
        self.assertGreaterEqual(plan["links/overlap"][:].min(), plan.attrs["overlap_threshold"])
        # Every pair of a network that overlaps enough is a link.
        component = plan["stations/component"][:]
        self.assertTrue((component[a] == component[b]).all())
        pairs = bits @ (bits * run.length).T
        enough = 2 * pairs / (own[:, None] + own[None, :]) >= plan.attrs["overlap_threshold"]
        self.assertEqual(np.triu(enough, 1).sum(), len(a))

    @on_every_run
    def test_certificate(self, run):
        lines = bytes(run.plan["certificate/text"][:]).decode().splitlines()
        self.assertEqual(lines[:2], ["vfplan certificate 1", f"scale {2**24}"])
        self.assertEqual(lines[-1], "end")
        self.assertEqual(run.plan["certificate"].attrs["bound"], run.summary["lower_bound"])
        # Fast proofs have lines of one kind only: by hand, over all candidates that did not go.
        bits = run.table > 0
        enough = self.near(run)
        component = connected_components(enough)[1]
        networks, bound, covered = [], 0, np.array([], dtype=int)
        for words in map(str.split, lines[2:-1]):
            if words[0] == "network":
                networks.append({"bound": int(words[3]), "piece": [], "weight": [], "gone": []})
            elif words[0] == "gone":
                networks[-1]["gone"].append(int(words[1]))
            elif words[0] == "line":
                self.assertEqual(words[2], "cover")
                networks[-1]["piece"].append(int(words[3]))
            elif words[0] == "weight":
                self.assertEqual(int(words[1]), len(networks[-1]["weight"]))
                networks[-1]["weight"].append(int(words[2]))
        stations = run.plan["stations/candidate"][:]
        for number, n in enumerate(networks):
            mine = stations[run.plan["stations/component"][:] == number][0]
            there = component == component[mine]
            there[n["gone"]] = False
            weight = np.array(n["weight"], dtype=np.int64)
            gained = bits[:, n["piece"]][there].astype(np.int64) @ weight
            value = weight.sum() + np.minimum(0, 2**24 - gained).sum()
            self.assertEqual(-(-value // 2**24), n["bound"])
            bound += n["bound"]
            # No more than the fewest that cover, and not much less, as HiGHS finds them.
            mine = bits[component == component[mine]]
            wanted = np.setdiff1d(np.flatnonzero(mine.sum(axis=0)), covered)
            covered = np.union1d(covered, wanted)
            cover = milp(
                np.ones(mine.shape[0]),
                constraints=LinearConstraint(mine[:, wanted].T.astype(float), lb=1),
                integrality=1,
                bounds=Bounds(0, 1),
                options={"time_limit": 60},
            )
            self.assertLessEqual(n["bound"], round(cover.fun))
            self.assertGreaterEqual(n["bound"], 0.85 * cover.mip_dual_bound - 1)
        self.assertEqual(bound, run.summary["lower_bound"])

    @staticmethod
    def near(run):
        """Candidates that overlap enough, a tie to within 1e-12 included."""
        bits = run.table > 0
        own = bits @ run.length
        pairs = (bits.multiply(run.length) @ bits.T).toarray()
        return 2 * pairs / (own[:, None] + own[None, :]) >= run.plan.attrs["overlap_threshold"] - 1e-12

    @on_every_run
    def test_the_field_is_its_tiles(self, run):
        vf = run.field["vf"]
        self.assertTrue(vf.is_virtual)
        shards = sorted(run.dir.glob("shards/field-64-*.h5"))
        self.assertEqual(len(shards), len(run.field["tile_status"]))
        self.assertGreater(len(shards), 1)
        met = np.zeros(vf.shape, bool)
        for path in shards:
            with h5py.File(path, "r") as shard:
                part = shard["vf"]
                y, x = shard.attrs["y_begin"], shard.attrs["x_begin"]
                place = np.s_[y : y + part.shape[0], x : x + part.shape[1]]
                np.testing.assert_array_equal(vf[place], part[:])
                self.assertFalse(met[place].any())
                met[place] = True
                self.assertEqual(shard["closed"].shape, part.shape)
        self.assertTrue(met.all())

    @on_every_run
    def test_chunks_are_packed_as_they_say(self, run):
        for path in run.dir.glob("shards/*.h5"):
            with h5py.File(path, "r") as shard:
                names = []
                shard.visititems(lambda n, o: names.append(n) if isinstance(o, h5py.Dataset) else 0)
                for name in names:
                    data = shard[name]
                    data[...]  # undoes the filters and checks the sums
                    if data.size >= 256:
                        self.assertEqual(
                            (data.compression, data.shuffle, data.fletcher32), ("gzip", True, True)
                        )
        for group in ("walls", "pieces", "candidates", "coverage"):
            for name, data in run.coverage[group].items():
                self.assertEqual(len(data[...]), len(data), name)

    @on_every_run
    def test_files_end_with_their_hash(self, run):
        files = [*run.dir.glob("*.h5"), *run.dir.glob("shards/*.h5")]
        self.assertGreater(len(files), 4)
        for path in files:
            content, line = path.read_bytes()[:-80], path.read_bytes()[-80:]
            want = f"\nvfplan sha256 {hashlib.sha256(content).hexdigest()}\n".encode()
            self.assertEqual(line, want, path)
        indices = (run.field, "field-*"), (run.coverage, "coverage-*"), (run.pool, "pool-*")
        for index, pattern in indices:
            listed = [bytes(row).hex() for row in index["tile_sha256"][:]]
            shards = sorted(run.dir.glob(f"shards/{pattern}.h5"))
            self.assertEqual(
                listed, [hashlib.sha256(p.read_bytes()[:-80]).hexdigest() for p in shards]
            )

    @unittest.skipUnless(anndata, "no anndata here (python3-anndata)")
    @on_every_run
    def test_coverage_by_anndata(self, run):
        table = anndata.experimental.read_elem(run.coverage["coverage"])
        self.assertTrue(scipy.sparse.isspmatrix_csr(table))
        self.assertEqual((table != run.table[: table.shape[0]]).nnz, 0)

    def expect_raster(self, run, size, transform, band):
        vf, cell = run.field["vf"][:], run.field["vf"].attrs["cell_m"]
        self.assertEqual(size, (vf.shape[1], vf.shape[0]))
        north_west = (run.field["x"][0] - cell / 2, run.field["y"][-1] + cell / 2)
        np.testing.assert_allclose(
            transform, (north_west[0], cell, 0, north_west[1], 0, -cell), atol=1e-6
        )
        if band is not None:  # GDAL's first row is the northernmost
            np.testing.assert_array_equal(band, vf[::-1])

    @unittest.skipUnless(gdal, "no GDAL for Python here (python3-gdal)")
    @on_every_run
    def test_field_by_gdal(self, run):
        gdal.UseExceptions()
        raster = gdal.Open(f'NETCDF:"{run.dir}/field.h5":vf')
        band = raster.GetRasterBand(1).ReadAsArray()
        size = (raster.RasterXSize, raster.RasterYSize)
        self.expect_raster(run, size, raster.GetGeoTransform(), band)

    @unittest.skipUnless(shutil.which("gdalinfo"), "no gdalinfo here (gdal-bin)")
    @on_every_run
    def test_field_by_gdalinfo(self, run):
        said = subprocess.run(
            ["gdalinfo", "-json", f'NETCDF:"{run.dir}/field.h5":vf'],
            check=True,
            capture_output=True,
        )
        info = json.loads(said.stdout)
        self.expect_raster(run, tuple(info["size"]), info["geoTransform"], None)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
