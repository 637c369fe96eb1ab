"""The commands of ``labial``, in modules of commands that belong together: their arguments and the code that they run.

For each command NAME its module has two functions, with ``_`` for ``-``: ``add_NAME(command)`` adds the arguments to
its :class:`argparse.ArgumentParser`; ``run_NAME(options)`` does the work and returns an exit status other than 0.
`labial.__main__` imports only the module of the named command. At their top the modules import only what Python
contains, so that help works without numpy; a command imports other packages when it runs.
"""

from __future__ import annotations

from typing import Dict, Tuple

#: Of each command, in its order: the module in ``labial.commands``, and its help.
COMMANDS: Dict[str, Tuple[str, str]] = {
    "say": ("say", "show how a mouth says a text"),
    "train": ("train", "train a model on a corpus"),
    "train-words": ("train", "train how words sound on a pronouncing dictionary"),
    "synth": ("models", "synthesise frames with the float64 reference"),
    "hear": ("hear", "make frames of speech from its sound alone"),
    "timings": ("corpora", "turn phoneme timings of any format into a .lab"),
    "align": ("corpora", "find the phonemes of a recording (English)"),
    "bake": ("models", "turn timings, a sound or frames into a C header that a board plays"),
    "export": ("models", "write a model as C tables"),
    "check": ("models", "compare the C library with the float64 reference"),
    "evaluate": ("evaluate", "compare all methods with the human's motion on held-out episodes"),
    "laughter-corpus": ("corpora", "generate the synthetic laughter corpus"),
    "speech-corpus": ("corpora", "speak sentences with free synthesisers, for train-hear"),
    "train-hear": ("train", "train a model of hearing on folders of speech (English)"),
    "evaluate-hear": ("evaluate", "compare lips from sound with those from true timings"),
    "rig": ("faces", "write a description of servos or blendshapes as a C table"),
    "fit": ("faces", "solve for a rig that shows on an avatar what the FAPs mean"),
    "plot": ("faces", "draw trajectories with their phonemes"),
    "page": ("faces", "write a page that plays motion"),
    "landmarks": ("corpora", "track the face in a video, for record"),
    "record": ("corpora", "make a corpus of tracked video (face landmarks)"),
}
