/*
 * labial/hear.h - lip motion from sound alone: samples of speech in, a stream of frames out.
 *
 *     static labial_hear_t hear;
 *     static uint32_t workspace[HEAR_SMALL_WORKSPACE_SIZE / 4];
 *
 *     labial_hear_init(&hear, &hear_small, 24000, 1, workspace, sizeof workspace, on_frame, NULL);
 *     while ((count = read_sound(samples)) > 0)         // blocks of any length, as they are sent to the loudspeaker
 *         labial_hear_push(&hear, samples, count);      // calls on_frame for each 20 ms
 *     labial_hear_end(&hear);                           // and for the last ones
 *
 * Frames are those of labial.h: 13 FAPs, 50 frames per second, so that rigs, blends and formats take them. Frame k
 * shows the lips in the sound of 20 ms that begins at 20 k ms. It also needs the sound after it: 120 ms from the
 * frame's start with the bundled models, 280 ms with hear_ahead (labial_hear_latency()). If you receive sound that long
 * before you play it, as from a network, hold each frame until its time, and the lips are in step.
 *
 * Speech should be the only sound. Its level does not matter from peaks at full scale, 0 dBFS, down to 200 of 32,768,
 * -44 dBFS, but that lips begin up to a quarter of a second late where the first word is faint. A stream begins and
 * ends with the neutral face, all FAPs 0, and so is silence: sound whose samples differ by 32 at most for 140 ms. So is
 * steady noise before the first word if its root mean square is -55 dBFS at most, or -40 dBFS of a hum or a rumble,
 * whose energy is in low frequencies; louder noise opens the mouth for as long as it lasts. A constant offset of the
 * samples is not heard, neither where a sound begins nor where it ends; a step of it in between is.
 *
 * Like the stream of phonemes (labial/labial.h) it never allocates, keeps no state outside `hear` and `workspace`,
 * computes in integers only and gives the same bits on every target and for blocks of any length. Calls on one stream
 * must not overlap; calls on different streams may. The structure may be moved or copied between calls as long as the
 * workspace stays where it is and only one copy is used from then on. Nothing needs to be released. Models are trusted;
 * samples and the order of calls are not.
 */
#ifndef LABIAL_HEAR_H
#define LABIAL_HEAR_H

#include <stddef.h>
#include <stdint.h>

#include "labial/hear_model.h"
#include "labial/hear_private.h"
#include "labial/labial.h"
#include "labial/result.h"
#include "labial/visemes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Frames per second. */
#define LABIAL_HEAR_FPS 50

/*
 * Receives a stretch of speech of one lip class: `shown` numbers the model's classes (NAME_CLASSES of its header),
 * `frame` is the first frame, `frames` how many have it, at least one. Without gaps: the next stretch begins where this
 * one ends. It is called after the last of these frames.
 */
typedef void (*labial_hear_class_fn)(void *user, unsigned shown, uint32_t frame, uint32_t frames);

/* ---- The calls ------------------------------------------------------------------------------------------------- */

/* Bytes of workspace for a model of so many units and rows, a multiple of four; a constant expression if both are.
 * NAME_WORKSPACE_SIZE of a model's header is this. */
#define LABIAL_HEAR_WORKSPACE_SIZE(units, rows) ((uint32_t)((units) * (rows)*2u))

/* The same for a given model; 0 for a null pointer. */
uint32_t labial_hear_workspace_size(const labial_hear_model_t *model);

/*
 * Prepares a stream and discards what it contained. The sound has 8000, 12000, 16000, 22050, 24000, 32000, 44100 or
 * 48000 `samples_per_second`; `channels` is 1 or 2, of which the mean is heard.
 *
 * `workspace` must be aligned to four bytes and have labial_hear_workspace_size() bytes. It belongs to the stream, and
 * the model must stay where it is, until the stream is initialised again or no longer used. `callback` receives the
 * frames, with `user` as its first argument.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_VERSION, LABIAL_ERROR_SAMPLE_RATE, LABIAL_ERROR_RANGE (channels,
 * or a model with more units than LABIAL_HEAR_UNITS_MAX of labial/config.h) or LABIAL_ERROR_WORKSPACE. After an error
 * the stream is unusable until it is initialised successfully.
 */
int labial_hear_init(labial_hear_t *hear, const labial_hear_model_t *model, uint32_t samples_per_second,
                     unsigned channels, void *workspace, size_t workspace_size, labial_frame_fn callback, void *user);

