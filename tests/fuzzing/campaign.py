"""Runs a target on changed inputs in a process of its own, and collects findings.

An input that ends in a way not seen before (another error, or one raised at another place) becomes a seed.
That leads deep into a reader without measuring its coverage.
"""

import hashlib
import json
import os
import random
import resource
import shutil
import signal
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from tests.fuzzing.mutation import mutated
from tests.fuzzing.targets import CHECKOUT, Read, Target, check_error
from tracker.errors import NavigationError

# Of the processor, for one small input; the slowest seed takes a tenth of a second.
MAX_SECONDS = 10.0
# A reader that waits for ever takes no processor time.
MAX_WAITING_S = 120.0
# Above what the seeds take.
MAX_RESIDENT_MB = 500.0
MAX_ADDRESS_BYTES = 3 * 2**30
MAX_CORPUS = 2000
PRODUCT = (f"{CHECKOUT}/server/", f"{CHECKOUT}/tracker/")
OF_SIGNAL = {
    signal.SIGPROF: "hang",
    signal.SIGALRM: "hang (waits)",
    signal.SIGKILL: "killed, perhaps out of memory",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """How a reader ended.

    Attributes:
        key: equal for inputs that end in the same way at the same place.
        problem: traceback of a finding; empty if there is none.
    """

    key: str
    problem: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """An input that crashes, hangs, takes too much memory, or ends in an error of a library."""

    target: str
    kind: str
    content: bytes
    problem: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """When a process ends: at this monotonic time, or after so many inputs or findings."""

    until_s: float
    inputs: int
    findings: int


@dataclass(slots=True, kw_only=True)
class Result:
    """What was tried of a target.

    Attributes:
        inputs: number of inputs.
        corpus: seeds, and inputs that ended in a new way.
        findings: one for each place.
        outcomes: number of inputs that were read, rejected, or a finding.
    """

    inputs: int = 0
    corpus: list[bytes] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    outcomes: Counter[str] = field(default_factory=Counter)


def outcome_of(target: Target, read: Read, content: bytes) -> Outcome:
    """Read one input."""
    try:
        read(target.wrap(content))
    except NavigationError as error:
        try:
            check_error(error)
        except Exception as broken:  # noqa: BLE001  each is a finding
            return _found(broken)
        return Outcome(key=f"{error.code} {_places(error)[-3:]}")
    except target.expected as error:
        return Outcome(key=f"{type(error).__name__} {_places(error)[-3:]}")
    except Exception as error:  # noqa: BLE001  each is a finding
        return _found(error)
    return Outcome(key="read")


def run(
    target: Target,
    *,
    seconds: float,
    seed: int,
    corpus: Iterable[bytes] = (),
    max_inputs: int = 2**40,
    max_findings: int = 20,
) -> Result:
    """Try changed inputs for this time, in processes that are started again after findings that end one."""
    result = Result(corpus=list(dict.fromkeys([*target.seeds(), *corpus])))
    until_s = time.monotonic() + seconds
    seen: set[str] = set()
    while time.monotonic() < until_s and result.inputs < max_inputs and len(result.findings) < max_findings:
        limits = Limits(
            until_s=until_s,
            inputs=max_inputs - result.inputs,
            findings=max_findings - len(result.findings),
        )
        with tempfile.TemporaryDirectory(prefix="coaxial-fuzzing-") as folder:
            _run_process(target, result, seen, limits, seed=seed, folder=Path(folder))
        seed += 1_000_003
    return result


def _run_process(
    target: Target, result: Result, seen: set[str], limits: Limits, *, seed: int, folder: Path
) -> None:
    pid = os.fork()
    if pid == 0:
        # A child of a fork must not go on as its parent.
        try:
            _try_inputs(target, result.corpus, seen, limits, seed=seed, folder=folder)
        except BaseException:  # noqa: BLE001  reported by the parent
            (folder / "failure").write_text(traceback.format_exc())
        os._exit(0)
    _, status = os.waitpid(pid, 0)
    if (folder / "failure").exists():
        raise RuntimeError(f"{target.name} cannot be tried: {(folder / 'failure').read_text()}")
    for line in _lines(folder / "outcomes"):
        one = json.loads(line)
        content = bytes.fromhex(one["content"])
        seen.add(one["key"])
        if one["problem"]:
            result.findings.append(
                Finding(target=target.name, kind=one["kind"], content=content, problem=one["problem"])
            )
        elif len(result.corpus) < MAX_CORPUS:
            result.corpus.append(content)
    for line in _lines(folder / "counts")[-1:]:
        counts = Counter(json.loads(line))
        result.outcomes += counts
        result.inputs += counts.total()
    if os.WIFSIGNALED(status):
        ended = signal.Signals(os.WTERMSIG(status))
        kind = OF_SIGNAL.get(ended, f"crash ({ended.name})")
        content = (folder / "current").read_bytes()
        result.outcomes["finding"] += 1
        result.findings.append(Finding(target=target.name, kind=kind, content=content, problem=kind))


def _try_inputs(
    target: Target, corpus: Sequence[bytes], seen: set[str], limits: Limits, *, seed: int, folder: Path
) -> None:
    """The child: try inputs, and write what was new about them and which is being tried."""
    rng, seeds, counts = random.Random(seed), list(corpus), Counter[str]()
    work = folder / "work"
    work.mkdir()
    silent = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silent, 1)
    os.dup2(silent, 2)
    current = os.open(folder / "current", os.O_RDWR | os.O_CREAT)
    with target.opened(work) as read, (folder / "outcomes").open("w", buffering=1) as outcomes:
        for content in seeds:
            _timed(target, read, content, current)
        before_mb = _peak_mb()
        limit = _address_bytes() + MAX_ADDRESS_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        counts_file = os.open(folder / "counts", os.O_WRONLY | os.O_CREAT)
        while (
            time.monotonic() < limits.until_s
            and counts.total() < limits.inputs
            and counts["finding"] < limits.findings
        ):
            content = mutated(rng.choice(seeds), seeds, rng)
            outcome = _timed(target, read, content, current)
            kind = "error" if outcome.problem else ""
            if _peak_mb() > before_mb + MAX_RESIDENT_MB:
                kind = "memory"
                outcome = Outcome(
                    key=f"memory {outcome.key}", problem=f"{_peak_mb() - before_mb:.0f} MB more"
                )
            counts["finding" if outcome.problem else "read" if outcome.key == "read" else "rejected"] += 1
            os.pwrite(counts_file, json.dumps(counts).encode().ljust(200), 0)
            if outcome.key not in seen and len(seeds) < MAX_CORPUS:
                seen.add(outcome.key)
                if not outcome.problem:
                    seeds.append(content)
                found = {
                    "key": outcome.key,
                    "kind": kind,
                    "problem": outcome.problem,
                    "content": content.hex(),
                }
                outcomes.write(json.dumps(found) + "\n")
            if kind == "memory":
                # The peak of this process stays; another one goes on.
                return
            if counts.total() % 500 == 0:
                _remove_files(work)


