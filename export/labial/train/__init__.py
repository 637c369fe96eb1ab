"""Training: from a corpus to the float model (:mod:`labial.model`)."""

from labial.train.pipeline import backed_off, check_options, train, without_apex

__all__ = ["backed_off", "check_options", "train", "without_apex"]
