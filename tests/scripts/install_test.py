#!/usr/bin/env python3
"""Installs a build into a folder, and tests the tree: its files, its programs, what the system shows of them.

    install_test.py CMAKE BUILD VERSION [TEST...]

BUILD is a whole build with the window and the importer. Needs Python 3, bash, zsh, desktop-file-utils, appstream,
shared-mime-info and man-db.
"""

import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
CMAKE, BUILD, VERSION = sys.argv[1:4]
SIZES = (16, 22, 24, 32, 48, 64, 128, 256, 512)
PLUGINS = ("forcedimension", "haply", "openhaptics")
# Shipped from resources as they are.
FOLDERS = ("demo", "devices", "docs", "models", "screenshots")
DEMO = "share/nearfit/demo/piston.nearfit"
# Debian's zsh looks in a folder of its own.
ZSH = "share/zsh/" + ("vendor-completions" if pathlib.Path("/etc/debian_version").exists() else "site-functions")
FILES = {
    "bin/nearfit", "bin/nearfit-cli", "include/nearfit/nearfit_device.h",
    *(f"lib/nearfit/plugins/{name}.so" for name in PLUGINS), "lib/udev/rules.d/70-nearfit.rules",
    "libexec/nearfit/nearfit-import", "libexec/nearfit/nearfit-export",
    "share/applications/nearfit.desktop", "share/mime/packages/nearfit.xml",
    "share/metainfo/org.nearfit.nearfit.metainfo.xml",
    "share/icons/hicolor/scalable/apps/nearfit.svg",
    *(f"share/icons/hicolor/{size}x{size}/apps/nearfit.png" for size in SIZES),
    "share/bash-completion/completions/nearfit", "share/bash-completion/completions/nearfit-cli",
    f"{ZSH}/_nearfit", f"{ZSH}/_nearfit-cli",
    "share/man/man1/nearfit.1.gz", "share/man/man1/nearfit-cli.1.gz",
    "share/doc/nearfit/copyright", "share/doc/nearfit/changelog.gz", "share/doc/nearfit/changelog.Debian.gz",
    "share/lintian/overrides/nearfit",
    *(f"share/nearfit/{file.relative_to(ROOT / 'resources')}" for folder in FOLDERS
      for file in (ROOT / "resources" / folder).rglob("*") if file.is_file()),
}
HOLDER = tempfile.TemporaryDirectory()
HOME = pathlib.Path(HOLDER.name) / "home"
TREE = pathlib.Path(HOLDER.name) / "tree"

# What a user types is in the array words; prints what bash offers, one a line.
ASK_BASH = """
source "$1"; shift
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
"$(complete -p "$1" | sed -E 's/.* -F ([^ ]+) .*/\\1/')" "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD-1]}"
printf '%s\\n' "${COMPREPLY[@]}"
"""
# The functions of zsh's completion replaced by ones that print what they are given: its own need a terminal.
ASK_ZSH = """
_arguments() { print -rl -- "$@"; state=$stage }
_describe() { print -rl -- "${(@P)2}" }
_files() { : }
file=$1 stage=$2 function=$3
shift 3
words=("$@")
# Loaded by zsh, it completes at once.
source $file >/dev/null
$function
"""


def package_of_build():
    """Files that the package makes in the build, with the times of their last changes."""
    folder = pathlib.Path(BUILD) / "resources/package"
    return {str(file.relative_to(folder)): file.stat().st_mtime_ns for file in folder.rglob("*")}


BEFORE = package_of_build()


def setUpModule():
    HOME.mkdir()
    result = subprocess.run([CMAKE, "--install", BUILD, "--prefix", str(TREE)], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def tearDownModule():
    HOLDER.cleanup()


def run(*command, **more):
    """Output of a command, which nothing of this environment leads to a build."""
    environment = {"PATH": os.environ["PATH"], "HOME": str(HOME), "LC_ALL": "C.UTF-8", "NEARFIT_CACHE": "off"}
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                          env={**environment, **more.pop("env", {})}, cwd=HOME, **more)


def helps(program, words=()):
    """Pairs of the words of each command, the program's own first, and its help."""
    text = run(TREE / "bin" / program, *words, "--help").stdout
    yield words, text
    below = re.search(r"^Subcommands:\n((?: {2}.*\n?)+)", text, re.M)
    for name in re.findall(r"^ {2}(\S+)", below.group(1) if below else "", re.M):
        yield from helps(program, (*words, name))


def options_of(text):
    """Options are indented by two, in a group by four; examples in the notes by more."""
    found = set()
    for names in re.findall(r"^ {2,4}(-\S+)", text, re.M):
        found.update(re.sub(r"\{.*", "", name) for name in names.split(","))
    return found


