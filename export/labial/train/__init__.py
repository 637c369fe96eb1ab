"""Training: from a corpus to the float model (:mod:`labial.tables.model`)."""

from labial.train.adapt import adapted
from labial.train.pipeline import backed_off, check_options, train, without_apex

__all__ = ["adapted", "backed_off", "check_options", "train", "without_apex"]
