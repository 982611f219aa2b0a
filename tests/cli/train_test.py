"""pcednet train: from labelled files to a model file, and what can go wrong on the way."""
import json
import os
import re
import resource
import signal
import struct
import subprocess
import unittest

import numpy as np

from support import PROGRAM, CliTest, cube, read_ply, rough_ground, run, write_own, write_ply


def tensors(path):
    """The header of a safetensors file, and its tensors as numpy arrays."""
    data = path.read_bytes()
    size = struct.unpack("<Q", data[:8])[0]
    header = json.loads(data[8:8 + size])
    metadata = header.pop("__metadata__")
    arrays = {name: np.frombuffer(data[8 + size:][slice(*entry["data_offsets"])], "<f4")
              .reshape(entry["shape"]) for name, entry in header.items()}
    return metadata, arrays


class Train(CliTest):
    def train(self, name, *extra, points=2500, expect=0):
        source = self.folder / "clouds"
        source.mkdir(exist_ok=True)
        write_ply(source / "a.ply", *cube(points, seed=1))
        write_ply(source / "b.ply", *cube(points, seed=2, noise=0.003))
        run("train", source, "-o", self.folder / name, *extra, expect=expect)
        return self.folder / name

    def test_makes_a_model_that_finds_edges(self):
        model = self.train("m.safetensors", "--epochs", 15)
        p, n, label = cube(seed=9)
        write_ply(self.folder / "c.ply", p, n)
        run("classify", self.folder / "c.ply", "--model", model)
        found = read_ply(self.folder / "c_edges.ply")[0]["label"]
        self.assertGreater(np.mean((found > 0) == (label > 0)), 0.93)

    def test_writes_the_same_bytes_for_the_same_seed(self):
        one = self.train("one.safetensors", "--epochs", 3, "--threads", 1).read_bytes()
        two = self.train("two.safetensors", "--epochs", 3, "--threads", 2).read_bytes()
        # The name of the model is the file's stem, of the same length here.
        self.assertEqual(one.replace(b'"one"', b'"two"'), two)
        other = self.train("six.safetensors", "--epochs", 3, "--seed", 6).read_bytes()
        self.assertNotEqual(other.replace(b'"six"', b'"two"'), two)

    def test_takes_the_scales_that_are_given_and_does_not_store_them(self):
        own, own_arrays = tensors(self.train("own.safetensors", "--epochs", 1))
        given, arrays = tensors(self.train("one.safetensors", "--epochs", 1, "--s-max", 0.5))
        self.assertEqual(own.keys(), given.keys())
        self.assertTrue(any(np.any(arrays[name] != own_arrays[name]) for name in arrays))
        (self.folder / "p.json").write_text("{}")

    def test_refuses_options_that_have_no_effect_on_a_project(self):
        (self.folder / "p.json").write_text("{}")
        for option in (["--s-max", 0.5], ["--seed", 2], ["--context"], ["--no-normals"], ["--keep-orientation"],
                       ["--epochs", 3], ["--only", "exact"]):
            said = run("train", "--project", self.folder / "p.json", "-o", self.folder / "p.safetensors",
                       *option, expect=2).stderr
            self.assertIn(f"{option[0]} has no effect on a --project", said)

    def test_says_in_the_file_what_the_model_is(self):
        metadata, arrays = tensors(self.train("m.safetensors", "--epochs", 2, "--classes", 2))
        self.assertEqual(metadata["classes"], "0 2")
        self.assertEqual(metadata["descriptor_features"], "tau kappa k1 dtau dkappa phi")
        self.assertEqual(arrays["tree.0.weight"].shape, (8, 6, 12))
        weights = sum(a.size for name, a in arrays.items() if not name.startswith("standard"))
        self.assertEqual(weights, 1606)

    def test_trains_a_second_network_on_the_context(self):
        model = self.train("m.safetensors", "--context", "--epochs", 15, "--classes", 2)
        metadata, arrays = tensors(model)
        self.assertEqual(metadata["format"], "pcednet-edge-model-2")
        self.assertEqual(arrays["context.tree.0.weight"].shape, (2, 8, 16))
        p, n, _ = cube(seed=9)
        write_ply(self.folder / "c.ply", p, n)
        found = {}
        for name, extra in (("with", []), ("without", ["--no-context"])):
            out = self.folder / (name + ".ply")
            run("classify", self.folder / "c.ply", "-o", out, "--model", model, *extra)
            found[name] = read_ply(out)[0]["scalar_p_sharp"]
        changed = found["with"] != found["without"]
        self.assertTrue(changed.any())
        # What is sure to be no edge stays as it is.
        self.assertTrue((found["without"][changed] >= 0.01).all())

    def test_joins_the_networks_of_another_model_for_clouds_of_a_kind(self):
        few = self.train("few.safetensors", "--epochs", 2, "--seed", 5)
        joined = ["--epochs", 2, "--expert", few]
        model = self.train("m.safetensors", *joined, "below=5000")
        self.assertEqual(tensors(model)[0]["format"], "pcednet-edge-model-4")
        p, n, _ = cube(seed=9)
        write_ply(self.folder / "c.ply", p, n)
        self.assertLess(len(p), 5000)
        out = run("classify", self.folder / "c.ply", "--model", model).stderr
        self.assertIn("for clouds of this kind: fewer than 5000 distinct points\n", out)
        run("classify", self.folder / "c.ply", "-o", self.folder / "few.ply", "--model", few)
        found, wanted = (read_ply(self.folder / name)[0] for name in ("c_edges.ply", "few.ply"))
        self.assertTrue((found["scalar_p_sharp"] == wanted["scalar_p_sharp"]).all())
        alone = self.train("alone.safetensors", "--epochs", 2)
        model = self.train("m2.safetensors", *joined, f"below={len(p)}")
        for name, its in (("joined", model), ("alone", alone)):
            run("classify", self.folder / "c.ply", "-o", self.folder / (name + ".ply"), "--model", its)
        found, wanted = (read_ply(self.folder / (name + ".ply"))[0] for name in ("joined", "alone"))
        self.assertTrue((found["scalar_p_sharp"] == wanted["scalar_p_sharp"]).all())

    def pieces_model(self):
        """A model that tells cubes from squares of rough ground."""
        clouds = self.folder / "pieces"
        clouds.mkdir()
        whole, piece = cube(1200, seed=3)[0], rough_ground(1200, seed=3)
        for id, points in enumerate((whole, piece)):
            write_own(clouds / f"{id}.ply", points, None, np.full(len(points), id), ("whole", "piece"))
        run("train", clouds, "-o", self.folder / "p.safetensors", "--epochs", 8)
        return self.folder / "p.safetensors"

    def test_leaves_pieces_of_larger_clouds_to_the_networks_of_all(self):
        few = self.train("few.safetensors", "--epochs", 2, "--seed", 5)
        joined = ["--epochs", 2, "--expert", few, "below=5000,estimated"]
        model = self.train("m.safetensors", *joined, "--pieces", self.pieces_model())
        self.assertEqual(tensors(model)[0]["format"], "pcednet-edge-model-5")
        alone = self.train("alone.safetensors", "--epochs", 2)
        for name, points, its in (("cube", cube(1000, seed=9)[0], few),
                                  ("ground", rough_ground(1000, seed=9), alone)):
            write_ply(self.folder / f"{name}.ply", points)
            found = []
            for number, by in enumerate((model, its)):
                out = self.folder / f"{name}{number}.ply"
                run("classify", self.folder / f"{name}.ply", "-o", out, "--model", by)
                found.append(read_ply(out)[0]["scalar_p_sharp"])
            self.assertTrue((found[0] == found[1]).all(), name)

    def test_refuses_a_model_that_does_not_tell_pieces(self):
        few = self.train("few.safetensors", "--epochs", 1)
        joined = ("-o", self.folder / "m.safetensors", "--expert", few, "below=9")
        result = run("train", self.folder / "clouds", *joined, "--pieces", few, expect=5)
        self.assertIn("other classes", result.stderr)
        run("train", self.folder / "clouds", *joined[:2], "--pieces", few, expect=2)
        self.assertFalse((self.folder / "m.safetensors").exists())

    def test_learns_from_clouds_of_a_kind_alone(self):
        plain = tensors(self.train("p.safetensors", "--epochs", 1))[0]
        kept = tensors(self.train("k.safetensors", "--epochs", 1, "--only", "below=100000"))[0]
        self.assertEqual(kept["training_clouds"], plain["training_clouds"])
        result = run("train", self.folder / "clouds", "-o", self.folder / "m.safetensors",
                     "--only", "below=2", expect=4)
        self.assertIn("no cloud is of the kind --only below=2", result.stderr)
        made = tensors(self.train("n.safetensors", "--epochs", 1, "--no-normals", "--only",
                                  "estimated"))[0]
        self.assertEqual(made["training_clouds"], plain["training_clouds"])
        self.train("bad.safetensors", "--only", "sparse", expect=2)

    def test_refuses_experts_that_want_another_description(self):
        few = self.train("few.safetensors", "--epochs", 1, "--scales", 8)
        result = run("train", self.folder / "clouds", "-o", self.folder / "m.safetensors",
                     "--expert", few, "below=9", expect=5)
        self.assertIn("another descriptor", result.stderr)
        self.assertFalse((self.folder / "m.safetensors").exists())

    def test_refuses_experts_of_as_many_other_classes(self):
        self.train("few.safetensors", "--epochs", 1)
        result = run("train", self.folder / "clouds", "-o", self.folder / "m.safetensors",
                     "--classes", 2, "--expert", self.pieces_model(), "below=9", expect=5)
        self.assertIn("its classes are whole, piece, not edges", result.stderr)
        self.assertNotIn("epoch", result.stdout + result.stderr)

    def test_takes_experts_that_learnt_without_octaves(self):
        tied = ("--epochs", 1, "--s-max-ratio", 8)
        few = self.train("few.safetensors", *tied)
        joined = tensors(self.train("m.safetensors", *tied, "--octaves", "--expert", few, "below=9"))[0]
        self.assertEqual(joined["descriptor_octaves"], "1")
        self.train("n.safetensors", *tied, "--octaves", "--unrounded-scales", "--expert", few, "below=9")

    def test_trains_with_two_gates_and_teachers(self):
        options = ["--gate", 0.4, "--second-gate", -0.3, "--distil", 2, "--epochs", 2]
        model = self.train("one.safetensors", *options, "--threads", 1)
        metadata, arrays = tensors(model)
        self.assertEqual(metadata["descriptor_second_gate"], "-0.3")
        self.assertEqual(arrays["tree.0.weight"].shape, (8, 6, 24))
        again = self.train("two.safetensors", *options, "--threads", 2).read_bytes()
        self.assertEqual(model.read_bytes().replace(b'"one"', b'"two"'), again)
        other = self.train("six.safetensors", *options[:4], *options[6:]).read_bytes()
        self.assertNotEqual(other.replace(b'"six"', b'"two"'), again, "--distil changes something")
        self.train("bad.safetensors", "--second-gate", 0.1, expect=2)
        self.train("bad.safetensors", "--gate", 2, expect=2)

    def test_trains_the_baselines_and_the_papers_recipe(self):
        for network, weights in (("fc", 6663), ("cnn", 9723)):
            _, arrays = tensors(self.train(network + ".safetensors", "--network", network,
                                           "--epochs", 1, points=800))
            found = sum(a.size for name, a in arrays.items() if not name.startswith("standard"))
            self.assertEqual(found, weights)
        self.train("paper.safetensors", "--recipe", "paper", "--epochs", 1, points=800)

    def test_stops_on_ctrl_c_with_the_best_model_so_far(self):
        source = self.folder / "a.ply"
        write_ply(source, *cube(4000))
        out = self.folder / "m.safetensors"
        running = subprocess.Popen([PROGRAM, "train", source, "-o", out, "--epochs", "100000"],
                                   stderr=subprocess.PIPE, text=True)
        for line in running.stderr:
            if line.startswith("epoch   3"):
                break
        running.send_signal(signal.SIGINT)
        running.stderr.read()
        running.stderr.close()
        self.assertEqual(running.wait(60), 130)
        self.assertEqual(tensors(out)[0]["name"], "m")
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.ply", "m.safetensors"])

    def test_refuses_a_class_without_samples(self):
        p, n, label = cube(1000)
        label[label == 1] = 0
        write_ply(self.folder / "a.ply", p, n, label)
        done = run("train", self.folder / "a.ply", "-o", self.folder / "m.safetensors", expect=4)
        self.assertIn("no point is labelled smooth-edge (1); --classes 2", done.stderr)
        self.assertIn("--start general needs no point of it", done.stderr)
        run("train", self.folder / "a.ply", "-o", self.folder / "m.safetensors", "--classes", 2,
            "--epochs", 1)

    def test_tells_what_labels_lack_before_the_work(self):
        p, n, label = cube(1000)
        a, b = self.folder / "a.ply", self.folder / "b.ply"
        write_ply(a, p, labels=label)
        for its, classes, said in ((np.full(1000, 255), 3, f"{b}: no labelled point (0 non-edge, "),
                                   (np.where(label == 2, 255, label), 2,
                                    "no point is labelled sharp-edge (2), but points are smooth-edge (1): if"),
                                   (np.where(label == 0, 0, 255), 2, "no point is labelled sharp-edge (2)\n"),
                                   (np.where(label == 0, 255, label), 3, "no point is labelled non-edge (0)"),
                                   (np.where(label == 1, 0, label), 3, "no point is labelled smooth-edge (1); --c")):
            write_ply(b, p, labels=its)
            inputs = (a, b) if said.startswith(str(b)) else (b,)
            done = run("train", *inputs, "-o", self.folder / "m.safetensors", "--classes", classes,
                       "--progress", "plain", expect=4)
            self.assertIn(said, done.stderr)
            self.assertNotIn(" %", done.stderr)

    def test_says_why_there_are_no_labels(self):
        p, n, label = cube(300)
        a = self.folder / "a.ply"
        for said, columns in (("no column is named label\n", {}), ("no column is named label\n", {"scalar_edge_class": label}),
                              ("no column is named label; Klass_edges may have to be renamed\n", {"Klass_edges": label}),
                              ("its column label holds 0.5, which is none\n", {"label": label / 2})):
            write_ply(a, p, n, **columns)
            done = run("train", a, "-o", self.folder / "m.safetensors", expect=4)
            self.assertIn(f"{a}: has no labels, as {said}", done.stderr)
        words = self.folder / "words.csv"
        words.write_text("x,y,z,label\n" + "".join(f"{x},{y},{z},edge\n" for x, y, z in p))
        done = run("train", words, "-o", self.folder / "m.safetensors", expect=4)
        self.assertIn("as no column is named label; columns of text are left out: label\n", done.stderr)

    def test_learns_from_the_codes_of_las(self):
        p, n, label = cube(1500, seed=4)
        a, coded, las = (self.folder / name for name in ("a.csv", "b.csv", "b.las"))
        codes = np.choose(label, [2, 6, 64])
        codes[:100], label[:100] = 1, 255
        codes[100:200], label[100:200] = 7, 0
        for path, name, its in ((a, "label", label), (coded, "Classification", codes)):
            rows = np.column_stack([np.round(p, 4), n, its])
            np.savetxt(path, rows, fmt=["%.4f"] * 6 + ["%d"], delimiter=",", header="x,y,z,nx,ny,nz," + name, comments="")
        self.assertIn("--las-classification", run("train", coded, "-o", self.folder / "m.safetensors", expect=4).stderr)
        run("convert", coded, "-o", las)
        by = ["--las-classification", "0=2,0=7,1=6,2=64"]
        for options in (["--epochs", 2], ["--start", "general"]):
            models = []
            for cloud, how in ((a, []), (coded, by), (las, by)):
                said = run("train", cloud, *how, "-o", self.folder / "m.safetensors", "--overwrite", *options).stderr
                self.assertEqual("labels from its field Classification" in said, bool(how))
                models.append((self.folder / "m.safetensors").read_bytes())
            self.assertEqual(models[0], models[1])
            self.assertEqual(models[0], models[2])
        scores = [json.loads(run("evaluate", cloud, "--json", "-", *how).stdout)["clouds"][0]["mcc"]
                  for cloud, how in ((a, []), (las, by))]
        self.assertEqual(*scores)
        for bad in ("2=64,0=64", "4=64", "2=256", "x"):
            said = run("train", las, "--las-classification", bad, "-o", self.folder / "n.safetensors", expect=2).stderr
            self.assertIn("--las-classification", said)

    def test_learns_what_another_program_corrected_in_a_result(self):
        """CloudCompare drops the comments and keeps the columns."""
        p, n, label = cube(4000, seed=4)
        source, cloud, las = (self.folder / name for name in ("a.ply", "b.ply", "b.las"))
        write_ply(source, p, n)
        run("classify", source, "-o", self.folder / "r.ply")
        run("classify", source, "-o", las)
        found = read_ply(self.folder / "r.ply")[0]
        columns = {name: found[name] for name in ("scalar_p_sharp", "scalar_p_smooth")}
        write_ply(cloud, p, n, scalar_edge_class=label.astype(np.float32), scalar_label=found["label"].astype(np.float32),
                  **columns)
        done = run("evaluate", cloud, "--json", "-")
        self.assertIn("the labels are those of its column scalar_edge_class, which was corrected", done.stderr)
        write_ply(self.folder / "true.ply", p, n, label)
        true = run("evaluate", self.folder / "true.ply", "--json", "-")
        scores = [json.loads(one.stdout)["clouds"][0]["mcc"] for one in (done, true)]
        self.assertEqual(*scores)
        self.assertLess(scores[0], 1)
        said = run("train", las, "--start", "general", "-o", self.folder / "m.safetensors").stderr
        self.assertIn("the labels of its column scalar_edge_class are no truth unless they were corrected", said)

    def test_counts_the_labels_that_are_no_classes(self):
        p, n, label = cube(1000)
        label[:30] = 5
        write_ply(self.folder / "a.ply", p, n, label)
        said = run("train", self.folder / "a.ply", "-o", self.folder / "m.safetensors", "--epochs", 1).stderr
        self.assertIn("a.ply: 30 labels are none of the classes", said)
        self.assertNotIn("labels are none", self.train_said(label=np.where(label == 5, 255, label)))

    def train_said(self, label):
        p, n, _ = cube(1000)
        write_ply(self.folder / "b.ply", p, n, label)
        return run("train", self.folder / "b.ply", "-o", self.folder / "b.safetensors", "--epochs", 1).stderr

    def test_a_model_learns_a_few_points_without_unlearning_the_rest(self):
        p, n, label = cube(8000, seed=3)
        few = np.full(8000, 255, np.uint8)
        few[np.flatnonzero((label == 2) & (p[:, 2] > 0.3))[::3]] = 0
        cloud, model = self.folder / "a.ply", self.folder / "m.safetensors"
        write_ply(cloud, p, n, few)
        said = run("train", cloud, "--start", "general", "-o", model).stderr
        self.assertIn("nothing is held out", said)
        self.assertEqual(tensors(model)[0]["name"], "m")
        found = []
        for name, its in (("before", "general"), ("after", model)):
            run("classify", cloud, "--model", its, "--no-boundary", "-o", self.folder / f"{name}.ply")
            found.append(read_ply(self.folder / f"{name}.ply")[0]["label"])
        before, after = found
        self.assertGreater(np.mean((before == after)[label == 0]), 0.95)
        painted = few == 0
        self.assertLess(np.mean(after[painted] == 2), np.mean(before[painted] == 2) / 2)
        self.assertEqual(run("train", cloud, "--start", model, "-o", self.folder / "n.safetensors", "--seed", 2,
                             "--no-normals", "--keep-orientation", "--progress", "none").returncode, 0)

    def test_refuses_what_does_not_go_with_a_start(self):
        p, n, label = cube(1000)
        a, b, own = (self.folder / f"{name}.ply" for name in ("a", "b", "own"))
        write_ply(a, p, n, label)
        write_ply(b, p, n, np.full(1000, 255))
        write_own(own, p, n, np.where(label == 2, 1, 0))
        model = self.folder / "m.safetensors"
        for extra in (["--classes", 2], ["--context"], ["--epochs", 3], ["--s-max", 1], ["--only", "given"], ["--natural"]):
            said = run("train", a, "--start", "general", "-o", model, *extra, expect=2).stderr
            self.assertIn(f"{extra[0]} has no effect beside --start", said)
        self.assertIn(f"{b}: no point is labelled", run("train", a, b, "--start", "general", "-o", model, expect=4).stderr)
        said = run("train", own, "--start", "general", "-o", model, expect=2).stderr
        self.assertIn("start: the model knows the classes edges, the labels are ground, wall, pipe", said)
        self.assertIn("neither a file nor a shipped model", run("train", a, "--start", "none", "-o", model, expect=2).stderr)
        run("train", a, "-o", model, "--epochs", 1)
        run("train", a, "--start", model, "-o", model, "--overwrite", expect=2)

    def test_writes_model_files_only(self):
        broken = self.folder / "broken.ply"
        broken.write_text("ply\nnonsense\n")
        for name in ("m.onnx", "m.ply", "m"):
            said = run("train", broken, "-o", self.folder / name, expect=2).stderr
            self.assertIn(f"{name}: must end in .safetensors", said)
        run("train", broken, "-o", self.folder / "m.SafeTensors", expect=3)
        self.assertEqual(os.listdir(self.folder), ["broken.ply"])

    def test_warns_of_too_little_memory(self):
        p, n, label = cube(400000)
        few = np.where(np.arange(len(p)) % 1000 < 3, label, 255)
        cloud, limit = self.folder / "a.ply", 200 << 20
        write_ply(cloud, p, n, few)
        command = [PROGRAM, "train", cloud, "-o", self.folder / "m.safetensors", "--overwrite", "--threads", "1"]
        for options, warns in ((["--start", "general"], True), (["--epochs", "1"], False)):
            done = subprocess.run([*command, *options], stderr=subprocess.PIPE, text=True, timeout=300,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            self.assertEqual(bool(re.search(r"warning: train: 400000 points may take 2\d\d MiB of memory, more than the "
                                            r"\d+ MiB that are free", done.stderr)), warns, done.stderr)
            self.assertIn(done.returncode, (0, 1), done.stderr)  # what is not free may suffice or not

    def test_says_that_scales_grow_with_the_cloud(self):
        self.train("a.safetensors", "--epochs", 1, points=800)
        source = self.folder / "clouds/a.ply"
        for options in ([], ["--s-max-ratio", 8], ["--s-max", 1], ["--start", "general"]):
            more = [] if "--start" in options else ["--epochs", 1]
            said = run("train", source, "-o", self.folder / "m.safetensors", "--overwrite", *more, *options).stderr
            self.assertEqual("its scales grow with the diagonal" in said, not options)
            self.assertEqual("the model does not keep --s-min and --s-max" in said, "--s-max" in options)

    def test_says_where_nothing_is_held_out(self):
        p, n, label = cube(1000)
        few = np.full(1000, 255, np.uint8)
        for id in range(3):
            few[np.flatnonzero(label == id)[:10]] = id
        write_ply(self.folder / "a.ply", p, n, few)
        model = self.folder / "m.safetensors"
        said = run("train", self.folder / "a.ply", "-o", model, "--epochs", 1).stderr
        self.assertIn("validation loss -  accuracy -\n", said)
        self.assertIn("nothing was held out for validation", said)
        self.assertIn("--start general learns more from few points", said)
        self.assertIn("those of --start general or with --s-max-ratio 8 follow the spacing", said)
        own = write_own(self.folder / "own.ply", p, n, few)
        said = run("train", own, "-o", model, "--epochs", 1, "--overwrite").stderr
        self.assertIn("nothing was held out for validation", said)
        self.assertIn("those with --s-max-ratio 8 follow the spacing", said)
        self.assertNotIn("general", said)
        self.assertNotIn("validation_loss", tensors(model)[0])
        said = tensors(self.train("all.safetensors", "--epochs", 1))[0]
        self.assertIn("validation_loss", said)


if __name__ == "__main__":
    unittest.main()
