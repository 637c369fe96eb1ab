/*
 * fixture.h - what the tests share: small models made by hand, streams of phonemes, a host that plays them.
 *
 * The models are built at run time from plain numbers, so that a test may change one value of a copy. Nothing here
 * depends on a test framework; the fuzz targets use it too.
 */
#ifndef LABIAL_TEST_FIXTURE_H
#define LABIAL_TEST_FIXTURE_H

#include <stddef.h>
#include <stdint.h>

#include "labial/labial.h"
#include "labial/names.h"
#include "labial/rig.h"

/* Rounds of a test that does the same over and over with other numbers: `full` of them, or, where every instruction is
 * interpreted (the memory check), a share that still takes every way through the code. */
#ifndef LABIAL_TEST_SHARE
#define LABIAL_TEST_SHARE 1
#endif
#define FIXTURE_ROUNDS(full) ((full) / LABIAL_TEST_SHARE > 0 ? (full) / LABIAL_TEST_SHARE : 1)

/* ---- Pseudo-random numbers: the same on every machine for one seed. ---- */

typedef struct {
    uint32_t state;
} fixture_random_t;

uint32_t fixture_random(fixture_random_t *random);                /* 32 bits */
uint32_t fixture_below(fixture_random_t *random, uint32_t limit); /* 0 .. limit - 1 */

/* Those of a test, from the seed that it sets. */
extern fixture_random_t fixture_dice;

/* Notes and returns a seed. What was noted last since a test began, and how often, goes with the test's failures. */
uint32_t fixture_seed(uint32_t seed);
uint32_t fixture_seed_last(void);
unsigned long fixture_seed_count(void);
void fixture_seed_forget(void);

/* ---- Models ---- */

#define FIXTURE_PHONEMES 8
#define FIXTURE_COMPONENTS 16
#define FIXTURE_CLASSES 4
#define FIXTURE_TAPS 7
#define FIXTURE_KERNEL_WORDS LABIAL_KERNEL_WORDS(LABIAL_CHANNELS)
#define FIXTURE_FLOORS 4
#define FIXTURE_PREDECESSORS 8 /* of each state, at most */
#define FIXTURE_PAIR_SIDE 3    /* known neighbours of each phoneme, to either side */
#define FIXTURE_PAIRS (6 * 2 * FIXTURE_PAIR_SIDE)

/* A model with the tables that it points to. Must not be moved: fixture_*() are called on the place it stays in. */
typedef struct {
    labial_model_t model;
    labial_channel_t channels[LABIAL_CHANNELS];
    labial_phoneme_t phonemes[FIXTURE_PHONEMES];
    labial_component_t components[FIXTURE_COMPONENTS];
    uint8_t contexts[FIXTURE_COMPONENTS * FIXTURE_CLASSES];
    int8_t shapes[FIXTURE_COMPONENTS * LABIAL_CHANNELS];
    int8_t slopes[FIXTURE_COMPONENTS * LABIAL_CHANNELS];
    uint32_t kernels[FIXTURE_PHONEMES * FIXTURE_TAPS * FIXTURE_KERNEL_WORDS];
    uint16_t pair_keys[FIXTURE_PAIRS];
    int8_t pairs[FIXTURE_PAIRS * 2 * LABIAL_CHANNELS];
    int16_t floors[FIXTURE_FLOORS * LABIAL_CHANNELS];
    uint16_t contacts[FIXTURE_FLOORS];
    labial_protrusion_t protrusion;
    labial_emission_t emissions[LABIAL_CHANNELS][LABIAL_STATES_MAX];
    labial_state_t states[LABIAL_CHANNELS][LABIAL_STATES_MAX];
    labial_transition_t transitions[LABIAL_CHANNELS][LABIAL_STATES_MAX * FIXTURE_PREDECESSORS];
    uint8_t initials[LABIAL_CHANNELS][LABIAL_STATES_MAX];
} fixture_model_t;

/* Phonemes of the two speech fixtures. */
enum { FIXTURE_SIL, FIXTURE_A, FIXTURE_O, FIXTURE_P, FIXTURE_S, FIXTURE_T, FIXTURE_SPEECH_COUNT };

/* Phonemes of the laughter fixture; silence is not its first one. */
enum { FIXTURE_HA, FIXTURE_NASAL, FIXTURE_LAUGH_SIL, FIXTURE_FRICATIVE, FIXTURE_LAUGH_COUNT };

#define FIXTURE_SPEECH_STATES 8
#define FIXTURE_LAUGH_STATES 5
#define FIXTURE_RATE 50
#define FIXTURE_STRIDE 2 /* of the rich and the laughter fixture, which can be used in one stream */

