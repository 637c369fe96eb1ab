"""Evaluation: the protocol (section 5 of the method), the measures, and every method that is compared.

    material  ->  splits  ->  methods (baselines/)  ->  measures  ->  report, plots
    timelines     who is       fit on the training       one number     Markdown, CSV,
    and motion    judged       part, predict the test    per method     PNG
"""
