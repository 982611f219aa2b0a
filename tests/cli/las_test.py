"""LAS and LAZ files: read, converted, classified, with nothing lost; damaged ones refused or warned about."""
import json
import pathlib
import re
import struct
import unittest

import numpy as np

from support import CliTest, cube, read_ply, run

XYZ = [("X", "<i4"), ("Y", "<i4"), ("Z", "<i4"), ("Intensity", "<u2")]
OLD = XYZ + [("returns", "u1"), ("classification", "u1"), ("ScanAngleRank", "i1"),
             ("UserData", "u1"), ("PointSourceId", "<u2")]
NEW = XYZ + [("returns", "u1"), ("flags", "u1"), ("Classification", "u1"), ("UserData", "u1"),
             ("ScanAngle", "<i2"), ("PointSourceId", "<u2"), ("GpsTime", "<f8")]
GPS = [("GpsTime", "<f8")]
RGB = [("Red", "<u2"), ("Green", "<u2"), ("Blue", "<u2")]
NIR = [("Infrared", "<u2")]
WAVE = [("WavePacketDescriptorIndex", "u1"), ("WaveformDataOffset", "<u8"),
        ("WaveformPacketSize", "<u4"), ("ReturnPointWaveformLocation", "<f4"), ("Xt", "<f4"),
        ("Yt", "<f4"), ("Zt", "<f4")]
FORMATS = [OLD, OLD + GPS, OLD + RGB, OLD + GPS + RGB, OLD + GPS + WAVE, OLD + GPS + RGB + WAVE,
           NEW, NEW + RGB, NEW + RGB + NIR, NEW + WAVE, NEW + RGB + NIR + WAVE]
SCALE, OFFSET = (0.001, 0.001, 0.0005), (652000.0, 6862000.0, 0.0)


def descriptor(name, kind, options=0):
    return struct.pack("<2xBB32s156x", kind, options, name.encode())


def vlr(user, number, data, description=b""):
    return struct.pack("<H16sHH32s", 0, user, number, len(data), description) + data


def evlr(user, number, data):
    return struct.pack("<H16sHQ32s", 0, user, number, len(data), b"") + data


def las(point_format, rows, vlrs=(), evlrs=(), minor=None):
    """A LAS file, written from the standard's tables."""
    minor = minor if minor is not None else (4 if point_format > 5 else 3 if point_format > 3 else 2)
    size = {4: 375, 3: 235}.get(minor, 227)
    body = b"".join(vlrs)
    start = size + len(body)
    header = struct.pack("<4sHHIHH8s", b"LASF", 7, 17 if minor == 4 else 1, 1, 2, 3, b"8 bytes.")
    header += struct.pack("<BB32s32sHHHII", 1, minor, b"a scanner", b"a program", 100, 2020, size,
                          start, len(vlrs))
    n = len(rows)
    header += struct.pack("<BHI5I", point_format, rows.dtype.itemsize, n if point_format < 6 else 0,
                          *[0] * 5)
    header += struct.pack("<12d", *SCALE, *OFFSET, *[0.0] * 6)
    if minor >= 3:
        header += struct.pack("<Q", 0)
    if minor >= 4:
        end = start + rows.nbytes
        header += struct.pack("<QIQ15Q", end if evlrs else 0, len(evlrs), n, *[0] * 15)
    assert len(header) == size
    return header + body + rows.tobytes() + b"".join(evlrs)


def random_rows(dtype, n=300, seed=1, extreme=False):
    random = np.random.default_rng(seed)
    rows = np.frombuffer(random.bytes(n * np.dtype(dtype).itemsize), dtype).copy()
    for name in rows.dtype.names:
        if rows.dtype[name].kind == "f":
            rows[name] = np.cumsum(random.integers(0, 5, n)).astype(rows.dtype[name])
    if not extreme:
        for axis, spread in zip("XYZ", (90000, 90000, 20000)):
            rows[axis] = np.cumsum(random.integers(-spread, spread, n))
    return rows


def points_of(data):
    start, = struct.unpack_from("<I", data, 96)
    length, = struct.unpack_from("<H", data, 105)
    count, = struct.unpack_from("<I", data, 107)
    if data[25] == 4:
        count, = struct.unpack_from("<Q", data, 247)
    return data[start:start + length * count], length, count


def records_of(data):
    at, found = struct.unpack_from("<H", data, 94)[0], []
    for _ in range(struct.unpack_from("<I", data, 100)[0]):
        user, number, length = struct.unpack_from("<2x16sHH", data, at)
        found.append((user.rstrip(b"\0"), number, data[at + 54:at + 54 + length]))
        at += 54 + length
    return found


