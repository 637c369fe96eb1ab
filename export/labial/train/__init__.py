"""Training: from a corpus to the float model (:mod:`labial.tables.model`)."""

from labial.train.pipeline import backed_off, check_options, train, without_apex
from labial.train.talkers import adapted

__all__ = ["adapted", "backed_off", "check_options", "train", "without_apex"]
