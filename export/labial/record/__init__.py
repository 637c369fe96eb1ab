"""A corpus of one's own: from faces tracked in video to FAPs."""
