"""English words to phonemes: the trainer of the tables behind ``labial/words.h``, and its reference decoder.

    dictionary  ->  alignment  ->  trees  ->  tables  ->  packing  ->  emit
    entries         letters to     questions  trees and   bytes        lib/words/NAME.c
                    phonemes       and cuts   exceptions

``questions`` defines what a tree may ask of a letter, and ``decoder`` reads a word from the trees as they were trained,
not from the bytes; so it is independent of the packing and of the C, which are compared with it.
"""