class Las(CliTest):
    def write(self, name, data):
        path = self.folder / name
        path.write_bytes(data)
        return path

    def convert(self, source, name):
        run("convert", source, "-o", self.folder / name, "--overwrite")
        return self.folder / name

    def test_gives_every_format_back_bit_for_bit(self):
        for number, dtype in enumerate(FORMATS):
            for extra in ([], [("height", "<f4"), ("code", "<i8"), ("triple", "u1", 3)]):
                with self.subTest(format=number, extra=bool(extra)):
                    rows = random_rows(dtype + extra, extreme=number % 2 == 1)
                    vlrs = [vlr(b"somebody", 7, b"kept as it is", b"of mine")]
                    if extra:
                        vlrs.append(vlr(b"LASF_Spec", 4, descriptor("height", 9) +
                                        descriptor("code", 8) + descriptor("triple", 21)))
                    evlrs = [evlr(b"LASF_Spec", 65535, b"waves" * 9)] if number > 5 else []
                    source = self.write("in.las", las(number, rows, vlrs, evlrs))
                    back = self.convert(source, "out.las").read_bytes()
                    points, length, count = points_of(back)
                    self.assertEqual((length, count), (rows.dtype.itemsize, len(rows)))
                    self.assertEqual(points, rows.tobytes())
                    self.assertEqual(back[:96], source.read_bytes()[:96])
                    self.assertEqual(back[131:179], source.read_bytes()[131:179])
                    self.assertEqual([r[2] for r in records_of(back) if r[1] == 7],
                                     [b"kept as it is"])
                    if evlrs:
                        self.assertTrue(back.endswith(evlrs[0]))

    def test_keeps_the_fields_in_ply_and_takes_them_from_it(self):
        rows = random_rows(FORMATS[7])
        source = self.write("in.las", las(7, rows, [vlr(b"somebody", 7, b"of mine")]))
        ply = self.convert(source, "a.ply")
        got, _ = read_ply(ply)
        for axis, scale, offset in zip("xyz", SCALE, OFFSET):
            np.testing.assert_array_equal(got[axis], rows[axis.upper()] * scale + offset)
        for name in ("Intensity", "Classification", "UserData", "ScanAngle", "PointSourceId",
                     "GpsTime", "Red", "Green", "Blue"):
            np.testing.assert_array_equal(got[name], rows[name])
        np.testing.assert_array_equal(got["ReturnNumber"], rows["returns"] & 15)
        np.testing.assert_array_equal(got["NumberOfReturns"], rows["returns"] >> 4)
        for bit, name in enumerate(("Synthetic", "KeyPoint", "Withheld", "Overlap")):
            np.testing.assert_array_equal(got[name], rows["flags"] >> bit & 1)
        np.testing.assert_array_equal(got["ScanChannel"], rows["flags"] >> 4 & 3)
        np.testing.assert_array_equal(got["ScanDirectionFlag"], rows["flags"] >> 6 & 1)
        np.testing.assert_array_equal(got["EdgeOfFlightLine"], rows["flags"] >> 7)
        np.testing.assert_array_equal(got["red"], (rows["Red"].astype(int) + 128) // 257)
        back = self.convert(ply, "b.las").read_bytes()
        self.assertEqual(points_of(back)[0], rows.tobytes())
        self.assertEqual(records_of(back), [(b"somebody", 7, b"of mine")])

    def scan(self, number=3):
        p, _, _ = cube(3000)
        rows = random_rows(FORMATS[number], len(p))
        for a, axis in enumerate("XYZ"):
            rows[axis] = np.round(p[:, a] / SCALE[a])
        return rows

    def test_classifies_into_extra_bytes_and_touches_nothing_else(self):
        for number in (1, 3, 6, 8):
            with self.subTest(format=number):
                rows = self.scan(number)
                source = self.write("scan.las", las(number, rows))
                run("classify", source, "--overwrite")
                data = (self.folder / "scan_edges.las").read_bytes()
                points, length, _ = points_of(data)
                self.assertEqual(length, rows.dtype.itemsize + 9)
                got = np.frombuffer(points, rows.dtype.descr + [
                    ("edge_class", "u1"), ("p_sharp", "<f4"), ("p_smooth", "<f4")])
                self.assertEqual(got[list(rows.dtype.names)].astype(rows.dtype).tobytes(),
                                 rows.tobytes())
                (user, _, described), = [r for r in records_of(data) if r[1] == 4]
                self.assertEqual(user, b"LASF_Spec")
                self.assertEqual(described[:192][4:36].rstrip(b"\0"), b"edge_class")
                self.assertEqual([described[192 * i + 2] for i in range(3)], [1, 9, 9])
                self.assertGreater(np.sum(got["edge_class"] == 2), 50)
                run("classify", self.folder / "scan_edges.las", "-o", self.folder / "again.las",
                    "--overwrite")
                self.assertEqual((self.folder / "again.las").read_bytes(), data)

    def test_names_extra_bytes_of_anothers_that_the_result_replaces(self):
        rows = self.scan(6)
        wide = np.zeros(len(rows), rows.dtype.descr + [("edge_class", "<f4"), ("p_sharp", "<u2")])
        for name in rows.dtype.names:
            wide[name] = rows[name]
        extra = descriptor("edge_class", 9) + descriptor("p_sharp", 3)
        source = self.write("own.las", las(6, wide, [vlr(b"LASF_Spec", 4, extra)]))
        for more in ((), ("--max-memory", "1M")):
            said = run("classify", source, "--overwrite", *more).stderr
            self.assertIn("own.las: its own edge_class, p_sharp are replaced by the result's", said)
        said = run("tiles", "plan", source, "-o", self.folder / "own.json").stderr
        self.assertIn("own.las: its own edge_class, p_sharp are replaced by the result's", said)
        again = run("classify", self.folder / "own_edges.las", "-o", self.folder / "again.las").stderr
        self.assertNotIn("replaced", again)

    def test_does_not_miss_class_colours_where_there_are_none(self):
        for number in (6, 3):
            source = self.write("scan.las", las(number, self.scan(number)))
            for options in ((), ("--class-colours",)):
                done = run("classify", source, "--overwrite", *options)
                self.assertNotIn("does not keep", done.stderr)
        points, _, _ = points_of((self.folder / "scan_edges.las").read_bytes())
        got = np.frombuffer(points, FORMATS[3] + [("edge_class", "u1"), ("p", "<f4", 2)])
        self.assertEqual(set(got["Red"][got["edge_class"] == 2]), {168 * 257})

    def test_brings_the_fields_back_through_text_and_pcd(self):
        rows = random_rows(FORMATS[7])
        source = self.write("in.las", las(7, rows))
        for name in ("a.csv", "a.xyz", "a.pts", "a.pcd"):
            self.convert(source, name)
            done = run("convert", self.folder / name, "-o", self.folder / "out.las", "--overwrite")
            self.assertNotIn("does not keep", done.stderr)
            points, length, _ = points_of((self.folder / "out.las").read_bytes())
            self.assertEqual(length, rows.dtype.itemsize)
            got = np.frombuffer(points, FORMATS[7])
            for field in set(rows.dtype.names) - set("XYZ"):
                np.testing.assert_array_equal(got[field], rows[field], f"{name} {field}")

    def test_keeps_numbers_that_are_no_intensity(self):
        source = self.write("a.csv", b"x,y,z,intensity\n1,2,3,0.5\n4,5,6,1\n")
        done = run("convert", source, "-o", self.folder / "a.las")
        self.assertIn("intensity in the field Intensity of LAS, since 0.5 is not a whole number",
                      done.stderr)
        points, length, _ = points_of((self.folder / "a.las").read_bytes())
        self.assertEqual(length, 38)
        self.assertEqual(np.frombuffer(points, NEW + [("intensity", "<f8")])["intensity"].tolist(), [0.5, 1.0])

    def test_info_tells_what_the_header_and_the_records_say(self):
        rows = self.scan(3)
        source = self.write("scan.las", las(3, rows))
        run("classify", source, "--overwrite")
        done = run("info", self.folder / "scan_edges.las", "--json", "-")
        facts = json.loads(done.stdout)[0]["las"]
        self.assertEqual(facts["point_format"], 3)
        self.assertFalse(facts["compressed"])
        self.assertEqual(len(facts["extra_bytes"]), 3)
        self.assertEqual(sum(facts["points_by_class"].values()), len(rows))
        self.assertEqual(sum(facts["points_by_return"].values()), len(rows))
        self.assertIn(4, [record["record_id"] for record in facts["records"]])
        self.assertIn("point format 3", run("info", source).stdout)

    def test_info_names_the_classes_and_noise(self):
        rows = self.scan(6)
        rows["Classification"] = 2
        rows["Classification"][:7], rows["Classification"][7:10], rows["Classification"][10] = 7, 18, 64
        said = run("info", self.write("scan.las", las(6, rows))).stdout
        self.assertIn(f"2 ground: {len(rows) - 11}, 7 low noise: 7, 18 high noise: 3, 64: 1\n", said)
        self.assertIn(f"10 of {len(rows)} points are of the classes 7 and 18, noise", said)

    def test_labels_in_utm_are_those_of_the_shifted_copy(self):
        rows = self.scan()
        data = bytearray(las(3, rows))
        source = self.write("utm.las", bytes(data))
        struct.pack_into("<3d", data, 155, 0.0, 0.0, 0.0)
        shifted = self.write("local.las", bytes(data))
        labels = []
        for path in (source, shifted):
            run("classify", path)
            points, length, count = points_of(
                (self.folder / f"{path.stem}_edges.las").read_bytes())
            labels.append(np.frombuffer(points, "u1").reshape(count, length)[:, -9])
        np.testing.assert_array_equal(*labels)

    def test_maps_classes_to_classification_codes_on_demand(self):
        source = self.write("scan.las", las(6, self.scan(6)))
        run("classify", source, "--las-classification", "2=64,1=65")
        points, _, _ = points_of((self.folder / "scan_edges.las").read_bytes())
        got = np.frombuffer(points, FORMATS[6] + [("edge_class", "u1"), ("p", "<f4", 2)])
        before = self.scan(6)["Classification"]
        expected = np.choose(got["edge_class"], [before, 65, 64])
        np.testing.assert_array_equal(got["Classification"], expected)
        for bad in ("3=1", "2=64x", "2=", "2", "2=4=6", "-1=6", "4294967298=64"):
            run("classify", source, "--las-classification", bad, expect=2)
        old = self.write("old.las", las(3, self.scan(3)))
        done = run("classify", old, "--las-classification", "2=64", expect=2)
        self.assertIn("does not fit point format 3", done.stderr)

    def test_makes_las_of_other_clouds_to_a_tenth_of_a_millimetre(self):
        p, n, _ = cube(500)
        p = p + np.array([652000.0, 6862000.0, 35.0])
        lines = "\n".join(" ".join(repr(float(v)) for v in row) for row in np.hstack([p, n]))
        source = self.write("a.xyz", b"# x y z nx ny nz\n" + lines.encode())
        data = self.convert(source, "a.las").read_bytes()
        self.assertEqual((data[25], data[104]), (4, 6))
        self.assertTrue(struct.unpack_from("<H", data, 6)[0] & 16)
        scale, offset = struct.unpack_from("<3d", data, 131), struct.unpack_from("<3d", data, 155)
        self.assertTrue(all(s <= 1e-4 for s in scale) and all(o == int(o) for o in offset))
        points, length, count = points_of(data)
        xyz = np.frombuffer(points, "u1").reshape(count, length)[:, :12].copy().view("<i4")
        # Half a step, and one rounding of a double at 7e6.
        np.testing.assert_allclose(xyz * scale + offset, p, atol=0.51 * max(scale) + 1e-9, rtol=0)
        back, _ = read_ply(self.convert(self.folder / "a.las", "b.ply"))
        np.testing.assert_allclose(back["nx"], n[:, 0], atol=1e-6)

    def read_all(self, folder):
        """One process reads all files of a folder, the first of them damaged: the names of those that it refuses
        because of a byte or a record, and what it says."""
        said = run("classify", folder, "--out-dir", self.folder / "out", expect=3).stderr
        reasons = r"byte \d+: |record |not a LAS file: |the file is empty"
        return set(re.findall(rf"^pcednet: {re.escape(str(folder))}/(\S+): (?:{reasons})", said, re.M)), said

    def test_refuses_every_truncation_but_those_behind_the_points(self):
        rows = random_rows(FORMATS[1], 3)
        whole = las(1, rows, [vlr(b"somebody", 7, b"abc")])
        self.assertLess(len(whole), 500)
        cuts = self.folder / "cuts"
        cuts.mkdir()
        for length in range(len(whole)):
            (cuts / f"{length}.las").write_bytes(whole[:length])
        refused, said = self.read_all(cuts)
        self.assertEqual(refused, {f"{length}.las" for length in range(len(whole))})
        self.assertIn(f"{len(whole)} of {len(whole)} inputs failed", said)
        self.assertEqual(list((self.folder / "out").iterdir()), [])
        for length in (0, 3, 226, 280, len(whole) - 1):
            run("convert", cuts / f"{length}.las", "-o", self.folder / "cut.ply", expect=3)

    def test_reads_what_is_only_slightly_wrong_and_refuses_absurd_counts(self):
        rows = random_rows(FORMATS[3], 20)
        good = las(3, rows, [vlr(b"somebody", 7, b"abc")])
        ply = self.folder / "a.ply"

        def changed(at, layout, value):
            data = bytearray(good)
            struct.pack_into(layout, data, at, value)
            return self.write("odd.las", bytes(data))

        for path in (changed(100, "<I", 3), changed(100, "<I", 2**32 - 1),
                     changed(227 + 20, "<H", 65535)):
            done = run("convert", path, "-o", ply, "--overwrite")
            self.assertIn("left out", done.stderr)
            self.assertEqual(len(read_ply(ply)[0]), 20)
        for at, layout, value in ((107, "<I", 2**32 - 1), (96, "<I", 100), (96, "<I", 2**32 - 1),
                                  (105, "<H", 33), (105, "<H", 0), (104, "B", 11), (24, "B", 2),
                                  (131, "<d", 0.0), (131, "<d", float("nan")),
                                  (155, "<d", float("inf"))):
            done = run("convert", changed(at, layout, value), "-o", ply, "--overwrite", expect=3)
            self.assertIn("odd.las", done.stderr)

    def test_gives_every_format_back_through_laz(self):
        # Without and with extra bytes, of which the one is steady and the other is not, in turn.
        for number, dtype in enumerate(FORMATS):
            for extra in ([], [("code", "<u2"), ("triple", "u1", 3)]):
                steady = bool(extra) == (number % 2 == 0)
                with self.subTest(format=number, extra=bool(extra), steady=steady):
                    rows = random_rows(dtype + extra, 2000, extreme=not steady)
                    if steady:  # layers that never change, and a constant time step
                        for name in set(rows.dtype.names) - {"X", "Y", "Intensity"}:
                            rows[name] = rows[name][0]
                        if "GpsTime" in rows.dtype.names:
                            rows["GpsTime"] = np.arange(2000) * 0.25
                    source = self.write("in.las", las(number, rows))
                    packed = self.convert(source, "a.laz")
                    back = self.convert(packed, "b.las").read_bytes()
                    self.assertEqual(points_of(back)[0], rows.tobytes())
                    self.assertEqual(back, self.convert(source, "c.las").read_bytes())
                    if steady:
                        self.assertLess(packed.stat().st_size, 0.6 * len(back))

    def test_writes_the_same_laz_with_any_threads(self):
        rows = random_rows(FORMATS[3], 60000)  # two chunks
        source = self.write("in.las", las(3, rows))
        packed = []
        for threads in (1, 2, 8):
            path = self.folder / f"{threads}.laz"
            run("convert", source, "-o", path, "--threads", threads)
            run("convert", path, "-o", self.folder / "b.las", "--threads", threads, "--overwrite")
            self.assertEqual(points_of((self.folder / "b.las").read_bytes())[0], rows.tobytes())
            packed.append(path.read_bytes())
        self.assertEqual(packed[0], packed[1])
        self.assertEqual(packed[0], packed[2])

    def test_refuses_truncated_laz_and_survives_changed_bytes(self):
        random = np.random.default_rng(5)
        files = self.folder / "files"
        files.mkdir()
        cuts, odd = set(), []
        for number in (3, 7):
            source = self.write("in.las", las(number, random_rows(FORMATS[number], 40)))
            whole = self.convert(source, "a.laz").read_bytes()
            for length in range(0, len(whole) - 12, 29):
                cuts.add(f"cut{number}_{length}.laz")
                (files / f"cut{number}_{length}.laz").write_bytes(whole[:length])
            for k in range(60):
                data = bytearray(whole)
                for at in random.integers(96, len(data), 4):
                    data[at] = random.integers(256)
                odd.append(files / f"odd{number}_{k}.laz")
                odd[-1].write_bytes(data)
        refused, said = self.read_all(files)
        self.assertLessEqual(cuts, refused)
        failed = len(refused) + said.count(": coordinates too large: ")
        self.assertIn(f"{failed} of {len(cuts) + len(odd)} inputs failed", said)
        for path in odd[::8]:
            run("convert", path, "-o", self.folder / "odd.ply", "--overwrite", expect=3 * (path.name in refused))

    def test_says_what_it_does_not_keep_of_an_empty_file(self):
        source = self.write("none.las", las(2, random_rows(FORMATS[2], 0)))
        self.assertEqual(points_of(self.convert(source, "b.las").read_bytes())[2], 0)


if __name__ == "__main__":
    unittest.main()
