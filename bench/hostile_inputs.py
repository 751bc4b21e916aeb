"""Wrong, odd and hostile inputs by the thousand: each gives a sound result or one clear error.

    ./trackvib exec -- python bench/hostile_inputs.py KIND --count 3000 --seed 1

Right is a sound result, or a refusal in plain lines that say what is accepted, within a minute and 1 GB. Ends with exit
code 1 if anything is wrong. What a kind is stands at the head of its module in `hostile/`.
"""

import argparse
import random
import resource
import sys
import warnings
from collections import Counter
from importlib import import_module

from hostile.trial import outcome
from machine import machine
from rich.console import Console
from rich.table import Table

KINDS = ("vehicles", "plans", "options", "parameters", "messages", "bags", "bag_verbs")
MEMORY = 1_000_000  # kB


def main():
    """Print the table; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("--count", type=int, default=1000, help="inputs")
    parser.add_argument("--seed", type=int, default=1)
    choices = parser.parse_args()
    kind, tried, right = import_module(f"hostile.{choices.kind}"), Counter(), Counter()
    for done, attempt in kind.trials(random.Random(choices.seed), choices.count):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # numpy's, of overflow on the way to an error
            result, wrong = outcome(attempt, kind.REFUSALS)
        tried[result] += 1
        right[result] += not wrong
        if wrong:
            print(f"{done}: {wrong}", flush=True)
    table = Table("outcome", choices.kind, "right", title=f"{machine()}; seed {choices.seed}")
    for result, count in tried.most_common():
        table.add_row(result, str(count), str(right[result]))
    Console().print(table)
    memory = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    print(f"{tried.total()} tried, {tried.total() - right.total()} wrong; most memory {memory // 1000} MB")
    return 1 if right != tried or memory > MEMORY else 0


if __name__ == "__main__":
    sys.exit(main())
