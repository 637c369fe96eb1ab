"""The commands of ``labial``, one module each: its arguments and, beside them, what it runs.

A command's module has two functions. ``add_arguments(command)`` gives its :class:`argparse.ArgumentParser` the
arguments; ``run(options)`` does the work and returns the exit status. `labial.cli` loads the module of the command that
is asked for and no other. The modules import nothing at their top that needs more than Python itself, so that help can
be read where numpy is not installed; what a command needs it imports when it runs.
"""

from __future__ import annotations

from typing import Dict

#: What the help says of each command, in its order. The module of NAME is ``labial.commands.NAME``, with ``_`` for
#: ``-``.
COMMANDS: Dict[str, str] = {
    "train": "train a model on a corpus",
    "synth": "synthesise frames with the float64 reference",
    "timings": "turn phoneme timings of any format into a .lab",
    "align": "find the phonemes of a recording (English)",
    "bake": "turn timings, a sound or frames into a C header that a board plays",
    "export": "write a model as C tables",
    "check": "compare the C library with the float64 reference",
    "evaluate": "compare all methods with the human's motion on held-out episodes",
    "laughter-corpus": "generate the synthetic laughter corpus",
    "rig": "write a description of servos or blendshapes as a C table",
    "fit": "solve for a rig that shows on an avatar what the FAPs mean",
    "plot": "draw trajectories with their phonemes",
    "page": "write a page that plays motion",
    "landmarks": "track the face in a video, for record",
    "record": "make a corpus of tracked video (face landmarks)",
}
