/*
 * labial/labial.h - lip motion from phonemes: a stream of phonemes and durations in, a stream of frames out.
 *
 *     static labial_t stream;
 *     static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
 *
 *     labial_init(&stream, &speech_en, workspace, sizeof workspace, on_frame, NULL);
 *     labial_push(&stream, SPEECH_EN_HH, 70);     // phoneme and milliseconds, while labial_room() > 0
 *     labial_push(&stream, SPEECH_EN_AY, 230);
 *     labial_end(&stream);
 *     while (labial_tick(&stream) != LABIAL_DONE) // once per frame period, from the main loop or a timer
 *         wait_for_next_frame();
 *
 * The library never allocates, keeps no state outside `stream` and `workspace`, computes in integers only and gives the
 * same bits on every target. Calls on one stream must not overlap, but for those of its callback; calls on different
 * streams may. The structure may be moved or copied between calls as long as the workspace stays where it is and only
 * one copy continues to be used. Nothing needs to be released.
 *
 * Trusted: models that the exporter wrote and the program was linked with; labial_init() and labial_use() check only
 * their format and frame rate. Not trusted: phoneme numbers, durations, the order of calls, and models from files: no
 * value of these can make the library read or write outside its memory. A model from a file may be used only after
 * labial_model_load() (labial/blob.h) has accepted it.
 */
#ifndef LABIAL_H
#define LABIAL_H

#include <stddef.h>
#include <stdint.h>

#include "labial/model.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LABIAL_VERSION_MAJOR 0
#define LABIAL_VERSION_MINOR 3
#define LABIAL_VERSION_PATCH 0

/* ---- Limits. Each may be set for the whole build; library and program must agree on them. ---------------------- */

/* How many frames ahead of the delivered ones the trajectory's backward pass starts, 1 .. 48. Each frame makes the motion
 * smoother and costs a frame of delay and 104 bytes of workspace. With the bundled models 3 frames leave an error of
 * .2 % of a channel's range (RMS); the stiffer models of the published method need 16 frames or more. */
#ifndef LABIAL_WINDOW
#define LABIAL_WINDOW 3
#endif

/* How many frames after a step the search decides on its state, if the unit does not end earlier, 0 .. 40. Each
 * frame makes the path more probable and costs a frame of delay and about 175 bytes of workspace; with the bundled
 * models the difference is not visible. With a lag as long as the longest unit, the states of each unit are the
 * likeliest path through it (Viterbi) among those that LABIAL_SEARCHED leaves. */
#ifndef LABIAL_LAG
#define LABIAL_LAG 0
#endif

/* States that a step of the search looks at, of those of a channel: the ones around that whose mean is nearest to the
 * target, 2 .. 64. With as many as a model has, no path is left out. Each costs a byte of workspace in each channel,
 * LABIAL_LAG bytes more with a lag, and its share of the search's time. */
#ifndef LABIAL_SEARCHED
#define LABIAL_SEARCHED 8
#endif

/* Phonemes that the queue has room for: how far ahead a program can push, LABIAL_REACH + 2 .. 255. Each costs 8 bytes
 * of the stream. Within these limits no sequence of pushes can stall the stream. */
#ifndef LABIAL_QUEUE
#define LABIAL_QUEUE 32
#endif

/* Distance of the farthest tap of a model's kernels from the frame, in frames to either side, 0 .. 60. Each frame
 * costs 2 bytes of the stream. A generated model that needs more does not compile, and a blob that needs more is
 * refused. */
#ifndef LABIAL_REACH
#define LABIAL_REACH 20
#endif

/* Models whose phonemes can be in a stream at the same time, 1 .. 255. Another model can replace a model when all
 * its phonemes have been taken in, and after them as many frames as share a state. */
#ifndef LABIAL_MODELS
#define LABIAL_MODELS 2
#endif

/* What does not compile: values out of range, sums without parentheses (which the code would take apart), unsigned
 * ones. */
