"""The Debian packages of this build: lintian, their content, and the main job from a folder that
they are unpacked in. packaging/try_debian.sh installs them in a bare Debian."""
import configparser
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
import urllib.request
import xml.etree.ElementTree as ElementTree

import packaging
from packaging import run

packaging.need("cpack", "lintian", "dpkg-shlibdeps", "desktop-file-validate")
PAGE = packaging.SOURCE / "web/dist/annotate.html"


class Deb(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        run("cpack", "-G", "DEB", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", "-B", cls.folder / "packed", cwd=packaging.BUILD)
        cls.debs = sorted((cls.folder / "packed").glob("*.deb"))
        cls.root = cls.folder / "root"
        for deb in cls.debs:
            run("dpkg-deb", "-x", deb, cls.root)

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def field(self, package, name):
        deb, = [d for d in self.debs if d.name.startswith(f"{package}_")]
        return run("dpkg-deb", "-f", deb, name).stdout.strip()

    def pcednet(self, *words):
        """Runs the unpacked program with nothing of this build in sight but what it was made of."""
        return run(self.root / "usr/bin/pcednet", *words, cwd=self.folder, env={"PATH": "/usr/bin"})

    def test_lintian_finds_neither_errors_nor_warnings(self):
        run("lintian", "--allow-root", "--fail-on", "error,warning", *self.debs)

    def test_the_packages_depend_on_what_they_link(self):
        names = [deb.name.partition("_")[0] for deb in self.debs]
        self.assertEqual(names[:2], ["libpcednet-dev", "pcednet"])
        self.assertIn("libtbb12", self.field("pcednet", "Depends"))
        self.assertIn("libtbb-dev", self.field("libpcednet-dev", "Depends"))
        self.assertRegex(self.field("pcednet", "Version"), rf"^{packaging.VERSION}-")

    def test_the_unpacked_program_classifies_and_draws(self):
        sample = packaging.SOURCE / "examples/building.ply"
        said = self.pcednet("classify", sample, "-o", "edges.ply", "--preview", "edges.png").stderr
        self.assertRegex(said, r"140000 points: [1-9]\d{3,} sharp-edge")
        self.pcednet("lines", "edges.ply", "-o", "edges.dxf")
        self.assertIn("LINE", (self.folder / "edges.dxf").read_text())
        self.assertGreater((self.folder / "edges.png").stat().st_size, 10000)
        ours = run(packaging.PROGRAM, "classify", sample, "-o", "ours.ply", cwd=self.folder)
        self.assertIn("140000 points", ours.stderr)
        self.assertEqual((self.folder / "ours.ply").read_bytes(),
                         (self.folder / "edges.ply").read_bytes())

    def test_the_program_finds_its_models_wherever_it_is_moved(self):
        moved = self.folder / "moved here"
        shutil.copytree(self.root / "usr/bin", moved / "bin")
        shutil.copytree(self.root / "usr/share/pcednet", moved / "share/pcednet")
        models = moved / "share/pcednet/models"
        (models / "general.safetensors").rename(models / "of_this_folder.safetensors")
        done = subprocess.run([moved / "bin/pcednet", "classify", "x.ply", "--model", "?"],
                              capture_output=True, text=True, cwd=self.folder)
        self.assertIn("of_this_folder", done.stderr)

    @unittest.skipUnless(PAGE.exists(), "scripts/build_web.sh has not run")
    def test_the_annotator_serves_its_page(self):
        self.pcednet("generate", "sample", "small.ply")
        program = subprocess.Popen(
            [self.root / "usr/bin/pcednet", "annotate", "small.ply", "--no-browser", "--model",
             "none"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
            cwd=self.folder)
        with program:
            with urllib.request.urlopen(program.stdout.readline().strip()) as answer:
                page = answer.read().decode()
            program.terminate()
        self.assertGreater(len(page), PAGE.stat().st_size // 2)
        self.assertIn("annotate", page)

    def test_python_finds_the_unpacked_module(self):
        module = self.root / "usr/lib/python3/dist-packages"
        if not module.exists():
            self.skipTest("built without PCEDNET_PYTHON_MODULE")
        code = ("import numpy, pcednet; xyz = numpy.random.default_rng(1).uniform(size=(5000, 3)); "
                "xyz[:, 2] = abs(xyz[:, 0] - .5); print(pcednet.classify(xyz).counts)")
        said = run("/usr/bin/python3", "-c", code, cwd=self.folder,
                   env={"PATH": "/usr/bin", "PYTHONPATH": str(module)}).stdout
        self.assertRegex(said, r"'sharp-edge': [1-9]")

    def test_other_programs_find_the_library(self):
        run("cmake", "-S", packaging.SOURCE / "examples", "-B", self.folder / "example",
            f"-DCMAKE_PREFIX_PATH={self.root}/usr")
        cache = (self.folder / "example/CMakeCache.txt").read_text()
        self.assertIn(f"pcednet_DIR:PATH={self.root}/usr/lib/cmake/pcednet", cache)

    def test_the_desktop_opens_point_files_with_the_annotator(self):
        entry = self.root / "usr/share/applications/pcednet.desktop"
        run("desktop-file-validate", entry)
        desktop = configparser.RawConfigParser()
        desktop.read(entry)
        entry = desktop["Desktop Entry"]
        types = ElementTree.parse(self.root / "usr/share/mime/packages/pcednet.xml").getroot()
        space = re.match(r"\{.*\}", types.tag).group()
        globs = {t.get("type"): t.find(f"{space}glob").get("pattern") for t in types}
        self.assertEqual(list(globs.values()), ["*.ply", "*.las", "*.laz", "*.e57"])
        self.assertEqual(entry["mimetype"].strip(";").split(";"), list(globs))
        icon = self.root / f"usr/share/icons/hicolor/scalable/apps/{entry['icon']}.svg"
        self.assertEqual(ElementTree.parse(icon).getroot().tag, "{http://www.w3.org/2000/svg}svg")
        # What the shell gets, unquoted as the specification of desktop entries says.
        command = entry["exec"].replace("\\\\", "\\")
        self.assertEqual(re.sub(r"\\(.)", r"\1", command),
                         'sh -c "pcednet annotate "$@" || read line" pcednet %F')


if __name__ == "__main__":
    unittest.main()