/*
 * Calls `callback` with the lip classes, and with the same `user`, from now on; null for none. Their names are
 * phonemes, so that a program can show them, or push them to a stream of phonemes (labial/labial.h).
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_hear_classes(labial_hear_t *hear, labial_hear_class_fn callback);

/*
 * The sounds of the frame that was delivered last, in its callback or until the next call (labial/visemes.h): the
 * classes that lead in it and in the frames beside it, a half and two quarters, as its pose is smoothed. `visemes` has
 * the viseme of each class of the model: labial_heard_visemes for those that Labial trains. In silence, and on the way
 * to rest, the shares pass to silence in step with the face.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (before labial_hear_init()).
 */
int labial_hear_visemes(const labial_hear_t *hear, const uint8_t *visemes, uint8_t shares[LABIAL_VISEMES]);

/*
 * Hears `count` samples, of two channels as many pairs, left first, and calls the callbacks for all frames that these
 * complete. In a callback, functions that change the same stream return LABIAL_ERROR_STATE, but for labial_hear_init():
 * with it the stream begins anew, the call that the callback is in does nothing more, also with the rest of its sound,
 * and returns LABIAL_OK.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (after labial_hear_end() or labial_hear_cancel()).
 */
int labial_hear_push(labial_hear_t *hear, const int16_t *samples, size_t count);

/*
 * No more sound will come: delivers all frames that are still to come, as if the last sample stayed. A frame that the
 * sound fills in part is the last one; after it the face comes to rest in LABIAL_EASE_FRAMES more, unless it is the
 * neutral one already. The callback receives all of them during the call; a program shows one every 20 ms.
 *
 * Returns LABIAL_OK (also when called again), LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_hear_end(labial_hear_t *hear);

/*
 * Whether the end delivers the frames of the sound alone, from now on; 0 after labial_hear_init().
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_hear_exact(labial_hear_t *hear, int exact);

/*
 * Drops everything that is not yet delivered, and eases the last delivered frame back to the neutral face (all FAPs 0)
 * over `milliseconds`, rounded up to whole frames, 1 .. LABIAL_CANCEL_MAX. The callback receives these frames during
 * the call; a program shows one every 20 ms.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_hear_cancel(labial_hear_t *hear, uint32_t milliseconds);

/*
 * Continues after labial_hear_end() or labial_hear_cancel(): frame numbers continue, the new sound begins with the next
 * frame, and the first frames are cross-faded from the last delivered one. The level stays (labial_hear_level()).
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (unless the stream has ended).
 */
int labial_hear_restart(labial_hear_t *hear);

/*
 * The level of the voice: the largest mean of the log2 energies of the network's 24 bands, in 1/256, that is 85 for a
 * decibel; it falls by 2.4 dB a second. Speech whose peaks are at full scale has some 7,700.
 *
 * A sound begins at LABIAL_HEAR_LEVEL_BEGIN, or where labial_hear_set_level() sets it, and after labial_hear_restart()
 * at the level of the sound before. The face rests until a sound comes within 12 dB of that, or rises 9 dB above the
 * noise; then the level falls by 9 dB a second until the voice reaches it. Set the level where you know it, so that the
 * first word is heard at it: for a file, hear it once from LABIAL_HEAR_LEVEL_MIN on, look at the level every 10 ms, and
 * take the largest.
 */
#define LABIAL_HEAR_LEVEL_MIN 3328
#define LABIAL_HEAR_LEVEL_BEGIN 6656
#define LABIAL_HEAR_LEVEL_MAX 11776

/* The level now; 0 for a null or uninitialised stream. */
unsigned labial_hear_level(const labial_hear_t *hear);

/* Sets the level, LABIAL_HEAR_LEVEL_MIN .. LABIAL_HEAR_LEVEL_MAX, before the first sample of a sound.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_RANGE or LABIAL_ERROR_STATE (while a sound is heard).
 */
int labial_hear_set_level(labial_hear_t *hear, unsigned level);

/*
 * How far the mouth moves, as labial_articulation() says it: the poses that the network tells from now on come nearer
 * to `percent`, by up to 10 each. Frames show that two frames later at the latest.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_hear_articulation(labial_hear_t *hear, unsigned percent);

/* The stream's current latency; all zero for a null or uninitialised stream. `frames` are those with sound, also in
 * part, that are not yet delivered; a frame is delivered with the sample that is `delay_milliseconds` after its first
 * one, which at other rates than 16 kHz is up to a millisecond more than `delay` frames. */
labial_latency_t labial_hear_latency(const labial_hear_t *hear);

#ifdef __cplusplus
}
#endif

#endif
