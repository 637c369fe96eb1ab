"""The commands of ``labial``, one module each: its arguments and the code that it runs.

A command's module has two functions: ``add_arguments(command)`` adds the arguments to its
:class:`argparse.ArgumentParser`; ``run(options)`` does the work and returns the exit status. `labial.__main__` imports
only the module of the named command. At their top the modules import only what Python contains, so that help works
without numpy; a command imports other packages when it runs.
"""

from __future__ import annotations

from typing import Dict

#: The help of each command, in its order. The module of NAME is ``labial.commands.NAME``, with ``_`` for ``-``.
COMMANDS: Dict[str, str] = {
    "train": "train a model on a corpus",
    "train-words": "train how words sound on a pronouncing dictionary",
    "synth": "synthesise frames with the float64 reference",
    "hear": "make frames of speech from its sound alone",
    "timings": "turn phoneme timings of any format into a .lab",
    "align": "find the phonemes of a recording (English)",
    "bake": "turn timings, a sound or frames into a C header that a board plays",
    "export": "write a model as C tables",
    "check": "compare the C library with the float64 reference",
    "evaluate": "compare all methods with the human's motion on held-out episodes",
    "laughter-corpus": "generate the synthetic laughter corpus",
    "speech-corpus": "speak sentences with free synthesisers, for train-hear",
    "train-hear": "train a model of hearing on folders of speech (English)",
    "evaluate-hear": "compare lips from sound with those from true timings",
    "rig": "write a description of servos or blendshapes as a C table",
    "fit": "solve for a rig that shows on an avatar what the FAPs mean",
    "plot": "draw trajectories with their phonemes",
    "page": "write a page that plays motion",
    "landmarks": "track the face in a video, for record",
    "record": "make a corpus of tracked video (face landmarks)",
}
