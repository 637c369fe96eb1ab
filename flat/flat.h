/*
 * flat.h - the library for languages that call C: pointers, numbers and texts, and no structure whose layout a caller
 * must know. Python calls it by ctypes (export/labial/core/library.py), JavaScript as a WebAssembly module (web). All
 * memory is the caller's, aligned to eight bytes; nothing here allocates.
 *
 * Results are those of labial/labial.h. What is not said here is as in the library's headers.
 */
#ifndef LABIAL_FLAT_H
#define LABIAL_FLAT_H

#include "labial/blend.h"
#include "labial/blob.h"
#include "labial/labial.h"
#include "labial/laugh.h"
#include "labial/names.h"
#include "labial/rig.h"
#include "labial/timings.h"
#include "labial/visemes.h"

/* Version of this interface; the Python package refuses a library of another one. */
#define FLAT_INTERFACE 8

/* Stands before each function that other languages call; nothing else leaves the module or the shared library, where
 * their symbols begin with flat_. flat/CMakeLists.txt makes the list of them that Python binds, so that they are declared
 * here and in the other headers of this folder, and nowhere else. */
#if defined(__wasm__)
#define FLAT(name) __attribute__((export_name(#name)))
#elif defined(_WIN32)
#define FLAT(name) __declspec(dllexport)
#else
#define FLAT_PRAGMA(text) _Pragma(#text)
#define FLAT(name) FLAT_PRAGMA(redefine_extname name flat_##name) __attribute__((visibility("default")))
#endif

/* A stream with all that belongs to it. */
typedef struct {
    labial_t stream;
    int16_t faps[LABIAL_CHANNELS];  /* of the frame delivered last */
    uint8_t shares[LABIAL_VISEMES]; /* of its sounds */
    const labial_model_t *speech;   /* the model whose phonemes have visemes; null before one was used */
    int32_t state;                  /* result of the last tick */
    uint8_t moved;                  /* whether the last tick delivered a face */
    uint8_t exact, ended;           /* what mouth_exact() was told; whether no more phonemes will come */
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4u];
} mouth_t;

/* FLAT_INTERFACE, "MAJOR.MINOR.PATCH", the method that the library is built for ("labial" or "paper"), and a sentence for
 * a result. */
FLAT(interface) uint32_t interface(void);
FLAT(version) const char *version(void);
FLAT(method) const char *method(void);
FLAT(result_text) const char *result_text(int result);

/* The functions with FLAT() by number: the name, and the types of the result and of the arguments, separated by blanks;
 * null beyond the last. Not in WebAssembly, whose exports say that themselves. */
#ifndef __wasm__
FLAT(function) const char *function(unsigned number);
#endif

/* Bytes of what the caller makes room for: a stream, a loaded model, a laugh, a parser of timings, an output and a curve
 * of a rig. */
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

/* Ticks until `count` frames lie at `out`, and their shares at `shares` unless that is null, or no more can be had; they are as many as it returns, unless it is an error.
 * Ticks that bring nothing before the first frame are made, too. As these follow no clock, the face stays where it is
 * while phonemes are late. */
FLAT(mouth_run) int mouth_run(mouth_t *mouth, int16_t *out, uint8_t *shares, unsigned count);

/* A laugh; laugh_next() writes a phoneme and its milliseconds. */
FLAT(laugh_init) int laugh_init(labial_laugh_t *laugh, uint32_t milliseconds, unsigned intensity, uint32_t seed);
FLAT(laugh_next) int laugh_next(labial_laugh_t *laugh, uint32_t *out);

FLAT(blend) int blend(unsigned intensity, unsigned words, const int16_t *speech, const int16_t *laugh, int16_t *out);

/* An output of a rig from FLAT_OUTPUT numbers: 13 weights; gain, neutral, minimum, maximum, invert, contact, closed; slew,
 * deadband, acceleration; how many segments its curve has, 0 for none, and three numbers of each; 1 where it has
 * amounts of visemes, and these. Curve and amounts lie at `more`, rig_curve_size() bytes, and must stay there. */
#define FLAT_OUTPUT (LABIAL_CHANNELS + 11 + 3 * LABIAL_RIG_SEGMENTS + 1 + LABIAL_VISEMES)
FLAT(rig_output) void rig_output(labial_rig_output_t *output, void *more, const int32_t *numbers);
FLAT(rig_check) int rig_check(const labial_rig_output_t *outputs, unsigned count);

/* Values of a rig at rest; moved on by the first of `frames` frames (labial_rig_apply_visemes_ahead()); those of a frame
 * alone. `shares` are null where they are not known. */
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

/* A timing: `times` are start, end and apex in seconds, the last one -1 without; `numbers` how many bytes were taken, the
 * line, a laugh's intensity or -1, and 1 where labels are X-SAMPA. timings_label() and timings_word() are its texts, or
 * null; timings_message() and timings_line() say what is wrong, and where. */
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

#endif
