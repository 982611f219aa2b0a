"""Files that commands write: never half of one, never over another, refused before the work."""
import os
import shutil
import signal
import stat
import subprocess
import unittest

import numpy as np

from support import PROGRAM, SOURCE, CliTest, cube, read_ply, run, write_ply


class Outputs(CliTest):
    def setUp(self):
        super().setUp()
        self.cloud = self.folder / "a.ply"
        write_ply(self.cloud, *cube(2000))

    def start(self, *arguments, **options):
        """A running pcednet that reports its progress, a line each."""
        return subprocess.Popen([PROGRAM, *map(str, arguments), "--progress", "json"],
                                stderr=subprocess.PIPE, text=True, **options)

    def end(self, running, expect):
        said = running.stderr.read()
        running.stderr.close()
        self.assertEqual(running.wait(60), expect, said)
        return said

    def halted(self, **options):
        """A conversion to out.ply that has begun to write, and waits for SIGCONT in its midst."""
        process = self.start("convert", self.cloud, "-o", self.folder / "out.ply", **options)
        while not any(".part" in name and f"-{process.pid}" in name for name in os.listdir(self.folder)):
            self.assertIsNone(process.poll(), "ended without writing")
        process.send_signal(signal.SIGSTOP)
        return process

    def write_large_cloud(self):
        """Of which a conversion writes long enough to be halted."""
        write_ply(self.cloud, np.random.default_rng(1).uniform(0.0, 1.0, (1_500_000, 3)))

    def test_describe_tells_what_it_wrote(self):
        out = self.folder / "a.npy"
        said = run("describe", self.cloud, "-o", out, "--s-min", 0.1, "--s-max", 0.4, "--scales", 4).stderr
        self.assertEqual(np.load(out).shape, (2000, 4, 6))
        self.assertTrue(said.endswith(f"a.ply: 2000 points, 4 scales from 0.1 to 0.4, 6 numbers at each\n"
                                      f"  -> {out}, {out.with_suffix('.json')}\n"), said)

    def test_one_of_three_runs_at_once_wins(self):
        self.write_large_cloud()
        out = self.folder / "out.ply"
        running = [self.halted() for _ in range(3)]  # all of them have begun to write
        for process in running:
            process.send_signal(signal.SIGCONT)
        said = [process.stderr.read() for process in running]
        for process in running:
            process.stderr.close()
        self.assertEqual(sorted(process.wait(60) for process in running), [0, 2, 2])
        self.assertEqual(sum("out.ply: exists already" in text for text in said), 2)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.ply", "out.ply"])
        self.assertEqual(len(read_ply(out)[0]), 1_500_000)

    def stop(self, *signals, expect=130, preexec_fn=None):
        """Sends signals to a conversion in its midst; returns the names of the files then."""
        self.write_large_cloud()
        running = self.halted(preexec_fn=preexec_fn)
        for number in signals:
            running.send_signal(number)
        self.assertTrue(any(".part" in name for name in os.listdir(self.folder)))
        running.send_signal(signal.SIGCONT)
        self.end(running, expect)
        return sorted(os.listdir(self.folder))

    def test_a_terminal_that_closes_leaves_no_part_of_a_file(self):
        self.assertEqual(self.stop(signal.SIGHUP), ["a.ply"])

    def test_two_signals_at_once_leave_no_part_of_a_file(self):
        self.assertEqual(self.stop(signal.SIGHUP, signal.SIGTERM), ["a.ply"])

    def test_the_sample_that_is_stopped_leaves_no_file(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            running = self.start("generate", "sample", self.folder / "sample.ply")
            self.assertIn("generate", running.stderr.readline())
            running.send_signal(number)
            self.assertIn("stopped by the user", self.end(running, 130))
            self.assertEqual(os.listdir(self.folder), ["a.ply"])

    def test_a_set_without_curves_has_no_folder_for_them(self):
        running = self.start("generate", "pieces", self.folder / "set")
        while not list(self.folder.glob("set/*.ply")):
            self.assertTrue(running.stderr.readline())
        running.send_signal(signal.SIGINT)
        self.end(running, 130)
        self.assertFalse((self.folder / "set/curves").exists())

    def test_nohup_goes_on_when_the_terminal_closes(self):
        ignore = lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)
        self.assertEqual(self.stop(signal.SIGHUP, expect=0, preexec_fn=ignore),
                         ["a.ply", "out.ply"])

    def test_a_missing_folder_is_found_before_the_work(self):
        # The inputs cannot be read: who reads them first fails with 3.
        broken = self.folder / "broken.ply"
        broken.write_text("ply\nnonsense\n")
        nowhere = self.folder / "nowhere"
        for arguments in (("classify", broken, "-o", nowhere / "x.ply"),
                          ("classify", broken, "--preview", nowhere / "x.png"),
                          ("convert", broken, "-o", nowhere / "x.ply"),
                          ("normals", broken, "-o", nowhere / "x.ply"),
                          ("describe", broken, "-o", nowhere / "x.npy"),
                          ("train", broken, "-o", nowhere / "x.safetensors"),
                          ("evaluate", broken, "--model", "scan", "--json", nowhere / "x.json"),
                          ("info", broken, "--json", nowhere / "x.json"),
                          ("generate", "sample", nowhere / "x.ply")):
            done = run(*arguments, expect=1)
            self.assertIn(f"there is no folder {nowhere}", done.stderr, arguments)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.ply", "broken.ply"])

    def test_existing_results_are_found_before_the_work(self):
        broken = self.folder / "broken.ply"
        broken.write_text("ply\nnonsense\n")
        for command, name in (("convert", "x.ply"), ("normals", "x.ply"), ("describe", "x.npy"),
                              ("train", "x.safetensors")):
            there = self.folder / name
            there.write_text("precious")
            done = run(command, broken, "-o", there, expect=2)
            self.assertIn(f"{there}: exists already; give --overwrite to replace it", done.stderr,
                          command)
            self.assertEqual(there.read_text(), "precious")

    def test_an_input_is_not_replaced_by_something_else(self):
        (self.folder / "soft.ply").symlink_to("a.ply")
        os.link(self.cloud, self.folder / "hard.ply")
        before = self.cloud.read_bytes()
        for output in (self.cloud, self.folder / "soft.ply", self.folder / "hard.ply"):
            for arguments in (("tiles", "plan", self.cloud, "-o", output),
                              ("train", self.folder, "-o", output),
                              ("info", self.cloud, "--json", output),
                              ("info", self.cloud, "--vpc", output),
                              ("evaluate", self.cloud, "--json", output),
                              ("convert", self.cloud, "-o", output, "--subsample", 0.1),
                              ("convert", self.cloud, "-o", output, "--spacing", 0.1)):
                said = run(*arguments, "--overwrite", expect=2).stderr
                self.assertIn(f"{output}: is the input", said)
        self.assertEqual(self.cloud.read_bytes(), before)
        shipped = SOURCE / "models/scan.safetensors"
        for name, arguments in (("m.json", ("tiles", "plan", self.cloud, "-o")),
                                ("m.ply", ("classify", self.cloud, "-o")),
                                ("m.png", ("classify", self.cloud, "-o", "x.ply", "--preview")),
                                ("m.dxf", ("lines", self.cloud, "--classify", "-o"))):
            model = self.folder / name
            shutil.copy(shipped, model)
            said = run(*arguments, model, "--model", model, "--overwrite", expect=2).stderr
            self.assertIn(f"{model}: is the input", said)
            self.assertEqual(model.read_bytes(), shipped.read_bytes())
        plan = self.folder / "p.json"
        plan.write_text("{}")
        run("tiles", "status", plan, "--json", plan, "--overwrite", expect=2)
        run("convert", self.cloud, "-o", self.cloud, "--overwrite")  # loses no point

    def test_an_output_of_no_format_is_found_before_the_work(self):
        broken = self.folder / "broken.ply"
        broken.write_text("ply\nnonsense\n")
        for name in ("x.foo", "-", "x.e57", "x.vpc", "x"):
            said = run("classify", broken, "-o", name, expect=2).stderr
            self.assertIn(f"{name}: points are written as .ply", said)

    def test_an_existing_cloud_of_a_set_is_found_before_the_others_are_made(self):
        few = ("--only", "roof_gable")
        run("generate", "lines", self.folder / "set", *few)
        *others, last = sorted(name for name in os.listdir(self.folder / "set") if name.endswith(".ply"))
        self.assertGreater(len(others), 0)
        (self.folder / "again").mkdir()
        (self.folder / "again" / last).write_text("precious")
        done = run("generate", "lines", self.folder / "again", *few, expect=2)
        self.assertIn(f"{last}: exists already", done.stderr)
        self.assertEqual(os.listdir(self.folder / "again"), [last])

    def test_files_and_folders_that_stand_in_for_each_other(self):
        file, folder = self.cloud, self.folder / "folder"
        folder.mkdir()
        (self.folder / "nothing.ply").symlink_to("gone")
        (self.folder / "device").symlink_to("/dev/full")
        for code, message, *arguments in (
                (2, f"{file}: is a file, not a folder", "classify", file, "--out-dir", file),
                (1, "Not a directory", "classify", file, "--out-dir", file / "x"),
                (2, f"{file}: is a file, not a folder", "generate", "default", file),
                (2, f"{file}: is a file, not a folder", "study", "methods", "--test",
                 f"a={file}", "-o", file),
                (2, f"{folder}: is a folder", "evaluate", file, "--model", "scan", "--json", folder),
                (1, f"{file} is not a folder", "convert", file, "-o", file / "x.ply"),
                (2, f"{folder}: is a folder; convert takes one cloud", "convert", folder, "-o", self.folder / "x.ply"),
                (2, "city.vpc: names other files; convert takes one cloud", "convert", "city.vpc", "-o", "x.laz"),
                (2, f"{folder}: is a folder; normals takes one cloud", "normals", folder, "-o", self.folder / "x.ply"),
                (2, f"{folder}: is a folder; describe takes one cloud", "describe", folder, "-o", self.folder / "x.npy"),
                (2, f"{folder}: is a folder; give its files one by one", "annotate", folder, "--no-browser"),
                (2, f"{folder}: is a folder; lines takes one cloud", "lines", folder, "-o", self.folder / "x.obj"),
                (2, "city.vpc: names other files; lines takes one cloud: give its files one by one, or make one of "
                    "them with pcednet tiles plan, run and join", "lines", "city.vpc", "-o", "x.obj"),
                (2, f"{folder}: is a folder", "annotate", file, "--no-browser", "--project",
                 folder),
                (1, "there is no folder", "annotate", file, "--no-browser", "--project",
                 self.folder / "none" / "x.json"),
                (3, f"{folder}: is a folder", "train", "--project", folder, "-o",
                 self.folder / "m.safetensors"),
                (3, "nothing.ply: no such file", "info", self.folder / "nothing.ply"),
                (2, "nothing.ply: exists already", "convert", file, "-o",
                 self.folder / "nothing.ply"),
                (2, "an argument is empty", "convert", file, "-o", ""),
                (2, "device: is a device", "info", file, "--json", self.folder / "device",
                 "--overwrite"),
                (2, "device: is a device", "evaluate", file, "--model", "scan", "--json",
                 self.folder / "device", "--overwrite")):
            done = run(*arguments, expect=code)
            self.assertIn(message, done.stderr)
            self.assertNotIn("filesystem error", done.stderr)
            for raw in ("std::", "basic_", "_M_"):  # the standard library's own words
                self.assertNotIn(raw, done.stderr)
        self.assertTrue(stat.S_ISCHR(os.stat(self.folder / "device").st_mode))
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["a.ply", "device", "folder", "nothing.ply"])

    def test_what_may_not_be_read_or_written(self):
        locked, secret = self.folder / "locked", self.folder / "secret.ply"
        locked.mkdir(mode=0)
        write_ply(secret, *cube(100)[:2])
        secret.chmod(0)
        self.folder.chmod(0o555)
        # Root may do everything, and becomes somebody else.
        somebody = (lambda: os.setuid(65534)) if os.getuid() == 0 else None
        for code, message, *arguments in (
                (3, "secret.ply: Permission denied", "info", secret),
                (3, "locked: cannot read the folder: Permission denied", "info", locked),
                (1, f"folder {self.folder}: Permission denied", "convert", self.cloud, "-o",
                 self.folder / "x.ply"),
                (1, "cannot create the folder: Permission denied", "classify", self.cloud,
                 "--out-dir", locked / "x"),
                (1, "Permission denied", "classify", self.cloud, "--out-dir", locked)):
            self.assertIn(message, run(*arguments, expect=code, preexec_fn=somebody).stderr)


if __name__ == "__main__":
    unittest.main()
