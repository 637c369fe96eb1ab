"""The run-time: the C library, called from Python. Needs only Python, not even numpy.

``import labial`` has all of it: :class:`labial.Stream`, :func:`labial.render`, :class:`labial.Model`,
:class:`labial.Rig`.
"""
