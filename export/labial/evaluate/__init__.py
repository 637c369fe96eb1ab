"""Evaluation: the protocol (``export/RESULTS.md``), the measures, and every method that is compared.

    material               ->  methods (baselines/)  ->  measures  ->  report, plots
    timelines and motion,      fit on the training       one number     Markdown, CSV,
    splits: who is judged      part, predict the test    per method     PNG

Laughter is judged by its pulses, speech by its closures.
"""
