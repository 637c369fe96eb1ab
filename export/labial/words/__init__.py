"""English words to phonemes: the trainer of the tables behind ``labial/words.h``, and its reference decoder.

    dictionary  ->  alignment  ->  trees  ->  tables  ->  packing  ->  emit
    entries         letters to     questions  trees and   bytes        lib/words/NAME.c
                    phonemes       and cuts   exceptions

``tables`` reads a word from the trees as they were trained, not from the bytes: the packing and the C are compared with
it.
"""
