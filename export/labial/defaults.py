"""Values of options that commands and functions have in common. Nothing is imported, so that help is there without
numpy."""

#: Kinds of corpora and models, and methods a model may be trained with; the first kind and the last method are the
#: default.
KINDS = ("speech", "laughter")
METHODS = ("paper", "labial")

#: Which of the faces in a video is the talker's.
WHICH_FACE = ("largest", "left", "right")

#: Frames per second of a model.
FPS = 50

#: States of each channel and components of each phoneme's mixture.
CODEBOOK = 50
COMPONENTS = 5

#: Seconds that the kernels reach into what follows; see DESIGN.md for what more would buy.
LOOK_AHEAD = 0.12

#: Frames that share a state of the decoded path. Targets move slowly enough that more states change nothing.
SEARCH_STRIDE = 3

#: Predecessors of each state that are kept in the exported tables.
PREDECESSORS = 4

#: Random splits of an evaluation, and episodes of the synthetic laughter corpus.
SPLITS = 20
EPISODES = 200