#define LABIAL_IS_NUMBER_(x, least, most) (x >= least && (x) <= most && 2 * x * 2 + 1 == 4 * (x) + 1 && -1 - (x) < 0)
#if !LABIAL_IS_NUMBER_(LABIAL_WINDOW, 1, 48)
#error "LABIAL_WINDOW must be a number from 1 to 48."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_LAG, 0, 40)
#error "LABIAL_LAG must be a number from 0 to 40."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_SEARCHED, 2, 64)
#error "LABIAL_SEARCHED must be a number from 2 to 64."
#endif
#if LABIAL_WINDOW + LABIAL_LAG > 55
#error "LABIAL_WINDOW and LABIAL_LAG must not be more than 55 together."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_REACH, 0, 60)
#error "LABIAL_REACH must be a number from 0 to 60."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_QUEUE, 2, 255)
#error "LABIAL_QUEUE must be a number from 2 to 255."
#endif
#if LABIAL_QUEUE < LABIAL_REACH + 2
#error "LABIAL_QUEUE must be LABIAL_REACH + 2 or more, or a stream could wait for a phoneme that has no room."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_MODELS, 1, 255)
#error "LABIAL_MODELS must be a number from 1 to 255."
#endif

/* Longest duration of one phoneme, milliseconds: one hour. */
#define LABIAL_DURATION_MAX 3600000u

/* ---- Results. Zero is success, a positive value says how a stream stands, a negative one is an error. ------------ */

#define LABIAL_RESULTS(X)                                                                                              \
    X(LABIAL_OK, 0, "success")                                                                                         \
    X(LABIAL_WAITING, 1, "the first frame is on its way or waits for phonemes")                                        \
    X(LABIAL_STARVED, 2, "the next frame waits for more phonemes")                                                     \
    X(LABIAL_DONE, 3, "the stream has ended and every frame was delivered")                                            \
    X(LABIAL_ERROR_NULL, -1, "a pointer that is needed is null")                                                       \
    X(LABIAL_ERROR_VERSION, -2, "the model is of another version: export its .npz again by labial export")             \
    X(LABIAL_ERROR_MODEL, -3, "the model's tables are out of range")                                                   \
    X(LABIAL_ERROR_WORKSPACE, -4, "the workspace is too small or not aligned to four bytes")                           \
    X(LABIAL_ERROR_STATE, -5, "the call is not allowed now: not initialised, or a push after the end")                 \
    X(LABIAL_ERROR_PHONEME, -6, "the model has no phoneme of this number")                                             \
    X(LABIAL_ERROR_DURATION, -7, "the duration exceeds LABIAL_DURATION_MAX")                                           \
    X(LABIAL_ERROR_FULL, -8, "the queue is full; tick and push again")                                                 \
    X(LABIAL_ERROR_RATE, -9, "the model's frame rate or search stride is not the stream's")                            \
    X(LABIAL_ERROR_MODELS, -10, "phonemes of LABIAL_MODELS other models are still to be played")                       \
    X(LABIAL_ERROR_NAME, -11, "no phoneme of this name is known")                                                      \
    X(LABIAL_ERROR_RIG, -12, "the rig has no output, or a value in its table is out of range")

typedef enum {
#define LABIAL_RESULT_VALUE(name, value, text) name = value,
    LABIAL_RESULTS(LABIAL_RESULT_VALUE)
#undef LABIAL_RESULT_VALUE
        LABIAL_RESULT_LAST_ = LABIAL_ERROR_RIG
} labial_result_t;

/* A sentence for any result, "unknown result" for other numbers. Linked only when used. */
const char *labial_result_text(int result);

/* ---- The stream ------------------------------------------------------------------------------------------------ */

/*
 * Receives a frame: `frame` counts frames since labial_init(), `faps` are the 13 channels in FAP units, valid during
 * the call. Called from labial_tick() alone, whose work is then done: it may call any function, of the same stream too.
 * A labial_tick() from here delivers the next frame before the first one returns, on top of its stack.
 */
