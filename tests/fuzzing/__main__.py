"""Feed changed files and messages to everything that reads bytes of strangers.

    make fuzz MINUTES=15
    PYTHONPATH=. python -m tests.fuzzing --minutes 15 [--only NAME ...] [--seed 1] [--folder .fuzzing]
    PYTHONPATH=. python -m tests.fuzzing --only NAME --input FILE

A crash, a hang, memory beyond the limit, or an exception other than the errors of this project is a finding.
Its input is stored in the folder, beside the inputs that ended in new ways and are seeds of the next run.
"""

import argparse
import sys
import tempfile
import time
from pathlib import Path

from tests.fuzzing.campaign import CHECKOUT, outcome_of, run, store, stored_corpus
from tests.fuzzing.doors import DOORS
from tests.fuzzing.targets import TARGETS as READERS

TARGETS = (*READERS, *DOORS)
COLUMNS = "{:<16}{:>9}{:>9}{:>10}{:>8}{:>10}\n"


def main() -> int:
    """Run the targets one after the other, and print a table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--minutes", type=float, default=10.0, help="for all targets together")
    parser.add_argument("--only", nargs="*", default=[], metavar="NAME", help="targets")
    parser.add_argument("--seed", type=int, default=None, help="of the random changes; the time if not given")
    parser.add_argument("--folder", type=Path, default=CHECKOUT / ".fuzzing", help="of findings and corpus")
    parser.add_argument("--input", type=Path, help="a finding to be read once more")
    given = parser.parse_args()
    targets = [one for one in TARGETS if not given.only or one.name in given.only]
    if not targets:
        parser.error(f"targets are {', '.join(one.name for one in TARGETS)}")
    if given.input is not None:
        with tempfile.TemporaryDirectory() as folder, targets[0].opened(Path(folder)) as read:
            outcome = outcome_of(targets[0], read, given.input.read_bytes())
        sys.stdout.write(f"{outcome.problem or outcome.key}\n")
        return 1 if outcome.problem else 0
    seed = int(time.time()) if given.seed is None else given.seed
    sys.stdout.write(f"Seed {seed}\n{COLUMNS.format('', 'inputs', 'read', 'rejected', 'corpus', 'findings')}")
    files: list[Path] = []
    for target in targets:
        result = run(
            target,
            seconds=60.0 * given.minutes / len(targets),
            seed=seed,
            corpus=stored_corpus(given.folder, target),
        )
        files += store(given.folder, target, result)
        counts = (result.inputs, result.outcomes["read"], result.outcomes["rejected"])
        sys.stdout.write(COLUMNS.format(target.name, *counts, len(result.corpus), len(result.findings)))
        sys.stdout.flush()
    for file in files:
        sys.stdout.write(f"{file}: {file.with_name(f'{file.name}.txt').read_text().strip()[-200:]}\n")
    return 1 if files else 0


if __name__ == "__main__":
    sys.exit(main())
