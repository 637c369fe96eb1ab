/*
 * words_en.h - how words sound, for labial/words.h. Written by labial export 0.4.0; do not edit.
 *
 * How long phonemes last was measured in speech of LibriSpeech (c) 2014 Vassil Panayotov and others and
 * LibriTTS (c) 2019 Heiga Zen and others, CC BY 4.0, https://www.openslr.org; the CSTR VCTK Corpus 0.92 (c) 2019 Junichi
 * Yamagishi and others, CC BY 4.0, https://datashare.ed.ac.uk/handle/10283/3443; CMU ARCTIC (c) 2003 Carnegie Mellon
 * University, John Kominek and Alan W Black, http://festvox.org/cmu_arctic.
 *
 * Trained on the CMU Pronouncing Dictionary, which comes with this notice:
 *
 * Copyright (C) 1993-2015 Carnegie Mellon University. All rights reserved.
 *
 * Redistribution and use in source and binary forms, with or without modification, are permitted provided that the
 * following conditions are met:
 *
 * 1. Redistributions of source code must retain the above copyright notice, this list of conditions and the following
 *    disclaimer. The contents of this file are deemed to be source code.
 *
 * 2. Redistributions in binary form must reproduce the above copyright notice, this list of conditions and the following
 *    disclaimer in the documentation and/or other materials provided with the distribution.
 *
 * This work was supported in part by funding from the Defense Advanced Research Projects Agency, the Office of Naval
 * Research and the National Science Foundation of the United States of America, and by member companies of the Carnegie
 * Mellon Sphinx Speech Consortium. We acknowledge the contributions of many volunteers to the expansion and improvement of
 * this dictionary.
 *
 * THIS SOFTWARE IS PROVIDED BY CARNEGIE MELLON UNIVERSITY ``AS IS'' AND ANY EXPRESSED OR IMPLIED WARRANTIES, INCLUDING,
 * BUT NOT LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE DISCLAIMED. IN NO
 * EVENT SHALL CARNEGIE MELLON UNIVERSITY NOR ITS EMPLOYEES BE LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL,
 * EXEMPLARY, OR CONSEQUENTIAL DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES; LOSS OF
 * USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT,
 * STRICT LIABILITY, OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS SOFTWARE, EVEN
 * IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
 */
#ifndef LABIAL_WORDS_WORDS_EN_H
#define LABIAL_WORDS_WORDS_EN_H

#include "labial/words.h"

#if LABIAL_WORDS_FORMAT != 2
#error "words_en was exported for another version of Labial: run labial export again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The tables, 38857 bytes and the structure that points to them. */
extern const labial_words_model_t words_en;

#ifdef __cplusplus
}
#endif

#endif