typedef void (*labial_frame_fn)(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS]);

/* ---- What a stream is made of. All members are private; they are declared here so that a stream can be allocated
 * statically. Each structure belongs to one file of lib/. ---- */

/* A phoneme that was pushed (units.c). */
typedef struct {
    uint32_t frames; /* duration in frames, never 0 */
    uint16_t ms;     /* duration in milliseconds, 65535 for longer ones */
    uint8_t phoneme; /* of the model in the slot */
    uint8_t slot;    /* model it belongs to */
} labial_segment_t;

/* The queue of what was pushed and not yet taken frame by frame (units.c). */
typedef struct {
    uint8_t head, count;
    uint8_t before;     /* phoneme in front of the oldest segment */
    uint8_t begins;     /* the next frame is the first of a solution */
    uint8_t rested;     /* the oldest segment is a pause that a solution began with */
    uint16_t remainder; /* of a frame, in 1/1000, that the durations so far leave over, from one half on */
    uint32_t taken;     /* frames of the oldest segment that were taken */
    uint32_t frames;    /* of all segments that are not yet taken */
    uint8_t labels[2 * LABIAL_REACH + 1]; /* phonemes of the frames around the last that was taken */
    labial_segment_t segments[LABIAL_QUEUE];
} labial_units_t;

/* The shape of a phoneme (shape.c): at its start and at its end, positions. */
typedef struct {
    int16_t knots[2][LABIAL_CHANNELS];
} labial_shape_t;

/* The selection of a shape (shape.c). */
typedef struct {
    uint8_t halves;                                    /* that are done */
    uint8_t count;                                     /* components that have a share */
    uint8_t components[LABIAL_PHONEME_COMPONENTS_MAX]; /* of the phoneme's */
    uint16_t shares[LABIAL_PHONEME_COMPONENTS_MAX];    /* of the mixture, Q12 */
    int16_t tilts[LABIAL_PHONEME_COMPONENTS_MAX];      /* how much of the slope counts: share times deviation, Q12 */
    labial_shape_t shape;
} labial_selection_t;

/* Where the search of one channel stands (viterbi.c). */
typedef struct {
    uint8_t first; /* state of the window */
    uint8_t best;  /* state, counted from the first */
    uint8_t scores[LABIAL_SEARCHED];
    uint8_t path[LABIAL_LAG + 1]; /* states of the last steps, the latest first */
#if LABIAL_LAG > 0
    uint8_t spans[LABIAL_LAG + 1];             /* frames of these steps */
    uint8_t undecided;                         /* steps before the last whose states may still change */
    uint8_t firsts[LABIAL_LAG];                /* windows of the steps before the last */
    uint8_t back[LABIAL_LAG][LABIAL_SEARCHED]; /* and where in them the states of the next step come from */
#endif
} labial_search_t;

/* Where the solution of one channel stands (trajectory.c): the recursion, and the row that the next one completes. */
typedef struct {
    int32_t row, bent; /* Q16 */
    int32_t k1, k2;    /* Q16 */
    int32_t q1, q2;    /* Q12 FAP */
    int32_t position;  /* Q12 FAP */
    int32_t pull, next_pull;
    uint16_t hold, delta;
} labial_solver_t;

/* What the backward pass needs of a frame (trajectory.c). */
typedef struct {
    int32_t q; /* Q12 FAP */
    uint16_t rho, kappa;
} labial_factors_t;

/* A frame that was taken (stream.c). */
typedef struct {
    uint32_t contacts;               /* bit k: channel k is in contact */
    int16_t target[LABIAL_CHANNELS]; /* positions */
    uint8_t slot;                    /* its model */
    uint8_t marks;
} labial_frame_t;

/* The factors that a channel's next step goes back through, the latest last; a structure, so that it is copied whole. */
typedef struct {
    labial_factors_t of[LABIAL_WINDOW + 1];
} labial_kept_t;

