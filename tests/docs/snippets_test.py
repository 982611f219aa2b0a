"""Every command of the tutorial and the how-to pages runs, one after the other as a reader would type
them, those of README.md too; Python runs; quoted code is what the files hold."""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
SOURCE = pathlib.Path(os.environ["PCEDNET_SOURCE_DIR"])
PROGRAM = pathlib.Path(os.environ["PCEDNET"])
PAGES = ["tutorial", "own-definition", "big-clouds", "which-scales", "confidences"]


def blocks(page, *languages):
    """(language, code) of the fenced blocks of a page."""
    text = (SOURCE / page).read_text("utf-8")
    found = re.findall(r"^```(\w+)\n(.*?)^```$", text, re.M | re.S)
    return [(language, code) for language, code in found if language in languages]


def folder_of_programs(folder):
    """A folder for PATH: pcednet, but `annotate` is a user who paints and saves, and the sample has a
    sixth of its points, so that the pages take seconds."""
    folder.mkdir()
    script = folder / "pcednet"
    script.write_text(f"""#!/bin/sh
case "$1 $2" in
  annotate*) exec {sys.executable} {HERE}/painter.py "$@" ;;
  "generate sample")
    {PROGRAM} generate sample "$3.whole.ply" --overwrite &&
      {PROGRAM} convert "$3.whole.ply" -o "$3" --subsample 0.167 --overwrite && rm "$3.whole.ply"
    exit ;;
esac
exec {PROGRAM} "$@"
""")
    script.chmod(0o755)


def run(code, language, folder):
    """Runs a block in the folder, which gets a folder of programs with the first one."""
    shell = ["bash", "-euo", "pipefail", "-c", code]
    programs = folder / ".programs"
    if not programs.exists():
        folder_of_programs(programs)
    return subprocess.run(shell if language == "sh" else [sys.executable, "-c", code], cwd=folder,
                          env={**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"},
                          capture_output=True, text=True, timeout=600)


def run_page(page):
    """What the commands of the page print, or how they fail."""
    with tempfile.TemporaryDirectory() as name:
        said = ""
        for language, code in blocks(f"docs/{page}.md", "sh", "python"):
            done = run(code, language, pathlib.Path(name))
            said += done.stdout + done.stderr
            if done.returncode != 0:
                raise AssertionError(f"docs/{page}.md: exit {done.returncode}:\n{code}\n{said}")
        files = {path.name for path in pathlib.Path(name).iterdir()}
    return said, files


class Snippets(unittest.TestCase):
    def test_the_commands_of_the_pages_run(self):
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            done = dict(zip(PAGES, pool.map(run_page, PAGES)))
        said, files = done["tutorial"]
        self.assertIn("no normals", said)
        self.assertRegex(said, r"scan_edges\.ply: \d+ curves")
        self.assertLessEqual({"edges.dxf", "edges.gpkg", "edges.obj", "edges.geojson", "edges.png",
                              "scan.png", "clean.dxf", "eaves.dxf"}, files)
        self.assertRegex(done["confidences"][0], r"\n[1-9]\d* of 2[34]\d{3} points are edges")
        self.assertIn("calibration", done["confidences"][0].lower())
        self.assertLessEqual({"scan.safetensors", "again.safetensors", "scan_annotated.ply",
                              "scan_annotation.json"}, done["own-definition"][1])
        self.assertIn("city_edges.ply", done["big-clouds"][1])

    def test_the_plan_of_the_page_on_big_clouds_fits_its_memory(self):
        plan = re.search(r"^pcednet (tiles plan .*)$", (SOURCE / "docs/big-clouds.md").read_text(), re.M)[1]
        with tempfile.TemporaryDirectory() as name:
            said = run(f"{PROGRAM} generate sample city.ply; {PROGRAM} {plan}", "sh", pathlib.Path(name)).stderr
        self.assertRegex(said, r"in \d+ tiles of length")
        self.assertNotIn("--max-memory", said)

    def test_the_page_on_scales_quotes_what_the_program_says(self):
        with tempfile.TemporaryDirectory() as name:
            said = run(f"{PROGRAM} generate sample scan.ply; {PROGRAM} classify scan.ply", "sh",
                       pathlib.Path(name)).stderr
        scales = re.search(r"scales: \S+ to \S+", said).group()
        self.assertIn(f"`{scales}`", (SOURCE / "docs/which-scales.md").read_text())

    def test_the_commands_of_the_readme_run(self):
        text = (SOURCE / "README.md").read_text("utf-8")
        commands = re.findall(r"^    (?:build/release/bin/)?(pcednet .*)$", text, re.M)
        self.assertGreaterEqual(len(commands), 3)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            run("pcednet generate sample scan.ply", "sh", folder)
            for command in commands:
                done = run(command, "sh", folder)
                self.assertEqual(done.returncode, 0, f"{command}\n{done.stderr}")
            self.assertTrue((folder / "edges.dxf").exists())

    def test_every_command_in_the_pages_has_the_options_that_it_is_given(self):
        """All pages: what stands after `pcednet COMMAND` is known to its help."""
        helps = {}
        pages = [*SOURCE.glob("docs/*.md"), SOURCE / "README.md"]
        checked = 0
        for page in pages:
            text = re.sub(r"\\\n\s*", " ", page.read_text("utf-8"))
            for command, rest in re.findall(r"\bpcednet ((?:tiles |generate )?[a-z]+)\b([^`\n|#;&]*)",
                                            text):
                if command not in helps:
                    done = subprocess.run([PROGRAM, *command.split(), "--help"], text=True,
                                          capture_output=True)
                    helps[command] = done.stdout if done.returncode == 0 else ""
                for option in re.findall(r"(?<=\s)--[a-z][a-z0-9-]*", rest):
                    checked += 1
                    self.assertRegex(helps[command], rf"{option}\b(?!-)",
                                     f"{page.name}: pcednet {command}{rest}")
        self.assertGreater(checked, 100)

    def test_the_code_beside_the_equations_is_that_of_the_files(self):
        text = (SOURCE / "docs/equations.md").read_text("utf-8")
        link, quoted = None, 0
        for part in re.finditer(r"\]\(\.\./([^)]*\.(?:cpp|h))\)|^```cpp\n(.*?)^```$", text,
                                re.M | re.S):
            if part[1]:
                link = part[1]
                continue
            quoted += 1
            self.assertIn(part[2], (SOURCE / link).read_text("utf-8"), link)
        self.assertGreater(quoted, 12)

    def test_every_page_of_the_folder_is_in_its_table(self):
        table = (SOURCE / "docs/README.md").read_text("utf-8")
        for page in SOURCE.glob("docs/*.md"):
            if page.name != "README.md":
                self.assertIn(f"]({page.name})", table)


if __name__ == "__main__":
    unittest.main()
