/*
 * flat.h - the library for languages that call C: pointers, numbers and texts, and no structure whose layout a caller
 * must know. Python calls it by ctypes (export/labial/core/library.py), JavaScript as a WebAssembly module (web). All
 * memory is the caller's, aligned to eight bytes; nothing here allocates.
 *
 * Results are those of labial/labial.h. What is not said here is as in the library's headers. Faces, hearing, words and
 * voices have a section and a file each; the rest is in flat.c.
 */
#ifndef LABIAL_FLAT_H
#define LABIAL_FLAT_H

#include "labial/blend.h"
#include "labial/blob.h"
#include "labial/face.h"
#include "labial/hear.h"
#include "labial/labial.h"
#include "labial/laugh.h"
#include "labial/names.h"
#include "labial/rig.h"
#include "labial/timings.h"
#include "labial/visemes.h"
#include "labial/voice.h"
#include "labial/words.h"

/* Version of this interface; the Python package refuses a library of another one. */
#define FLAT_INTERFACE 8

/* Stands before each function that other languages call; nothing else leaves the module or the shared library, where
 * their symbols begin with flat_. flat/CMakeLists.txt makes the list of them that Python binds, so that they are
 * declared here and nowhere else. */
#if defined(__wasm__)
#define FLAT(name) __attribute__((export_name(#name)))
#elif defined(_WIN32)
#define FLAT(name) __declspec(dllexport)
#else
#define FLAT_PRAGMA(text) _Pragma(#text)
#define FLAT(name) FLAT_PRAGMA(redefine_extname name flat_##name) __attribute__((visibility("default")))
#endif

/* Defines a function that does no more than to return a value. */
#define FLAT_RETURNS(function, value)                                                                                  \
    function                                                                                                           \
    {                                                                                                                  \
        return value;                                                                                                  \
    }

/* A stream with all that belongs to it. */
typedef struct {
    labial_t stream;
    int16_t faps[LABIAL_CHANNELS];  /* of the frame delivered last */
    uint8_t shares[LABIAL_VISEMES]; /* of its sounds */
    const labial_model_t *speech;   /* the model whose phonemes have visemes; null before one was used */
    int32_t state;                  /* result of the last tick */
    uint8_t moved;                  /* whether the last tick delivered a face */
    uint8_t exact, ended;           /* the argument of mouth_exact(); whether no more phonemes will come */
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4u];
} mouth_t;

/* FLAT_INTERFACE, "MAJOR.MINOR.PATCH", the method that the library is built for ("labial" or "paper"), and a sentence
 * for a result. */
FLAT(interface) uint32_t interface(void);
FLAT(version) const char *version(void);
FLAT(method) const char *method(void);
FLAT(result_text) const char *result_text(int result);

/* The functions with FLAT() by number: the name, and the types of the result and of the arguments, separated by blanks;
 * null beyond the last. Not in WebAssembly, whose exports say that themselves. */
#ifndef __wasm__
FLAT(function) const char *function(unsigned number);
#endif

/* Bytes of what the caller makes room for: a stream, a loaded model, a laugh, a parser of timings, an output and a
 * curve of a rig. */
FLAT(mouth_size) uint32_t mouth_size(void);
FLAT(blob_size) uint32_t blob_size(void);
FLAT(laugh_size) uint32_t laugh_size(void);
FLAT(timings_size) uint32_t timings_size(void);
FLAT(rig_output_size) uint32_t rig_output_size(void);
FLAT(rig_curve_size) uint32_t rig_curve_size(void);

/* The bundled models by number: name, tables and phonemes' names; null beyond the last, and for tables that are not
 * linked. */
FLAT(bundled_name) const char *bundled_name(unsigned number);
FLAT(bundled_model) const labial_model_t *bundled_model(unsigned number);
FLAT(bundled_names) const labial_names_t *bundled_names(unsigned number);

/* Of a model: phonemes, the number of its silence, frames per second, frames that share a step of the search. */
FLAT(model_phonemes) unsigned model_phonemes(const labial_model_t *model);
FLAT(model_silence) unsigned model_silence(const labial_model_t *model);
FLAT(model_fps) unsigned model_fps(const labial_model_t *model);
FLAT(model_stride) unsigned model_stride(const labial_model_t *model);
FLAT(model_load) int model_load(labial_blob_t *blob, const void *data, uint32_t size);

