"""Completion as a user meets it: bash and zsh in a terminal, and the Tab key."""
import os
import pathlib
import pty
import re
import select
import subprocess
import tempfile
import time
import unittest

import packaging

packaging.need("bash", "zsh")
MARK = "prompt-of-the-test>"
TAB = "\t"


class Shell:
    """An interactive shell in a terminal, 400 columns wide so that nothing wraps."""

    def __init__(self, words, folder):
        self.master, slave = pty.openpty()
        environment = {"PATH": os.environ["PATH"], "HOME": str(folder), "TERM": "dumb",
                       "LC_ALL": "C.UTF-8", "COLUMNS": "400", "LINES": "200"}
        self.process = subprocess.Popen(words, stdin=slave, stdout=slave, stderr=slave,
                                        cwd=folder, env=environment, start_new_session=True)
        os.close(slave)
        self.wait(MARK)

    def wait(self, wanted):
        """What the terminal shows until it matches."""
        shown, end = "", time.monotonic() + 120
        while not re.search(wanted, shown):
            ready, _, _ = select.select([self.master], [], [], max(0, end - time.monotonic()))
            if not ready:
                raise AssertionError(f"no {wanted!r} in {shown!r}")
            shown += os.read(self.master, 65536).decode(errors="replace")
            shown = re.sub(r"[^\b]\x08|\x1b\[[0-9;?]*[A-Za-z]", "", shown)
        return shown

    def complete(self, line, wanted):
        """Types the line with its Tabs, and empties it again."""
        os.write(self.master, line.encode())
        shown = self.wait(wanted)
        os.write(self.master, b"\x15")  # Ctrl-U
        os.write(self.master, b"echo; echo en''d\r")
        self.wait(rf"\nend\s[^>]*{MARK}")
        return shown

    def close(self):
        os.close(self.master)
        self.process.kill()
        self.process.wait()


class Completion(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._folder.name)
        (self.folder / "hall").mkdir()
        (self.folder / "hall.ply").touch()
        (self.folder / "old scan.las").touch()

    def tearDown(self):
        self.shell.close()
        self._folder.cleanup()

    def open_bash(self):
        (self.folder / ".bashrc").write_text(
            f"PS1='{MARK}'\nbind 'set bell-style none'\nbind 'set page-completions off'\n"
            f"bind 'set enable-bracketed-paste off'\n. {packaging.MADE}/bash/pcednet\n")
        self.shell = Shell(["bash", "--noprofile", "-i"], self.folder)

    def open_zsh(self):
        (self.folder / ".zshrc").write_text(
            f"PS1='{MARK}'\nunsetopt zle_bracketed_paste beep list_ambiguous prompt_sp\n"
            f"zstyle ':completion:*' list-prompt ''\n"
            f"LISTMAX=0\nfpath=({packaging.MADE}/zsh $fpath)\nautoload -Uz compinit\n"
            "compinit -u -D\n")
        self.shell = Shell(["zsh", "-d", "-i"], self.folder)

    def check_common(self):
        """What both shells complete."""
        complete = self.shell.complete
        complete(f"pcednet cla{TAB}", r"pcednet classify ")
        complete(f"pcednet ti{TAB}st{TAB}", r"pcednet tiles status ")
        complete(f"pcednet generate wo{TAB}", r"pcednet generate worn ")
        complete(f"pcednet classify --skip{TAB}", r"classify --skip-existing ")
        complete(f"pcednet classify --model sc{TAB}", r"--model scan ")
        complete(f"pcednet classify --method mul{TAB}", r"--method multi-scale ")
        complete(f"pcednet tiles plan --max{TAB}", r"plan --max-memory")
        complete(f"pcednet study meth{TAB}", r"study methods ")
        complete(f"pcednet info hall.{TAB}", r"info hall\.ply ")
        complete(f"pcednet info ol{TAB}", r"info old\\ scan\.las ")
        complete(f"pcednet classify hall.ply --out-dir h{TAB}", r"--out-dir hall/")
        complete(f"pcednet lines hall.ply --dxf-version=r{TAB}", r"--dxf-version=r12 ")

    def check_lists(self):
        def all_of(*words):
            return "(?s)" + "".join(rf"(?=.*\s{word}\s)" for word in words)

        self.shell.complete(f"pcednet {TAB}{TAB}",
                            all_of("classify", "lines", "tiles", "train", "report", "annotate"))
        shown = self.shell.complete(f"pcednet lines x.ply --{TAB}{TAB}",
                                    all_of("--min-length", "--dxf-version", "--regularise", "--view"))
        self.assertNotIn("--epochs", shown)

    def test_bash(self):
        self.open_bash()
        self.check_common()
        self.check_lists()

    def test_zsh(self):
        self.open_zsh()
        self.check_common()
        self.check_lists()


if __name__ == "__main__":
    unittest.main()
