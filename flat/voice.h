/*
 * voice.h - a voice that is followed, for languages that call C (flat.h).
 */
#ifndef LABIAL_FLAT_VOICE_H
#define LABIAL_FLAT_VOICE_H

#include "flat.h"
#include "labial/voice.h"

/* Bytes of a voice with so many places of items (labial/voice.h), and of `count` items of a message. */
FLAT(voice_size) uint32_t voice_size(const labial_model_t *model, uint32_t places);
FLAT(voice_items_size) uint32_t voice_items_size(uint32_t count);

/* `numbers` are the model's phonemes of ARPABET in the order of words_label(), 40 of them, which must stay where they
 * are; null where they are the same. */
FLAT(voice_init)
int voice_init(labial_voice_t *voice, const labial_model_t *model, uint32_t places, const uint8_t *numbers,
               int32_t offset);

/* How words are pronounced from now on: `own` of words_own(), or null; or a function that is asked for each word. */
FLAT(voice_words) int voice_words(labial_voice_t *voice, const labial_words_own_t *own);
FLAT(voice_pronounce) int voice_pronounce(labial_voice_t *voice, labial_voice_own_fn own);

/*
 * A message of `count` items, made at `memory`. `times` are their beginnings and ends, in seconds; a negative end is
 * one that is not known, and items with other odd times are skipped. Of phonemes, `texts` are their numbers, a byte
 * each; of other kinds the texts one behind the other, and `sizes` their bytes. `key` is 0 for none, `gap`
 * milliseconds; `kind` and `counted` are a labial_voice_kind_t and a labial_voice_times_t.
 */
FLAT(voice_tell)
int voice_tell(labial_voice_t *voice, void *memory, uint32_t count, const double *times, const uint16_t *sizes,
               const char *texts, uint32_t utterance, uint32_t key, uint32_t gap, unsigned kind, unsigned counted);

FLAT(voice_identity) uint32_t voice_identity(const char *text, uint32_t size);

/* Seconds from which the next utterance's times count; a negative number for the end of the one before. */
FLAT(voice_begin) int voice_begin(labial_voice_t *voice, double at, uint32_t utterance);
FLAT(voice_finish) int voice_finish(labial_voice_t *voice);
FLAT(voice_cancel) int voice_cancel(labial_voice_t *voice, uint32_t milliseconds);

/* The next frame if it is due, which it is when `due` or a later one is. */
FLAT(voice_frame) int voice_frame(labial_voice_t *voice, uint32_t due, int16_t *faps);

/* The shares of its sounds; `shares` are those of the frame before, all 0 at first. */
FLAT(voice_visemes) int voice_visemes(const labial_voice_t *voice, uint8_t *shares);

/* The number of the frame that comes next; whether nothing more moves; whether it was finished, or cancelled, and
 * nothing begun since; the next pose on the way to rest after that; items told and skipped, messages dropped. */
FLAT(voice_next) uint32_t voice_next(const labial_voice_t *voice);
FLAT(voice_done) int voice_done(labial_voice_t *voice);
FLAT(voice_finished) int voice_finished(const labial_voice_t *voice);
FLAT(voice_cancelled) int voice_cancelled(const labial_voice_t *voice);
FLAT(voice_ease) int voice_ease(labial_voice_t *voice, int16_t *faps);
FLAT(voice_counts) void voice_counts(const labial_voice_t *voice, uint32_t *out);

/* A model whose tables were copied from another module's memory, `further` bytes behind where they were there (modulo
 * the size of addresses): sets their addresses. */
FLAT(voice_move) void voice_move(labial_model_t *model, size_t further);

#endif