/* Of names: how many there are, the label of each, "" beyond the last; labial_find_in() and labial_find_nearest(). */
FLAT(names_phonemes) unsigned names_phonemes(const labial_names_t *names);
FLAT(label_at) const char *label_at(const labial_names_t *names, unsigned phoneme);
FLAT(find) int find(const labial_names_t *names, unsigned labels, const char *name, uint32_t length);
FLAT(find_nearest)
int find_nearest(const labial_names_t *names, unsigned labels, const char *name, uint32_t length, unsigned silence);

/* A stream. mouth_faps() is where the face that mouth_tick() delivered last lies, mouth_moved() whether the last one
 * did: also one that comes to rest while phonemes are late. */
FLAT(mouth_init) int mouth_init(mouth_t *mouth, const labial_model_t *model);
FLAT(mouth_use) int mouth_use(mouth_t *mouth, const labial_model_t *model);
FLAT(mouth_push) int mouth_push(mouth_t *mouth, unsigned phoneme, uint32_t milliseconds);
FLAT(mouth_room) unsigned mouth_room(const mouth_t *mouth);
FLAT(mouth_end) int mouth_end(mouth_t *mouth);
FLAT(mouth_cancel) int mouth_cancel(mouth_t *mouth, uint32_t milliseconds);
FLAT(mouth_restart) int mouth_restart(mouth_t *mouth);
FLAT(mouth_articulation) int mouth_articulation(mouth_t *mouth, unsigned percent);
FLAT(mouth_exact) int mouth_exact(mouth_t *mouth, unsigned exact);
FLAT(mouth_tick) int mouth_tick(mouth_t *mouth);
FLAT(mouth_moved) unsigned mouth_moved(const mouth_t *mouth);
FLAT(mouth_faps) const int16_t *mouth_faps(const mouth_t *mouth);

/* The shares of the sounds of the frame that was delivered last, LABIAL_VISEMES of them (labial/visemes.h). */
FLAT(mouth_visemes) const uint8_t *mouth_visemes(const mouth_t *mouth);

FLAT(mouth_state) int mouth_state(const mouth_t *mouth);

/* What it holds: frames, milliseconds, phonemes, and its delay in frames (labial_latency_t). */
FLAT(mouth_held) uint32_t mouth_held(const mouth_t *mouth);
FLAT(mouth_milliseconds) uint32_t mouth_milliseconds(const mouth_t *mouth);
FLAT(mouth_waiting) unsigned mouth_waiting(const mouth_t *mouth);
FLAT(mouth_delay) unsigned mouth_delay(const mouth_t *mouth);

/* Ticks until `count` frames lie at `out`, and their shares at `shares` unless that is null, or no more can be had;
 * they are as many as it returns, unless it is an error. Ticks that bring nothing before the first frame are made, too.
 * As these follow no clock, the face stays where it is while phonemes are late. */
FLAT(mouth_run) int mouth_run(mouth_t *mouth, int16_t *out, uint8_t *shares, unsigned count);

/* A laugh; laugh_next() writes a phoneme and its milliseconds. */
FLAT(laugh_init) int laugh_init(labial_laugh_t *laugh, uint32_t milliseconds, unsigned intensity, uint32_t seed);
FLAT(laugh_next) int laugh_next(labial_laugh_t *laugh, uint32_t *out);

FLAT(blend) int blend(unsigned intensity, unsigned words, const int16_t *speech, const int16_t *laugh, int16_t *out);

/* An output of a rig from FLAT_OUTPUT numbers: 13 weights; gain, neutral, minimum, maximum, invert, contact, closed;
 * slew, deadband, acceleration; how many segments its curve has, 0 for none, and three numbers of each; 1 where it has
 * amounts of visemes, and these. Curve and amounts lie at `more`, rig_curve_size() bytes, and must stay there. */
#define FLAT_OUTPUT (LABIAL_CHANNELS + 11 + 3 * LABIAL_RIG_SEGMENTS + 1 + LABIAL_VISEMES)
FLAT(rig_output) void rig_output(labial_rig_output_t *output, void *more, const int32_t *numbers);
FLAT(rig_check) int rig_check(const labial_rig_output_t *outputs, unsigned count);

/* Values of a rig at rest; moved on by the first of `frames` frames (labial_rig_apply_visemes_ahead()); those of a
 * frame alone. `shares` may be null. */
