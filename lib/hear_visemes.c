/*
 * hear_visemes.c - the sounds that a frame of hearing shows (labial_hear_visemes()): those of the classes that lead in
 * it and beside it. hearing/integer.py computes the same integers.
 */
#include "fade.h"
#include "fixed.h"
#include "hear_parts.h"
#include "labial/hear.h"

/* How much of the sound of the last frame the face shows. */
static uint32_t sound_shown(const labial_hear_t *hear)
{
    uint32_t whole;
    if (hear->told == LABIAL_HEAR_NOTHING_)
        return 0;
    whole = (uint32_t)(labial_hear_motion_share(&hear->motion) * LABIAL_VISEME_ONE) >> 14;
    return hear->told == LABIAL_HEAR_SOUND_ ? whole : labial_fade_left(&hear->fade, whole);
}

/* Adds a class of this viseme to the parts of the sounds; what is no viseme is silence. */
static void add_class(unsigned viseme, unsigned part, uint8_t parts[LABIAL_VISEMES])
{
    if (viseme == LABIAL_VISEME_NONE)
        return;
    if (viseme >= LABIAL_VISEMES)
        viseme = LABIAL_VISEME_SIL;
    parts[viseme] = (uint8_t)(parts[viseme] + part);
}

int labial_hear_visemes(const labial_hear_t *hear, const uint8_t *visemes, uint8_t shares[LABIAL_VISEMES])
{
    uint8_t parts[LABIAL_VISEMES] = { 0 };
    uint32_t whole, sum = 0;
    unsigned i;
    if (!hear || !visemes || !shares)
        return LABIAL_ERROR_NULL;
    if (hear->magic != LABIAL_HEAR_MAGIC_)
        return LABIAL_ERROR_STATE;
    add_class(visemes[hear->earlier], 1, parts);
    add_class(visemes[hear->shown], 2, parts);
    add_class(visemes[hear->motion.leader], 1, parts);
    for (i = 0; i < LABIAL_VISEMES; i++)
        sum += parts[i];
    whole = sum > 0 ? sound_shown(hear) : 0u;
    for (i = 0; i < LABIAL_VISEMES; i++)
        shares[i] = (uint8_t)(sum > 0 ? labial_quotient(parts[i] * whole + sum / 2u, sum) : 0u);
    shares[LABIAL_VISEME_SIL] = (uint8_t)(shares[LABIAL_VISEME_SIL] + LABIAL_VISEME_ONE - whole);
    return LABIAL_OK;
}
