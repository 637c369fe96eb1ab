"""Motion or phonemes as a C header: ``labial bake``."""
