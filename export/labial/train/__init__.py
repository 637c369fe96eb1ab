"""Training: from a corpus to the float model (:mod:`labial.model`)."""

from labial.train.train import train

__all__ = ["train"]
