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
 * The library never allocates, keeps no state outside `stream` and `workspace`, computes in integers only and gives
 * the same bits on every target. A stream is not reentrant: calls on one stream must not overlap, calls on different
 * streams may. The structure may be moved or copied between calls as long as the workspace stays where it is and only
 * one copy is used on. Nothing needs to be released.
 *
 * Trusted: models that the exporter wrote and the program was linked with; labial_init() and labial_use() look at their
 * format and frame rate alone. Not trusted: phoneme numbers, durations, the order of calls, and models from files,
 * which are not to be used before labial_model_load() (labial/blob.h) has accepted them: no value of these can make the
 * library read or write outside its memory.
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
#define LABIAL_VERSION_MINOR 1
#define LABIAL_VERSION_PATCH 0

/* ---- Limits. Each may be set for the whole build; library and program must agree on them. ---------------------- */

/* Most frames that are decoded at once; a longer unit is cut and chained. Costs 28 + states / stride bytes of workspace
 * and 8 of the stream each. */
#ifndef LABIAL_WINDOW
#define LABIAL_WINDOW 40
#endif

/* Short units are decoded together until they have so many frames, or no further one fits the window. More gives fewer
 * joins and less work, less is less latency; 1 decodes every unit by itself. LABIAL_WINDOW at most. */
#ifndef LABIAL_PIECE
#define LABIAL_PIECE 16
#endif

/* Most frames over which two pieces, or two models, are cross-faded; half of the window at most. Costs 34 bytes of the
 * stream each. */
#ifndef LABIAL_OVERLAP
#define LABIAL_OVERLAP 8
#endif

/* Farthest tap of a model's kernels, in frames, to either side. Costs 2 bytes of workspace, 16 of the stream each. */
#ifndef LABIAL_REACH
#define LABIAL_REACH 20
#endif

/* Frames that are held ready at most; half of the window at least. Costs 26 bytes of the stream each. */
#ifndef LABIAL_READY
#define LABIAL_READY 30
#endif

/* Frames that are ready before the first is delivered, unless input is short. Half of the window and no less is enough
 * for the even work of labial_tick() always to be done in time; 1 delivers at once. LABIAL_READY at most. */
#ifndef LABIAL_PREROLL
#define LABIAL_PREROLL (LABIAL_WINDOW / 2)
#endif

/* Models whose phonemes a stream can hold at the same time. A model makes room for another when its phonemes have been
 * decoded and are no longer needed as context. */
#ifndef LABIAL_MODELS
#define LABIAL_MODELS 2
#endif

/* Phonemes that can be held. So many that a window of one-frame phonemes, what the kernels reach beyond it and the
 * neighbours that give context always fit; no sequence of pushes can stall the stream. */
#define LABIAL_QUEUE (LABIAL_WINDOW + 2 * LABIAL_REACH + LABIAL_OVERLAP + 4)

/* Longest duration of one phoneme, milliseconds: one hour. */
#define LABIAL_DURATION_MAX 3600000u

/* ---- Results. Zero is success, a positive value says how a stream stands, a negative one is an error. ------------ */

#define LABIAL_RESULTS(X)                                                                                        \
    X(LABIAL_OK, 0, "success")                                                                                   \
    X(LABIAL_WAITING, 1, "the first frame waits for more phonemes")                                              \
    X(LABIAL_STARVED, 2, "the next frame is due and waits for more phonemes")                                    \
    X(LABIAL_BUSY, 3, "the next frame is being computed")                                                        \
    X(LABIAL_DONE, 4, "the stream has ended and every frame was delivered")                                      \
    X(LABIAL_ERROR_NULL, -1, "a pointer that is needed is null")                                                 \
    X(LABIAL_ERROR_VERSION, -2, "the model was exported for another version of the library")                     \
    X(LABIAL_ERROR_MODEL, -3, "the model's tables are out of range")                                             \
    X(LABIAL_ERROR_WORKSPACE, -4, "the workspace is too small or not aligned to four bytes")                     \
    X(LABIAL_ERROR_STATE, -5, "the call is not allowed now: not initialised, or a push after the end")           \
    X(LABIAL_ERROR_PHONEME, -6, "the model has no phoneme of this number")                                       \
    X(LABIAL_ERROR_DURATION, -7, "the duration exceeds LABIAL_DURATION_MAX")                                     \
    X(LABIAL_ERROR_FULL, -8, "the queue is full; tick and push again")                                           \
    X(LABIAL_ERROR_RATE, -9, "the model's frame rate is not the stream's")                                       \
    X(LABIAL_ERROR_MODELS, -10, "phonemes of LABIAL_MODELS other models are still held")                         \
    X(LABIAL_ERROR_NAME, -11, "no phoneme of this name is known")                                                \
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
 * the call. Called from labial_tick() alone; it must not call back into the same stream.
 */
