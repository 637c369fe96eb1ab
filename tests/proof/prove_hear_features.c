/*
 * Any window of samples and any level that a stream can have.
 */
#include "hear_features.h"

#include "prove.h"

int main(void)
{
    static int16_t window[LABIAL_HEAR_WINDOW_], features[LABIAL_HEAR_BANDS];
    int32_t level = Frama_C_interval(LABIAL_HEAR_LEVEL_LEAST, 64 * LABIAL_HEAR_BANDS * 46 * 256);
    FILL(window);
    labial_hear_features(window, &level, features);
    return 0;
}
