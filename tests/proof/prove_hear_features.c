/*
 * Any window of samples and any level that a stream can have; any sample, the first one or at any place of a window.
 */
#include "hear_parts.h"

#include "prove.h"

static void any_level(labial_hear_level_t *level)
{
    level->level = Frama_C_interval(LABIAL_HEAR_LEVEL_MIN / 256 * LABIAL_HEAR_LEVEL_ONE, 46 * LABIAL_HEAR_LEVEL_ONE);
    level->quietest = Frama_C_interval(LABIAL_HEAR_LEVEL_ONE, LABIAL_HEAR_LEVEL_NONE);
    level->before = Frama_C_interval(LABIAL_HEAR_LEVEL_ONE, LABIAL_HEAR_LEVEL_NONE);
    level->stage = (uint8_t)Frama_C_interval(0, 2);
}

int main(void)
{
    static labial_hear_features_t stream;
    static int16_t window[LABIAL_HEAR_WINDOW_], features[LABIAL_HEAR_BANDS];
    labial_hear_level_t level;
    any_level(&level);
    FILL(window);
    labial_hear_features(window, any_int, &level, features);
    labial_hear_features_reset(&stream);
    FILL(stream.window);
    FILL(stream.tail);
    stream.hop = (uint8_t)Frama_C_interval(0, 1);
    any_level(&stream.level);
    labial_hear_features_last(&stream);
    labial_hear_features_take(&stream, any_int16); /* the first one */
    stream.filled = (uint16_t)Frama_C_interval(LABIAL_HEAR_SHARED, LABIAL_HEAR_WINDOW_ - 1);
    labial_hear_features_begun(&stream);
    labial_hear_features_last(&stream);
    labial_hear_features_take(&stream, any_int16);
    return 0;
}
