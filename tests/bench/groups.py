"""Groups of tests (tests/README.md) on a device that may fail: what crashes or hangs is told, and the rest runs."""

import collections
import dataclasses
import os
import pathlib
import re
import selectors
import subprocess
import threading
import time

LINE = re.compile(r"^\[ +(RUN|OK|FAILED|SKIPPED) +\] ([^\s,]+)")


@dataclasses.dataclass
class Verdict:
    """What became of the tests of a group, by their names."""

    passed: list = dataclasses.field(default_factory=list)
    failed: list = dataclasses.field(default_factory=list)
    skipped: list = dataclasses.field(default_factory=list)
    crashed: list = dataclasses.field(default_factory=list)  # ended their program
    hung: list = dataclasses.field(default_factory=list)     # said nothing for as long as `patience`
    not_run: list = dataclasses.field(default_factory=list)  # for want of time
    seconds: float = 0.0

    def text(self):
        """A line: counts, and the names of what did not pass."""
        counts = [f"{len(getattr(self, kind))} {kind.replace('_', ' ')}"
                  for kind in ("passed", "failed", "skipped", "crashed", "hung", "not_run") if getattr(self, kind)]
        return ", ".join(counts) or "no tests"

    def bad(self):
        return self.failed + self.crashed + self.hung


def tests_of(program, pattern, environment):
    """Names of the tests of a GoogleTest program."""
    lines = subprocess.run([*program, "--gtest_list_tests", f"--gtest_filter={pattern}"], check=True, timeout=60,
                           stdout=subprocess.PIPE, text=True, env=environment).stdout.splitlines()
    names, suite = [], ""
    for line in lines:
        name = line.split("#")[0].rstrip()
        if name and not name.startswith(" "):
            suite = name
        elif name and suite.endswith("."):
            names.append(suite + name.strip())
    return names


def run_group(program, pattern="*", environment=None, limit=600.0, patience=120.0, shards=1, log=os.devnull):
    """Runs the tests of a program (a command as a list) whose names match, so many suites at a time: its Verdict.

    limit, patience: seconds, of all and of one test. log: file that what they say is added to.
    """
    environment = {**os.environ, **(environment or {})}
    begun = time.monotonic()
    suites = collections.defaultdict(list)
    for name in tests_of(program, pattern, environment):
        suites[name.rpartition(".")[0]].append(name)
    waiting, verdict, lock = collections.deque(suites.values()), Verdict(), threading.Lock()

    def work():
        while True:
            with lock:
                if not waiting:
                    return
                names = waiting.popleft()
            while names:
                left = limit - (time.monotonic() - begun)
                if left <= 0:
                    with lock:
                        verdict.not_run += names
                    break
                text, names = _run(program, names, environment, left, patience, verdict, lock)
                with lock, open(log, "a", encoding="utf-8") as file:
                    file.write(text)

    threads = [threading.Thread(target=work) for _ in range(shards)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    verdict.seconds = time.monotonic() - begun
    return verdict


def _run(program, names, environment, limit, patience, verdict, lock):
    """Runs tests in one process until one ends it: (what it said, the tests that are left)."""
    process = subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               env={**environment, "GTEST_FILTER": ":".join(names), "GTEST_COLOR": "no"})
    selector = selectors.DefaultSelector()
    selector.register(process.stdout, selectors.EVENT_READ)
    said, rest, running, done = "", "", None, set()
    end, heard, hung = time.monotonic() + limit, time.monotonic(), False
    while True:
        now = time.monotonic()
        if now > end or now > heard + patience:
            hung = now <= end
            process.kill()
            break
        if not selector.select(min(end, heard + patience) - now + 0.01):
            continue
        part = os.read(process.stdout.fileno(), 1 << 16).decode(errors="replace")
        if not part:
            break
        said += part
        *lines, rest = (rest + part).split("\n")
        for line in lines:
            match = LINE.match(line)
            # The list of what failed at the end repeats names.
            if not match or match[2] not in names or match[2] in done:
                continue
            heard = time.monotonic()
            if match[1] == "RUN":
                running = match[2]
                continue
            done.add(match[2])
            running = None
            with lock:
                {"OK": verdict.passed, "FAILED": verdict.failed, "SKIPPED": verdict.skipped}[match[1]].append(match[2])
    process.wait()
    left = [name for name in names if name not in done]
    if not left:
        return said, []
    if time.monotonic() > end and not hung:
        with lock:
            verdict.not_run += left
        return said, []
    blamed = running or left[0]
    with lock:
        (verdict.hung if hung else verdict.crashed).append(blamed)
    return said + f"\n{blamed} {'hung' if hung else f'ended the program with {process.returncode}'}\n", [
        name for name in left if name != blamed]


def layers(*folders):
    """The environment in which the loader finds Vulkan layers there, in that order, and the installed ones."""
    installed = ["/etc/vulkan/explicit_layer.d", "/usr/share/vulkan/explicit_layer.d"]
    return {"VK_LAYER_PATH": ":".join([*map(str, folders), *filter(os.path.isdir, installed)])}


def tail(file, lines=3):
    """The last words of a log."""
    path = pathlib.Path(file)
    return " / ".join(path.read_text(errors="replace").strip().splitlines()[-lines:]) if path.exists() else ""