typedef void (*labial_frame_fn)(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS]);

/* A phoneme that was pushed. Private. */
typedef struct {
    uint32_t frames;  /* duration in frames, never 0 */
    uint16_t ms;      /* duration in milliseconds, 65535 for longer ones */
    uint8_t phoneme;  /* of the model in the slot */
    uint8_t slot;     /* model it belongs to */
} labial_segment_t;

/* Part of the input that is decoded at once: a unit, several, or part of one that was cut. Private. */
typedef struct {
    uint32_t begin;    /* first frame, counted from the start of the queue's oldest segment */
    uint16_t length;   /* frames, 1 .. LABIAL_WINDOW */
    uint16_t fade_in;  /* frames shared with the piece before */
    uint16_t fade_out; /* frames shared with the piece after; 0 for the stream's last */
    uint8_t slot;      /* model it is decoded with */
} labial_piece_t;

/* The stream's state. Its members are private; it is declared here so that it can be allocated statically. Small
 * members come first, where small instructions reach them. */
typedef struct {
    uint32_t magic;  /* set while the stream is initialised */
    uint8_t slot;    /* model of the next push */
    uint8_t ended;   /* no more phonemes will come */
    uint8_t stage;   /* of the work on the piece */
    uint8_t channel; /* and where it stands */
    uint8_t begun;   /* a frame was delivered since the stream was initialised or taken up again */
    uint8_t rolling; /* enough frames were ready; cleared when they run out */
    uint8_t resumed; /* the first piece fades in from `pose` */

    labial_piece_t piece; /* being decoded */
    uint16_t step;        /* within the stage */
    uint16_t segment;     /* target: next segment, counted from the oldest */
    uint16_t pace;        /* work that each tick does on the piece */
    uint16_t overspent;   /* work that earlier ticks did beyond their share */

    uint16_t queue_head;
    uint16_t queue_count;
    uint16_t next_fade_in; /* frames that the next piece shares with the one before */
    uint16_t remainder;    /* of a frame, in 1/1000, that the durations so far leave over, from one half on */

    uint16_t ready_head;
    uint16_t ready_count; /* frames that can be played */
    uint16_t held_count;  /* frames behind them that the next piece fades into */
    uint16_t ease_length; /* frames of easing back to neutral; 0 when the stream does not ease */
    uint16_t ease_step;

    uint32_t queue_frames; /* of all segments held */
    uint32_t next_begin;   /* first frame of the next piece, counted from the start of the oldest segment */
    uint32_t segment_end;  /* target: end of the segment whose shape is held */
    uint32_t frame;        /* number of the next frame */
    uint32_t pending;      /* frames pushed and not yet delivered */

    uint32_t workspace_size;
    uint8_t *workspace;
    const labial_model_t *models[LABIAL_MODELS];
    labial_frame_fn callback;
    void *user;

    int16_t shape[LABIAL_CHANNELS]; /* target: the held shape, positions */
    int16_t pose[LABIAL_CHANNELS];  /* FAPs of the frame delivered last, from which easing starts */
    labial_segment_t queue[LABIAL_QUEUE]; /* phonemes, with those still needed as context in front */
    int16_t ready[LABIAL_READY + LABIAL_OVERLAP][LABIAL_CHANNELS]; /* frames that are solved, Q4 FAP */
} labial_t;

/*
 * Bytes of workspace for models of up to `states` codebook entries of which one is searched every `stride` frames, a
 * multiple of four; a constant expression when both are. It holds, in this order: two rows of Viterbi scores and the
 * back-pointers, whose memory the trajectory solver uses in its turn; for each frame of the window the target, which
 * becomes the trajectory; the state path; the phonemes of the window and of what the kernels reach.
 */
#define LABIAL_WORKSPACE_SIZE(states, stride)                                                              \
    ((LABIAL_SEARCH_SIZE_(states, stride) > LABIAL_SOLVER_SIZE_ ? LABIAL_SEARCH_SIZE_(states, stride)      \
                                                                : LABIAL_SOLVER_SIZE_) +                   \
     ((uint32_t)LABIAL_WINDOW * 2u * LABIAL_CHANNELS + 3u) / 4u * 4u + LABIAL_LABELS_SIZE_)
#define LABIAL_SEARCH_SIZE_(states, stride)                                                                \
    (8u * ((uint32_t)(states) + 1u) +                                                                      \
     (((uint32_t)LABIAL_WINDOW - 1u) / (uint32_t)(stride) * (uint32_t)(states) + 3u) / 4u * 4u)