/* Where one channel stands (channels.c). */
typedef struct {
    labial_solver_t solver;
    labial_kept_t kept;
    labial_search_t search;
} labial_progress_t;

/* All channels (channels.c). The pointers are to parts of the workspace. */
typedef struct {
    uint8_t stride;              /* frames that share a state */
    uint8_t phase;               /* channels phase, phase + stride, ... are next */
    uint8_t entered;             /* frames that were taken, 255 for more */
    uint8_t beyond;              /* ticks since the last frame was taken */
    labial_progress_t *progress; /* LABIAL_CHANNELS */
    labial_frame_t *frames;      /* the latest stride + LABIAL_LAG, the last one taken at the end */
    int16_t *motion;             /* a ring of stride x LABIAL_CHANNELS, Q4 FAP */
} labial_channels_t;

/* Ticks from taking a frame in to delivering it. */
#define LABIAL_DELAY(stride) (LABIAL_WINDOW + LABIAL_LAG + (stride))

#define LABIAL_BEGINS_WORDS_ (LABIAL_DELAY(LABIAL_SEARCH_STRIDE_MAX) / 32 + 1)

/* The stream's state (stream.c). Small members come first, where small instructions reach them. */
typedef struct {
    uint32_t magic;       /* set while the stream is initialised */
    uint8_t slot;         /* model of the next push */
    uint8_t ended;        /* no more phonemes will come */
    uint8_t begun;        /* a frame was delivered since the stream was initialised or restarted */
    uint8_t shown;        /* a frame was delivered since the stream was initialised: what begins fades in from `pose` */
    uint8_t fade_step;    /* 0 when nothing fades */
    uint16_t ease_length; /* frames of easing back to neutral; 0 when the stream does not ease */
    uint16_t ease_step;
    uint32_t frame;   /* number of the next frame */
    uint32_t pending; /* frames pushed and not yet delivered */
    uint32_t
        begins[LABIAL_BEGINS_WORDS_]; /* bit i: a solution begins with the frame that was taken i ticks ago; what was
                                            * taken before a cancel moves beyond the delay before a frame is due */
    labial_channels_t channels;
    const labial_model_t *models[LABIAL_MODELS];
    labial_frame_fn callback;
    void *user;
    labial_shape_t shape;             /* of the phoneme that the latest frame belongs to */
    labial_selection_t next;          /* that of the phoneme that begins next */
    int16_t pose[LABIAL_CHANNELS];    /* the frame delivered last, Q4 FAP */
    int16_t earlier[LABIAL_CHANNELS]; /* the one before it; while something fades, how far it moved on */
    int16_t faded[LABIAL_CHANNELS];   /* the pose that fades */
    labial_units_t units;
} labial_t;

/*
 * Bytes of workspace for models that search a state every `stride` frames, a multiple of four; a constant expression
 * when `stride` is. Its parts are, in this order: how far each channel is; the frames whose targets are still needed;
 * the motion that is not yet delivered.
 */
#define LABIAL_WORKSPACE_SIZE(stride)                                                                                  \
    ((uint32_t)(LABIAL_CHANNELS * sizeof(labial_progress_t) +                                                          \
                (((stride) + LABIAL_LAG) * sizeof(labial_frame_t) + (stride)*2u * LABIAL_CHANNELS + 3u) / 4u * 4u))

/* The same for a given model; 0 for a null pointer. */
uint32_t labial_workspace_size(const labial_model_t *model);

/* The larger of two sizes, for the workspace of a stream that uses two models; nested, of more. */
#define LABIAL_LARGER(a, b) ((a) > (b) ? (a) : (b))

/*
 * Prepares a stream whose first phonemes are those of `model`; whatever it contained before is forgotten.
 *
 * `workspace` is aligned to four bytes and has at least labial_workspace_size() bytes of the largest model that the
 * stream will use; it belongs to the stream until it is initialised anew or no longer used.
 *
 * The model must stay where it is for the same time. It is trusted: it was compiled in, or labial_model_load() accepted
 * it. `callback` receives the frames, with `user` as its first argument.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_VERSION or LABIAL_ERROR_WORKSPACE. After an error the stream is
 * unusable until it is initialised successfully.
 */
