"""The run-time: the C library, called from Python. Needs neither numpy nor anything else that Python does not bring.

``import labial`` has all of it: :class:`labial.Stream`, :func:`labial.render`, :class:`labial.Model`,
:class:`labial.Rig`.
"""

#: The bundled models. The order of a kind's phonemes is part of the interface, so that their names are every model's.
BUNDLED = ("speech_en", "laughter_synthetic")
