/*
 * channels.h - the channel step: targets in, motion out.
 *
 * A state lasts `stride` frames, and so channels take turns: in each tick those that are next are searched and solved
 * for the frames since their last step, up to the latest one, and go back from there to the frames that are due.
 * Channel c has its step every `stride` ticks, c ticks apart from channel 0. So every tick does about the same work,
 * and a frame is complete LABIAL_DELAY(stride) ticks after it was accepted.
 *
 * Models of a stream may have different numbers of channels. As many step as the widest model has of those whose frames
 * are in hand. Beside frames of a narrower model the others move as its first channel does, and nobody asks.
 */
#ifndef LABIAL_CHANNELS_H
#define LABIAL_CHANNELS_H

#include "labial/labial.h"

/* Divides up a workspace of LABIAL_WORKSPACE_SIZE(stride, width) bytes, for labial_channels_reset() to clear; returns the
 * place of two shapes in it. */
labial_shape_t *labial_channels_init(labial_channels_t *channels, unsigned stride, unsigned width, void *workspace);

/* Drops all frames. */
void labial_channels_reset(labial_channels_t *channels);

/* Advances by a tick; returns the accepted frame, of the model in `slot`, for the caller to fill in. */
labial_frame_t *labial_channels_enter(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                                      unsigned slot);

/* Advances by a tick beyond the last accepted frame, whose marks say so. */
void labial_channels_run_out(labial_channels_t *channels);

/* Searches and solves the channels that are next; the frames that are solved now have the articulation `gain`, in
 * 1/LABIAL_GAIN_ONE (trajectory.h). */
void labial_channels_step(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS], int32_t gain);

/* Writes the frame that is due, Q4 FAP; returns whether one is. */
int labial_channels_due(const labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                        int16_t frame[LABIAL_CHANNELS]);

/* ---- The channels of a frame that follow others (followers.c): the same value again, or FAP 17 of the corners ---- */

enum { LABIAL_FAP_17 = 2, LABIAL_FAP_53 = 5, LABIAL_FAP_54 = 6 }; /* places in a frame */

/* FAP 17 for the sum of both corners, each Q4 FAP of 16 bits; Q4 FAP. */
int16_t labial_protrusion(const labial_protrusion_t *table, int32_t corners);

/* The frame that a model's channels make, Q4 FAP: channel c moves to motion[c * spacing]. */
void labial_followers_complete(const labial_model_t *model, const int16_t *motion, unsigned spacing,
                               int16_t frame[LABIAL_CHANNELS]);

#endif