/* The published method alone: no optional table, hard selection, a state for every frame. The first component of every
 * phoneme lasts 100 ms and every channel has a state whose mean is exactly that component's shape. */
void fixture_plain(fixture_model_t *fixture);

/* The same phonemes with contexts, slopes, anchors, kernels (where LABIAL_REACH has room for any), pairs of two knots,
 * floors (where it has room for contacts) and soft selection; FIXTURE_STRIDE frames share a state. Of the floors of P and
 * S some are contact, silence comes to rest on some of its channels, O has plain ones. */
void fixture_rich(fixture_model_t *fixture);

/* Other phonemes, other states, fewer predecessors, no optional table; the same frame rate and stride as the rich one. */
void fixture_laughter(fixture_model_t *fixture);

/* The rich model with LABIAL_STATES_MAX states, of which three frames share one, and kernels that reach as far as they
 * may, to both sides. */
void fixture_slow(fixture_model_t *fixture);

/* Takes channels of a fixture away, which has all: its tables are written again with those alone that are their own source
 * in `sources` (13 channels of a frame), in this order. If FAP 17 is LABIAL_FROM_CORNERS, a table of it is added, whose
 * values go up and down by a FAP unit for each unit of the corners at most. */
void fixture_narrow(fixture_model_t *fixture, const uint8_t sources[LABIAL_CHANNELS]);

/* Sources: all channels but FAP 17, which is computed; those of the left side, which the right one mirrors; the left side
 * after the right one, and FAP 16 after FAP 3. */
extern const uint8_t fixture_computed[LABIAL_CHANNELS], fixture_mirrored[LABIAL_CHANNELS],
    fixture_crossed[LABIAL_CHANNELS];

/* The four that have all channels. */
void fixture_all(fixture_model_t *plain, fixture_model_t *rich, fixture_model_t *laugh, fixture_model_t *slow);

/* The value of a minifloat weight (labial/model.h). */
double fixture_weight_value(uint8_t code);

/* The short gain (labial/model.h) nearest to that of a standard deviation, and the gain that one stands for. */
uint8_t fixture_gain_code(double sigma);
double fixture_gain_value(uint8_t code);

/* The mean of a state's delta, or with 1 of its delta-delta, in positions, with an articulation of `gain` / 256. */
double fixture_motion(const labial_channel_t *channel, const labial_state_t *state, unsigned which, int32_t gain);

/* Kernels as a model has them, of steps of `channels` channels in each row; and one step of such a row. */
void fixture_pack_kernels(const int8_t *steps, size_t rows, unsigned channels, uint32_t *kernels);
int fixture_kernel(const uint32_t *kernels, size_t row, unsigned channels, unsigned channel);

/* ---- Streams of phonemes ---- */

typedef struct {
    uint32_t ms;
    uint8_t phoneme;
    uint8_t model; /* index into the host's models */
} fixture_phoneme_t;

typedef enum {
    FIXTURE_ONE_FRAME,  /* every phoneme exactly one frame */
    FIXTURE_PAUSES,     /* silences of many windows between words */
    FIXTURE_VOWELS,     /* boundaries only */
    FIXTURE_CONSONANTS, /* no boundary at all */
    FIXTURE_CONTACTS,   /* P and S of 0 .. 45 frames, mostly few, apart and beside each other, also in pauses */
    FIXTURE_RANDOM,     /* 0 .. 400 ms, any phoneme */
    FIXTURE_LONG,       /* the same, meant for 2,000 phonemes */
    FIXTURE_MILLI,      /* all 1 ms */
    FIXTURE_ZERO,       /* all 0 ms */
    FIXTURE_HOUR,       /* one phoneme of an hour and then `count` - 1 ordinary ones */
    FIXTURE_KINDS
} fixture_kind_t;

/* Fills `out` with `count` speech phonemes of that kind; an hour ends in `count` - 1 ordinary ones. */
void fixture_stream(fixture_phoneme_t *out, size_t count, fixture_kind_t kind, uint32_t seed);

/* Sum of the durations. */
uint64_t fixture_duration(const fixture_phoneme_t *input, size_t count);

/* Whether `frames` is the rounded length of `ms`; an exact half may go either way. */
int fixture_is_exact(uint64_t frames, uint64_t ms, unsigned rate);

/* ---- Rigs (labial/rig.h) in doubles ---- */

/* A jaw that is closed at 1400, and opens by one unit for each by which the lower lip does, up to a `maximum`. */
labial_rig_output_t fixture_jaw(int32_t maximum, int32_t slew, int32_t acceleration);

double fixture_limited(double value, double low, double high);

