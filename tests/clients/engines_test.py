"""The scripts of examples/large, run by the engines that they are written for, on this machine.

engines_test.py ENGINE exits with 77 (skipped) where the engine is not installed. Slurm gets two nodes
of one processor and loses one of them and a task; root must start it.
"""
import importlib.util
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest

SOURCE = pathlib.Path(os.environ["PCEDNET_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "tests/cli"))

import tiles_support
from support import PROGRAM, CliTest, run, write_ply

EXAMPLES = SOURCE / "examples/large"
UNPACKED = SOURCE / "build/snakemake"  # by scripts/unpack_snakemake.sh

# Runs pcednet; but the first time that a tile of $HELD/hold is run, it says who it is and stops.
HELD = """#!/bin/sh
for tile in $(cat "$HELD/hold"); do
  case " $* " in *" --tile $tile "*)
    if mkdir "$HELD/first-$tile" 2>/dev/null; then
      echo "$$ $PPID ${SLURMD_NODENAME:-}" >"$HELD/new-$tile"
      mv "$HELD/new-$tile" "$HELD/held-$tile"
      kill -STOP $$
    fi ;;
  esac
done
exec "$PROGRAM" "$@"
"""

SLURM_CONF = """
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={port0}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdPidFile={folder}/%n.pid
SlurmdLogFile={folder}/%n.log
SlurmdSpoolDir={folder}/spool-%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=2,bf_interval=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SlurmdTimeout=10
MinJobAge=300
KillWait=2
ReturnToService=2
JobRequeue=1
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port={port1} CPUs=1 RealMemory=1000
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port={port2} CPUs=1 RealMemory=1000
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Engine(CliTest):
    """A plan whose tiles can be made to stop when they are run first."""

    def setUp(self):
        super().setUp()
        self.folder.chmod(0o755)
        write_ply(self.folder / "cloud.ply", *tiles_support.field(3, 300))
        self.plan = self.folder / "p.json"
        run("tiles", "plan", self.folder / "cloud.ply", "-o", self.plan, "--tile", 1)
        self.count = len(json.loads(self.plan.read_text())["tiles"])
        self.assertGreaterEqual(self.count, 8)
        program = self.folder / "pcednet"
        program.write_text(HELD)
        program.chmod(0o755)
        (self.folder / "hold").write_text("")
        self.environment = dict(os.environ, PCEDNET=str(program), PROGRAM=PROGRAM,
                                HELD=str(self.folder))
        self.daemons = []

    def tearDown(self):
        for process in reversed(self.daemons):
            process.terminate()
        for process in self.daemons:
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        super().tearDown()

    def wait_for(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = condition()
            if found:
                return found
            time.sleep(0.2)
        self.fail(f"not within {seconds} s: {what}\n{self.logs()}")

    def logs(self):
        said = []
        for path in [*self.folder.glob("*.log"), *self.folder.glob("p.json.*/*.txt")]:
            said += [f"== {path.name}", *path.read_text(errors="replace").splitlines()[-30:]]
        return "\n".join(said)

    def held(self, tile):
        """The process that holds a tile, its parent and its node."""
        path = self.folder / f"held-{tile}"
        self.wait_for(path.exists, 120, f"tile {tile} begins")
        pid, parent, *node = path.read_text().split()
        return int(pid), int(parent), node[0] if node else ""

    def check_joined(self, joined):
        """The same bytes as of the tiles that no engine ran."""
        run("tiles", "run", self.plan, "--overwrite")
        run("tiles", "join", self.plan, "-o", self.folder / "expected.ply", "--overwrite")
        self.assertEqual(joined.read_bytes(), (self.folder / "expected.ply").read_bytes())


class Slurm(Engine):
    def start(self, *command):
        log = open(self.folder / f"{pathlib.Path(command[0]).name}-out.log", "a")
        self.daemons.append(subprocess.Popen(list(map(str, command)), stdout=log, stderr=log,
                                             env=self.environment))
        log.close()
        return self.daemons[-1]

    def slurm(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True).stdout

    def start_cluster(self):
        port0, port1, port2 = free_ports(3)
        configuration = self.folder / "slurm.conf"
        configuration.write_text(SLURM_CONF.format(folder=self.folder, port0=port0, port1=port1,
                                                   port2=port2))
        self.environment["SLURM_CONF"] = str(configuration)
        for name in ("state", "spool-n1", "spool-n2"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        self.start("munged", "--foreground", "--force", f"--socket={self.folder}/munge.socket",
                   f"--key-file={key}", f"--pid-file={self.folder}/munged.pid",
                   f"--seed-file={self.folder}/munge.seed")
        self.wait_for((self.folder / "munge.socket").exists, 30, "munged starts")
        self.start("slurmctld", "-D")
        nodes = {name: self.start("slurmd", "-D", "-N", name) for name in ("n1", "n2")}
        self.wait_for(lambda: self.slurm("sinfo", "-h", "-o", "%D %T") == "2 idle\n", 60,
                      "both nodes are idle")
        return nodes

    def test_a_killed_task_and_a_killed_node_lose_nothing(self):
        nodes = self.start_cluster()
        (self.folder / "hold").write_text("2 5")
        joined = self.folder / "joined.ply"
        said = subprocess.run([EXAMPLES / "slurm.sh", self.plan, joined], env=self.environment,
                              capture_output=True, text=True)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn(f"round 1: {self.count} tiles in array ", said.stdout)
        task, _, _ = self.held(2)
        os.kill(task, signal.SIGKILL)
        task, step, name = self.held(5)
        for pid in (nodes[name].pid, step, task):
            os.kill(pid, signal.SIGKILL)
        self.wait_for(joined.exists, 240, "the tiles are joined")
        self.wait_for(lambda: self.slurm("squeue", "-h") == "", 60, "the queue is empty")
        # Slurm itself queues the task of the lost node again, but not the killed one.
        jobs = self.slurm("scontrol", "show", "job")
        self.assertRegex(jobs, r"JobState=FAILED[^\n]*\n[^\n]*Restarts=0 .*ExitCode=0:9")
        self.assertEqual(jobs.count("Restarts=1"), 1)
        self.assertIn("down*", self.slurm("sinfo", "-h", "-n", name))
        closing = "".join(p.read_text() for p in self.folder.glob("p.json.slurm/closing-*.txt"))
        self.assertIn("round 2: 1 tiles in array ", closing)
        self.assertNotIn("round 3", closing)
        self.check_joined(joined)


class Snakemake(Engine):
    def setUp(self):
        super().setUp()
        if not shutil.which("snakemake"):
            self.environment["PYTHONPATH"] = str(UNPACKED / "usr/lib/python3/dist-packages")

    def start(self, *options):
        snakemake = shutil.which("snakemake") or UNPACKED / "usr/bin/snakemake"
        command = [snakemake, "--snakefile", EXAMPLES / "Snakefile", "--cores", 2, "--keep-going",
                   "--retries", 3, "--rerun-incomplete", *options,
                   "--config", f"plan={self.plan}", f"out={self.folder / 'joined.ply'}"]
        with open(self.folder / "snakemake.log", "a") as log:
            return subprocess.Popen(list(map(str, command)), stdout=log, stderr=log,
                                    cwd=self.folder, env=self.environment)

    def expect(self, code, *options):
        self.assertEqual(self.start(*options).wait(120), code, self.logs())

    def test_a_killed_task_and_a_killed_snakemake_lose_nothing(self):
        (self.folder / "hold").write_text("2 5")
        first = self.start()
        os.kill(self.held(2)[0], signal.SIGKILL)
        task, _, _ = self.held(5)
        for pid in (first.pid, task):
            os.kill(pid, signal.SIGKILL)
        first.wait()
        self.assertFalse((self.folder / "joined.ply").exists())
        self.expect(0, "--unlock")
        self.expect(0)
        self.check_joined(self.folder / "joined.ply")
        # A mark of a tile that is no longer there does not count.
        tile = json.loads(self.plan.read_text())["tiles"][3]["output"]
        (self.folder / tile).unlink()
        self.expect(0)
        self.check_joined(self.folder / "joined.ply")


class Parallel(Engine):
    def test_a_killed_task_is_run_again(self):
        (self.folder / "hold").write_text("2 5")
        with open(self.folder / "parallel.log", "w") as log:
            parallel = subprocess.Popen([EXAMPLES / "parallel.sh", self.plan], stdout=log, stderr=log,
                                        env=self.environment)
        for tile in (2, 5):
            os.kill(self.held(tile)[0], signal.SIGKILL)
        self.assertEqual(parallel.wait(120), 0, self.logs())
        run("tiles", "join", self.plan, "-o", self.folder / "joined.ply")
        self.check_joined(self.folder / "joined.ply")


    def test_a_tile_that_cannot_be_written_is_told(self):
        plan = self.folder / "two words.json"
        self.plan.rename(plan)
        tile = self.folder / json.loads(plan.read_text())["tiles"][3]["output"]
        tile.parent.mkdir(exist_ok=True)
        tile.write_text("no tile")
        said = []
        for code in (1, 0):
            done = subprocess.run([EXAMPLES / "parallel.sh", plan], env=self.environment, capture_output=True,
                                  text=True, timeout=120)
            self.assertEqual(done.returncode, code, done.stderr)
            said.append(done.stdout)
            tile.unlink()
        self.assertRegex(said[0], r"missing +1 tiles, +\d+ points: 3\n")
        self.assertRegex(said[1], rf"done +{self.count} tiles")


class Dask(Engine):
    def test_a_killed_task_and_a_killed_worker_lose_nothing(self):
        (self.folder / "hold").write_text("2 5")
        joined = self.folder / "joined.ply"
        with open(self.folder / "dask.log", "w") as log:
            dask = subprocess.Popen([sys.executable, EXAMPLES / "dask_tiles.py", self.plan, joined],
                                    stdout=log, stderr=log, env=self.environment)
        os.kill(self.held(2)[0], signal.SIGKILL)
        task, worker, _ = self.held(5)
        for pid in (worker, task):
            os.kill(pid, signal.SIGKILL)
        self.assertEqual(dask.wait(120), 0, self.logs())
        self.check_joined(joined)


def has(*programs):
    return all(map(shutil.which, programs))


ENGINES = {
    "parallel": (Parallel, lambda: has("parallel")),
    "slurm": (Slurm, lambda: os.geteuid() == 0 and has("slurmctld", "slurmd", "munged")),
    "snakemake": (Snakemake, lambda: has("snakemake") or (UNPACKED / "usr/bin/snakemake").exists()),
    "dask": (Dask, lambda: importlib.util.find_spec("distributed")),
}


if __name__ == "__main__":
    case, is_there = ENGINES[sys.argv[1]]
    if not is_there():
        print(f"skipped: {sys.argv[1]} is not installed, or needs root")
        sys.exit(77)
    tests = unittest.defaultTestLoader.loadTestsFromTestCase(case)
    sys.exit(not unittest.TextTestRunner().run(tests).wasSuccessful())