class InstallTree(unittest.TestCase):
    def good(self, result):
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def test_the_tree_holds_these_files_and_no_others(self):
        self.assertEqual({str(file.relative_to(TREE)) for file in TREE.rglob("*") if file.is_file()}, FILES)

    def test_installing_leaves_the_build_as_it_is(self):
        # Who installs may be root, and the files that it made were then root's, which the next build could not replace.
        self.assertIn("made/debian/changelog", BEFORE)
        self.assertEqual(package_of_build(), BEFORE)

    def test_what_is_loaded_or_run_may_be_changed_by_its_owner_alone(self):
        for folder in ("bin", "lib", "libexec"):
            for file in (TREE / folder).rglob("*"):
                if file.is_file():
                    self.assertEqual(file.stat().st_mode & 0o022, 0, file)
                    self.assertEqual(bool(file.stat().st_mode & 0o111), folder != "lib", file)

    def test_programs_say_the_version_of_the_project(self):
        for program in ("bin/nearfit", "bin/nearfit-cli", "libexec/nearfit/nearfit-import", "libexec/nearfit/nearfit-export"):
            lines = self.good(run(TREE / program, "--version")).split("\n")
            self.assertEqual(lines[0], f"{program.split('/')[-1]} {VERSION}")

    def test_the_command_line_reads_and_writes_cad_files_by_the_helpers_of_the_tree(self):
        step = HOME / "piston.step"
        self.good(run(TREE / "bin/nearfit-cli", "export", TREE / DEMO, "-o", step))
        self.assertIn("cylinder", self.good(run(TREE / "bin/nearfit-cli", "info", step)))
        # It is the tree's importer: elsewhere there is none.
        moved = TREE.parent / "moved"
        shutil.copytree(TREE / "bin", moved / "bin")
        refused = run(moved / "bin/nearfit-cli", "info", step)
        self.assertEqual(refused.returncode, 1)
        self.assertIn(str(moved / "bin/nearfit-import"), refused.stderr)
        self.assertIn("is missing", refused.stderr)

    def test_the_command_line_leads_the_part_of_the_demo(self):
        placed = HOME / "placed.json"
        self.good(run(TREE / "bin/nearfit-cli", "place", TREE / DEMO, "--part", "piston head", "--path",
                      TREE / "share/nearfit/demo/hand.csv", "--fast", "--export", placed))
        self.assertIn("piston head", placed.read_text())

    def test_plug_ins_and_udev_rules_of_the_tree_are_found(self):
        moved = TREE.parent / "plugins"
        shutil.copytree(TREE, moved, ignore=shutil.ignore_patterns("share", "libexec"))
        rules = moved / "lib/udev/rules.d/70-nearfit.rules"
        rules.write_text("# Rules of this tree.\n")
        self.assertEqual(self.good(run(moved / "bin/nearfit-cli", "devices", "--udev-rules")).strip(), "# Rules of this tree.")
        # One that is no plug-in is named with its folder.
        (moved / "lib/nearfit/plugins/broken.so").write_text("no library")
        said = run(moved / "bin/nearfit-cli", "devices")
        self.assertIn(str(moved / "lib/nearfit/plugins/broken.so"), said.stdout + said.stderr)

    def test_the_desktop_file_is_valid_and_starts_the_program_with_files(self):
        file = TREE / "share/applications/nearfit.desktop"
        self.assertEqual(self.good(run("desktop-file-validate", file)), "")
        keys = dict(line.split("=", 1) for line in file.read_text().split("\n") if "=" in line)
        self.assertEqual(keys["Exec"].split(), ["nearfit", "%F"])
        self.assertIn("application/x-nearfit-scene", keys["MimeType"].split(";"))
        self.assertTrue((TREE / f"share/icons/hicolor/scalable/apps/{keys['Icon']}.svg").is_file())

    def test_icons_have_the_sizes_that_their_folders_say(self):
        for size in SIZES:
            data = (TREE / f"share/icons/hicolor/{size}x{size}/apps/nearfit.png").read_bytes()
            self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual((int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")), (size, size))

    def test_scene_files_have_a_type_and_are_of_it_by_their_name(self):
        data = HOME / "share"
        (data / "mime").mkdir(parents=True)
        shutil.copytree(TREE / "share/mime/packages", data / "mime/packages")
        self.good(run("update-mime-database", data / "mime"))
        self.assertIn(":application/x-nearfit-scene:*.nearfit", (data / "mime/globs2").read_text())

    def test_the_metainfo_is_valid_and_of_this_version(self):
        file = TREE / "share/metainfo/org.nearfit.nearfit.metainfo.xml"
        said = run("appstreamcli", "validate", "--no-net", file).stdout
        self.assertRegex(said, "Validation (was successful|failed)")
        # There is no page on the web; later versions warn of that.
        self.assertEqual(set(re.findall(r"(?m)^[EW]: \S+ (\S+)", said)) - {"url-homepage-missing"}, set(), said)
        tree = xml.etree.ElementTree.parse(file)
        self.assertEqual(tree.find("releases/release").get("version"), VERSION)
        self.assertTrue((TREE / "share/applications" / tree.findtext("launchable")).is_file())
        for binary in tree.findall("provides/binary"):
            self.assertTrue((TREE / "bin" / binary.text).is_file())

    def test_manual_pages_name_every_command_and_option(self):
        for program in ("nearfit", "nearfit-cli"):
            page = TREE / f"share/man/man1/{program}.1.gz"
            shown = run("man", "--warnings", "-l", page, env={"MANWIDTH": "200", "MANPAGER": "cat"})
            self.assertEqual((shown.returncode, shown.stderr), (0, ""))
            source = gzip.decompress(page.read_bytes()).decode()
            for words, text in helps(program):
                if words:
                    self.assertIn(f'.SS "{" ".join(words)}"'.replace("-", "\\-"), source)
                for option in options_of(text):
                    self.assertRegex(shown.stdout, rf"(?m)^ +(\S+,)?{re.escape(option)}\b", (words, option))

    def test_bash_completes_every_command_and_option(self):
        for program in ("nearfit", "nearfit-cli"):
            file = TREE / f"share/bash-completion/completions/{program}"
            for words, text in helps(program):
                offered = self.good(run("bash", "-c", ASK_BASH, "bash", file, program, *words, "-")).split("\n")
                self.assertEqual(set(offered) - {""}, options_of(text), words)
            commands = {words[0] for words, _ in helps(program) if len(words) == 1}
            offered = self.good(run("bash", "-c", ASK_BASH, "bash", file, program, "")).split("\n")
            self.assertEqual({word for word in offered if word and not word.startswith("-")} & commands, commands)

    def test_bash_completes_values(self):
        (HOME / "some file.stl").write_text("")
        file = TREE / "share/bash-completion/completions/nearfit-cli"

        def offered(*words):
            return set(self.good(run("bash", "-c", ASK_BASH, "bash", file, "nearfit-cli", *words)).split("\n")) - {""}

        self.assertEqual(offered("lmd", "--law", ""), {"linear", "printed"})
        self.assertEqual(offered("lmd", "--law", "=", "p"), {"printed"})
        self.assertEqual(offered("lmd", "--law", "="), {"linear", "printed"})
        self.assertEqual(offered("scene", "re"), {"release", "refine"})
        self.assertEqual(offered("info", "some"), {"some file.stl"})
        self.assertEqual(offered("place", "--path", "some"), {"some file.stl"})
        self.assertIn("--arm", offered("place", "--device", "--a"))

    def test_zsh_completes_every_command_and_option(self):
        for program in ("nearfit", "nearfit-cli"):
            file = TREE / ZSH / f"_{program}"
            self.assertEqual(file.read_text().split("\n")[0], f"#compdef {program}")
            self.good(run("zsh", "-f", "-n", file))
            for words, text in helps(program):
                function = "_" + "_".join((program, *words))
                said = self.good(run("zsh", "-f", "-c", ASK_ZSH, "zsh", file, "", function, program)).split("\n")
                names = {found.group(1) for line in said
                         if (found := re.match(r"(?:\*|\([^)]*\))(-[^\[=+]*)[=+]?\[", line))}
                self.assertEqual(names, options_of(text), words)
            commands = {words[0] for words, _ in helps(program) if len(words) == 1}
            if commands:
                said = self.good(run("zsh", "-f", "-c", ASK_ZSH, "zsh", file, "command", f"_{program}", program)).split("\n")
                self.assertEqual({line.split(":")[0] for line in said} & commands, commands)
                # What comes behind a command is led to the function of that command.
                said = self.good(run("zsh", "-f", "-c", ASK_ZSH, "zsh", file, "rest", f"_{program}", "lmd")).split("\n")
                self.assertTrue(any("--cutoff=[" in line for line in said))

    def test_the_changelog_of_debian_begins_with_this_version(self):
        with gzip.open(TREE / "share/doc/nearfit/changelog.Debian.gz", "rt") as file:
            self.assertRegex(file.readline(), rf"^nearfit \({re.escape(VERSION)}-1~\S+\) \S+; urgency=medium$")
        with gzip.open(TREE / "share/doc/nearfit/changelog.gz", "rt") as file:
            self.assertEqual(file.read(), (ROOT / "CHANGELOG.md").read_text())


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
