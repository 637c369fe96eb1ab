"""Forced alignment: which phoneme of a recording is spoken when (``labial align``)."""
