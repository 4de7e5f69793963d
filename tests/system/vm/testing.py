"""The list of tests and their order, and what a test gets to work with."""
import time

from machine import Failure

TESTS = []


class Skip(Exception):
    """The test cannot run here; the text says why."""


def test(function):
    """Adds a function to the list; its name is the test's, its arguments are (room)."""
    TESTS.append(function)
    return function


def expect(condition, what):
    if not condition:
        raise Failure(what)


class Room:
    """What tests share: the machine and what was found out about it in this run."""

    def __init__(self, machine, build, demo, units, artefacts):
        self.machine, self.build, self.demo, self.units, self.artefacts = machine, build, demo, units, artefacts
        self.cold_start_s = None  # of the kiosk: from start to first picture, measured in this boot
        self.figures = []         # lines for the report

    def say(self, line):
        self.figures.append(line)
        print(line, flush=True)

    def note(self, text):
        self.say(f"      {text}")

    def timed(self, what, action):
        started = time.monotonic()
        value = action()
        self.note(f"{what}: {time.monotonic() - started:.1f} s")
        return value
