"""Options of the command line: numbers that no command may take, and options that need others."""
import os
import resource
import signal
import subprocess
import unittest

from support import PROGRAM, CliTest, cube, run, write_ply


class Options(CliTest):
    def setUp(self):
        super().setUp()
        self.cloud, self.out = self.folder / "a.ply", self.folder / "x.ply"
        write_ply(self.cloud, *cube(200))

    def refused(self, *arguments, saying):
        said = run(*arguments, expect=2).stderr
        self.assertIn(saying, said)
        self.assertEqual(said[:9], "pcednet: ", said)
        self.assertLess(max(map(len, said.splitlines())), 250, said)
        self.assertEqual(os.listdir(self.folder), ["a.ply"])

    def test_whole_numbers_below_0_and_beyond_64_bits(self):
        convert = ("convert", self.cloud, "-o", self.out)
        train = ("train", self.cloud, "-o", self.folder / "m.safetensors")
        for arguments in ((*convert, "--sample", -5), (*convert, "--sample", 99999999999),
                          (*convert, "--sample", 0), (*convert, "--seed", -1), (*train, "--seed", -1),
                          (*train, "--seed", "99999999999999999999"), (*train, "--epochs", -3),
                          (*train, "--width", -1), (*train, "--distil", -1),
                          ("generate", "default", self.folder / "set", "--seed", -1),
                          ("study", "methods", "-o", self.folder / "set", "--seeds", "1,-1"),
                          ("lines", self.cloud, "-o", self.folder / "x.dxf", "--min-points", -1),
                          ("classify", self.cloud, "--method", "ca", "--neighbours", 0),
                          ("normals", self.cloud, "-o", self.out, "--neighbours", -1)):
            value = str(arguments[-1]).split(",")[-1]
            self.refused(*arguments, saying=f"{arguments[-2]}: {value} is not a whole number from ")

    def test_a_whole_number_may_begin_with_0(self):
        run("convert", self.cloud, "-o", self.out, "--noise", 0.001, "--seed", "010")
        self.assertIn(b"seed 10", self.out.read_bytes())
        plan = self.folder / "p.json"
        run("tiles", "plan", self.cloud, "-o", plan, "--threads", "09")
        run("tiles", "run", plan, "--jobs", "08")
        for option, value, saying in (("--scales", "010", "10 not in"), ("--scales", "0x10", "0x10 is not a whole number"),
                                      ("--threads", "010000", "10000 is not a whole number from 0 to 4096"),
                                      ("--threads", "-1", "-1 is not a whole number from 0 to 4096")):
            self.assertIn(saying, run("describe", self.cloud, "-o", self.folder / "x.npy", option, value, expect=2).stderr)

    def test_numbers_that_are_not_finite_or_out_of_range(self):
        convert = ("convert", self.cloud, "-o", self.out)
        classify = ("classify", self.cloud, "-o", self.out)
        plan = ("tiles", "plan", self.cloud, "-o", self.folder / "p.json", "--tile")
        for arguments in ((*convert, "--noise", "nan"), (*convert, "--noise", "-1"),
                          (*convert, "--noise", "1e300"),
                          (*convert, "--spacing", "0"), (*convert, "--spacing", "inf"),
                          (*convert, "--subsample", "nan"), (*convert, "--subsample", "2"),
                          (*classify, "--method", "ca", "--threshold", "nan"),
                          (*classify, "--method", "ca", "--threshold", "-1"),
                          (*classify, "--s-max", "nan"), (*classify, "--s-min", "-1"),
                          (*plan, "nan"), (*plan, "inf"), (*plan, "-1"), (*plan, "0"),
                          ("describe", self.cloud, "-o", self.folder / "x.npy", "--gate", "nan"),
                          ("train", self.cloud, "-o", self.out, "--balance", "nan"),
                          ("normals", self.cloud, "-o", self.out, "--viewpoint", "0", "0", "nan"),
                          ("generate", "default", self.folder / "set", "--bands", "1", "0")):
            self.refused(*arguments, saying=f"{arguments[-1]} is not a")

    def test_bands_in_the_wrong_order(self):
        self.refused("generate", "default", self.folder / "set", "--bands", "5", "1",
                     saying="--bands 5 1: the sharp band is wider than the smooth one")

    def test_more_samples_than_memory_holds(self):
        limit = 4 << 30
        done = subprocess.run([PROGRAM, "convert", self.cloud, "-o", self.out, "--sample", "4294967295"],
                              capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        self.assertEqual(done.returncode, 2)
        self.assertIn("--sample 4294967295: the free memory holds ", done.stderr)
        self.assertEqual(os.listdir(self.folder), ["a.ply"])

    def test_sampling_stops_at_once(self):
        mesh = self.folder / "mesh.obj"
        mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        for number in (signal.SIGINT, signal.SIGTERM):
            running = subprocess.Popen(
                [PROGRAM, "convert", mesh, "-o", self.out, "--sample", "15000000", "--progress", "plain"],
                stderr=subprocess.PIPE, text=True,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (1, 1)))  # all would take more
            self.assertEqual(running.stderr.readline(), "sample 0 %\n")
            running.send_signal(number)
            self.assertIn("stopped by the user", running.communicate(timeout=60)[1])
            self.assertEqual(running.returncode, 130)
            self.assertFalse(self.out.exists())

    def test_options_that_would_have_no_effect(self):
        classify = ("classify", self.cloud, "-o", self.out)
        lines = ("lines", self.cloud, "-o")
        for saying, *arguments in (
                ("--threshold requires --method", *classify, "--threshold", "0.1"),
                ("--neighbours requires --method", "evaluate", self.cloud, "--neighbours", "9"),
                ("--octaves requires --s-max-ratio", "train", self.cloud, "-o", self.out, "--octaves"),
                ("--ascii is for .ply and .pcd", "convert", self.cloud, "-o", self.folder / "x.las", "--ascii"),
                ("--ascii is for .ply and .pcd", "classify", self.cloud, "-o", self.folder / "x.xyz", "--ascii"),
                ("--seed requires --noise, --spacing, --subsample or --sample", "convert", self.cloud, "-o", self.out, "--seed", 3),
                ("--exact excludes --eps", "describe", self.cloud, "-o", self.folder / "x.npy", "--exact", "--eps", 0.2),
                ("--all excludes --vpc", "info", self.cloud, "--all", "--vpc", self.folder / "x.vpc"),
                ("--view is for .svg", *lines, self.folder / "x.dxf", "--view", "front"),
                ("--unit is for .dxf .svg files", *lines, self.folder / "x.obj", "--unit", "mm"),
                ("--dxf-arcs is for .dxf", *lines, self.folder / "x.obj", "--dxf-arcs", "flat"),
                ("--dxf-version is for .dxf", *lines, self.folder / "x.obj", "--dxf-version", "r12")):
            self.refused(*arguments, saying=saying)

    def test_scales_beyond_the_cloud(self):
        classify = ("classify", self.cloud, "-o", self.out)
        self.refused(*classify, "--s-min", "1e6", saying="--s-min 1e+06 is larger than the cloud")
        said = run(*classify, "--s-max", "1e6").stderr
        self.assertIn("warning: " + str(self.cloud) + ": --s-max 1e+06 is larger than the cloud", said)

    def test_scales_below_the_spacing(self):
        write_ply(self.cloud, *cube(4000))
        classify = ("classify", self.cloud, "-o", self.out, "--overwrite")
        for scales in (("--s-max", "0.001", "--s-min", "0.0005"), ("--s-min", "1e-6")):
            self.assertIn(f"warning: {self.cloud}: the largest scale, ", run(*classify, *scales).stderr)
        for scales in ((), ("--s-min", "0.05"), ("--s-max", "0.1"), ("--s-min", "0.02", "--s-max", "0.08")):
            self.assertNotIn("the largest scale, ", run(*classify, *scales).stderr)

    def test_a_size_of_bytes_needs_its_unit(self):
        plan = self.folder / "p.json"
        for arguments in (("classify", self.cloud, "-o", self.out), ("lines", self.cloud, "-o", self.folder / "x.obj"),
                          ("tiles", "plan", self.cloud, "-o", plan)):
            for size in ("8", "1048575", "0.5"):
                self.refused(*arguments, "--max-memory", size, saying=f"--max-memory {size}: is a number of bytes: "
                                                                      f"write the unit, such as {size}G or {size}M")
        for size in ("0", "-8", "8X", "nan"):
            self.refused("classify", self.cloud, "-o", self.out, f"--max-memory={size}",
                         saying=f"--max-memory {size}: not a size such as 500M or 2G")
        run("tiles", "plan", self.cloud, "-o", plan, "--max-memory", "1073741824")

    def test_a_system_in_degrees_is_a_warning(self):
        p, n, label = cube(200)
        near, far = self.folder / "near.ply", self.folder / "far.ply"
        write_ply(near, p, n, label)
        write_ply(far, p + [357000, 5812000, 0], n, label, position_type="double")

        def said(cloud, code):
            done = subprocess.run([PROGRAM, "lines", cloud, "-o", self.folder / "x.dxf", "--overwrite", "--crs",
                                   f"EPSG:{code}"], capture_output=True, text=True)
            return done.stderr if done.returncode == 0 else None
        knows_codes = said(near, 999999) is None  # with PROJ
        self.assertNotIn("degrees", said(far, 25833))
        for code in (4326, 4258) if knows_codes else ():
            self.assertIn(f"far.ply: coordinates up to 5.812e+06 are no degrees, which --crs EPSG:{code} has",
                          said(far, code))
            self.assertIn(f"near.ply: by --crs EPSG:{code} its coordinates are in degrees: lengths across",
                          said(near, code))

    def test_a_command_that_there_is_not(self):
        for said, *words in (("there is no command foo\n", "foo"),
                             ("there is no command clasify; did you mean classify?", "clasify", "a.ply"),
                             ("there is no command generate foo\n", "generate", "foo", "x"),
                             ("there is no command tiles plane; did you mean tiles plan?", "tiles", "plane"),
                             ("a command is missing before the option --threads", "--threads", "2", "foo"),
                             ("a command is missing\n",), ("generate needs a command\n", "generate")):
            self.assertIn("pcednet: " + said, run(*words, expect=2).stderr)

    def test_an_option_that_there_is_not(self):
        for said, *words in (("there is no option --modle of classify; did you mean --model?\n", "--modle", "x"),
                             ("there is no option --modell of classify; did you mean --model?\n", "--modell=x"),
                             ("there is no option --colour of classify\n", "--colour", "x"),
                             ("there is no option -m of classify\n", "-m", "x")):
            self.assertIn("pcednet: " + said, run("classify", self.cloud, *words, expect=2).stderr)
        self.assertIn("there is no option --outputt of lines; did you mean --output?",
                      run("lines", self.cloud, "--outputt", "a.dxf", expect=2).stderr)
        self.assertIn("lines takes one input; not expected: b.ply\n",
                      run("lines", self.cloud, "b.ply", "-o", "a.dxf", expect=2).stderr)
        self.assertIn("run takes one plan; not expected: b.json\n", run("tiles", "run", "a.json", "b.json", expect=2).stderr)
        for words, said in ((["classify"], "classify needs one or more inputs"), (["lines"], "lines needs an input"),
                            (["tiles", "run"], "run needs a plan"), (["lines", "a.ply"], "--output is required")):
            self.assertEqual(f"pcednet: {said}\nRun with --help for more information.\n",
                             run(*words, expect=2).stderr)

    def test_a_file_with_the_name_of_an_option_is_named(self):
        (self.folder / "-scan.ply").write_bytes(self.cloud.read_bytes())
        said = run("info", "-scan.ply", cwd=self.folder, expect=2).stderr
        self.assertIn("there is no option -scan.ply of info; the file of this name is ./-scan.ply\n", said)
        run("info", "./-scan.ply", cwd=self.folder)

    def test_a_preview_is_a_png(self):
        self.refused("classify", self.cloud, "--preview", self.folder / "x.jpg",
                     saying="x.jpg does not end in .png")


if __name__ == "__main__":
    unittest.main()