def _timed(target: Target, read: Read, content: bytes, current: int) -> Outcome:
    """Read an input, which is in the file `current` meanwhile; a timer ends the process if it takes long."""
    os.ftruncate(current, 0)
    os.pwrite(current, content, 0)
    signal.setitimer(signal.ITIMER_PROF, MAX_SECONDS)
    signal.setitimer(signal.ITIMER_REAL, MAX_WAITING_S)
    try:
        return outcome_of(target, read, content)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _remove_files(work: Path) -> None:
    """Remove large files that a reader left behind."""
    for path in work.rglob("*"):
        with suppress(OSError):
            if path.is_file() and path.stat().st_size > 2**24:
                path.unlink()


def _found(error: Exception) -> Outcome:
    lines = "".join(traceback.format_exception(error))
    text = lines.encode("ascii", "backslashreplace").decode()
    return Outcome(key=f"{type(error).__name__} {_places(error)[-2:]}", problem=text[-6000:])


def _places(error: BaseException) -> list[str]:
    """Return file and line of the product's frames, the innermost last."""
    frames = traceback.extract_tb(error.__traceback__)
    return [f"{Path(one.filename).name}:{one.lineno}" for one in frames if one.filename.startswith(PRODUCT)]


def _peak_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def _address_bytes() -> int:
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()


def _lines(file: Path) -> list[str]:
    if not file.exists():
        return []
    # A killed process leaves an incomplete line.
    return [one for one in file.read_text(encoding="utf-8").split("\n")[:-1] if one] or [
        one for one in [file.read_text(encoding="utf-8").strip()] if one.endswith("}")
    ]


def stored_corpus(folder: Path, target: Target) -> list[bytes]:
    """Return the inputs that earlier runs kept."""
    return [path.read_bytes() for path in sorted((folder / "corpus" / target.name).glob("*"))]


def store(folder: Path, target: Target, result: Result) -> list[Path]:
    """Write corpus and findings; return the files of the findings."""
    known = {_name(one) for one in target.seeds()}
    _write(
        folder / "corpus" / target.name, {_name(one): one for one in result.corpus if _name(one) not in known}
    )
    shutil.rmtree(folder / "findings" / target.name, ignore_errors=True)
    files = {}
    for one in result.findings:
        files[_name(one.content)] = one.content
        files[f"{_name(one.content)}.txt"] = f"{one.kind}\n{one.problem}\n".encode()
    _write(folder / "findings" / target.name, files)
    return [folder / "findings" / target.name / _name(one.content) for one in result.findings]


def _write(folder: Path, files: dict[str, bytes]) -> None:
    if files:
        folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)


def _name(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:16]
