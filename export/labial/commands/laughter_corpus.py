"""``labial laughter-corpus``: the synthetic corpus of laughter."""

from __future__ import annotations

import argparse

from labial.defaults import EPISODES
from labial.files.arguments import positive, seed


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A folder, the number of episodes and the seed."""
    command.add_argument("output", metavar="OUT", help="folder, new or empty")
    command.add_argument("--episodes", type=positive, default=EPISODES)
    command.add_argument("--seed", type=seed, default=0)


def run(options: argparse.Namespace) -> int:
    """Writes the corpus."""
    from labial.corpus.laughter import generate

    generate(options.output, episodes=options.episodes, seed=options.seed)
    print(f"{options.output}: {options.episodes} synthetic episodes")
    return 0
