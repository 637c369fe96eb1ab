"""Captures a corpus: from faces tracked in video to FAPs."""
