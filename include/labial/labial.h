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
 * A stream begins and ends with the neutral face, all FAPs 0: the first 8 frames lead from rest to the motion, and
 * after the last phoneme as many as LABIAL_EASE_FRAMES lead back.
 *
 * The library never allocates, keeps no state outside `stream` and `workspace`, computes in integers only and gives the
 * same bits on every target. Calls on one stream must not overlap, except those from its callback, or in a build with
 * LABIAL_LOCKS (below); calls on different streams may. The structure may be moved or copied between calls as long as
 * the workspace stays where it is and only one copy is used from then on. Nothing needs to be released.
 *
 * The library trusts models that the exporter wrote and that are linked into the program; labial_init() and
 * labial_use() check only their format and frame rate. It does not trust phoneme numbers, durations, the order of
 * calls, or models from files: no value of these can make it read or write outside its memory. A model from a file may
 * be used only after labial_model_load() (labial/blob.h) has accepted it.
 */
#ifndef LABIAL_H
#define LABIAL_H

#include <stddef.h>
#include <stdint.h>

#include "labial/config.h"
#include "labial/model.h"
#include "labial/private.h"
#include "labial/result.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LABIAL_VERSION_MAJOR 0
#define LABIAL_VERSION_MINOR 4
#define LABIAL_VERSION_PATCH 0

/* Longest duration of one phoneme, milliseconds: one hour. */
#define LABIAL_DURATION_MAX 3600000u

/* Frames in which the face comes to rest, and ticks for which it keeps its pose before that while phonemes are late. */
#define LABIAL_EASE_FRAMES 12u
#define LABIAL_HOLD_TICKS 5u

/* Largest articulation, percent. */
#define LABIAL_ARTICULATION_MAX 200u

/* ---- The stream ------------------------------------------------------------------------------------------------ */

#if LABIAL_LOCKS > 0
/*
 * The lock of a stream, which the program defines: labial_lock() returns when no other call on the stream can run until
 * labial_unlock(). The library does not nest them, and holds no lock while the callback runs. `stream` is the argument
 * of the call, which may be null.
 *
 * - labial_tick() comes from one context at a time. With LABIAL_LOCKS 1 it takes no lock: it is an interrupt, which
 *   labial_lock() holds off (docs/porting.md). With 2 it takes the lock until it calls the callback.
 * - All other calls take the lock; they may be made in any context that may take it, and from the callback.
 * - labial_init() takes no lock: nothing else is called on the stream until it returns.
 */
void labial_lock(const labial_t *stream);
void labial_unlock(const labial_t *stream);
#endif

/*
 * Receives a frame: `frame` counts frames since labial_init(), `faps` are the 13 channels in FAP units, valid during
 * the call. While phonemes are late, the face that comes to rest in place of the missing frame has that frame's number,
 * which the frame itself then has again.
 *
 * labial_tick() calls it last. So the callback may call any function, also on the same stream, as if the tick had
 * returned: labial_restart() is refused while frames of phonemes are still to come, and labial_init() begins with frame
 * 0 again. A labial_tick() from the callback delivers the next frame before the first tick returns, on top of its
 * stack.
 */
typedef void (*labial_frame_fn)(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS]);

/*
 * Bytes of workspace for models of `channels` channels that search a state every `stride` frames, a multiple of four; a
 * constant expression when both are. Its parts are, in this order: the state of each channel; the frames whose targets
 * are still needed; the motion that is not yet delivered. LABIAL_CHANNELS are enough for any model.
 */
#if LABIAL_PAPER
#define LABIAL_WORKSPACE_SIZE(stride, channels)                                                                        \
    ((uint32_t)(sizeof(labial_pieces_t) + 2u * LABIAL_CHANNELS * sizeof(labial_shape_t) + 0u * (stride) * (channels)))
#else
#define LABIAL_WORKSPACE_SIZE(stride, channels)                                                                        \
    ((uint32_t)((channels) * (sizeof(labial_progress_t) + 2u * sizeof(labial_shape_t)) +                               \
                (((stride) + LABIAL_LAG) * sizeof(labial_frame_t) + (stride)*2u * (channels) + 3u) / 4u * 4u))
#endif

/* The same for a given model; 0 for a null pointer. */
uint32_t labial_workspace_size(const labial_model_t *model);

/* The larger of two sizes, for the workspace of a stream that uses two models; nested, of more. */
#define LABIAL_LARGER(a, b) ((a) > (b) ? (a) : (b))

/*
 * Prepares a stream whose first phonemes are those of `model`, and discards what it contained.
 *
 * `workspace` must be aligned to four bytes and have at least labial_workspace_size() bytes of the largest model that
 * the stream will use; it belongs to the stream until the stream is initialised again or no longer used.
 *
 * The model must stay where it is for the same time. It is trusted: it is compiled in, or labial_model_load() accepted
 * it. `callback` receives the frames, with `user` as its first argument.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_VERSION or LABIAL_ERROR_WORKSPACE. After an error the stream is
 * unusable until it is initialised successfully.
 */
int labial_init(labial_t *stream, const labial_model_t *model, void *workspace, size_t workspace_size,
                labial_frame_fn callback, void *user);

/*
 * Selects `model`, speech or laughter, for the phonemes of the next pushes. Each model treats the other's phonemes as
 * silence; where the stream changes from one to the other, the motion fades over 8 frames. Where a p, b, m, f or v
 * comes before the end of that, lips that are apart reach it sooner, with the jaw, so that they meet. The model is
 * trusted like that of labial_init().
 *
 * Returns LABIAL_OK or, with the stream unchanged, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE, LABIAL_ERROR_VERSION,
 * LABIAL_ERROR_FRAME_RATE (frames per second and search stride are those of the stream's first model),
 * LABIAL_ERROR_WORKSPACE (the model has more channels than the workspace holds) or LABIAL_ERROR_MODELS.
 */