FLAT(rig_rest) int rig_rest(const labial_rig_output_t *outputs, unsigned count, int32_t *values);
FLAT(rig_apply)
int rig_apply(const labial_rig_output_t *outputs, unsigned count, const int16_t *faps, const uint8_t *shares,
              unsigned frames, int32_t *values, int32_t *changes);
FLAT(rig_weigh)
void rig_weigh(const labial_rig_output_t *outputs, unsigned count, const int16_t *faps, const uint8_t *shares,
               int32_t *values);

/* Formats of timings by number: name and suffix; null beyond the last. */
FLAT(timings_name) const char *timings_name(unsigned format);
FLAT(timings_suffix) const char *timings_suffix(unsigned format);

/* A parser; `tier` stays the caller's, null without. */
FLAT(timings_init)
int timings_init(labial_timings_t *timings, unsigned format, const char *tier, unsigned tier_number);

/* A timing: `times` are start, end and apex in seconds, the last one -1 without; `numbers` how many bytes were taken,
 * the line, a laugh's intensity or -1, and 1 where labels are X-SAMPA. timings_label() and timings_word() are its
 * texts, or null; timings_message() and timings_line() say what is wrong, and where. */
FLAT(timings_next)
int timings_next(labial_timings_t *timings, const char *text, uint32_t size, double *times, int32_t *numbers);
FLAT(timings_end) int timings_end(labial_timings_t *timings, double *times, int32_t *numbers);
FLAT(timings_label) const char *timings_label(const labial_timings_t *timings);
FLAT(timings_word) const char *timings_word(const labial_timings_t *timings);
FLAT(timings_message) const char *timings_message(const labial_timings_t *timings);
FLAT(timings_line) uint32_t timings_line(const labial_timings_t *timings);

#ifdef FLAT_FACES
/* The rigs of labial_faces by number: the name of each and of its outputs, null beyond the last; thousandths of the
 * weights of a frame. What the licence of the speech model's data asks to be said. */
FLAT(face_name) const char *face_name(unsigned face);
FLAT(weight_name) const char *weight_name(unsigned face, unsigned weight);
FLAT(weigh) void weigh(unsigned face, const int16_t *faps, const uint8_t *shares, int32_t *out);
FLAT(attribution) const char *attribution(void);
#endif

/* ---- Faces (servos.c; labial/face.h) ----------------------------------------------------------------------------- */

/* A face with its rig; its memory follows. */
typedef struct {
    labial_face_t face;
    labial_rig_t rig;
} servos_t;

/* Bytes of a face of so many outputs, 1 .. 65535, that looks `ahead` frames ahead, up to LABIAL_FACE_AHEAD_MAX. */
FLAT(servos_size) uint32_t servos_size(unsigned outputs, unsigned ahead);

/* The outputs must stay where they are, and so must the face. */
FLAT(servos_init)
int servos_init(servos_t *servos, const labial_rig_output_t *outputs, unsigned count, unsigned ahead);
FLAT(servos_frame) int servos_frame(servos_t *servos, const int16_t *faps, const uint8_t *shares);
FLAT(servos_values) int servos_values(servos_t *servos, const int32_t *wanted);
FLAT(servos_tick) int servos_tick(servos_t *servos, int32_t *values);
FLAT(servos_play) int servos_play(servos_t *servos);
FLAT(servos_skip) int servos_skip(servos_t *servos, unsigned count);
FLAT(servos_cancel) int servos_cancel(servos_t *servos, uint32_t milliseconds);
FLAT(servos_soft_start) int servos_soft_start(servos_t *servos, unsigned ticks);
FLAT(servos_attached) unsigned servos_attached(const servos_t *servos);
FLAT(servos_place) int servos_place(servos_t *servos, const int32_t *values);

/* ---- Hearing (ears.c; labial/hear.h) ----------------------------------------------------------------------------- */

/* A stream of sound with all that belongs to it. */
typedef struct {
    labial_hear_t hear;
    /* Where the frames of the present call go, their sounds, and the stretches of one class; null: nowhere. */
    int16_t *faps;
    uint8_t *visemes;
    uint32_t *stretches;
    uint32_t room;        /* for each */
    uint32_t frame_count; /* how many there were in the last call */
    uint32_t stretch_count;
    uint32_t workspace[LABIAL_HEAR_WORKSPACE_SIZE(LABIAL_HEAR_UNITS_MAX, 255) / 4u];
} ears_t;

FLAT(ears_size) uint32_t ears_size(void);