int labial_init(labial_t *stream, const labial_model_t *model, void *workspace, size_t workspace_size,
                labial_frame_fn callback, void *user);

/*
 * Makes the next pushes phonemes of `model`, speech or laughter. Each model treats the other's phonemes as silence;
 * where the stream changes from one to the other, the motion fades over 8 frames. The model is trusted as that of
 * labial_init() is.
 *
 * Returns LABIAL_OK or, with the stream unchanged, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE, LABIAL_ERROR_VERSION,
 * LABIAL_ERROR_RATE (frames per second and search stride are those of the stream's first model) or LABIAL_ERROR_MODELS.
 */
int labial_use(labial_t *stream, const labial_model_t *model);

/*
 * Appends a phoneme of the current model with its duration in milliseconds, 0 to LABIAL_DURATION_MAX. Durations are
 * added exactly: after any number of pushes the frames amount to the rounded sum of the durations. A phoneme that gets
 * no frame of its own is skipped, and its time is added to the next.
 *
 * How a phoneme looks depends on what follows: its frames wait until the next phoneme and everything within the
 * kernels' reach are known, or until labial_end(). Pauses of any length delay nothing: a silence is pushed whole when
 * it begins.
 *
 * Returns LABIAL_OK or, with the stream unchanged, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE (after labial_end() or
 * labial_cancel()), LABIAL_ERROR_PHONEME, LABIAL_ERROR_DURATION or LABIAL_ERROR_FULL.
 */
int labial_push(labial_t *stream, unsigned phoneme, uint32_t milliseconds);

/* Phonemes that can be pushed before the queue is full; 0 when none, or when the stream takes no more. */
unsigned labial_room(const labial_t *stream);

/* No more phonemes will come. Returns LABIAL_OK (also when called again), LABIAL_ERROR_NULL or LABIAL_ERROR_STATE. */
int labial_end(labial_t *stream);

/*
 * Call once per frame period. Takes in one frame of what was pushed and delivers the one that was taken in
 * LABIAL_DELAY(stride) ticks before; every call does about the same work. When phonemes come too late, the stream is
 * late by one frame for each tick that returned LABIAL_STARVED, and catches up by as many extra calls (docs/kiosk.md).
 *
 * Returns LABIAL_OK when the callback was called, once; LABIAL_WAITING, LABIAL_STARVED or LABIAL_DONE when there was
 * nothing to deliver; LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_tick(labial_t *stream);

/*
 * Drops all that was pushed and not yet delivered, and eases the last delivered frame back to the neutral face (all
 * FAPs 0) over `milliseconds`, rounded up to whole frames and at most 1,000 of them; then the stream is done. With 0
 * one neutral frame follows.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_cancel(labial_t *stream, uint32_t milliseconds);

/*
 * Continues a stream that is done or was cancelled: phonemes can be pushed again, frame numbers continue, and the first
 * frames are cross-faded from the frame delivered last, so that there is no jump. The current model stays.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (before labial_init(), or while frames are still to come).
 */
int labial_restart(labial_t *stream);

/* How much of the input has been pushed and not yet delivered. */
typedef struct {
    uint32_t frames;       /* pushed and not yet delivered */
    uint32_t milliseconds; /* the same as time, rounded to the nearest */
    unsigned phonemes;     /* in the queue: pushed, with frames that are not yet taken in */
    unsigned delay;        /* ticks from taking a frame in to delivering it: LABIAL_DELAY() */
} labial_latency_t;

/* The stream's look-ahead at this moment; all zero for a null or uninitialised stream. */
labial_latency_t labial_latency(const labial_t *stream);

#ifdef __cplusplus
}
#endif

#endif
