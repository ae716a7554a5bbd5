"""The tool, and programs of users, as several processes: mpirun_test.py MPIRUN OCTAFRONT PROGRAM C_PROGRAM SAMPLES_DIR [TEST ...]."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MPIRUN, OCTAFRONT, PROGRAM, C_PROGRAM = sys.argv[1:5]
SAMPLES = pathlib.Path(sys.argv[5])
BRACKET = SAMPLES / "bracket.stl"

# More processes than cores, as root in a container, where memory cannot be bound; processes that wait let others work.
LAUNCH = [MPIRUN, "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "--mca", "hwloc_base_mem_bind_failure_action",
          "silent", "--mca", "mpi_yield_when_idle", "1"]

# All ranks have the same mesh, or the same error.
PYTHON_PROGRAM = """
import sys
import octafront
from mpi4py import MPI
world = MPI.COMM_WORLD
try:
    mesh = octafront.mesh(sys.argv[1], elements=20000, comm=world)
except octafront.InputError as error:
    sys.exit(7 if set(world.allgather(str(error))) == {str(error)} and not print(error, file=sys.stderr) else 8)
hashes = world.allgather(mesh.report["hash"])
assert len(set(hashes)) == 1, hashes
if world.rank == 0:
    mesh.save(sys.argv[2])