/* The bundled models of hearing by number: name and tables, null beyond the last. */
FLAT(hearing_name) const char *hearing_name(unsigned number);
FLAT(hearing_model) const labial_hear_model_t *hearing_model(unsigned number);

/* Of a bundled model: how many classes it has, and the name of each, null beyond the last. */
FLAT(hearing_classes) unsigned hearing_classes(unsigned number);
FLAT(hearing_class) const char *hearing_class(unsigned number, unsigned shown);

FLAT(ears_init)
int ears_init(ears_t *ears, const labial_hear_model_t *model, uint32_t samples_per_second, unsigned channels);

/* Milliseconds from the begin of a frame until it is ready. */
FLAT(ears_latency) uint32_t ears_latency(const ears_t *ears);

/* These write the frames that they deliver to `faps`, 13 numbers each, the shares of their sounds to `visemes`, 15
 * each, and the stretches of one class to `stretches`, class, first frame and number of frames, up to `room` of each.
 * They return how many frames there were, or an error; ears_stretches() is how many stretches. */
FLAT(ears_push)
int ears_push(ears_t *ears, const int16_t *samples, uint32_t count, int16_t *faps, uint8_t *visemes,
              uint32_t *stretches, uint32_t room);
FLAT(ears_end) int ears_end(ears_t *ears, int16_t *faps, uint8_t *visemes, uint32_t *stretches, uint32_t room);
FLAT(ears_cancel)
int ears_cancel(ears_t *ears, uint32_t milliseconds, int16_t *faps, uint8_t *visemes, uint32_t *stretches,
                uint32_t room);
FLAT(ears_stretches) uint32_t ears_stretches(const ears_t *ears);
FLAT(ears_exact) int ears_exact(ears_t *ears, unsigned exact);
FLAT(ears_level) unsigned ears_level(const ears_t *ears);
FLAT(ears_set_level) int ears_set_level(ears_t *ears, unsigned level);
FLAT(ears_articulation) int ears_articulation(ears_t *ears, unsigned percent);
FLAT(ears_restart) int ears_restart(ears_t *ears);

/* ---- Words to phonemes, with the tables words_en (words.c; labial/words.h) --------------------------------------- */

/* A part of its own with voices: in npm it is the module of the package labial-words. */

/* Bytes of a stream of words, of what goes from word to word, and of `count` words of the caller's own. */
FLAT(words_size) uint32_t words_size(void);
FLAT(words_context_size) uint32_t words_context_size(void);
FLAT(words_own_size) uint32_t words_own_size(unsigned count);

/* Words of the caller's own from `packed`, which must stay where it is: of each the text, NUL, the number of its
 * phonemes and these. Returns what the functions below take as `own`, at `memory`. */
FLAT(words_own) const labial_words_own_t *words_own(void *memory, unsigned count, const char *packed);

/* The label of a phoneme, "" beyond the last. */
FLAT(words_label) const char *words_label(unsigned phoneme);

/* Reads the next word of a text; `context` is all zero at its beginning. `out` has 3 + 3 * LABIAL_WORDS_PHONEMES bytes:
 * the number of phonemes, that of the word's characters, how many phonemes the word before loses at its end; then of
 * each phoneme its number, its character and whether a spoken word begins. Returns the word's kind. */
FLAT(words_read)
int words_read(const labial_words_own_t *own, labial_words_context_t *context, const char *text, uint32_t size,
               uint8_t *out);

/* A stream of words; words_next() writes a phoneme and its milliseconds. */
FLAT(words_init) int words_init(labial_words_t *stream, const labial_words_own_t *own, int32_t offset);
/* Other words of the caller's own, for the words that follow. */
FLAT(words_pronounce) void words_pronounce(labial_words_t *stream, const labial_words_own_t *own);
FLAT(words_push)
int words_push(labial_words_t *stream, const char *text, uint32_t size, uint32_t start, uint32_t end);
FLAT(words_push_characters)
int words_push_characters(labial_words_t *stream, const char *text, uint32_t size, uint32_t start, const uint32_t *ends,
                          unsigned count);
FLAT(words_end) int words_end(labial_words_t *stream);
FLAT(words_restart) int words_restart(labial_words_t *stream);
FLAT(words_next) int words_next(labial_words_t *stream, uint32_t *out);

/* ---- A voice that is followed (voice.c; labial/voice.h) ---------------------------------------------------------- */

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
