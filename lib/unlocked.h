/*
 * unlocked.h - what stream.c does about LABIAL_LOCKS: its calls have other names, and locks.c has theirs (locks.h).
 */
#ifndef LABIAL_UNLOCKED_H
#define LABIAL_UNLOCKED_H

#include "locks.h"

#if LABIAL_LOCKS > 0
#define labial_use labial_unlocked_use
#define labial_push labial_unlocked_push
#define labial_room labial_unlocked_room
#define labial_end labial_unlocked_end
#define labial_tick labial_unlocked_tick
#define labial_cancel labial_unlocked_cancel
#define labial_restart labial_unlocked_restart
#define labial_exact labial_unlocked_exact
#define labial_articulation labial_unlocked_articulation
#endif

/* The end of what a tick does with its stream, before it calls the callback. */
#if LABIAL_LOCKS > 1
#define LABIAL_TICK_ENDS(stream) labial_unlock(stream)
#else
#define LABIAL_TICK_ENDS(stream) ((void)0)
#endif

#endif
