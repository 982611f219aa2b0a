"""pcednet tiles run: no point lost or doubled and nothing replaced, whatever happens on the way."""
import contextlib
import json
import os
import pathlib
import pty
import random
import re
import resource
import shutil
import signal
import subprocess
import unittest

import numpy as np

from support import PROGRAM, run, write_ply
from tiles_support import TilesTest, field


class TilesRun(TilesTest):
    def test_only_what_is_missing_or_damaged_is_run(self):
        plan, content = self.small()
        run("tiles", "run", plan, "--tile", "0", "--tile", "2-4")
        state = self.status(plan)
        self.assertEqual(state["done"], [0, 2, 3, 4])
        self.assertIn(f"  next: pcednet tiles run {plan}\n", run("tiles", "status", plan).stdout)
        said = run("tiles", "join", plan, "-o", self.folder / "j.ply", expect=4).stderr
        self.assertIn("missing or damaged: 1, 5 to ", said)
        self.assertFalse((self.folder / "j.ply").exists())
        run("tiles", "run", plan)
        state = self.status(plan)
        self.assertEqual(state["missing"] + state["damaged"], [])
        self.assertEqual(state["done_points"], content["points"])
        files = [self.folder / t["output"] for t in content["tiles"]]
        before = [f.read_bytes() for f in files]
        # Times say nothing: neither old nor future ones make a tile to be run.
        for f, when in zip(files, (0, 1, 2**31, 2**33)):
            os.utime(f, (when, when))
            os.utime(str(f) + ".json", (2**33 - when, 2**33 - when))
        said = run("tiles", "run", plan).stderr
        self.assertIn("0 tiles run", said)
        # Of four damages the last is seen by digest only.
        files[0].unlink()
        files[1].write_bytes(before[1][:-1])
        pathlib.Path(str(files[2]) + ".json").unlink()
        files[3].write_bytes(before[3][:-1] + bytes([before[3][-1] ^ 1]))
        state = self.status(plan)
        self.assertEqual((state["missing"], state["damaged"]), ([0, 2], [1]))
        self.assertEqual(self.status(plan, "--verify")["damaged"], [1, 3])
        said = run("tiles", "status", plan, "--verify").stdout
        self.assertRegex(said, r"missing +2 tiles, +\d+ points: 0, 2\n")
        self.assertEqual(state["in_the_way"], [2])
        self.assertIn("  of the missing, in the place of 2: files without the record of a tile\n", said)
        again = f"pcednet tiles run {plan} --tile 2 --overwrite"
        self.assertIn(f"  next: pcednet tiles run {plan} --tile 1-3 --overwrite\n"
                      f"  then: pcednet tiles run {plan}, for the others\n", said)
        self.assertIn(f"  next: {again}\n", run("tiles", "status", plan).stdout)
        # The file without a record is, for all that is known, not a tile: all others are run.
        said = run("tiles", "run", plan, expect=2).stderr
        self.assertIn(f"{files[2]}: exists, but has no record of being a tile: not replaced; to replace it: {again}", said)
        self.assertEqual(self.status(plan)["missing"], [2])
        said = run("tiles", "run", plan, "--tile", 2, expect=2).stderr
        self.assertNotIn("tiles run,", said)
        run("tiles", "run", plan, "--tile", 2, "--overwrite")
        run("tiles", "run", plan)
        run("tiles", "run", plan, "--tile", 3, "--overwrite")
        self.assertEqual([f.read_bytes() for f in files], before)
        self.assertEqual(self.status(plan, "--verify")["done"], list(range(len(files))))

    def test_tiles_and_copies_replace_nothing_else(self):
        p, n = field(3, 300)
        os.mkdir(self.folder / "in")
        for name in ("0.ply", "1.ply", "unsorted_0.ply"):
            write_ply(self.folder / "in" / name, p[::3], n[::3])
        before = (self.folder / "in/0.ply").read_bytes()
        plan, copies = self.folder / "p.json", self.folder / "copies"
        for options in (("--out-dir", self.folder / "in"), ("--sort", self.folder / "in")):
            said = run("tiles", "plan", self.folder / "in", "-o", plan, "--tile", 1.4, *options,
                       "--overwrite", expect=2).stderr
            self.assertIn("0.ply: is the input", said)
        self.assertEqual(len(list((self.folder / "in").iterdir())), 3)
        copies.mkdir()
        (copies / "1.ply").write_text("precious")
        sort = ("tiles", "plan", self.folder / "in/0.ply", "-o", plan, "--tile", 1.4, "--sort", copies)
        self.assertIn("1.ply: exists already", run(*sort, expect=2).stderr)
        self.assertEqual([f.name for f in copies.iterdir()], ["1.ply"])
        run(*sort, "--overwrite")
        tile = self.folder / "p_tiles/2.ply"
        tile.parent.mkdir()
        for name in ("2.ply", "2.ply.json"):
            there = tile.parent / name
            there.write_text("precious")
            for jobs in (1, 2):
                said = run("tiles", "run", plan, "--jobs", jobs, expect=2).stderr
                self.assertIn(f"{there}: exists, but has no record", said)
                self.assertEqual(self.status(plan)["missing"], [2])
            self.assertEqual(there.read_text(), "precious")
            there.unlink()
        run("tiles", "run", plan)
        self.assertEqual((self.folder / "in/0.ply").read_bytes(), before)

    def test_a_point_far_from_all_others_has_its_own_tile(self):
        p, n = field(3, 300)
        write_ply(self.folder / "near.ply", p, n)
        write_ply(self.folder / "far.ply", np.vstack([p, (1e5, -1e5, 0)]), np.vstack([n, (0, 0, 1)]))
        tiles = []
        for name in ("near", "far"):
            plan = self.folder / f"{name}.json"
            run("tiles", "plan", self.folder / f"{name}.ply", "-o", plan, "--tile", 1.4)
            run("tiles", "run", plan)
            tiles.append([(t["row"], t["column"], t["points"])
                          for t in json.loads(plan.read_text())["tiles"]])
        self.assertEqual(len(tiles[1]), len(tiles[0]) + 1)
        self.assertEqual([t for t in tiles[1] if t[2] > 1], tiles[0])

    def test_an_input_counts_once(self):
        p, n = field(3, 300)
        write_ply(self.folder / "a.ply", p, n)
        (self.folder / "b.ply").symlink_to("a.ply")
        once = self.folder / "once.json"
        run("tiles", "plan", self.folder / "a.ply", self.folder / "./a.ply", "-o", once)
        self.assertEqual(json.loads(once.read_text())["points"], len(p))
        for twice in ("b.ply", "."):
            said = run("tiles", "plan", self.folder / "a.ply", self.folder / twice, "-o",
                       self.folder / "p.json", expect=2).stderr
            self.assertIn("the same file as the input", said)

    def test_killed_at_random_nothing_is_lost(self):
        plan, content = self.small(tile=1.0)
        whole = self.folder / "small.ply"
        chance = random.Random(17)
        for attempt in range(200):
            found = self.status(plan)
            if not found["missing"] and not found["damaged"]:  # killed between a tile and its record
                break
            # Each attempt lives a little longer, so that one comes to its end at last.
            process = subprocess.Popen([PROGRAM, "tiles", "run", str(plan), "--jobs",
                                        str(1 + attempt % 2)], stderr=subprocess.DEVNULL,
                                       start_new_session=True)
            try:
                process.wait(chance.uniform(0.02, 0.15 + 0.02 * attempt))
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        self.assertGreater(attempt, 0)
        rows = self.check_whole(plan, whole)
        tiles = [self.folder / t["output"] for t in content["tiles"]]
        again = [t.read_bytes() for t in tiles]
        run("tiles", "run", plan, "--overwrite")
        self.assertEqual([t.read_bytes() for t in tiles], again)
        self.assertEqual(len(rows), content["points"])

    def on_terminal(self, *arguments):
        """What a run writes on a terminal."""
        ours, its = pty.openpty()
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], stderr=its)
        os.close(its)
        said = b""
        with contextlib.suppress(OSError):  # EIO at the end
            while some := os.read(ours, 65536):
                said += some
        os.close(ours)
        self.assertEqual(process.wait(), 0)
        return said.decode()

    def test_a_terminal_shows_tiles_on_lines_of_their_own(self):
        plan, _ = self.small()
        for jobs in 1, 2:
            said = self.on_terminal("tiles", "run", plan, "--overwrite", "--jobs", jobs)
            self.assertEqual(len(re.findall(r"(?:^|\n)tile \d: \d+ points, ", said)), 9, said)
            self.assertRegex(said, r"\rtiles +\[#+-+\] +56 %")

    def test_the_time_that_is_left_is_told(self):
        write_ply(self.folder / "a.ply", *field(3, 4000))
        plan, _ = self.make_plan(self.folder / "a.ply", "--exact", tile=0.5)
        said = run("tiles", "run", plan, "--threads", 1, "--progress", "plain").stderr
        self.assertRegex(said, r"\ntiles \d\d %, \d+ s left\n")

    def test_a_stop_is_told_once(self):
        write_ply(self.folder / "a.ply", *field())
        plan, _ = self.make_plan(self.folder / "a.ply")
        process = subprocess.Popen([PROGRAM, "tiles", "run", str(plan), "--jobs", "2", "--progress", "json"],
                                   stderr=subprocess.PIPE, text=True, start_new_session=True)
        process.stderr.readline()
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        said = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 130)
        self.assertEqual(said.count("stopped by the user"), 1, said)

    def test_tiles_that_failed_are_listed_in_order(self):
        plan, _ = self.small(tile=1.0)
        tiles = json.loads(plan.read_text())
        cloud = self.folder / "small.ply"
        changed = bytearray(cloud.read_bytes())
        changed[-20] ^= 1
        cloud.write_bytes(changed)
        said = run("tiles", "run", plan, "--jobs", 3, expect=3).stderr
        self.assertIn(f"tiles failed, for the reasons above: 0 to {len(tiles['tiles']) - 1}\n", said)

    def test_tiles_that_failed_are_told_where_the_parent_ignores_their_end(self):
        plan, tiles = self.small(tile=1.0)
        (self.folder / "small.ply").write_bytes((self.folder / "small.ply").read_bytes()[:-20] + bytes(20))
        said = run("tiles", "run", plan, "--jobs", 3, expect=3,
                   preexec_fn=lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN)).stderr
        self.assertIn(f"tiles failed, for the reasons above: 0 to {len(tiles['tiles']) - 1}\n", said)

    def test_a_result_replaces_no_file_of_the_plan(self):
        plan, content = self.small()
        run("tiles", "run", plan)
        tile = self.folder / content["tiles"][0]["output"]
        model = self.folder / content["model"]["path"]
        for needed in (self.folder / "small.ply", tile, f"{tile}.json", model, plan):
            before = pathlib.Path(needed).read_bytes()
            for command in (("status", plan, "--json"), ("join", plan, "-o"), ("join", plan, "--vpc")):
                done = run("tiles", *command, needed, "--overwrite", expect=2)
                self.assertNotIn("No such file", done.stderr)
            self.assertEqual(pathlib.Path(needed).read_bytes(), before)
        run("tiles", "status", plan)

    def test_status_fails_before_it_reads_for_a_result_that_is_there(self):
        plan, content = self.small()
        there = self.folder / "there.json"
        there.touch()
        done = run("tiles", "status", plan, "--verify", "--json", there, expect=2)
        self.assertIn("there.json: exists already", done.stderr)
        self.assertEqual(done.stdout, "")

    def test_an_input_that_changed_is_found_where_all_is_done(self):
        plan, content = self.small()
        run("tiles", "run", plan)
        cloud = self.folder / "small.ply"
        changed = bytearray(cloud.read_bytes())
        changed[-20] ^= 1
        run("tiles", "status", plan, "--verify")
        cloud.write_bytes(changed)
        run("tiles", "status", plan)
        done = run("tiles", "status", plan, "--verify", expect=3)
        self.assertIn(f"{cloud}: has changed since the plan", done.stderr)
        self.assertRegex(done.stdout, rf"done +{len(content['tiles'])} tiles")

    def test_a_shipped_model_is_found_by_its_name(self):
        plan, content = self.small()
        content["model"]["path"] = "/elsewhere/general.safetensors"
        plan.write_text(json.dumps(content))
        run("tiles", "run", plan, "--tile", 0)
        content["model"]["name"] = "mine"
        plan.write_text(json.dumps(content))
        said = run("tiles", "run", plan, "--tile", 1, expect=3).stderr
        self.assertIn("/elsewhere/general.safetensors: No such file", said)
        content["model"]["name"] = "worn"
        plan.write_text(json.dumps(content))
        self.assertIn("not the model", run("tiles", "run", plan, "--tile", 1, expect=5).stderr)

    def test_two_runs_at_once_do_no_harm(self):
        plan, content = self.small()
        runs = [subprocess.Popen([PROGRAM, "tiles", "run", str(plan)], stderr=subprocess.PIPE)
                for _ in range(3)]
        for process in runs:
            said = process.communicate()[1]
            self.assertEqual(process.returncode, 0, said)
        self.assertEqual(self.status(plan, "--verify")["done"], list(range(len(content["tiles"]))))
        self.check_whole(plan, self.folder / "small.ply")
        self.assertEqual([p.name for p in (self.folder / "p_tiles").iterdir() if "part" in p.name], [])

    def test_runs_side_by_side_share_the_tiles(self):
        plan, content = self.small(tile=1.0)
        tiles = len(content["tiles"])
        self.assertGreater(tiles, 6)
        for jobs in ("1", "2"):
            shutil.rmtree(self.folder / "p_tiles", ignore_errors=True)
            runs = [subprocess.Popen([PROGRAM, "tiles", "run", str(plan), "--jobs", jobs], stderr=subprocess.PIPE,
                                     text=True) for _ in range(2)]
            said = [process.communicate(timeout=60)[1] for process in runs]
            ran = [len(re.findall(r"^tile \d+: ", text, re.M)) for text in said]
            self.assertEqual([process.returncode for process in runs], [0, 0], said)
            # At the end each may also run, with all of its jobs, what the other is at.
            self.assertLessEqual(sum(ran), tiles + 2 * int(jobs) - 1, said)
            self.check_whole(plan, self.folder / "small.ply")

    def test_a_mark_that_a_killed_run_left_delays_its_tile_alone(self):
        plan, content = self.small(tile=1.0)
        last = len(content["tiles"]) - 1
        for jobs in (1, 2):
            shutil.rmtree(self.folder / "p_tiles", ignore_errors=True)
            (self.folder / "p_tiles").mkdir()
            (self.folder / (content["tiles"][0]["output"] + ".part-run")).touch()
            said = run("tiles", "run", plan, "--jobs", jobs).stderr
            if jobs == 1:
                self.assertEqual(re.findall(r"^tile (\d+): ", said, re.M), [*map(str, range(1, last + 1)), "0"])
            self.check_whole(plan, self.folder / "small.ply")
            self.assertEqual([p.name for p in (self.folder / "p_tiles").iterdir() if "part" in p.name], [])

    def test_tiles_of_another_run_are_counted_as_its_own(self):
        plan, content = self.small(tile=1.0)
        tiles = len(content["tiles"])
        for jobs in ("1", "2"):
            shutil.rmtree(self.folder / "p_tiles", ignore_errors=True)
            first = subprocess.Popen([PROGRAM, "tiles", "run", str(plan), "--jobs", jobs, "--progress", "json"],
                                     stderr=subprocess.PIPE, text=True)
            self.assertTrue(first.stderr.readline())  # it has seen that no tile is done
            first.send_signal(signal.SIGSTOP)
            run("tiles", "run", plan)
            first.send_signal(signal.SIGCONT)
            said = first.communicate(timeout=60)[1]
            self.assertEqual(first.returncode, 0, said)
            ran = len(re.findall(r"^tile \d+: ", said, re.M))
            self.assertLess(ran, tiles)
            self.assertRegex(said, rf"(?m)^{ran} tiles? run, 0 were done, {tiles - ran} were done by another run meanwhile$")

    def test_an_interrupt_stops_cleanly(self):
        write_ply(self.folder / "a.ply", *field())
        plan, _ = self.make_plan(self.folder / "a.ply")
        for jobs in ("1", "2"):
            process = subprocess.Popen([PROGRAM, "tiles", "run", str(plan), "--jobs", jobs,
                                        "--overwrite", "--progress", "json"],
                                       stderr=subprocess.PIPE)
            self.assertTrue(process.stderr.readline())  # the first tile is in work
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130)
            self.assertEqual([p.name for p in (self.folder / "p_tiles").iterdir()
                              if "part" in p.name], [])
            self.assertEqual(self.status(plan, "--verify")["damaged"], [])

    def test_a_full_disk_is_said_and_harms_nothing(self):
        plan, _ = self.small()
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        said = run("tiles", "run", plan, expect=1, preexec_fn=limit).stderr
        self.assertIn("File too large", said)
        self.assertEqual(list((self.folder / "p_tiles").iterdir()), [])
        run("tiles", "run", plan)
        self.check_whole(plan, self.folder / "small.ply")
        run("tiles", "join", plan, "-o", self.folder / "j.ply", expect=1, preexec_fn=limit)
        self.assertFalse((self.folder / "j.ply").exists())

    def test_inputs_and_models_that_changed_are_refused(self):
        plan, _ = self.small()
        cloud = self.folder / "small.ply"
        before = cloud.read_bytes()
        changed = bytearray(before)
        changed[-20] ^= 1  # as long as before
        for content, code, words in ((bytes(changed), 3, "has changed since the plan"),
                                     (before + b" ", 3, "has changed since the plan"),
                                     (before[:-4], 3, "has changed since the plan"),
                                     (None, 3, "small.ply")):
            cloud.unlink(missing_ok=True)
            if content is not None:
                cloud.write_bytes(content)
            self.assertIn(words, run("tiles", "run", plan, expect=code).stderr)
        said = run("tiles", "run", plan, "--jobs", 2, expect=3).stderr
        self.assertEqual(said.count("small.ply: No such file"), 1)
        self.assertEqual(self.status(plan)["done"], [])
        cloud.write_bytes(before)
        model = self.folder / "m.safetensors"
        shutil.copy(pathlib.Path(os.environ["PCEDNET_SOURCE_DIR"]) / "models/general.safetensors", model)
        plan, _ = self.make_plan(cloud, "--model", model, tile=1.0)
        run("tiles", "run", plan, "--tile", 0)
        shutil.copy(pathlib.Path(os.environ["PCEDNET_SOURCE_DIR"]) / "models/worn.safetensors", model)
        self.assertIn("not the model", run("tiles", "run", plan, expect=5).stderr)
        self.assertIn("not the model", run("tiles", "run", plan, "--jobs", 2, expect=5).stderr)

    def test_a_plan_in_the_place_of_another_tells_of_its_tiles(self):
        plan, _ = self.small()
        run("tiles", "run", plan, "--tile", 1, "--tile", 2)
        again = ("tiles", "plan", self.folder / "small.ply", "-o", plan, "--overwrite", "--tile")
        self.assertNotIn("another plan", run(*again, 1.4).stderr)  # the same
        said = run(*again, 2).stderr
        self.assertIn(f"warning: {self.folder}/p_tiles: tiles of another plan are here, such as 1.ply", said)
        self.assertEqual(self.status(plan)["done"], [])

    def test_names_of_tiles_and_plans_that_mean_nothing(self):
        cloud = self.folder / "small.ply"
        self.small()
        before = sorted(os.listdir(self.folder))
        for name, place in (("{TILE}.ply", "{TILE}"), ("{id}.ply", "{id}"), ("{ID}_{XLEFT.ply", "{XLEFT.ply")):
            said = run("tiles", "plan", cloud, "-o", self.folder / "q.json", "--output", name, "--progress", "plain",
                       expect=2).stderr
            self.assertIn(f"{name}: names of tiles have no {place}; there are {{ID}}, {{COLUMN}}, {{ROW}}, {{XLEFT}}, "
                          "{XRIGHT}, {YBOTTOM}, {YTOP}", said)
            self.assertNotIn("index", said)
        said = run("tiles", "plan", cloud, "-o", "-", cwd=self.folder, expect=2).stderr
        self.assertIn("-o -: a plan is a file", said)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_names_of_files_that_are_not_utf8(self):
        self.small()
        odd = os.fsencode(str(self.folder)) + b"/lat\xfcin.ply"
        os.rename(self.folder / "small.ply", odd)
        for words in ((odd, "-o", self.folder / "q.json"),
                      (self.folder, "-o", self.folder / "q.json"),
                      (odd, "-o", self.folder / "q.json", "--out-dir", odd + b".d")):
            done = subprocess.run([PROGRAM, "tiles", "plan", *words, "--progress", "plain"], capture_output=True)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(b"lat\xfcin.ply: the name is not in UTF-8", done.stderr)
            self.assertNotIn(b"index", done.stderr)

    def test_a_plan_behind_a_link_is_where_it_is(self):
        plan, _ = self.small()
        (self.folder / "links").mkdir()
        link = self.folder / "links/l.json"
        link.symlink_to(plan)
        run("tiles", "run", link, "--tile", 0)
        self.assertEqual(self.status(plan)["done"], [0])

    def test_next_commands_can_be_pasted(self):
        self.small()
        plan = self.folder / "two words' ü.json"
        said = run("tiles", "plan", self.folder / "small.ply", "-o", plan, "--tile", 1.4).stderr
        quoted = "'" + str(plan).replace("'", "'\\''") + "'"
        self.assertIn(f"next: pcednet tiles run {quoted}\n", said)
        self.assertIn(f"next: pcednet tiles run {quoted}\n", run("tiles", "status", plan).stdout)
        line = re.search("next: pcednet (.*)", said)[1]
        subprocess.run(["sh", "-c", f'"$PCEDNET" {line}'], check=True, stderr=subprocess.DEVNULL)
        self.assertIn("next: pcednet tiles join '", run("tiles", "status", plan).stdout)

    def test_little_memory_is_not_taken_for_disorder(self):
        p = np.random.default_rng(4).uniform(0, 100, (1_200_000, 3)).astype(np.float32)
        write_ply(self.folder / "a.ply", p)
        said = run("tiles", "plan", self.folder / "a.ply", "-o", self.folder / "p.json", "--max-memory", "10K",
                   expect=2).stderr
        self.assertIn("0.0102 MB of memory are less than one tile needs: 115 MB and more", said)

    def test_usage_errors(self):
        plan, content = self.small()
        run("tiles", "plan", self.folder / "none.laz", "-o", self.folder / "q.json", expect=3)
        run("tiles", "plan", self.folder / "small.ply", "-o", plan, expect=2)  # exists
        self.assertIn("-o is required",
                      run("tiles", "plan", self.folder / "small.ply", expect=2).stderr)
        for bad in ("99", "x", "2-", "3-1", "-1"):
            run("tiles", "run", plan, "--tile=" + bad, expect=2)
        for bad in ("lots", "2GX", "2BB", "2Bi", "iB", "2 G"):
            run("tiles", "run", plan, "--max-memory", bad, expect=2)
        for fine in ("2G", "2gb", "2GiB", "2000000000B", "2000000000"):
            run("tiles", "run", plan, "--tile", 0, "--overwrite", "--max-memory", fine)
        said = run("tiles", "join", plan, "-o", self.folder / "j.pcd", expect=2).stderr  # before what is missing
        self.assertIn("j.pcd: tiles are joined as .laz, .las, .ply or text", said)
        self.assertIn("smaller", run("tiles", "run", plan, "--max-memory", "1M", expect=2).stderr)
        self.assertIn("convert", run("tiles", "plan", self.text_cloud(), "-o",
                                     self.folder / "q.json", expect=2).stderr)
        self.assertIn("tiles of length 1e-07: too short",
                      run("tiles", "plan", self.folder / "small.ply", "-o",
                          self.folder / "q.json", "--tile", 1e-7, expect=2).stderr)
        (self.folder / "no.json").write_text("{}")
        for command in ("run", "status"):
            run("tiles", command, self.folder / "no.json", expect=3)
        said = run("tiles", "run", self.folder / "small.ply", expect=3).stderr
        self.assertIn("not a plan of tiles: byte 1 is not JSON", said)
        self.assertIn("Examples", run("tiles", "run", "--help").stdout)

    def text_cloud(self):
        path = self.folder / "a.xyz"
        path.write_text("0 0 0\n1 1 1\n")
        return path


if __name__ == "__main__":
    unittest.main()
