"""Evaluation: the protocol (``export/RESULTS.md``), the measures, and every method that is compared.

    material  ->  splits  ->  methods (baselines/)  ->  measures  ->  report, plots
    timelines     who is       fit on the training       one number     Markdown, CSV,
    and motion    judged       part, predict the test    per method     PNG

Laughter is judged by its pulses (``pulses.py``), speech by its closures. ``side_by_side.py`` draws the motion of
several models for one stream of phonemes, without human motion.
"""
