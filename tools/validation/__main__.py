"""The gallery of validation: runs the cases and compares their numbers with exact, computed and reported ones.

usage: python tools/validation [--quick] [--case NAME ...] [--page]
--quick: only the runs that `make test` makes; --page: writes docs/validation.md and docs/validation/ (all cases).
Exit code 1 where a line leaves its bound that is not known to do so.
"""

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import page
from cases import CASES
from page import allowed, difference, number, within
from runs import Finished, program


def shown(case, finished):
    """Prints the lines of a case; those outside of their bounds that are not known to be."""
    bad = []
    for line, value in finished.numbers(case):
        met = within(line, value)
        word = "within" if met else "OUTSIDE (known)" if line.open else "OUTSIDE"
        text = (
            f"{case.name}: {line.quantity}: {number(value, line.unit)}, reference {number(line.reference, line.unit)}"
        )
        print(f"{text}: {difference(line, value)} of {allowed(line)} allowed: {word}", flush=True)
        if not met and not line.open:
            bad.append(text)
    return bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--case", action="append", choices=[case.name for case in CASES])
    args = parser.parse_args()
    if args.quick and args.page:
        parser.error("the page has all runs: leave out --quick")
    chosen = [case for case in CASES if not args.case or case.name in args.case]
    binary, bad, outcomes = program(), [], []
    with tempfile.TemporaryDirectory() as folder:
        for case in chosen:
            labels = [label for label in case.runs if not args.quick or label in case.quick]
            if not labels:
                continue
            finished = Finished()
            for label in labels:
                finished.add(binary, case, label, Path(folder))
            print(f"{case.name}: {sum(finished.seconds.values()):.1f} s", flush=True)
            bad += shown(case, finished)
            outcomes.append((case, finished))
        if args.page:
            for case, finished in outcomes:
                page.picture(binary, case, finished)
            if not args.case:
                page.write(outcomes)
    if bad:
        sys.exit("\n".join(["outside of their bounds:", *bad]))


if __name__ == "__main__":
    main()
