"""Motion or phonemes as a C header to compile: ``labial bake``."""