int labial_use(labial_t *stream, const labial_model_t *model);

/*
 * Whether a stream needs the bytes of `model`: 1 if it is the current one, or frames of its phonemes are still to be
 * delivered, else 0. Before a model's place in flash is written, select another one by labial_use(), or initialise the
 * stream with it, and tick until this is 0 (docs/porting.md).
 */
int labial_uses(const labial_t *stream, const labial_model_t *model);

/*
 * Appends a phoneme of the current model with its duration in milliseconds, 0 to LABIAL_DURATION_MAX. Rounding errors
 * do not accumulate: after any number of pushes the number of frames is the rounded sum of the durations. A phoneme
 * that gets no frame is skipped, and its time is added to the next one.
 *
 * How a phoneme looks depends on what follows: its frames wait until the next phoneme and everything within the
 * kernels' reach are known, or until labial_end(). A pause of any length adds no delay if it is pushed whole when it
 * begins.
 *
 * Returns LABIAL_OK or, with the stream unchanged, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE (after labial_end() or
 * labial_cancel()), LABIAL_ERROR_PHONEME, LABIAL_ERROR_DURATION or LABIAL_ERROR_FULL.
 */
int labial_push(labial_t *stream, unsigned phoneme, uint32_t milliseconds);

/* Phonemes that can be pushed before the queue is full; 0 when none, or when the stream accepts no more. */
unsigned labial_room(const labial_t *stream);

/*
 * No more phonemes will come. After the frames of the last one the face comes to rest in LABIAL_EASE_FRAMES more,
 * unless it is the neutral one already; then the stream is done.
 *
 * Returns LABIAL_OK (also when called again), LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_end(labial_t *stream);

/*
 * Call once per frame period. Accepts one frame of the pushed phonemes and delivers the frame that was accepted
 * LABIAL_DELAY(stride) ticks before; every call does about the same work. When phonemes come too late, the stream is
 * late by one frame for each tick that returned LABIAL_STARVED, and catches up by as many extra calls (docs/kiosk.md).
 *
 * A face that is not at rest when a frame is missing keeps its pose for LABIAL_HOLD_TICKS ticks from the last frame
 * or push; then it comes to rest in LABIAL_EASE_FRAMES ticks, each of which calls the callback. The next frames lead
 * from there to the motion as at the beginning.
 *
 * Returns LABIAL_OK after one call of the callback with the next frame; LABIAL_WAITING (before the first frame since
 * labial_init() or labial_restart()) or LABIAL_STARVED when it is missing; LABIAL_DONE; LABIAL_ERROR_NULL or
 * LABIAL_ERROR_STATE.
 */
int labial_tick(labial_t *stream);

/*
 * Drops everything that is not yet delivered, and eases the last delivered frame back to the neutral face over
 * `milliseconds`, rounded up to whole frames, 1 .. LABIAL_CANCEL_MAX; then the stream is done.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_cancel(labial_t *stream, uint32_t milliseconds);

/*
 * Continues a stream that has ended or was cancelled: phonemes can be pushed again, frame numbers continue, and the
 * first 8 frames lead from the last delivered face to the motion, as in labial_use(), so that there is no jump. The
 * current model stays. A face that is still on its way to rest goes on while the first frame is missing.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (before labial_init(), before labial_end() or
 * labial_cancel(), or while frames of phonemes are still to come).
 */
int labial_restart(labial_t *stream);

/*
 * Whether the stream delivers exactly the frames of its phonemes, from the next tick on: with anything but 0 it is done
 * after the last of them, and holds the face for as long as phonemes are late. A cancel and the first frames are as
 * always. It is 0 after labial_init(); a cancel or a restart keeps it. For programs that compute frames ahead of their
 * time, not by a clock, or count them.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_exact(labial_t *stream, int exact);

/*
 * How far the mouth moves: every channel's distance from the neutral face, in percent of what the models learned. It is
 * 100 after labial_init(); 50 is a mumble, 130 a shout, 0 the neutral face, but for FAP 17, which follows the corners
 * and is up to 3 units off with the bundled models; more than LABIAL_ARTICULATION_MAX counts as that. Lips still meet
 * in p, b, m and the lower lip still touches the teeth in f, v: what is in contact is moved by 100 percent at most. It
 * costs no time.
 *
 * Set it whenever you like: each accepted frame moves up to 10 percent towards the new value, so that the motion does
 * not jump. Frames show that LABIAL_DELAY(stride) ticks later, or up to `stride` ticks less. Before the first frame,
 * and after a cancel or a restart, the new value applies at once. It holds for all models, and a cancel or a restart
 * keeps it.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_articulation(labial_t *stream, unsigned percent);

/* How much input a stream holds, and how late its output is. The same for phonemes, sound (labial/hear.h) and words
 * (labial/words.h). */
typedef struct {
    uint32_t frames;             /* pushed and not yet delivered; those in which the face comes to rest do not count */
    uint32_t milliseconds;       /* the same as time, rounded to the nearest */
    unsigned phonemes;           /* in the queue: pushed, with frames that are not yet accepted */
    unsigned delay;              /* frames from a frame's input to its output, of a stream LABIAL_DELAY(); constant */
    uint32_t delay_milliseconds; /* the same as time */
} labial_latency_t;

/* The stream's current latency; all zero for a null or uninitialised stream. */
labial_latency_t labial_latency(const labial_t *stream);

#ifdef __cplusplus
}
#endif

#endif
