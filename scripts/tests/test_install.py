#!/usr/bin/python3
"""Tests of what build/ installs: the program, the library that other
programs find, and the package.

All is installed into an empty folder, which is then moved, and runs from a third one with an empty
environment, while the source tree cannot be seen: an empty folder is mounted over
it, where the system allows that.
"""
from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"
VERSION = re.search(
    r"project\(foldproof VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
).group(1)
HEADER_OF_CPP = re.compile(r"[a-z0-9_]+")        # <vector>; <unistd.h> is none
LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)")    # of Markdown, to a file


def output_of(*words: str | Path, folder: Path | None = None) -> str:
    """Output of a command; if it fails, its messages are the error."""
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise AssertionError(f"{words}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Installation:
    """A prefix that was moved, and a folder beside it to work in."""

    def __init__(self, folder: Path) -> None:
        self.prefix, self.work = folder / "moved here", folder / "work"
        self.work.mkdir()
        output_of("cmake", "--install", BUILD, "--prefix", folder / "prefix")
        (folder / "prefix").rename(self.prefix)
        (folder / "nothing").mkdir()
        self.blind = self._blindfold(folder / "nothing")

    def _blindfold(self, nothing: Path) -> list[str]:
        """Words before a command that is not to see the source tree; none where nobody may
        mount."""
        mount = ["--mount", "sh", "-c", 'mount --bind "$0" "$1" && shift && exec "$@"',
                 str(nothing), str(ROOT)]
        for words in (["unshare", *mount], ["unshare", "--user", "--map-root-user", *mount]):
            done = subprocess.run([*words, "ls", ROOT], capture_output=True, text=True,
                                  check=False, env={})
            if done.returncode == 0 and not done.stdout:
                return words
        print("test_install: nobody may mount here; the source tree stays in sight")
        return []

    def run(self, *arguments: str, program: Path | None = None) -> subprocess.CompletedProcess[str]:
        """The installed program, or another, typed in the folder `work`."""
        return subprocess.run(
            [*self.blind, program or self.prefix / "bin/foldproof", *arguments], cwd=self.work,
            env={}, capture_output=True, text=True, check=False)

    def files(self) -> dict[str, tuple[int, int]]:
        """All that is installed, folders included: size, and time of the last change [ns]."""
        return {str(path.relative_to(self.prefix)): (path.lstat().st_size, path.lstat().st_mtime_ns)
                for path in sorted(self.prefix.rglob("*"))}


def setUpModule() -> None:  # noqa: N802
    """Installs once, for all tests."""
    folder = tempfile.TemporaryDirectory(prefix="foldproof install ")
    unittest.addModuleCleanup(folder.cleanup)
    Installed.here = Installation(Path(folder.name))


class Installed(unittest.TestCase):
    """Shared by all tests."""
    here: Installation

    def run_well(self, *arguments: str, **how: Path) -> subprocess.CompletedProcess[str]:
        """Of the installed program, with exit code 0."""
        done = self.here.run(*arguments, **how)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done


class Program(Installed):
    """The program, from any folder."""

    def test_a_shipped_case_becomes_a_page_and_nothing_is_written_beside_the_program(self) -> None:
        before = self.here.files()
        # the first reads a mesh beside its file
        for case in ("any_mesh", "hinge.toml", "hard/sharp_fold"):
            done = self.here.run("simulate", case, "--set", "time.end=0.05", "--out", "out")
            self.assertIn("t = 0.05 s", done.stdout, done.stderr)
        self.assertEqual(self.run_well("report", "out").stdout, "out/report.html\n")
        page = (self.here.work / "out/report.html").read_text(encoding="utf-8")
        self.assertTrue('<code class="command">foldproof simulate any_mesh' in page
                        and "build/foldproof" not in page)
        self.run_well("export", "out/any_mesh.h5", "--format", "obj", "--out", "frames")
        done = self.here.run("film", "out/hinge.h5", "--size", "160x90")
        self.assertTrue(done.returncode == 0 or "ffmpeg" in done.stderr, done.stderr)
        self.assertEqual(self.here.files(), before)
        with h5py.File(self.here.work / "out/any_mesh.h5") as file:
            self.assertEqual(file.attrs["case_folder"],
                             str(self.here.prefix / "share/foldproof/cases"))

    def test_checks_know_their_claims_faults_and_cases(self) -> None:
        self.run_well("check", "dynamics.solves-are-counted", "case.sharp_fold.folds-back-to",
                      "--out", "checked")
        self.run_well("claims", "T19", "--out", "checked")
        with h5py.File(self.here.work / "checked/run.h5") as file:
            self.assertEqual((file.attrs["version"], file.attrs["subject_version"]),
                             (VERSION, VERSION))
            self.assertGreater(len(file["findings/dynamics.solves-are-counted"].attrs["faults"]), 0)

    def test_it_says_where_its_cases_are_and_what_it_misses(self) -> None:
        self.assertIn(f"Cases are {self.here.prefix}/share/foldproof/cases/NAME.toml.",
                      self.here.run("list").stdout)
        self.assertIn("`foldproof list cases` shows the shipped ones",
                      self.here.run("simulate", "nowhere").stderr)
        self.assertIn("`foldproof verify --out none`",
                      self.here.run("claims", "--out", "none").stderr)
        alone = self.here.work / "alone/bin/foldproof"
        alone.parent.mkdir(parents=True)
        shutil.copy(self.here.prefix / "bin/foldproof", alone)
        self.assertIn(f"foldproof {VERSION} ", self.here.run("--version", program=alone).stdout)
        if self.here.blind:
            done = self.here.run("simulate", "hinge", program=alone)
            self.assertEqual(done.returncode, 2)
            self.assertIn("alone/share/foldproof nor in", done.stderr)

    def test_bash_completes_names_of_shipped_cases(self) -> None:
        program = self.here.prefix / "bin/foldproof"
        completion = self.here.prefix / "share/bash-completion/completions/foldproof"
        lines = [f"source '{completion}'",
                 f"COMP_WORDS=('{program}' simulate garm) COMP_CWORD=2", "_foldproof",
                 'echo "${COMPREPLY[@]}"']
        self.assertEqual(output_of("bash", "-c", "\n".join(lines), folder=self.here.work),
                         "garment\n")

    def test_links_of_its_pages_lead_somewhere(self) -> None:
        pages = self.here.prefix / "share/doc/foldproof"
        for name in ("README.md", "reports/TUTORIAL.md", "verification/subjects/PROTOCOL.md"):
            for link in LINK.findall((pages / name).read_text(encoding="utf-8")):
                self.assertTrue(((pages / name).parent / link).exists(), f"{name}: {link}")
        for name in ("LICENSE", "copyright", "GPL-3.txt", "MPL-2.0.txt"):
            self.assertGreater((pages / name).stat().st_size, 1000)

    def test_another_solver_is_put_on_trial(self) -> None:
        toy = self.here.prefix / "share/doc/foldproof/verification/subjects/adapters/toy_solver.py"
        self.run_well("judge", "--solver",
                      f"PYTHONDONTWRITEBYTECODE=1 exec /usr/bin/python3 '{toy}'")

    def test_versions_agree(self) -> None:
        self.assertRegex((ROOT / "CITATION.cff").read_text(encoding="utf-8"),
                         rf"(?m)^version: {re.escape(VERSION)}$")


class Library(Installed):
    """foldproof::reference, as another program finds it."""

    def test_its_headers_include_each_other_eigen_and_the_standard_library(self) -> None:
        include = self.here.prefix / "include/foldproof"
        headers = sorted(path for path in include.rglob("*") if path.is_file())
        self.assertGreater(len(headers), 50)
        for path in headers:
            for named in re.findall(r"^#include (.*)$", path.read_text(encoding="utf-8"), re.M):
                is_there = named[0] == '"' and (include / named.strip('"')).is_file()
                is_allowed = (named.startswith("<Eigen/")
                              or HEADER_OF_CPP.fullmatch(named.strip("<>")))
                self.assertTrue(is_there or is_allowed, f"{path}: {named}")

    def test_the_example_finds_it_and_hangs_a_sheet(self) -> None:
        example = self.here.prefix / "share/doc/foldproof/reference/example"
        made = self.here.work / "example"
        self.cmake(example, made, "-DCMAKE_BUILD_TYPE=Release",
                   "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        output_of("cmake", "--build", made)
        heights = [float(line.split()[2]) for line in output_of(made / "hung_sheet").splitlines()]
        self.assertEqual((len(heights), heights[0]), (11, 1.0))
        self.assertTrue(1.005 < heights[-1] < 1.1, heights)  # it hangs, and stretches by its weight
        linked = output_of("ldd", made / "hung_sheet")
        for name in ("gsl", "toml", "hdf5"):
            self.assertNotIn(name, linked)

    def test_the_paper_s_method_stands_without_what_it_does_not_have(self) -> None:
        archives = [next(self.here.prefix.rglob(f"libfoldproof_{name}.a"))
                    for name in ("method", "geometry")]
        main = self.here.work / "linked.cpp"
        main.write_text("int main() {}\n", encoding="utf-8")
        libraries = ["-ltbb", "-lz"]  # all of the archives is linked, and nothing may be missing
        output_of("c++", "-o", self.here.work / "linked", main, "-Wl,--whole-archive", *archives,
                  "-Wl,--no-whole-archive", *libraries)
        headers = self.here.prefix / "include/foldproof/reference"
        for folder in ("mesh", "motion", "forces", "filters", "dynamics", "level_set", "post"):
            for header in (headers / folder).glob("*.h"):
                self.assertNotIn('#include "reference/beyond/', header.read_text(encoding="utf-8"),
                                 header)

    def test_it_is_found_by_versions_that_it_serves(self) -> None:
        asking = self.here.work / "versions"
        asking.mkdir()
        asked = ("0.1", "0.2", VERSION, "0.3", "1.0")
        lines = ["cmake_minimum_required(VERSION 3.25)", "project(versions LANGUAGES CXX)"]
        lines += [f'find_package(foldproof {version} QUIET)\nmessage("${{foldproof_FOUND}}")'
                  for version in asked]
        (asking / "CMakeLists.txt").write_text("\n".join(lines), encoding="utf-8")
        self.assertEqual(re.findall(r"^[01]$", self.cmake(asking, asking / "build"), re.M),
                         ["0", "1", "1", "0", "0"])

    def test_its_files_for_cmake_name_no_place(self) -> None:
        for path in (self.here.prefix / "lib/cmake/foldproof").iterdir():
            text = path.read_text(encoding="utf-8")
            self.assertNotIn(str(ROOT), text)
            self.assertNotIn("foldproof install ", text)

    def cmake(self, source: Path, made: Path, *options: str) -> str:
        """Output of CMake as it configures `source`, with the source tree of foldproof hidden."""
        done = subprocess.run(
            [*self.here.blind, "cmake", "-S", source, "-B", made,
             f"-DCMAKE_PREFIX_PATH={self.here.prefix}", *options],
            capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout + done.stderr


@unittest.skipUnless(all(map(shutil.which, ("dpkg-deb", "dpkg-shlibdeps", "file"))),
                     "needs Debian's dpkg-dev and file")
class Package(Installed):
    """The .deb."""
    package: Path

    @classmethod
    def setUpClass(cls) -> None:
        folder = cls.here.work / "package"
        output_of("cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", folder)
        cls.package = next(folder.glob("*.deb"))

    def test_it_names_its_version_and_needs(self) -> None:
        architecture = output_of("dpkg", "--print-architecture").strip()
        self.assertEqual(self.package.name, f"foldproof_{VERSION}_{architecture}.deb")
        needs = output_of("dpkg-deb", "-f", self.package, "Depends")
        for name in ("libc6", "libstdc++6", "libgsl", "libhdf5", "libfmt", "libtbb",
                     "python3-matplotlib", "python3-h5py", "python3-jinja2"):
            self.assertRegex(needs, rf"(^|, ){re.escape(name)}")

    def test_it_holds_what_is_installed_and_all_of_it_belongs_to_root(self) -> None:
        contents = output_of("dpkg-deb", "--contents", self.package)
        rows = [row.split(maxsplit=5) for row in contents.splitlines()]
        self.assertEqual({row[1] for row in rows}, {"root/root"})
        held = {row[5].removeprefix("./usr/").rstrip("/") for row in rows} - {"", "./usr", "."}
        self.assertEqual(held, set(self.here.files()))
        self.assertTrue(all(not row[0].startswith("d") or row[0] == "drwxr-xr-x" for row in rows))

    def test_its_copyright_says_what_is_gpl_and_what_is_not(self) -> None:
        text = (self.here.prefix / "share/doc/foldproof/copyright").read_text(encoding="utf-8")
        head, *others = [
            dict(re.findall(r"^([A-Z][\w-]*):[ \n]*((?:.*)(?:\n .*)*)", part, re.M))
            for part in text.split("\n\n")
        ]
        self.assertIn("packaging-manuals/copyright-format/1.0/", head["Format"])
        self.assertEqual(head["License"], "GPL-3+")
        self.assertIn("GNU Scientific Library", head["Comment"])
        licences = {row["Files"].split()[0]: row["License"] for row in others if "Files" in row}
        self.assertEqual(licences["reference/*"], "BSD-3-Clause")
        self.assertEqual(licences["usr/bin/foldproof"], "GPL-3+")
        texts = {row["License"].splitlines()[0] for row in others
                 if "Files" not in row and "\n" in row["License"]}
        self.assertEqual(set(licences.values()) | {head["License"]}, texts)

    def test_it_installs_into_an_empty_system_and_runs(self) -> None:
        root = self.here.work / "root"
        if os.geteuid() == 0:
            known = root / "var/lib/dpkg"
            known.mkdir(parents=True)
            (known / "status").touch()
            output_of("dpkg", f"--root={root}", "--force-depends", "--force-not-root",
                      "--log=/dev/null", "-i", self.package)
            self.assertIn("install ok installed",
                          output_of("dpkg-query", f"--admindir={known}", "-s", "foldproof"))
        else:
            output_of("dpkg-deb", "-x", self.package, root)
        program = root / "usr/bin/foldproof"
        done = self.here.run("simulate", "garment", "--set", "time.end=0.001", "--out",
                             "of_package", program=program)
        self.assertIn("t = 0.001 s", done.stdout, done.stderr)
        self.assertNotIn(".symtab", output_of("readelf", "-S", program))


if __name__ == "__main__":
    unittest.main()
