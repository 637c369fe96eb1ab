/*
 * oracle.h - the run-time's steps over again: each takes the whole of its input at once, in doubles where it may. They
 * follow the rules that the headers of lib/ state, in other words and by other ways than lib/ does.
 */
#ifndef LABIAL_TEST_ORACLE_H
#define LABIAL_TEST_ORACLE_H

#include "fixture.h"

/* ---- Units: phonemes to frames (lib/units.h) ---- */

/* One frame of a stream. */
typedef struct {
    unsigned phoneme, model, previous, next; /* as its model sees them */
    unsigned ms;
    int is_first, begins, ends, unit_ends;
    uint64_t number, whole; /* which frame it is of how many of its phoneme; a pause that is cut in two has two */
    unsigned rest; /* how far the mouth has come to rest in such a pause, of 16: not where it leads on to something */
    size_t needs;  /* phonemes pushed before the frame can be taken; more than there are: only the end helps */
} oracle_frame_t;

/* Expands `count` phonemes; there must be room. Returns the number of frames. */
size_t oracle_units(const labial_model_t *const *models, const fixture_phoneme_t *input, size_t count,
                    oracle_frame_t *frames, size_t room);

/* The phoneme of the frame that lies `offset` after frame `at`, as the model of frame `at` sees it: a run of one model's
 * phonemes is in silence. */
unsigned oracle_label(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count, size_t at,
                      int offset);

/* ---- Shapes: phonemes to targets (lib/shape.h) ---- */

/* The shape of a phoneme between two others: both halves of lib/shape.c's selection, which may come in different ticks. */
void oracle_shape(const labial_model_t *model, unsigned phoneme, unsigned ms, unsigned previous, unsigned next,
                  labial_shape_t *shape);

/* Whether a contact of `whole` frames is made in frame `number`: in as many in the middle as half of them, rounded up, or
 * three, or all but seven; an odd frame is left at the end. */
int oracle_is_made(uint64_t number, uint64_t whole);

/* The targets of a whole stream, and bit by bit the channels in contact. Shapes and what is added to them are
 * lib/shape.c's own, of models without floors; floors, contact and rest are put upon them here, phoneme by phoneme. */
void oracle_targets(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count,
                    int16_t (*targets)[LABIAL_CHANNELS], uint16_t *contacts);

/* ---- Viterbi: targets to states (lib/viterbi.h) ---- */

#define ORACLE_NONE 1e30 /* the cost of what cannot be */

/* A step: the cost of every state, of the best path into it, and where that comes from. */
typedef struct {
    double cost[LABIAL_STATES_MAX];
    unsigned from[LABIAL_STATES_MAX];
    unsigned first, best;
    int ends_unit;
} oracle_step_t;

/* Negative log-likelihood of a position in a state, as the tables state it. */
double oracle_emission(const labial_emission_t *state, int32_t position);

/* The first of the states that are looked at: LABIAL_SEARCHED around the nearest one. */
unsigned oracle_window(const labial_model_t *model, const labial_channel_t *channel, int32_t position);

/* Costs of the next step; `before` is null for the first one of a path. */
void oracle_step(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                 const oracle_step_t *before, oracle_step_t *step);

/* The state of step `at` on the best path into step `from`. */
unsigned oracle_traced(const oracle_step_t *steps, size_t from, size_t at);

/* The states of a channel's frames `first` .. `first` + `count` - 1 of a stream, which are one solution; `frames` and
 * `targets` are theirs. */
void oracle_search(const labial_model_t *model, unsigned channel, const oracle_frame_t *frames,
                   const int16_t (*targets)[LABIAL_CHANNELS], size_t first, size_t count, uint8_t *path);

/* ---- Trajectory: states to motion (lib/trajectory.h) ---- */

/*
 * Equation 3 for one channel: the matrix is W' U^-1 W + A, multiplied out row of W by row of W. A frame in contact (bit
 * `bit` of `contacts`) is held at its target alone, by the channel's `contact_weight` at least. With `gain`, in 1/256, frame
 * t is articulated: all that holds it and moves it counts gain[t] times, from FAP 0 on, contact at most once; null: all
 * once. Frame t is taken from a
 * way back that begins at frame start[t], as if all frames beyond were equal to that one; null: at the last frame.
 * Q4 FAP, not rounded.
 */
void oracle_trajectory(const labial_channel_t *channel, const uint8_t *path, const int16_t *targets,
                       const uint16_t *contacts, unsigned bit, const int32_t *gain, size_t count, const size_t *start,
                       double *motion);

/* ---- A whole stream ---- */

/* The frames of a stream, Q4 FAP, `held` being the pose it fades in from, null for the face at rest; `told` the articulation, percent, that
 * holds when each frame is taken in, or null for 100. At least `room` frames fit; returns their number. */
size_t oracle_stream(const labial_model_t *const *models, const fixture_phoneme_t *input, size_t count,
                     const double *held, const uint8_t *told, double (*motion)[LABIAL_CHANNELS], size_t room);

#endif
