"""The float64 reference of the run-time: the same steps, under the same names, as the C files of ``lib/``.

A step works on either kind of tables (:mod:`labial.reference.tables`): the trained model's, in floating point, or the
exported ones, on which every decision (component, state path) is taken in the library's own integers, so that what
remains to compare is arithmetic.
"""
