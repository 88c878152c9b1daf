# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program selvedge and reads what it says: progress, warnings, errors, results. Blender is not asked here."""

import dataclasses
import functools
import json
import os
import re
import select
import signal
import subprocess
import tempfile

PROGRESS = re.compile(r"(?P<what>[a-z][a-z ]*) (?P<at>\d+) of (?P<of>\d+), (?P<rate>\S+) frames/s, ?(?P<left>.*)$")
NOT_FOUND = "install it, or give its place in Preferences > Add-ons > Selvedge Cloth"


class Failure(Exception):
    """What is wrong, and how it is cured."""

    def __init__(self, what, cure=""):
        super().__init__(what + (f"\ncure: {cure}" if cure else ""))
        self.what, self.cure = what, cure


@dataclasses.dataclass
class Progress:
    what: str  # `frame`, or `draping`
    at: int
    of: int
    rate: float  # frames a second
    left: str  # time left, such as `3 min 20 s left`; empty where nothing is known yet


def read_progress(line):
    """A line of the program, or None where it is another one."""
    found = PROGRESS.match(line)
    if not found:
        return None
    return Progress(found["what"], int(found["at"]), int(found["of"]), float(found["rate"]), found["left"])


def read_failure(text):
    """What the program's last words (`selvedge: what`, `cure: how`) say, or None."""
    found = re.search(r"^selvedge: (?P<what>.+?)(?:\n\s*cure: (?P<cure>.+))?\s*\Z", text, re.M | re.S)
    return found and Failure(found["what"].strip(), (found["cure"] or "").strip())


class Run:
    """The program at work. It writes to a terminal of its own, as it shows progress ten times a second only there."""

    def __init__(self, program, arguments):
        self.progress, self.warnings, self.text = None, [], ""
        self.result = tempfile.TemporaryFile()
        self.waiting = ""  # the begin of a line
        self.terminal, theirs = os.openpty()
        try:
            self.process = subprocess.Popen(
                [program, *map(str, arguments), "--json"], stdin=subprocess.DEVNULL, stdout=self.result, stderr=theirs
            )
        except OSError as why:
            os.close(self.terminal)
            raise Failure(f"`{program}` cannot be started ({why.strerror})", NOT_FOUND) from why
        finally:
            os.close(theirs)

    def poll(self, seconds=0.0):
        """Reads what there is, for `seconds` at most. Returns the status of a program that has ended, else None."""
        if self.terminal is None:
            return self.process.returncode
        while select.select([self.terminal], [], [], seconds)[0]:
            seconds = 0.0
            try:
                said = os.read(self.terminal, 65536)
            except OSError:  # how Linux says that the other end is closed
                said = b""
            if not said:
                return self._end()
            self._take(said.decode(errors="replace"))
        return None

    def _take(self, said):
        *lines, self.waiting = re.split(r"[\r\n]+", (self.waiting + said).replace("\033[K", ""))
        for line in lines:
            progress = read_progress(line)
            self.progress = progress or self.progress
            if line.startswith("warning: "):
                self.warnings.append(line.removeprefix("warning: "))
            elif line and not progress:
                self.text += line + "\n"

    def _end(self):
        self._take("\n")
        os.close(self.terminal)
        self.terminal = None
        return self.process.wait()

    def stop(self):
        """Asks it to end as Ctrl-C does: it leaves whole files and a checkpoint."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)

    def json(self):
        """What it printed. Raises Failure with its own words where it ended with an error."""
        self.result.seek(0)
        try:
            if self.process.returncode in (0, 1):
                return json.loads(self.result.read())
        except ValueError:
            pass
        said = self.text.strip().splitlines()[-3:]
        raise read_failure(self.text) or Failure(
            f"the program ended with status {self.process.returncode}" + "".join(f"; {line}" for line in said)
        )


def said_by(program, *arguments):
    """What the program prints in a moment, as text."""
    try:
        done = subprocess.run(
            [program, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=20
        )
    except (OSError, subprocess.TimeoutExpired) as why:
        raise Failure(f"`{program}` cannot be started ({getattr(why, 'strerror', 'no answer')})", NOT_FOUND) from why
    if done.returncode != 0:
        raise read_failure(done.stderr) or Failure(f"`{program}` ended with status {done.returncode}", NOT_FOUND)
    return done.stdout


def version(program):
    """Such as `0.1.0`."""
    said = said_by(program, "--version").strip()
    if not re.fullmatch(r"\d+\.\d+\S*", said):
        raise Failure(f"`{program}` is not selvedge: it says `{said[:40]}`", NOT_FOUND)
    return said


@functools.lru_cache
def materials(program):
    """Names of the program's materials; none where it cannot be asked."""
    try:
        return json.loads(said_by(program, "info", "--json"))["materials"].split(", ")
    except (Failure, ValueError, KeyError):
        return []
