"""Training: from a corpus to the float model (:mod:`labial.model`)."""

from labial.train.pipeline import backed_off, train

__all__ = ["backed_off", "train"]
