"""Default values of options that commands and functions share. Imports nothing, so that help works without numpy."""

#: Kinds of corpora and models, and methods a model may be trained with; the first kind and the last method are the
#: default.
KINDS = ("speech", "laughter")
METHODS = ("paper", "labial")
#: Which of the faces in a video is the talker's.
WHICH_FACE = ("largest", "left", "right")
#: Frames per second of a model.
FPS = 50
#: States of each channel and components of each phoneme's mixture, the published ones; and those of Labial's method by
#: kind. States that track the motion (labial.train.states) are few, so that the search sees most of them.
CODEBOOK = 50
COMPONENTS = 5
SIZES = {"speech": (CODEBOOK, COMPONENTS), "laughter": (10, 1)}
#: Look-ahead of the kernels, seconds (docs/experiments.md compares others).
LOOK_AHEAD = 0.12
#: Frames that share a state of the decoded path. Targets move slowly enough that more states change nothing.
SEARCH_STRIDE = 3
#: Predecessors of each state that are kept in the exported tables.
PREDECESSORS = 4
#: Random splits of an evaluation, and episodes of the synthetic laughter corpus.
SPLITS = 20
EPISODES = 200
