/*
 * grow.h - lists that grow.
 */
#ifndef LABIAL_EXAMPLE_GROW_H
#define LABIAL_EXAMPLE_GROW_H

#include <stdint.h>
#include <stdlib.h>

/* Makes room for one more of `size` bytes at `items`. Returns the list, moved if need be, or null. */
static inline void *grow(void *items, size_t count, size_t *room, size_t size)
{
    if (count < *room)
        return items;
    const size_t wanted = *room ? *room * 2u : 256u;
    if (wanted > SIZE_MAX / size)
        return NULL;
    void *moved = realloc(items, wanted * size);
    if (moved)
        *room = wanted;
    return moved;
}

#endif
