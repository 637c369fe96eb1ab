/*
 * closure.c - levels of the sound, and the silence before a burst.
 */
#include "closure.h"

#include <string.h>

#define FRAME_MS 5u
#define FRAMES_PER_SECOND (1000u / FRAME_MS)
#define LONGEST_MS 100u /* of a closure */
#define KEPT_MS 20u     /* by the phoneme before */
#define SILENT_SHARE 16u

void closure_init(closure_t *closure, unsigned samples_per_second)
{
    memset(closure, 0, sizeof *closure);
    closure->rate = samples_per_second;
}

void closure_sound(closure_t *closure, const short *samples, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint64_t frame = closure->samples * FRAMES_PER_SECOND / closure->rate;
        closure->sum += (uint64_t)(samples[i] < 0 ? -(int32_t)samples[i] : samples[i]);
        closure->count++;
        closure->samples++;
        if (closure->samples * FRAMES_PER_SECOND / closure->rate > frame) {
            closure->level[frame % CLOSURE_FRAMES] = (uint16_t)(closure->sum / closure->count);
            closure->sum = 0;
            closure->count = 0;
        }
    }
}

uint64_t closure_begin(const closure_t *closure, uint64_t before, uint64_t burst)
{
    const uint64_t known = closure->samples * FRAMES_PER_SECOND / closure->rate;
    const uint64_t end = burst / FRAME_MS < known ? burst / FRAME_MS : known;
    const uint64_t oldest = known > CLOSURE_FRAMES ? known - CLOSURE_FRAMES : 0;
    uint64_t first = (before + KEPT_MS + FRAME_MS - 1u) / FRAME_MS;
    unsigned loudest = 0;
    for (uint64_t k = before / FRAME_MS > oldest ? before / FRAME_MS : oldest; k < end; k++)
        if (closure->level[k % CLOSURE_FRAMES] > loudest)
            loudest = closure->level[k % CLOSURE_FRAMES];
    if (first < oldest)
        first = oldest;
    if (end > LONGEST_MS / FRAME_MS && first < end - LONGEST_MS / FRAME_MS)
        first = end - LONGEST_MS / FRAME_MS;
    uint64_t begin = end;
    while (begin > first && closure->level[(begin - 1u) % CLOSURE_FRAMES] * SILENT_SHARE <= loudest)
        begin--;
    return begin < end ? begin * FRAME_MS : burst;
}

int closure_is_stop(const char *label)
{
    /* In UTF-8 the IPA's g, t and d with tails, barred j and small capital g. */
    static const char *const others[] = { "\xc9\xa1", "\xca\x88", "\xc9\x96", "\xc9\x9f", "\xc9\xa2" };
    if (label[0] != '\0' && strchr("ptkbdgcq", label[0]))
        return 1;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (strncmp(label, others[i], 2) == 0)
            return 1;
    return 0;
}
