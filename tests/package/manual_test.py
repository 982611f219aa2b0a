"""The man pages say what --help says, and groff has nothing against them."""
import gzip
import re
import subprocess
import unittest

import packaging
import program_help

packaging.need("groff")


class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.program = program_help.read_command(packaging.PROGRAM)

    def page(self, name):
        """The page as a terminal shows it, in one line."""
        roff = gzip.decompress((packaging.MADE / f"man1/{name}.1.gz").read_bytes())
        done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-P-cbou", "-rLL=200n"],
                              input=roff, capture_output=True, check=True)
        self.assertEqual(done.stderr.decode(), "", name)
        return re.sub(r"\s+", " ", done.stdout.decode().replace("\u2212", "-").replace(
            "\u2010", "-"))

    def test_every_command_has_a_page_with_all_its_options(self):
        names = {path.name for path in (packaging.MADE / "man1").iterdir()}
        self.assertEqual(names, {"pcednet.1.gz"} | {f"pcednet-{c.words[0]}.1.gz"
                                                    for c in self.program.commands})
        options = 0
        for command in self.program.all():
            page = self.page(f"pcednet-{command.words[0]}")
            self.assertIn(command.summary[1:], page)
            for option in command.positionals + command.options:
                options += 1
                self.assertIn(", ".join(option.names), page)
                self.assertIn(option.text[1:], page, f"{command.name} {option.names}")
        self.assertGreater(options, 250)

    def test_the_page_of_the_program_lists_commands_and_exit_codes(self):
        page = self.page("pcednet")
        for command in self.program.commands:
            self.assertIn(f"{command.name} {command.summary}.", page)
            self.assertIn(f"pcednet-{command.name}(1)", page)
        self.assertIn("130 Stopped by a signal.", page)

    def test_all_words_of_the_help_were_understood(self):
        """Each line of a table of the help is in the entry that was made of it."""
        for command in self.program.all():
            text = packaging.run(packaging.PROGRAM, *command.words, "--help").stdout
            table = text[text.index("\nOptions:"):].split("\n\n")[0]
            known = " ".join(f"{' '.join(o.names)} {o.kind} {' '.join(o.choices)} {o.allowed} "
                             f"{o.preset} {' '.join(o.excludes + o.needs)} {o.text}"
                             for o in command.options)
            for word in re.split(r"[\s,:={}]+", table.replace("\nOptions:", "")):
                if word not in ("", "...", "x", "2", "3", "Excludes", "Needs", "REQUIRED"):
                    self.assertIn(word, re.split(r"[\s,:={}]+", known), command.name)


if __name__ == "__main__":
    unittest.main()
