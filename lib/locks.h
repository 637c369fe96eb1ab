/*
 * locks.h - with LABIAL_LOCKS, the calls of labial.h without their lock, which stream.c has; locks.c has those with it.
 * What only reads a stream (cost.c, visemes.c) takes the lock itself.
 */
#ifndef LABIAL_LOCKS_H
#define LABIAL_LOCKS_H

#include "labial/labial.h"

#if LABIAL_LOCKS > 0

int labial_unlocked_use(labial_t *stream, const labial_model_t *model);
int labial_unlocked_push(labial_t *stream, unsigned phoneme, uint32_t milliseconds);
unsigned labial_unlocked_room(const labial_t *stream);
int labial_unlocked_end(labial_t *stream);
int labial_unlocked_tick(labial_t *stream); /* its callback is called without the lock */
int labial_unlocked_cancel(labial_t *stream, uint32_t milliseconds);
int labial_unlocked_restart(labial_t *stream);
int labial_unlocked_exact(labial_t *stream, int exact);
int labial_unlocked_articulation(labial_t *stream, unsigned percent);

#define LABIAL_LOCK(stream) labial_lock(stream)
#define LABIAL_UNLOCK(stream) labial_unlock(stream)
#else
#define LABIAL_LOCK(stream) ((void)0)
#define LABIAL_UNLOCK(stream) ((void)0)
#endif

#endif
