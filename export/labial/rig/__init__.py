"""Rigs: readable descriptions of what moves a face, as C tables for ``labial/rig.h`` and as drawings."""