/* Where an output is at rest, and where it belongs with these FAPs and sounds, or null, without limits of its motion. */
double fixture_rest(const labial_rig_output_t *output);
double fixture_output(const labial_rig_output_t *output, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares);

/* ---- Input that ends exactly where its heap block does, so that a sanitizer sees every byte read beyond it ---- */

/* Room for `count` zeroed elements of `size` bytes, or a copy of `bytes`, to be freed; neither fails. */
void *fixture_room(size_t count, size_t size);
void *fixture_copy(const void *bytes, size_t size);

/* labial_find() of a copy of the name. */
int fixture_find(const labial_names_t *names, const char *name, size_t length);

/* ---- A host that plays a stream ---- */

typedef struct {
    int16_t (*frames)[LABIAL_CHANNELS];
    size_t count, capacity;
    uint32_t next;        /* number that the next frame must have */
    unsigned misnumbered; /* frames that had another */
    unsigned calls;       /* since it was last cleared by the host */
} fixture_recorder_t;

/* labial_frame_fn: `user` is a fixture_recorder_t. */
void fixture_record(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS]);

typedef enum {
    FIXTURE_FILL,   /* as much as room allows before every tick */
    FIXTURE_SINGLE, /* one phoneme before every tick */
    FIXTURE_HUNGRY, /* one phoneme when a tick says that it waits for one, never earlier */
    FIXTURE_CHANCE, /* random bursts of pushes */
    FIXTURE_FEEDS
} fixture_feed_t;

#define FIXTURE_MODELS 4 /* of one host */

typedef struct {
    labial_t *stream;    /* on the heap, so that overruns are seen */
    uint32_t *workspace; /* on the heap, exactly as large as is demanded */
    const labial_model_t *models[FIXTURE_MODELS];
    unsigned model_count, current;
    fixture_recorder_t recorder;
    int moving; /* move the stream's structure before every tick */
    fixture_random_t random;

    /* What happened so far. */
    unsigned seen[4];      /* how often a tick returned each value from LABIAL_OK to LABIAL_DONE */
    unsigned on_way;       /* ticks that waited for the first frame though nothing was lacking */
    size_t begun;          /* frames that were recorded when the stream was initialised or taken up again */
    int ended, cancelled;  /* set by fixture_end(), fixture_cancel() and fixture_restart() */
    const char *complaint; /* the first thing that went wrong, else null */
} fixture_host_t;

/* Returns what labial_init() does with the first model. The workspace suits the largest of them. */
int fixture_open(fixture_host_t *host, const labial_model_t *const *models, unsigned model_count);
void fixture_close(fixture_host_t *host);

/* Initialises the stream anew where it lies, with an empty recorder. */
int fixture_open_again(fixture_host_t *host);

/* The calls of that name; what is expected of the ticks that follow depends on them. Each must succeed. */
void fixture_end(fixture_host_t *host);
void fixture_cancel(fixture_host_t *host, uint32_t milliseconds);
void fixture_restart(fixture_host_t *host);

/* One tick, its result and the callbacks checked against each other; also moves the stream when asked to. */
int fixture_tick(fixture_host_t *host);

/* Pushes one phoneme, of another model if need be. LABIAL_ERROR_FULL and LABIAL_ERROR_MODELS mean: tick, try again. */
int fixture_push(fixture_host_t *host, const fixture_phoneme_t *phoneme);

/* Plays all of `input`, ends the stream, and ticks until it is done. Returns 0 when all went as it must, else -1 with
 * host->complaint set. */
int fixture_play(fixture_host_t *host, const fixture_phoneme_t *input, size_t count, fixture_feed_t feed);

/* The same with as many phonemes in the queue as there is room for, so that each tick takes a frame in: frame t with an
 * articulation of told[t] percent, of which there are `room`. */
int fixture_play_told(fixture_host_t *host, const fixture_phoneme_t *input, size_t count, const uint8_t *told,
                      size_t room);

/* Open, play with `feed`, and leave the host open for a look at its recorder. Returns as fixture_play(). */
int fixture_run(fixture_host_t *host, const labial_model_t *model, const fixture_phoneme_t *input, size_t count,
                fixture_feed_t feed);

/* First frame at which two recordings differ, or -1 when they are the same, lengths included. */
long fixture_difference(const fixture_recorder_t *a, const fixture_recorder_t *b);

/* ---- Blobs (labial/blob.h) ---- */

uint32_t fixture_crc32(const uint8_t *data, size_t size);

/* Writes `model` as a blob and returns its size; nothing is written when `room` is too small for it. */
size_t fixture_serialise(const labial_model_t *model, uint8_t *out, size_t room);

/* Writes size and CRC of a blob of `size` bytes anew. */
void fixture_seal(uint8_t *blob, size_t size);

#endif
