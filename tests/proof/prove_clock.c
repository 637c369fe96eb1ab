/* Any sounds at any times, on clocks of any rate, and on one that is whatever labial_clock_play() may have left. */
#include "labial/clock.h"

#include "prove.h"

static volatile int64_t any_int64;

int main(void)
{
    labial_clock_t clock;
    int64_t sample;
    labial_clock_init(NULL, any_uint32);
    labial_clock_init(&clock, any_uint32);
    while (any_int) {
        if (any_int)
            labial_clock_play(&clock, any_int64, any_uint32, any_int64);
        if (any_int)
            labial_clock_stop(&clock);
        labial_clock_at(&clock, any_int64, &sample);
    }
    return 0;
}
