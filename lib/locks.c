/*
 * locks.c - the calls of labial.h with their lock, in builds with LABIAL_LOCKS (labial/config.h).
 */
#include "locks.h"

#if LABIAL_LOCKS > 0

int labial_use(labial_t *stream, const labial_model_t *model)
{
    int result;
    labial_lock(stream);
    result = labial_unlocked_use(stream, model);
    labial_unlock(stream);
    return result;
}

int labial_push(labial_t *stream, unsigned phoneme, uint32_t milliseconds)
{
    int result;
    labial_lock(stream);
    result = labial_unlocked_push(stream, phoneme, milliseconds);
    labial_unlock(stream);
    return result;
}

unsigned labial_room(const labial_t *stream)
{
    unsigned room;
    labial_lock(stream);
    room = labial_unlocked_room(stream);
    labial_unlock(stream);
    return room;
}

int labial_end(labial_t *stream)
{
    int result;
    labial_lock(stream);
    result = labial_unlocked_end(stream);
    labial_unlock(stream);
    return result;
}

int labial_tick(labial_t *stream)
{
#if LABIAL_LOCKS > 1
    int result;
    labial_lock(stream);
    result = labial_unlocked_tick(stream);
    if (result < 0) /* else the tick unlocks at its end, before the callback */
        labial_unlock(stream);
    return result;
#else
    return labial_unlocked_tick(stream);
#endif
}

int labial_cancel(labial_t *stream, uint32_t milliseconds)
{
    int result;
    labial_lock(stream);
    result = labial_unlocked_cancel(stream, milliseconds);
    labial_unlock(stream);
    return result;
}

int labial_restart(labial_t *stream)
{
    int result;
    labial_lock(stream);
    result = labial_unlocked_restart(stream);
    labial_unlock(stream);
    return result;
}

int labial_exact(labial_t *stream, int exact)
{
    int result;
    labial_lock(stream);
    result = labial_unlocked_exact(stream, exact);
    labial_unlock(stream);
    return result;
}

int labial_articulation(labial_t *stream, unsigned percent)
{
    int result;
    labial_lock(stream);
    result = labial_unlocked_articulation(stream, percent);
    labial_unlock(stream);
    return result;
}

#endif
