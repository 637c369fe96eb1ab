/*
 * Any window of samples and any level that a stream can have; any sample at any place of a window.
 */
#include "hear_features.h"

#include "prove.h"

int main(void)
{
    static labial_hear_features_t stream;
    static int16_t window[LABIAL_HEAR_WINDOW_], features[LABIAL_HEAR_BANDS];
    int32_t level = Frama_C_interval(LABIAL_HEAR_LEVEL_LEAST, 64 * LABIAL_HEAR_BANDS * 46 * 256);
    FILL(window);
    labial_hear_features(window, &level, features);
    labial_hear_features_reset(&stream);
    FILL(stream.window);
    FILL(stream.tail);
    stream.hop = (uint8_t)Frama_C_interval(0, 1);
    stream.filled = (uint16_t)Frama_C_interval(LABIAL_HEAR_SHARED, LABIAL_HEAR_WINDOW_ - 1);
    stream.level = Frama_C_interval(LABIAL_HEAR_LEVEL_LEAST, 64 * LABIAL_HEAR_BANDS * 46 * 256);
    labial_hear_features_begun(&stream);
    labial_hear_features_take(&stream, any_int16);
    return 0;
}