#define LABIAL_SOLVER_SIZE_ (60u + 12u * (uint32_t)LABIAL_WINDOW)
#define LABIAL_LABELS_SIZE_ (((uint32_t)LABIAL_WINDOW * 2u + 2u * (uint32_t)LABIAL_REACH + 3u) / 4u * 4u)

/* The same for a given model; 0 for a null pointer. */
uint32_t labial_workspace_size(const labial_model_t *model);

/* The larger of two sizes, for the workspace of a stream that uses two models; nested, of more. */
#define LABIAL_LARGER(a, b) ((a) > (b) ? (a) : (b))

/*
 * Prepares a stream whose first phonemes are those of `model`; whatever it held before is forgotten.
 *
 * `workspace` is aligned to four bytes and has at least labial_workspace_size() bytes of the largest model that the
 * stream will use; it belongs to the stream until it is initialised anew or no longer used.
 *
 * The model stays where it is for as long, and is trusted: one that was compiled in, or that labial_model_load()
 * accepted. `callback` receives the frames, with `user` as its first argument.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_VERSION or LABIAL_ERROR_WORKSPACE. After an error the stream is
 * unusable until it is initialised successfully.
 */
int labial_init(labial_t *stream, const labial_model_t *model, void *workspace, size_t workspace_size,
                labial_frame_fn callback, void *user);

/*
 * Makes the next pushes phonemes of `model`, speech or laughter; where the stream passes from one model to the other,
 * both are decoded for up to LABIAL_OVERLAP frames, each taking the other's phonemes for silence, and cross-faded. The
 * model is trusted as that of labial_init() is.
 *
 * Returns LABIAL_OK or, with the stream unchanged, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE, LABIAL_ERROR_VERSION,
 * LABIAL_ERROR_RATE, LABIAL_ERROR_WORKSPACE (it is too small for the model) or LABIAL_ERROR_MODELS.
 */
int labial_use(labial_t *stream, const labial_model_t *model);

/*
 * Appends a phoneme of the current model with its duration in milliseconds, 0 to LABIAL_DURATION_MAX. Durations are
 * added exactly: after any number of pushes the frames amount to the rounded sum of the durations. A phoneme that gets
 * no frame of its own leaves no trace but its time.
 *
 * How a phoneme looks depends on what follows: its frames wait until the units that it is decoded with (LABIAL_PIECE),
 * the phoneme behind these and all that the kernels reach are known, or until labial_end(). A program that goes on
 * without end pushes its pauses in short pieces.
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
 * Call once per frame period. Does a bounded share of the work on the frames to come - that of decoding two frames at
 * most, and mostly less - and delivers the next frame when there is one. While phonemes are pushed early enough, no
 * frame is late; after a shortage LABIAL_PREROLL frames are gathered again.
 *
 * Returns LABIAL_OK when the callback was called, once; LABIAL_WAITING, LABIAL_STARVED, LABIAL_BUSY or LABIAL_DONE when
 * there was nothing to deliver; LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_tick(labial_t *stream);

/*
 * Does one small step of the work, for programs with time to spare between frames: ticks find their work done. Never
 * needed. Returns LABIAL_OK when there is more to do at once, LABIAL_WAITING when everything is done that can be done
 * before more phonemes come or frames are taken, LABIAL_DONE when nothing is left to do at all, or LABIAL_ERROR_NULL or
 * LABIAL_ERROR_STATE.
 */
int labial_work(labial_t *stream);

/*
 * Drops all that was pushed and not yet delivered, and eases the last delivered frame back to the neutral face (all
 * FAPs 0) over `milliseconds`, rounded up to whole frames and at most 1,000 of them; then the stream is done. With 0
 * one neutral frame follows.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_cancel(labial_t *stream, uint32_t milliseconds);

/*
 * Takes up a stream again that is done or was cancelled: phonemes can be pushed, frames are numbered on, and the first
 * of them are cross-faded from the frame delivered last, so that there is no jump. The current model stays.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (before labial_init(), or while frames are still to come).
 */
int labial_restart(labial_t *stream);

/* How much input the stream holds between what was pushed and what was delivered. */
typedef struct {
    uint32_t frames;       /* pushed and not yet delivered */
    uint32_t milliseconds; /* the same as time, rounded to the nearest */
    unsigned phonemes;     /* held in the queue, those included that are only kept as context */
    unsigned ready;        /* frames that are computed; the first wait until LABIAL_PREROLL of them are */
} labial_latency_t;

/* The stream's look-ahead at this moment; all zero for a null or uninitialised stream. */
labial_latency_t labial_latency(const labial_t *stream);

#ifdef __cplusplus
}
#endif

#endif
