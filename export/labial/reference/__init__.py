"""The float64 reference of the run-time: the steps of the C files of ``lib/``, under the same names.

A step works on either kind of tables (:mod:`labial.reference.tables`): those of the trained model, in floating point,
or the exported ones. On exported tables every decision (component, state path) uses the library's integers, so that
only arithmetic remains to be compared.
"""