"""


class Mpirun(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)
        self.out = self.dir / "out.vtu"

    def tearDown(self):
        self.scratch.cleanup()

    def launch(self, ranks, *command, check=None):
        done = subprocess.run([*LAUNCH, "-n", str(ranks), *map(str, command)], text=True, timeout=300, capture_output=True)
        if check is not None:
            self.assertEqual(done.returncode, check, f"{done.stdout}{done.stderr}")
        return done

    def mesh(self, ranks, *options, source=BRACKET, check=0):
        sources = source if isinstance(source, list) else [source]
        return self.launch(ranks, OCTAFRONT, "mesh", *sources, "-o", self.out, "--json", self.dir / "out.json", *options, check=check)

    def nothing_left(self):
        self.assertEqual([p.name for p in self.dir.iterdir() if p.suffix != ".json"], [])

    def test_one_mesh_for_any_number_of_ranks(self):
        cube = self.dir / "cube.off"
        corners = [[n >> axis & 1 for axis in range(3)] for n in range(8)]
        faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2),
                 (1, 3, 7), (1, 7, 5)]
        cube.write_text("\n".join(["OFF", "8 12 0", *(" ".join(map(str, c)) for c in corners),
                                   *("3 %d %d %d" % f for f in faces)]) + "\n")
        for source, options in ((BRACKET, ["--elements", "60000"]), (cube, ["--size", "0.07", "--order", "2"]),
                                ("gyroid(x,y,z) - 0.3", ["--cell", "10", "--size", "1"])):
            self.one_mesh(source, options, (1, 2, 3, 5, 8))

    def one_mesh(self, source, options, counts):
        sources = source if isinstance(source, list) else [source]
        self.out.unlink(missing_ok=True)
        subprocess.run([OCTAFRONT, "mesh", *sources, "-o", self.out, "-q", *options], check=True)
        alone = self.out.read_bytes()
        for ranks in counts:
            for threads in (1, 2):
                self.out.unlink()
                done = self.mesh(ranks, *options, "--threads", threads, source=source)
                self.assertEqual(self.out.read_bytes(), alone, f"{source}: {ranks} ranks, {threads} threads")
                self.assertEqual(done.stdout.count("written:"), 1)
                told = json.loads((self.dir / "out.json").read_text())
                self.assertEqual(len(told.get("ranks", [0])), ranks)
                rows = told.get("ranks", [])
                self.assertTrue(all(row["rounds_of_talk"] > 0 for row in rows))
                self.assertTrue(ranks == 1 or sum(row["shared_seconds"] for row in rows) > 0)

    def test_one_mesh_of_an_image(self):
        self.one_mesh(SAMPLES / "head_labels.nii.gz", ["--size", "12"], (1, 2, 3))

    def test_one_mesh_of_several_bodies(self):
        self.one_mesh([SAMPLES / "gear.obj", BRACKET], ["--size", "4"], (1, 2, 3))

    def test_one_mesh_of_a_kept_surface(self):
        self.one_mesh(SAMPLES / "torus_knot.ply", ["--keep-surface"], (1, 2, 3))

    def test_one_mesh_of_the_bunny(self):
        bunny = SAMPLES.parent / "models" / "clean" / "bunny00.off"
        if not bunny.exists():
            self.skipTest("bench/models/get-models.sh fetches it")
        self.one_mesh(bunny, ["--elements", "30000"], (1, 2, 3))

    def test_long_messages_go_in_parts(self):
        for ranks in (1, 2, 5):
            self.launch(ranks, PROGRAM, "messages", check=0)

    def test_programs_in_c(self):
        missing = self.dir / "missing.stl"
        subprocess.run([OCTAFRONT, "mesh", BRACKET, "-o", self.out, "-q", "--elements", "20000"], check=True)
        alone = self.out.read_bytes()
        for ranks in (1, 2, 3):
            self.out.unlink()
            done = self.launch(ranks, C_PROGRAM, BRACKET, self.out, "20000", check=0)
            self.assertEqual(self.out.read_bytes(), alone)
            self.assertEqual(done.stdout.count("tetrahedra"), 1)
            self.out.unlink()
            done = self.launch(ranks, C_PROGRAM, missing, self.out, check=3)
            self.assertEqual(len([line for line in done.stderr.splitlines() if "missing.stl" in line]), 1, done.stderr)
            self.nothing_left()
            self.out.touch()

    def test_programs_in_python(self):
        program = self.dir / "program.json"  # by its ending one of those that may be left
        program.write_text(PYTHON_PROGRAM)
        subprocess.run([OCTAFRONT, "mesh", BRACKET, "-o", self.out, "-q", "--elements", "20000"], check=True)
        alone = self.out.read_bytes()
        for ranks in (1, 2, 3):
            self.out.unlink()
            self.launch(ranks, "/usr/bin/python3", "-m", "mpi4py", program, BRACKET, self.out, check=0)
            self.assertEqual(self.out.read_bytes(), alone)
            self.out.unlink()
            done = self.launch(ranks, "/usr/bin/python3", "-m", "mpi4py", program, self.dir / "missing.stl", self.out, check=7)
            self.assertIn("missing.stl", done.stderr)
            self.nothing_left()
            self.out.touch()

    def stages(self):
        done = self.launch(2, PROGRAM, "kill", "none", "0", BRACKET, self.out, check=0)
        self.out.unlink()
        return list(dict.fromkeys(done.stdout.splitlines()))

    def test_a_rank_killed_in_any_stage_ends_all_and_leaves_nothing(self):
        stages = self.stages()
        self.assertIn("writing", stages)
        self.assertGreater(len(stages), 6)
        for stage in stages:
            for rank in (0, 2):
                begin = time.time()
                done = self.launch(3, PROGRAM, "kill", stage, rank, BRACKET, self.out)
                self.assertNotEqual(done.returncode, 0, stage)
                self.assertIn("signal 9", done.stderr, stage)
                self.assertLess(time.time() - begin, 60)
                if stage == "writing" and rank != 0 and self.out.exists():  # The first rank was done, and it is all there.
                    subprocess.run([OCTAFRONT, "check", self.out], check=True, capture_output=True)
                    self.out.unlink()
                self.nothing_left()

    def test_a_killed_tool_leaves_nothing(self):
        run = subprocess.Popen([*LAUNCH, "-n", "3", OCTAFRONT, "mesh", str(BRACKET), "-o", str(self.out), "--elements", "2e6"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        ranks = []
        while len(ranks) < 3:
            time.sleep(0.2)
            listed = subprocess.run(["ps", "-o", "pid=,args=", "--ppid", str(run.pid)], capture_output=True, text=True).stdout
            ranks = [int(line.split()[0]) for line in listed.splitlines() if OCTAFRONT in line]
        time.sleep(2)
        os.kill(ranks[1], signal.SIGKILL)
        self.assertIn("signal 9", run.communicate(timeout=60)[1])
        self.assertNotEqual(run.returncode, 0)
        self.nothing_left()

    def test_no_memory_on_one_rank_is_one_message(self):
        limited = ["sh", "-c", 'ulimit -v $1; shift; exec "$@"', "sh", "500000"]
        command = [OCTAFRONT, "mesh", BRACKET, "-o", self.out, "--elements", "8e6", "--threads", "1"]
        done = self.launch(1, *command, ":", "-n", "1", *limited, *command)
        self.assertEqual(done.returncode, 6, done.stderr)
        self.assertEqual(len(re.findall(r"octafront: rank 1 of 2, in stage .*out of memory", done.stderr)), 1, done.stderr)
        self.nothing_left()

    def test_refusals_are_said_once(self):
        missing = self.dir / "missing.stl"
        for command, status, words in ((["mesh", missing, "-o", self.out], 3, "missing.stl"),
                                       (["mesh", BRACKET, "-o", self.out, "--size", "-1"], 2, "--size"),
                                       (["mesh", BRACKET, "-o", self.out, "--improve-time", "1"], 2, "--improve-time"),
                                       (["mesh", "-", "-o", self.out], 2, "standard input"),
                                       (["mesh", BRACKET, "-o", self.dir / "no" / "out.vtu"], 5, "no")):
            done = self.launch(3, OCTAFRONT, *command, check=status)
            said = [line for line in done.stderr.splitlines() if line.startswith("octafront:")]
            self.assertEqual(len(said), 1, done.stderr)
            self.assertIn(words, said[0])
            self.nothing_left()

    def test_other_commands_are_done_by_the_first(self):
        for command in (["info", BRACKET], ["mesh", BRACKET, "--dry-run", "--size", "5"], ["help"]):
            alone = subprocess.run([OCTAFRONT, *command], capture_output=True, text=True, check=True).stdout
            done = self.launch(3, OCTAFRONT, *command, check=0)
            self.assertEqual(len(done.stdout.splitlines()), len(alone.splitlines()))

    def test_other_commands_write_their_file_once(self):
        old = self.dir / "old.msh"
        subprocess.run([OCTAFRONT, "mesh", BRACKET, "-o", old, "-q", "--size", "6"], check=True)
        for name, *command in (("new.stl", "surface", BRACKET, "--size", "6"), ("new.stl", "repair", BRACKET),
                               ("new.vtu", "size", BRACKET, "--size", "6"), ("new.vtu", "improve", old),
                               ("new.vtu", "adapt", old, "--size", "8"), ("new.inp", "convert", old),
                               ("new.html", "report", old)):
            new = self.dir / name
            alone = subprocess.run([OCTAFRONT, *command, "-o", new], capture_output=True, text=True, check=True).stdout
            made = new.read_bytes()
            new.unlink()
            done = self.launch(2, OCTAFRONT, *command, "-o", new, check=0)
            self.assertEqual(new.read_bytes(), made, command[0])
            self.assertEqual(len(done.stdout.splitlines()), len(alone.splitlines()), done.stdout)
            new.unlink()
        old.unlink()
        self.nothing_left()

    def test_standard_output_is_no_place_for_a_mesh(self):
        done = self.launch(2, OCTAFRONT, "mesh", BRACKET, "--size", "6", "-o", "-", "--format", "msh", check=2)
        self.assertIn("mpirun", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[6:]], verbosity=2)
