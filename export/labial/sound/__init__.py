"""Sound: reading sound and video, and forced alignment of phonemes (``labial align``)."""
